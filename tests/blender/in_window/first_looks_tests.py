# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist sees at first: keys, the sidebar of the UV editor, cuts while painting."""

from contextlib import suppress

import bpy
from installed import addon
from scenes import add_cone_cube, edit
from windows import DRAWN, area, middle, move_to, press, split_off_uv_editor, take_picture, until, window

KEYS = ("type", "shift", "ctrl", "alt", "oskey")


def test_the_key_of_the_pie_is_none_of_blenders():
    pie, keyconfigs = addon.ui.pie, bpy.context.window_manager.keyconfigs
    around = {"Window", "Screen", "Screen Editing", "View2D", "3D View Generic", "3D View", "Image", "Image Generic"}
    theirs = [
        (keymap.name, item.idname)
        for keymap in keyconfigs.default.keymaps
        if keymap.name in around | {name for name, _ in pie.KEYMAPS}
        for item in keymap.keymap_items
        if item.active and item.type == "U" and (item.any or (item.shift and item.alt and not item.ctrl))
    ]
    assert len(keyconfigs.default.keymaps) > 50
    assert theirs == []
    yield 0.1


def test_the_pie_opens_with_its_key():
    add_cone_cube()
    yield from move_to(middle())
    yield from press("U", middle(), shift=True, alt=True)
    yield DRAWN
    take_picture("pie")
    yield from press("ESC", middle())
    edit(bpy.context.object)
    yield from move_to(middle())
    yield from press("U", middle(), shift=True, alt=True)
    yield DRAWN
    take_picture("pie_in_edit_mode")
    yield from press("ESC", middle())


def test_cuts_are_drawn_while_painting():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    bpy.ops.object.mode_set(mode="TEXTURE_PAINT")
    bpy.ops.view3d.view_all()
    view3d = addon.overlay.view3d
    drawn = []
    original = view3d._draw_cuts
    view3d._draw_cuts = lambda *arguments: (drawn.append(arguments[0].name), original(*arguments))
    try:
        area().tag_redraw()
        yield from until(lambda: drawn)
        yield DRAWN
        take_picture("cuts_while_painting")
    finally:
        view3d._draw_cuts = original
    assert set(drawn) == {cube.name}
    bpy.ops.object.mode_set(mode="OBJECT")


def test_the_sidebar_of_the_uv_editor_has_our_panels():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    edit(cube)
    view = split_off_uv_editor()
    yield DRAWN
    view.spaces.active.show_region_ui = True
    yield DRAWN
    side = next(one for one in view.regions if one.type == "UI")
    # Of earlier versions of Blender it can only be read.
    with suppress(AttributeError, TypeError):
        side.active_panel_category = "Cone Unwrap"
    yield 2 * DRAWN
    take_picture("sidebar_of_uv_editor")
    with bpy.context.temp_override(window=window(), area=view, region=side):
        shown = {panel.bl_label for panel in addon.ui.panels.UV_EDITOR_PANELS if panel.poll(bpy.context)}
    assert {"Cone Unwrap", "Islands", "Quality", "Overlay", "Texel Density"} <= shown
