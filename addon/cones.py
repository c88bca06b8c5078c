# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones on a mesh: members of a vertex group; read, marked, cleared, selected. Their angles are in angles.py."""

from __future__ import annotations

from collections.abc import Iterable

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .mesh_read import vertex_weights

CONE_WEIGHT = 1.0


def marked_cones(obj: bpy.types.Object, group_name: str) -> NDArray[np.int32]:
    """Vertices with a weight above zero in the group, ascending; none where there is no such group."""
    weights = vertex_weights(obj, group_name)
    return np.empty(0, np.int32) if weights is None else np.flatnonzero(weights > 0.0).astype(np.int32)


def mark_cones(obj: bpy.types.Object, group_name: str, vertices: Iterable[int]) -> None:
    """Put vertices into the group, which is created where it does not exist."""
    group = obj.vertex_groups.get(group_name)
    if group is None:
        had_groups, active = bool(obj.vertex_groups), obj.vertex_groups.active_index
        group = obj.vertex_groups.new(name=group_name)
        if had_groups:
            # Blender activates a new group; the artist's choice is not ours to change.
            obj.vertex_groups.active_index = active
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        deform = bm.verts.layers.deform.verify()
        bm.verts.ensure_lookup_table()
        for vertex in vertices:
            bm.verts[vertex][deform][group.index] = CONE_WEIGHT
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    else:
        group.add([int(vertex) for vertex in vertices], CONE_WEIGHT, "REPLACE")


def clear_cones(obj: bpy.types.Object, group_name: str, vertices: Iterable[int]) -> None:
    """Take vertices out of the group they are in; the group stays."""
    group = obj.vertex_groups[group_name]
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        deform = bm.verts.layers.deform.active
        bm.verts.ensure_lookup_table()
        for vertex in vertices:
            del bm.verts[vertex][deform][group.index]
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    else:
        group.remove([int(vertex) for vertex in vertices])


def selected_vertices(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Selected, visible vertices of a mesh in edit mode, ascending."""
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.index_update()
    return np.array([vertex.index for vertex in bm.verts if vertex.select and not vertex.hide], np.int32)
