# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY with texture coordinates, through plyfile: s and t of each vertex, as most programs read them."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.lib import recfunctions
from numpy.typing import NDArray

from ..errors import Finding
from ..indexed_uv import index_corners
from .mesh_gltf import unsolved_at_origin
from .mesh_ply import CORNER_LISTS
from .polygons import PolygonMesh

if TYPE_CHECKING:
    from plyfile import PlyData, PlyElement

UV = ("s", "t")
# Coordinates of the corners of faces, of which those of the vertices take the place.
WEDGE_UV = "texcoord"


def format_ply(
    mesh: PolygonMesh, corner_uv: NDArray[np.float64], source: bytes | None = None
) -> tuple[bytes, tuple[Finding, ...]]:
    """A PLY file of the mesh with coordinates (c, 2) per corner.

    source: the PLY file that the mesh was read from; its other elements and properties, comments, and whether it is
    text or binary then stay. A vertex with several coordinates is split: the vertex stays where it is, with its first
    ones, and those with the others come after all of the file's, so that what refers to vertices does not change.
    A polygon with a NaN keeps its old coordinates; where it has none, they are 0.
    Takes plyfile.
    """
    from plyfile import PlyData

    ply = _bare(mesh) if source is None else PlyData.read(io.BytesIO(source))
    corner_uv, missing = _with_old(ply["vertex"].data, mesh, corner_uv)
    vertex, uv, corners = _split(mesh, corner_uv)
    elements = []
    for element in ply.elements:
        if element.name == "vertex":
            element = _vertices(element, vertex, uv)
        elif element.name == "face":
            element = _faces(element, mesh, corners)
        elements.append(element)
    out = io.BytesIO()
    # In another byte order than the machine's, plyfile 1.1 writes single values beside lists wrongly.
    PlyData(elements, ply.text, "=", ply.comments, ply.obj_info).write(out)
    return out.getvalue(), (unsolved_at_origin(missing, "PLY"),) if missing else ()


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
    data = recfunctions.drop_fields(element.data, UV, usemask=False)[vertex]
    data = recfunctions.append_fields(data, UV, list(uv.T), usemask=False)
    return _element(element, data)


def _faces(element: PlyElement, mesh: PolygonMesh, corners: NDArray[np.int64]) -> PlyElement:
    data = recfunctions.drop_fields(element.data, WEDGE_UV, usemask=False)
    name = next(name.decode() for name in CORNER_LISTS if name.decode() in data.dtype.names)
    lists = np.empty(len(mesh.sizes), object)
    lists[:] = np.split(corners.astype(np.int32), mesh.starts[1:])
    if data.dtype[name].kind != "O":
        kinds = [(field, object if field == name else data.dtype[field]) for field in data.dtype.names]
        data = data.astype(kinds)
    data[name] = lists
    return _element(element, data, {name: "i4"})


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

    vertices = np.array(list(map(tuple, mesh.positions.tolist())), [(axis, "f8") for axis in "xyz"])
    faces: Any = np.empty(len(mesh.sizes), [("vertex_indices", object)])
    faces["vertex_indices"] = np.split(mesh.corners, mesh.starts[1:])
    length = "u1" if mesh.sizes.max(initial=0) < 256 else "i4"
    return PlyData(
        [
            PlyElement.describe(vertices, "vertex"),
            PlyElement.describe(faces, "face", {"vertex_indices": length}, {"vertex_indices": "i4"}),
        ],
        byte_order="<",
    )
