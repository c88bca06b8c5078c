# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams that Blender's own operators mark, with the UV selection of a window.  Run by run_in_window.py; no pytest."""

import bpy
from scenes import UvMap, edit
from windows import until


def faces_by_island(obj):
    islands = {}
    for face, island in enumerate(UvMap(obj).island_of_face()):
        islands.setdefault(island, set()).add(face)
    return {frozenset(faces) for faces in islands.values()}


def test_suzanne_with_seams_from_islands_gets_the_same_islands_again():
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    edit(suzanne)
    bpy.context.tool_settings.use_uv_select_sync = True
    assert bpy.ops.uv.smart_project("EXEC_DEFAULT", True, angle_limit=1.15, island_margin=0.01) == {"FINISHED"}
    yield 0.1
    islands = faces_by_island(suzanne)
    assert len(islands) > 20
    assert bpy.ops.uv.seams_from_islands("EXEC_DEFAULT", True) == {"FINISHED"}
    yield 0.1
    seams = UvMap(suzanne).seams
    assert bpy.ops.mesh.uv_texture_remove() == {"FINISHED"}
    assert not suzanne.data.uv_layers
    bpy.ops.uv.cone_unwrap("INVOKE_DEFAULT", True, seams="BOUNDARY", overlaps="KEEP")
    yield from until(lambda: bool(suzanne.data.uv_layers) and not bpy.context.window.modal_operators)
    assert faces_by_island(suzanne) == islands
    assert UvMap(suzanne).split_edges() == seams
