# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF and GLB: all triangles of all meshes as one mesh, and new texture coordinates into the document."""

from __future__ import annotations

import base64
import contextlib
import mimetypes
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.counted import counted
from ..errors import Finding, InputError
from ..indexed_uv import index_corners
from .gltf_document import (
    FLOAT,
    INDICES,
    UNSIGNED_INT,
    UNSIGNED_SHORT,
    VERTICES,
    Document,
    ReadUri,
    component_of,
    index_of,
    load_document,
    objects_of,
    quoted_text,
    some_numbers,
    uri_data,
    whole_number,
    without_compressed,
)
from .mesh_text import malformed
from .polygons import PolygonMesh
from .welding import weld

TRIANGLES, STRIPS = 4, (5, 6)
POSITION, UV, TANGENTS = "POSITION", "TEXCOORD_0", "TANGENT"
BROKEN = (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError, RecursionError)
# Triangles of all primitives, where these share so much data that there are more corners than bytes.
SHARED_TRIANGLES = 1_000_000


@dataclass(frozen=True)
class _Primitive:
    """One of a mesh. content: its JSON. vertices: (3 t,) the vertices at the corners of its triangles."""

    mesh: int
    content: dict[str, Any]
    vertices: NDArray[np.int64]


def read_gltf(data: bytes, read_uri: ReadUri, with_uv: bool = False) -> PolygonMesh:
    """The triangles of all meshes, in their order, at the places that their first node gives them.

    Vertices of a mesh at exactly the same place are one: glTF repeats them at hard edges, materials and seams.
    read_uri: the content of a file beside the document.  Raises OSError, InputError: MALFORMED_FILE.
    """
    with _contradictions_refused():
        return _joined(load_document(data, read_uri), with_uv)


@contextlib.contextmanager
def _contradictions_refused() -> Iterator[None]:
    """Raises InputError: MALFORMED_FILE where a document does not have what it refers to, or has another type."""
    try:
        yield
    except InputError:
        raise
    except BROKEN as error:
        raise malformed(f"the glTF contradicts itself ({type(error).__name__}: {error}).") from error


def edit_gltf(
    data: bytes, read_uri: ReadUri, corner_uv: NDArray[np.float64], *, binary: bool, with_images: bool
) -> tuple[bytes, tuple[Finding, ...]]:
    """The document with these texture coordinates, (c, 2) per corner of `read_gltf`'s mesh, as a GLB or a glTF file.

    They become TEXCOORD_0 of every primitive; vertices with several coordinates are split, with all that they have.
    Triangles with a NaN keep the coordinates they have. Tangents follow from coordinates and are taken out. The rest of
    the document stays, its binary data inside the file.

    with_images: take images that are files of their own into the document.  Raises InputError: MALFORMED_FILE.
    """
    with _contradictions_refused():
        document = load_document(data, read_uri)
        outside = _take_in_images(document, read_uri) if with_images else []
        tangents, missing = _put_uv(document, corner_uv)
        edited = document.to_bytes(binary=binary)
    findings = []
    if outside:
        findings.append(
            Finding(
                "CONTENT_NOT_KEPT",
                "Images outside the document's folder are not read and were not taken along, first "
                f"{quoted_text(outside[0])}. Copy them beside it.",
            )
        )
    if tangents:
        findings.append(
            Finding("CONTENT_NOT_KEPT", "Tangents belong to the old texture coordinates and were taken out.")
        )
    if missing:
        findings.append(unsolved_at_origin(missing, "glTF"))
    return edited, tuple(findings)


def _put_uv(document: Document, corner_uv: NDArray[np.float64]) -> tuple[int, int]:
    """The coordinates of all corners into the document; of how many primitives tangents were taken out, and how many
    triangles have no coordinates."""
    uses = _accessor_uses(document)
    tangents = missing = at = 0
    for primitive in list(_primitives(document)):
        count = len(primitive.vertices)
        uv, without = _stored(document, primitive, corner_uv[at : at + count])
        at += count
        missing += without
        tangents += primitive.content["attributes"].pop(TANGENTS, None) is not None
        _split(document, primitive, uv, uses)
    return tangents, missing


def new_gltf(
    positions: NDArray[np.float64], triangles: NDArray[np.int32], corner_uv: NDArray[np.float64], *, binary: bool
) -> tuple[bytes, tuple[Finding, ...]]:
    """A document of one mesh.  triangles: (m, 3). corner_uv: (m, 3, 2), NaN where there is none.

    Raises InputError: EMPTY_MESH, WRONG_PARAMETER.
    """
    if not len(triangles):
        raise InputError("EMPTY_MESH", "glTF cannot hold a mesh without triangles. Give one with some.")
    missing = int(np.isnan(corner_uv).any(axis=(1, 2)).sum())
    solved = np.where(np.isnan(corner_uv).any(axis=(1, 2))[:, None, None], 0.0, corner_uv)
    vt, index = index_corners(triangles.ravel(), _flipped(solved.reshape(-1, 2)))
    vertex = np.empty(len(vt), np.int64)
    vertex[index] = triangles.ravel()
    document = Document({"asset": {"version": "2.0", "generator": "lsgp"}}, [], positions.nbytes + corner_uv.nbytes)
    places = _in_single_precision(positions[vertex])
    attributes = {
        POSITION: _new_accessor(document, places, "VEC3", FLOAT, VERTICES) | _limits(places),
        UV: _new_accessor(document, _in_single_precision(vt), "VEC2", FLOAT, VERTICES),
    }
    primitive = {name: document.add_accessor(accessor) for name, accessor in attributes.items()}
    indices = _new_accessor(document, index.astype(np.uint32)[:, None], "SCALAR", UNSIGNED_INT, INDICES)
    document.content |= {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": primitive, "indices": document.add_accessor(indices)}]}],
    }
    return document.to_bytes(binary=binary), (unsolved_at_origin(missing, "glTF"),) if missing else ()


def _in_single_precision(numbers: NDArray[np.float64]) -> NDArray[np.float32]:
    """Raises InputError: WRONG_PARAMETER where they are beyond its range."""
    with np.errstate(over="ignore"):
        single = numbers.astype(np.float32)
    if not np.isfinite(single).all():
        raise InputError(
            "WRONG_PARAMETER",
            f"glTF holds numbers up to {np.finfo(np.float32).max:.2g}, and the mesh has {np.abs(numbers).max():.2g}. "
            "Write OBJ, or scale the mesh.",
        )
    return single


def unsolved_at_origin(count: int, form: str) -> Finding:
    """The warning about faces without texture coordinates in a format that requires them for every vertex."""
    return Finding(
        "UNSOLVED_AT_ORIGIN",
        f"{counted(count, 'face has', 'faces have')} no texture coordinates, which {form} cannot say: they are at the "
        "origin. Write OBJ where that matters.",
    )


def _joined(document: Document, with_uv: bool) -> PolygonMesh:
    transforms = _transforms(document)
    primitives = list(_primitives(document))
    positions, corners, first = [np.empty((0, 3))], [np.empty(0, np.int64)], 0
    for mesh, own in groupby(primitives, lambda primitive: primitive.mesh):
        places, index = weld(np.concatenate([_points(document, primitive) for primitive in own]))
        positions.append(_placed(places, transforms.get(mesh, np.eye(4))))
        corners.append(index + first)
        first += len(places)
    faces = np.concatenate(corners).astype(np.int32)
    uv = [np.empty((0, 2)), *(_old_uv(document, primitive) for primitive in primitives)] if with_uv else None
    return PolygonMesh(
        np.concatenate(positions),
        faces,
        np.full(len(faces) // 3, 3, np.int64),
        None if uv is None else np.concatenate(uv),
        _extras(document, primitives),
        document.named_files(),
    )


def _primitives(document: Document) -> Iterator[_Primitive]:
    """Those of triangles, in the order of the document; points and lines are passed over."""
    corners = 0
    for number, mesh in enumerate(document.content.get("meshes", [])):
        for content in objects_of(mesh, "primitives"):
            mode = whole_number(content, "mode", TRIANGLES)
            if mode in STRIPS:
                raise malformed("triangle strips and fans are not read; export triangles.")
            if mode != TRIANGLES or POSITION not in _attributes(content):
                continue
            indices, position = content.get("indices"), content["attributes"][POSITION]
            count = document.count(position)
            corners += count if indices is None else document.count(indices)
            if corners > max(3 * SHARED_TRIANGLES, document.size):
                raise malformed(f"a glTF of {document.size} bytes with {corners // 3} triangles or more.")
            document.rows(position)  # which has as many
            vertices = np.arange(count) if indices is None else document.indices(indices)
            if len(vertices) % 3 or (vertices >= count).any():
                raise malformed("triangles that are cut short or name vertices that are not there.")
            yield _Primitive(number, content, vertices)


def _attributes(primitive: dict[str, Any]) -> dict[str, Any]:
    """The accessors of a primitive by the names of attributes.  Raises InputError."""
    found = primitive.get("attributes")
    if not isinstance(found, dict):
        raise malformed("a primitive of the glTF has no attributes.")
    return found


def _points(document: Document, primitive: _Primitive) -> NDArray[np.float64]:
    """(3 t, 3) places of the corners."""
    return document.numbers(primitive.content["attributes"][POSITION], "VEC3", primitive.vertices)


def _old_uv(document: Document, primitive: _Primitive) -> NDArray[np.float64]:
    """(3 t, 2) coordinates at the corners, NaN where the primitive has none."""
    accessor = primitive.content["attributes"].get(UV)
    if accessor is None:
        return np.full((len(primitive.vertices), 2), np.nan)
    return _flipped(document.numbers(accessor, "VEC2", primitive.vertices))


def _flipped(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """To glTF, where v runs down from the upper left corner of the texture, or from it."""
    return np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)


def _placed(points: NDArray[np.float64], transform: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(all="ignore"):
        placed = _product(transform[:3, :3], points.T).T + transform[:3, 3]
        first, second, third = transform[:3, :3]
        if (np.cross(first, second) * third).sum() < 0:
            placed[:, 0] *= -1  # the triangles are to turn as they do in the mesh
    return placed


def _product(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of matrices. That of numpy is rounded otherwise on other processors, and these are positions."""
    return sum(left[:, k, np.newaxis] * right[k] for k in range(len(right)))


def _transforms(document: Document) -> dict[int, NDArray[np.float64]]:
    """Of each mesh, by its number, the transform of the first node that has it, to the scene."""
    nodes, meshes = document.content.get("nodes", []), document.content.get("meshes", [])
    children = [_children(node, nodes) for node in nodes]
    below = {child for of_one in children for child in of_one}
    found: dict[int, NDArray[np.float64]] = {}
    seen = set()
    waiting = [(number, np.eye(4)) for number in range(len(nodes)) if number not in below][::-1]
    while waiting:
        number, above = waiting.pop()
        if number in seen:
            continue
        seen.add(number)
        with np.errstate(over="ignore", invalid="ignore"):  # places that are not finite are refused by the library
            transform = _product(above, _matrix(nodes[number]))
        if "mesh" in nodes[number]:
            found.setdefault(index_of(nodes[number]["mesh"], meshes, "mesh"), transform)
        waiting += [(child, transform) for child in reversed(children[number])]
    return found


def _children(node: dict[str, Any], nodes: list[dict[str, Any]]) -> list[int]:
    found = node.get("children", [])
    if not isinstance(found, list):
        raise malformed("the children of a node of the glTF are no list.")
    return [index_of(child, nodes, "node") for child in found]


def _matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    if "matrix" in node:
        return some_numbers(node, "matrix", (0.0,) * 16).reshape(4, 4).T
    x, y, z, w = some_numbers(node, "rotation", (0.0, 0.0, 0.0, 1.0))
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * some_numbers(node, "scale", (1.0, 1.0, 1.0))
    matrix[:3, 3] = some_numbers(node, "translation", (0.0, 0.0, 0.0))
    return matrix


def _extras(document: Document, primitives: list[_Primitive]) -> tuple[str, ...]:
    """Content of the document other than triangles and their texture coordinates."""
    names = {name for primitive in primitives for name in primitive.content["attributes"]} - {POSITION, UV}
    names |= {key for key in ("materials", "skins", "animations", "cameras") if document.content.get(key)}
    if len(document.content.get("nodes", [])) > 1:
        names.add("nodes")
    if any("targets" in primitive.content for primitive in primitives):
        names.add("morph targets")
    return tuple(quoted_text(name)[1:-1] for name in sorted(names))


def _accessor_uses(document: Document) -> Counter[int]:
    """How often primitives refer to each accessor."""
    uses: Counter[int] = Counter()
    for mesh in document.content.get("meshes", []):
        for primitive in objects_of(mesh, "primitives"):
            named = [accessor for accessors in _holders_of(primitive) for accessor in accessors.values()]
            uses.update(accessor for accessor in [*named, primitive.get("indices")] if type(accessor) is int)
    return uses


def _holders_of(primitive: dict[str, Any]) -> list[dict[str, Any]]:
    """The objects in which accessors stand by the names of attributes: its own and those of its morph targets."""
    return [_attributes(primitive), *objects_of(primitive, "targets")]


def _take_in_images(document: Document, read_uri: ReadUri) -> list[str]:
    """Returns the names of those outside the document's folder, which stay where they are."""
    outside = []
    texts: dict[int, tuple[bytes, str]] = {}  # by the identity of what was read, which stays as long as it is in here
    for image in document.content.get("images", []):
        uri = image.get("uri", "data:")
        if not isinstance(uri, str):
            raise malformed("the name of an image is no text.")
        if uri.startswith("data:"):
            continue
        try:
            data = uri_data(uri, read_uri)
        except OSError:  # one that is missing here is no more missing elsewhere
            continue
        except InputError:
            outside.append(uri)
            continue
        if id(data) not in texts:
            texts[id(data)] = data, base64.b64encode(data).decode("ascii")
            document.size += len(data)
        _, text = texts[id(data)]
        document.require_room(len(text))
        kind = image.get("mimeType") or mimetypes.guess_type(uri)[0] or "application/octet-stream"
        image["uri"] = f"data:{kind};base64,{text}"
    return outside


def _stored(
    document: Document, primitive: _Primitive, corner_uv: NDArray[np.float64]
) -> tuple[NDArray[np.float64], int]:
    """The coordinates of the corners as they are stored, and how many triangles have none, neither old nor new."""
    old = _old_uv(document, primitive).reshape(-1, 3, 2)
    uv = corner_uv.reshape(-1, 3, 2)
    uv = np.where(np.isnan(uv).any(axis=(1, 2))[:, None, None], old, uv)
    missing = np.isnan(uv).any(axis=(1, 2))
    uv = np.where(missing[:, None, None], 0.0, uv)
    return _flipped(uv.reshape(-1, 2)), int(missing.sum())


def _split(document: Document, primitive: _Primitive, uv: NDArray[np.float64], uses: Counter[int]) -> None:
    """Give the primitive vertices that have one coordinate each."""
    vt, index = index_corners(primitive.vertices, uv)
    vertex = np.empty(len(vt), np.int64)
    vertex[index] = primitive.vertices
    content = primitive.content
    without_compressed(content)  # it is of the old vertices
    taken: dict[int, int] = {}
    for accessors in _holders_of(content):
        for name in [name for name in accessors if name != UV or accessors is not content["attributes"]]:
            old = accessors[name]
            document.accessor(old)
            if old not in taken:
                taken[old] = _taken(document, old, vertex, uses)
            accessors[name] = taken[old]
    new_uv = _new_accessor(document, _in_single_precision(vt), "VEC2", FLOAT, VERTICES)
    content["attributes"][UV] = _put(document, content["attributes"].get(UV), new_uv, uses)
    is_short = len(vt) < np.iinfo(np.uint16).max
    numbers = index.astype(np.uint16 if is_short else np.uint32)[:, None]
    indices = _new_accessor(document, numbers, "SCALAR", UNSIGNED_SHORT if is_short else UNSIGNED_INT, INDICES)
    content["indices"] = _put(document, content.get("indices"), indices, uses)


def _taken(document: Document, accessor: int, vertex: NDArray[np.int64], uses: Counter[int]) -> int:
    """An accessor of the elements of these vertices, with all else that the old one says."""
    old, rows = document.accessor(accessor), document.rows(accessor)
    if len(rows) <= vertex.max(initial=-1):
        raise malformed("an attribute has fewer elements than its primitive has vertices.")
    if uses[accessor] > 1:  # it stays for others, and all that it says is written again
        document.require_room(document.text_length(accessor))
    new = old | {"bufferView": document.add_view(rows[vertex], VERTICES), "count": len(vertex)}
    for name in ("byteOffset", "min", "max"):
        new.pop(name, None)
    if "min" in old:
        new |= _limits(np.ascontiguousarray(rows[vertex]).view(component_of(old)))
    return _put(document, accessor, new, uses)


def _limits(values: NDArray) -> dict[str, list[float]]:
    """The least and largest of each component, as far as JSON has the numbers."""
    limits = {"min": values.min(axis=0), "max": values.max(axis=0)}
    return {name: limit.tolist() for name, limit in limits.items() if np.isfinite(limit).all()}


def _put(document: Document, old: int | None, accessor: dict[str, Any], uses: Counter[int]) -> int:
    """In the place of the old one where nothing else uses that, otherwise behind all others."""
    if old is None or uses[old] > 1:
        uses[old] -= 1
        return document.add_accessor(accessor)
    document.content["accessors"][old] = accessor
    return old


def _new_accessor(document: Document, rows: NDArray, kind: str, component: int, target: int) -> dict[str, Any]:
    view = document.add_view(rows, target)
    return {"bufferView": view, "componentType": component, "count": len(rows), "type": kind}
