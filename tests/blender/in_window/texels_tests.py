# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density as an artist sets it: the sub-panel, its button, undo.  Run by run_in_window.py; no pytest."""

import bpy
from installed import addon
from scenes import add_ball, add_cone_cube, changed, edit, snapshot, uv_key
from windows import area, region, take_picture

reports = addon.mesh.reports
SHOWN = ("VIEW3D_PT_cone_unwrap_texels", "VIEW3D_PT_cone_unwrap_quality")


def open_panels():
    """The sidebar with these panels open, as after a click on each."""
    for name in SHOWN:
        panel = getattr(bpy.types, name)
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()
        bpy.utils.register_class(panel)
    area().spaces.active.show_region_ui = True
    yield 0.3
    region("UI").active_panel_category = "Cone Unwrap"
    region("UI").tag_redraw()
    yield 0.5


def test_the_panel_sets_what_it_shows_and_one_undo_takes_it_back():
    add_ball("Second").location.x = 3
    add_cone_cube("First")
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
    edit(*bpy.context.selected_objects)
    yield from open_panels()
    kept = bpy.context.scene.cone_unwrap_texels
    kept.use_image, kept.texture_size, kept.density = False, 2048, 300
    bpy.ops.ed.undo_push(message="before")
    take_picture("texel_panel_before")
    before = {obj.name: snapshot(obj) for obj in bpy.context.objects_in_mode}
    assert bpy.ops.uv.cone_texel_set("INVOKE_DEFAULT", True) == {"FINISHED"}
    yield 0.3
    kept = bpy.context.scene.cone_unwrap_texels
    kept.density = 1
    assert bpy.ops.uv.cone_texel_get("INVOKE_DEFAULT", False) == {"FINISHED"}
    assert abs(kept.density - 300) < 0.05
    for obj in bpy.context.objects_in_mode:
        assert changed(before[obj.name], snapshot(obj)) == {uv_key()}
    told = {obj.name: reports.find(obj.data) for obj in bpy.context.objects_in_mode}
    assert all(report is not None for report in told.values())
    take_picture("texel_panel_after")
    bpy.ops.ed.undo()
    yield 0.3
    for obj in bpy.context.objects_in_mode:
        assert changed(before[obj.name], snapshot(obj)) == set()
