# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's meshes to the arrays of the library, through foreach_get, in edit mode and in object mode."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from . import native

if TYPE_CHECKING:
    import lsgp


@dataclass(frozen=True, slots=True)
class Region:
    """The faces of one mesh that are to be unwrapped, as triangles, and the way back to Blender's loops.

    Vertex indices are the mesh's own, so that the library's errors name Blender's vertices.

    surface: all vertices (the library leaves out those without a triangle), the triangles Blender draws the faces with,
        the faces' edges and the marked seams among them.
    triangle_loops: (m, 3) int32, mesh loop of each triangle corner.
    triangle_faces: (m,) int32, mesh face of each triangle.
    face_loop_start: (f,) int32 of all faces of the mesh.
    vertex_used: (n,) bool, the vertices of the region's faces.
    """

    surface: lsgp.Surface
    triangle_loops: NDArray[np.int32]
    triangle_faces: NDArray[np.int32]
    face_loop_start: NDArray[np.int32]
    vertex_used: NDArray[np.bool_]


def target_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Mesh objects to work on, one for each mesh: those in edit mode, or the selected ones in object mode."""
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    if context.mode != "OBJECT":
        return []
    one_per_mesh: dict[bpy.types.Mesh, bpy.types.Object] = {}
    for obj in context.selected_objects:
        if obj.type == "MESH":
            one_per_mesh.setdefault(obj.data, obj)
    return list(one_per_mesh.values())


def read_region(obj: bpy.types.Object) -> Region | None:
    """The selected, visible faces of a mesh in edit mode; all faces in object mode.  None where that is no face."""
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    mesh = obj.data
    in_region = _faces_in_region(mesh, only_selected=obj.mode == "EDIT")
    if not in_region.any():
        return None

    mesh.calc_loop_triangles()
    triangle_faces = _read(mesh.loop_triangles, "polygon_index", np.int32)
    taken = in_region[triangle_faces]
    triangles = _read(mesh.loop_triangles, "vertices", np.int32, 3)[taken]

    positions = _read(mesh.vertices, "co", np.float32, 3).astype(np.float64)
    vertex_used = np.zeros(len(positions), bool)
    vertex_used[triangles] = True

    face_sizes = _read(mesh.polygons, "loop_total", np.int32)
    loop_edges = _read(mesh.loops, "edge_index", np.int32)
    edge_used = np.zeros(len(mesh.edges), bool)
    edge_used[loop_edges[np.repeat(in_region, face_sizes)]] = True
    edges = _read(mesh.edges, "vertices", np.int32, 2)
    seams = edges[edge_used & _read(mesh.edges, "use_seam", bool)]

    return Region(
        surface=native.lsgp.Surface(positions, triangles, edges=edges[edge_used], seams=seams),
        triangle_loops=_read(mesh.loop_triangles, "loops", np.int32, 3)[taken],
        triangle_faces=triangle_faces[taken],
        face_loop_start=_read(mesh.polygons, "loop_start", np.int32),
        vertex_used=vertex_used,
    )


def _faces_in_region(mesh: bpy.types.Mesh, only_selected: bool) -> NDArray[np.bool_]:
    if not only_selected:
        return np.ones(len(mesh.polygons), bool)
    return _read(mesh.polygons, "select", bool) & ~_read(mesh.polygons, "hide", bool)


def _read(collection: bpy.types.bpy_prop_collection, name: str, dtype: type, columns: int = 1) -> NDArray:
    """One property of all elements: (n,) or (n, columns)."""
    values = np.empty(len(collection) * columns, dtype)
    collection.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)
