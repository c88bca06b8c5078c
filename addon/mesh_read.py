# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's meshes to the arrays of the library, through foreach_get, in edit mode and in object mode."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from . import native, versions

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
    corner_uv: (m, 3, 2) float64, the active UV layer as it is; NaN where the mesh has none.
    pinned: (m, 3) bool, the corners whose UV is pinned in that layer.
    """

    surface: lsgp.Surface
    triangle_loops: NDArray[np.int32]
    triangle_faces: NDArray[np.int32]
    face_loop_start: NDArray[np.int32]
    vertex_used: NDArray[np.bool_]
    corner_uv: NDArray[np.float64]
    pinned: NDArray[np.bool_]


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


def selects_by_uv(context: bpy.types.Context) -> bool:
    """True in a UV editor that has a selection of its own."""
    space = context.space_data
    in_uv_editor = space is not None and space.type == "IMAGE_EDITOR" and space.show_uvedit
    return in_uv_editor and not context.tool_settings.use_uv_select_sync


def read_region(obj: bpy.types.Object, by_uv: bool = False) -> Region | None:
    """The selected, visible faces of a mesh in edit mode; all faces in object mode.  None where that is no face.

    by_uv: of those only the faces of which all UVs are selected in the UV editor.
    """
    with readable_mesh(obj) as mesh:
        return _read_mesh(mesh, obj.mode == "EDIT", by_uv)


def read_all(obj: bpy.types.Object) -> Region | None:
    """All faces of a mesh in any mode; None where it has none."""
    with readable_mesh(obj) as mesh:
        return _read_mesh(mesh, False, False)


def read_triangles(obj: bpy.types.Object) -> tuple[int, NDArray[np.int32], NDArray[np.int32]]:
    """How many vertices a mesh has, all its triangles (m, 3) and its seams (s, 2).

    Unlike `read_all` it makes no copy, so that panels can call it; in edit mode that is slower.
    """
    mesh = obj.data
    if obj.mode != "EDIT":
        mesh.calc_loop_triangles()
        edges = _read(mesh.edges, "vertices", np.int32, 2)
        seams = edges[_read(mesh.edges, "use_seam", bool)]
        return len(mesh.vertices), _read(mesh.loop_triangles, "vertices", np.int32, 3), seams
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.index_update()
    triangles = [[loop.vert.index for loop in loops] for loops in bm.calc_loop_triangles()]
    seams = [[vertex.index for vertex in edge.verts] for edge in bm.edges if edge.seam]
    return (
        len(bm.verts),
        np.array(triangles, np.int32).reshape(-1, 3),
        np.array(seams, np.int32).reshape(-1, 2),
    )


def vertex_weights(obj: bpy.types.Object, group_name: str) -> NDArray[np.float64] | None:
    """(n,) weight of each vertex in the group, 0 where it is not in it; None where there is no such group."""
    group = obj.vertex_groups.get(group_name)
    if group is None:
        return None
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        deform = bm.verts.layers.deform.active
        if deform is None:
            return np.zeros(len(bm.verts))
        return np.array([vertex[deform].get(group.index, 0.0) for vertex in bm.verts], np.float64)
    weights = np.zeros(len(obj.data.vertices))
    for vertex in obj.data.vertices:
        for entry in vertex.groups:
            if entry.group == group.index:
                weights[vertex.index] = entry.weight
    return weights


def _read_mesh(mesh: bpy.types.Mesh, only_selected: bool, by_uv: bool) -> Region | None:
    layer = mesh.uv_layers.active
    face_sizes = _read(mesh.polygons, "loop_total", np.int32)
    in_region = _faces_in_region(mesh, only_selected)
    if by_uv and layer is not None:
        unselected = ~versions.selected_loops(mesh, layer.name)
        in_region[np.repeat(np.arange(len(face_sizes)), face_sizes)[unselected]] = False
    if not in_region.any():
        return None

    mesh.calc_loop_triangles()
    triangle_faces = _read(mesh.loop_triangles, "polygon_index", np.int32)
    taken = in_region[triangle_faces]
    triangles = _read(mesh.loop_triangles, "vertices", np.int32, 3)[taken]

    positions = _read(mesh.vertices, "co", np.float32, 3).astype(np.float64)
    vertex_used = np.zeros(len(positions), bool)
    vertex_used[triangles] = True

    loop_edges = _read(mesh.loops, "edge_index", np.int32)
    edge_used = np.zeros(len(mesh.edges), bool)
    edge_used[loop_edges[np.repeat(in_region, face_sizes)]] = True
    edges = _read(mesh.edges, "vertices", np.int32, 2)
    seams = edges[edge_used & _read(mesh.edges, "use_seam", bool)]

    triangle_loops = _read(mesh.loop_triangles, "loops", np.int32, 3)[taken]
    if layer is None:
        loop_uv, pinned = np.full((len(mesh.loops), 2), np.nan), np.zeros(len(mesh.loops), bool)
    else:
        loop_uv = _read(layer.uv, "vector", np.float32, 2).astype(np.float64)
        pinned = versions.pinned_loops(mesh, layer.name)

    return Region(
        surface=native.lsgp.Surface(positions, triangles, edges=edges[edge_used], seams=seams),
        triangle_loops=triangle_loops,
        triangle_faces=triangle_faces[taken],
        face_loop_start=_read(mesh.polygons, "loop_start", np.int32),
        vertex_used=vertex_used,
        corner_uv=loop_uv[triangle_loops],
        pinned=pinned[triangle_loops],
    )


@contextmanager
def readable_mesh(obj: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The mesh as it is now. In edit mode that is a copy, because Blender hides the attributes of an edited mesh."""
    if obj.mode != "EDIT":
        yield obj.data
        return
    obj.update_from_editmode()
    copy = obj.data.copy()
    try:
        yield copy
    finally:
        bpy.data.meshes.remove(copy)


def _faces_in_region(mesh: bpy.types.Mesh, only_selected: bool) -> NDArray[np.bool_]:
    if not only_selected:
        return np.ones(len(mesh.polygons), bool)
    return _read(mesh.polygons, "select", bool) & ~_read(mesh.polygons, "hide", bool)


def _read(collection: bpy.types.bpy_prop_collection, name: str, dtype: type, columns: int = 1) -> NDArray:
    """One property of all elements: (n,) or (n, columns)."""
    values = np.empty(len(collection) * columns, dtype)
    collection.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)
