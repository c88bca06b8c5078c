# SPDX-License-Identifier: GPL-3.0-or-later
"""Selecting elements of meshes."""

from __future__ import annotations

from collections.abc import Iterable

import bmesh
import bpy
import numpy as np

VERTEX_MODE = (True, False, False)
EDGE_MODE = (False, True, False)
FACE_MODE = (False, False, True)


def select_elements(
    mesh: bpy.types.Mesh,
    *,
    extend: bool,
    vertices: Iterable[int] = (),
    edges: Iterable[tuple[int, int]] = (),
    faces: Iterable[int] = (),
) -> int:
    """Select the visible ones among these elements and return how many there are.

    extend: keep the selection; otherwise everything else is deselected. edges: vertex pairs; pairs that are not edges
    are ignored. The select mode must be the one of the smallest elements, in which all of them can be selected.
    """
    bm = bmesh.from_edit_mesh(mesh)
    for sequence in (bm.verts, bm.edges, bm.faces):
        sequence.ensure_lookup_table()
    if not extend:
        for element in (*bm.verts, *bm.edges, *bm.faces):
            element.select = False
    wanted = [bm.verts[vertex] for vertex in vertices]
    wanted += filter(None, (bm.edges.get((bm.verts[first], bm.verts[second])) for first, second in edges))
    wanted += [bm.faces[face] for face in faces]
    visible = [element for element in wanted if not element.hide]
    for element in visible:
        element.select_set(True)
    bm.select_flush_mode()
    bm.select_history.validate()
    if hasattr(bm, "uv_select_sync_valid"):
        # Blender 5.0 has a separate UV selection, which no longer matches the selected elements.
        bm.uv_select_sync_valid = False
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(visible)


def select_stored_vertex(mesh: bpy.types.Mesh, vertex: int, *, extend: bool) -> None:
    """Select a vertex of a mesh in object mode, as it will be seen in edit mode.  extend: keep the selection."""
    if not extend:
        for elements in (mesh.vertices, mesh.edges, mesh.polygons):
            elements.foreach_set("select", np.zeros(len(elements), bool))
    mesh.vertices[vertex].select = True
    mesh.update_tag()


def set_select_mode(
    context: bpy.types.Context, mode: tuple[bool, bool, bool], meshes: Iterable[bpy.types.Mesh]
) -> None:
    """Switch meshes in edit mode to vertex, edge or face select mode."""
    context.tool_settings.mesh_select_mode = mode
    names = {name for name, on in zip(("VERT", "EDGE", "FACE"), mode, strict=True) if on}
    for mesh in meshes:
        bmesh.from_edit_mesh(mesh).select_mode = names
