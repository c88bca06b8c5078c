# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY with texture coordinates, through plyfile: s and t of each vertex, as most programs read them.

plyfile reads and writes lists row by row, and text as well. Where all polygons have as many corners, they are a table
without lists but in name: a million of them take a tenth of the time in a binary file, a thirtieth in text.
"""

from __future__ import annotations

import io
import re
import tempfile
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..errors import Finding, InputError
from ..indexed_uv import index_corners
from .mesh_gltf import unsolved_at_origin
from .mesh_ply import CORNER_LISTS, read_text_tables, structured, with_whole_comments
from .mesh_text import malformed, quoted
from .polygons import PolygonMesh

if TYPE_CHECKING:
    from plyfile import PlyData, PlyElement

UV = ("s", "t")
# Coordinates of the corners of faces, of which those of the vertices take the place.
WEDGE_UV = "texcoord"
ROW_COUNT = re.compile(rb"^(\s*element\s+\S+\s+)\d+", re.MULTILINE)


def format_ply(
    mesh: PolygonMesh, corner_uv: NDArray[np.float64], source: bytes | None = None
) -> tuple[bytes, tuple[Finding, ...]]:
    """A PLY file of the mesh with coordinates (c, 2) per corner.

    source: the PLY file that the mesh was read from; its other elements and properties, comments, and whether it is
    text or binary then stay. A vertex with several coordinates is split: the vertex stays where it is, with its first
    ones, and those with the others come after all of the file's, so that what refers to vertices does not change.
    A polygon with a NaN keeps its old coordinates; where it has none, they are 0.
    Takes plyfile.  Raises InputError: EMPTY_MESH; MALFORMED_FILE where that does not read the source, as it reads more
    of it than `read_ply`.
    """
    from plyfile import PlyData

    if not len(mesh.positions):
        raise InputError("EMPTY_MESH", "A mesh without vertices has no coordinates to write. Give one with some.")
    ply = _bare(mesh) if source is None else _read_as_it_is(source, mesh)
    corner_uv, missing = _with_old(ply["vertex"].data, mesh, corner_uv)
    vertex, uv, corners = _split(mesh, corner_uv)
    elements = []
    for element in ply.elements:
        if element.name == "vertex":
            element = _vertices(element, vertex, uv)
        elif element.name == "face":
            element = _faces(element, mesh, corners)
        elements.append(element)
    # In another byte order than the machine's, plyfile 1.1 writes single values beside lists wrongly.
    data = _content(PlyData(elements, ply.text, "=", ply.comments, ply.obj_info))
    return data, (unsolved_at_origin(missing, "PLY"),) if missing else ()


def _read_as_it_is(source: bytes, mesh: PolygonMesh) -> PlyData:
    """All of the file.  Raises InputError."""
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            return _read(source, mesh)
    except Exception as error:  # of many kinds: its own, and those of numpy for numbers that do not fit their types
        problem = quoted(str(error).encode("utf-8", "surrogatepass"), most=120)
        raise malformed(f"plyfile, by which PLY is written, does not read the file: {problem}. Write OBJ.") from error


def _read(source: bytes, mesh: PolygonMesh) -> PlyData:
    from plyfile import PlyData

    source = with_whole_comments(source)
    size = _common_size(mesh)
    if size is None:
        return PlyData.read(io.BytesIO(source))
    text = read_text_tables(source)
    if text is not None:
        header = PlyData.read(io.BytesIO(ROW_COUNT.sub(rb"\g<1>0", text.header)))
        elements = [_element(element, table) for element, table in zip(header.elements, text.tables, strict=True)]
        return PlyData(elements, text=True, comments=header.comments, obj_info=header.obj_info)
    lengths = {"face": {name.decode(): size for name in CORNER_LISTS}}
    with tempfile.TemporaryFile() as file:  # plyfile takes tables from files only
        file.write(source)
        file.seek(0)
        return PlyData.read(file, known_list_len=lengths)


def _content(ply: PlyData) -> bytes:
    if all(_is_table(element) for element in ply.elements):
        rows = _text if ply.text else _table
        return b"".join([ply.header.encode("ascii"), b"\n", *map(rows, ply.elements)])
    out = io.BytesIO()
    ply.write(out)
    return out.getvalue()


def _is_table(element: PlyElement) -> bool:
    """Whether each list has the same length in all rows."""
    return not element.data.dtype.hasobject


def _text(element: PlyElement) -> bytes:
    """The rows of an element in a text file."""
    rows = _rows(element)
    columns: list[NDArray] = []
    for name in rows.dtype.names or ():
        columns += [rows[name]] if rows[name].ndim == 1 else list(rows[name].T)
    return _lsgp.format_table(columns) if columns else b"\n" * len(rows)


def _table(element: PlyElement) -> bytes:
    """The rows of an element in a binary file."""
    return _rows(element).tobytes()


def _rows(element: PlyElement) -> NDArray:
    """A structured array, of the lists also their lengths."""
    fields: list[tuple] = []
    for p in element.properties:
        shape = element.data.dtype[p.name].shape
        if shape:
            length_type, value_type = p.list_dtype("=")
            fields += [(_length_of(p.name), length_type), (p.name, value_type, shape)]
        else:
            fields.append((p.name, p.dtype("=")))
    rows = np.empty(len(element.data), fields)
    for name in element.data.dtype.names:
        rows[name] = element.data[name]
        shape = rows.dtype[name].shape
        if shape:
            rows[_length_of(name)] = shape[0]
    return rows


def _length_of(name: str) -> str:
    return f"length of {name}"  # no property has such a name, as it has spaces


def _common_size(mesh: PolygonMesh) -> int | None:
    """How many corners all polygons have; None where they differ."""
    sizes = mesh.sizes
    return int(sizes[0]) if len(sizes) and (sizes == sizes[0]).all() else None


def _split(
    mesh: PolygonMesh, corner_uv: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.int64]]:
    """The old vertex of each new one, its coordinates, and the new vertex of each corner."""
    vt, index = index_corners(mesh.corners, corner_uv)
    owner = np.empty(len(vt), np.int64)
    owner[index] = mesh.corners
    _, first = np.unique(owner, return_index=True)
    is_first = np.zeros(len(vt), bool)
    is_first[first] = True
    count = len(mesh.positions)
    place = np.where(is_first, owner, count - 1 + np.cumsum(~is_first))
    vertex = np.concatenate([np.arange(count), owner[~is_first]])
    uv = np.zeros((len(vertex), 2))
    uv[place] = vt
    return vertex, uv, place[index]


def _with_old(vertices: NDArray, mesh: PolygonMesh, corner_uv: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """The coordinates with those that unsolved polygons have or 0, and how many have neither."""
    polygon = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    unsolved = np.unique(polygon[np.isnan(corner_uv).any(axis=1)])
    if not len(unsolved):
        return corner_uv, 0
    has_old = set(UV) <= set(vertices.dtype.names)
    old = np.stack([vertices[name] for name in UV], axis=1) if has_old else np.zeros((len(vertices), 2))
    on = np.isin(polygon, unsolved)[:, None]
    return np.where(on, old[mesh.corners], corner_uv), 0 if has_old else len(unsolved)


def _vertices(element: PlyElement, vertex: NDArray[np.int64], uv: NDArray[np.float64]) -> PlyElement:
    kept = {name: element.data[name][vertex] for name in element.data.dtype.names if name not in UV}
    return _element(element, structured(kept | dict(zip(UV, uv.T, strict=True))))


def _faces(element: PlyElement, mesh: PolygonMesh, corners: NDArray[np.int64]) -> PlyElement:
    columns = {name: element.data[name] for name in element.data.dtype.names if name != WEDGE_UV}
    name = next(name.decode() for name in CORNER_LISTS if name.decode() in columns)
    columns[name] = _lists(mesh, corners)
    return _element(element, structured(columns), {name: "i4"})


def _lists(mesh: PolygonMesh, corners: NDArray[np.int64]) -> NDArray:
    """The vertices of each polygon: (f, size) int32 where all have as many, else (f,) arrays."""
    size = _common_size(mesh)
    if size is not None:
        return corners.astype(np.int32).reshape(-1, size)
    lists = np.empty(len(mesh.sizes), object)
    lists[:] = np.split(corners.astype(np.int32), mesh.starts[1:])
    return lists


def _element(element: PlyElement, data: NDArray, value_types: dict[str, str] | None = None) -> PlyElement:
    """The element with other rows, its lists as they were."""
    from plyfile import PlyElement, PlyListProperty

    lists = [p for p in element.properties if isinstance(p, PlyListProperty)]
    kinds = {p.name: p.val_dtype for p in lists} | (value_types or {})
    return PlyElement.describe(
        data, element.name, {p.name: p.len_dtype for p in lists}, kinds, comments=element.comments
    )


def _bare(mesh: PolygonMesh) -> PlyData:
    """A binary file of nothing but the mesh."""
    from plyfile import PlyData, PlyElement

    vertices = structured(dict(zip("xyz", mesh.positions.T, strict=True)))
    faces = structured({"vertex_indices": _lists(mesh, mesh.corners)})
    length = "u1" if mesh.sizes.max(initial=0) < 256 else "i4"
    return PlyData(
        [
            PlyElement.describe(vertices, "vertex"),
            PlyElement.describe(faces, "face", {"vertex_indices": length}, {"vertex_indices": "i4"}),
        ],
        byte_order="<",
    )
