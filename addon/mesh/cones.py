# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones on a mesh: the members of a vertex group. Their angles are in angles.py."""

from __future__ import annotations

from collections.abc import Iterable

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .mesh_reader import MeshReader
from .reader import reader

CONE_WEIGHT = 1.0
LEAST_WEIGHT = 0.5
"""A vertex that Blender makes in the middle between a cone and another vertex gets this weight, and is no cone."""


def marked_cones(obj: bpy.types.Object, group_name: str) -> NDArray[np.int32]:
    """Vertices of the surface with a weight above 0.5 in the group, ascending; none where there is no such group."""
    mesh = reader(obj.data)
    weights = weights_in(obj, group_name, mesh)
    return np.empty(0, np.int32) if weights is None else np.unique(mesh.stitched[cones_among(weights)])


def cones_among(weights: NDArray[np.float64]) -> NDArray[np.int32]:
    """The vertices whose weights mark them as cones, ascending.  weights: (n,)."""
    return np.flatnonzero(weights > LEAST_WEIGHT).astype(np.int32)


def weights_in(
    obj: bpy.types.Object, group_name: str, mesh: MeshReader, outside: float = 0.0
) -> NDArray[np.float64] | None:
    """(n,) weight of each vertex in the group, and of those outside it; None where there is no such group."""
    group = obj.vertex_groups.get(group_name)
    return None if group is None else mesh.weights(group.index, outside)


def mark_cones(obj: bpy.types.Object, group_name: str, vertices: Iterable[int]) -> None:
    """Add vertices to the group, which is created if it does not exist."""
    write_weights(obj, group_name, vertices, CONE_WEIGHT)


def write_weights(obj: bpy.types.Object, group_name: str, vertices: Iterable[int], weight: float) -> None:
    """Give vertices a weight in the group, which is created if it does not exist."""
    group = obj.vertex_groups.get(group_name)
    if group is None:
        had_groups, active = bool(obj.vertex_groups), obj.vertex_groups.active_index
        group = obj.vertex_groups.new(name=group_name)
        if had_groups:
            # Blender makes a new group the active one; keep the artist's choice.
            obj.vertex_groups.active_index = active
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        deform = bm.verts.layers.deform.verify()
        bm.verts.ensure_lookup_table()
        for vertex in vertices:
            bm.verts[vertex][deform][group.index] = weight
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    else:
        group.add([int(vertex) for vertex in vertices], weight, "REPLACE")


def clear_cones(obj: bpy.types.Object, group_name: str, vertices: Iterable[int]) -> None:
    """Remove vertices of the surface from the group they are in; the group stays."""
    group = obj.vertex_groups[group_name]
    copies = np.flatnonzero(np.isin(reader(obj.data).stitched, list(vertices))).tolist()
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        deform = bm.verts.layers.deform.active
        bm.verts.ensure_lookup_table()
        for vertex in copies:
            if group.index in bm.verts[vertex][deform]:
                del bm.verts[vertex][deform][group.index]
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    else:
        group.remove(copies)


def selected_vertices(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """The vertices of the surface that selected, visible vertices of a mesh in edit mode are, ascending."""
    stitched = reader(mesh).stitched
    bm = bmesh.from_edit_mesh(mesh)
    return np.unique(stitched[[vertex.index for vertex in bm.verts if vertex.select and not vertex.hide]])
