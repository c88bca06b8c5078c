# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over meshes, judged by the pixels of a real window.  Run by run_in_window.py, not by pytest."""

from dataclasses import replace

import bpy
import gpu
import numpy as np
import pytest
from installed import addon
from mathutils import Vector
from scenes import add_ball, add_cone_cube, edit
from windows import area, region, take_picture

reports, cache, view3d = addon.mesh.reports, addon.overlay.cache, addon.overlay.view3d
SPACES = {"VIEW_3D": bpy.types.SpaceView3D, "IMAGE_EDITOR": bpy.types.SpaceImageEditor}


def pixels(kind="WINDOW", within="VIEW_3D"):
    """(h, w, 3) colors of a region from 0 to 1, once it has been drawn."""
    seen = []

    def read():
        _, _, width, height = gpu.state.viewport_get()
        buffer = gpu.state.active_framebuffer_get().read_color(0, 0, width, height, 3, 0, "FLOAT")
        seen.append(np.array(buffer.to_list()).reshape(height, width, 3))

    handler = SPACES[within].draw_handler_add(read, (), kind, "POST_PIXEL")
    try:
        for _ in range(50):
            region(kind, within).tag_redraw()
            yield 0.05
            if len(seen) > 1:
                break
    finally:
        SPACES[within].draw_handler_remove(handler, kind)
    assert seen, "nothing was drawn"
    return seen[-1]


def count(picture, color, off=0.03):
    """How many pixels have this color."""
    return int((np.abs(picture - np.array(color[:3])) < off).all(axis=2).sum())


def look():
    return addon.overlay.look.overlay_look()


def chosen():
    return bpy.context.window_manager.cone_unwrap_overlay


def unwrapped(build, **options):
    obj = build()
    bpy.ops.uv.cone_unwrap(**options)
    area().spaces.active.shading.color_type = "SINGLE"
    bpy.ops.view3d.view_axis(type="FRONT")
    bpy.ops.view3d.view_all()
    return obj


def cut_pixels(picture):
    return [count(picture, color) for color in look().cut_colors()]


def test_cuts_and_cones_are_drawn_in_the_colors_of_the_preferences():
    cube = unwrapped(add_cone_cube, seamless=True)
    for in_edit_mode in (False, True):
        if in_edit_mode:
            edit(cube, select="DESELECT")
        picture = yield from pixels()
        # From the front four cones and the cuts between them are seen.
        assert sum(number > 100 for number in cut_pixels(picture)) >= 2, cut_pixels(picture)
        assert count(picture, look().tip) > 100
        for name in ("cuts", "cones"):
            setattr(chosen(), name, False)
        picture = yield from pixels()
        assert max(cut_pixels(picture)) < 20 and count(picture, look().tip) < 20
        for name in ("cuts", "cones"):
            setattr(chosen(), name, True)
    look().tip = (0.0, 1.0, 1.0, 1.0)
    picture = yield from pixels()
    assert count(picture, (0.0, 1.0, 1.0)) > 100
    look().property_unset("tip")
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.nightly
def test_nothing_is_drawn_with_overlays_off_or_without_a_selection():
    unwrapped(add_cone_cube)
    space = area().spaces.active
    assert count((yield from pixels()), look().tip) > 100
    space.overlay.show_overlays = False
    assert count((yield from pixels()), look().tip) < 20
    space.overlay.show_overlays = True
    chosen().show = False
    assert count((yield from pixels()), look().tip) < 20
    chosen().show = True
    bpy.ops.object.select_all(action="DESELECT")
    assert count((yield from pixels()), look().tip) < 20


@pytest.mark.nightly
def test_cones_behind_the_mesh_are_hidden_but_in_x_ray():
    cube = unwrapped(add_cone_cube)
    bpy.ops.view3d.view_axis(type="RIGHT")
    front = count((yield from pixels()), look().tip)
    cube.data.materials.clear()
    area().spaces.active.shading.show_xray = True
    area().spaces.active.region_3d.view_rotation.rotate(bpy.context.object.matrix_world.to_quaternion())
    bpy.ops.view3d.view_orbit(angle=0.4, type="ORBITLEFT")
    x_ray = count((yield from pixels()), look().tip)
    area().spaces.active.shading.show_xray = False
    assert front > 100 and x_ray > 1.3 * front, (front, x_ray)


def test_angles_are_written_at_cones_that_nothing_hides():
    ball = unwrapped(add_ball)
    bpy.ops.view3d.view_orbit(angle=0.4, type="ORBITLEFT")
    bpy.ops.view3d.view_orbit(angle=0.3, type="ORBITUP")
    yield from pixels()
    toward = np.array(area().spaces.active.region_3d.view_rotation.to_matrix().col[2])
    cones = [cone.vertex for cone in cache.entry(ball).content.cones]
    facing = np.array([np.array(ball.data.vertices[v].normal) @ toward for v in cones])
    _, seen = view3d._seen[ball.data.session_uid, "cone_places"]
    assert seen[facing > 0.3].all() and not seen[facing < -0.3].any()
    assert (facing > 0.3).sum() >= 2 and (facing < -0.3).sum() >= 2
    area().spaces.active.shading.show_xray = True
    yield from pixels()
    assert view3d._seen[ball.data.session_uid, "cone_places"][1].all()
    area().spaces.active.shading.show_xray = False


@pytest.mark.nightly
def test_errors_are_written_at_strokes_that_the_map_misses():
    ball = add_ball(cuts=9)
    up = np.zeros((len(ball.data.polygons), 3), np.float32)
    for face in ball.data.polygons:
        if abs(face.center.z) < 0.15 or abs(face.center.x) < 0.1:
            up[face.index] = face.center.cross(Vector((0.3, 1, 0.2))).normalized()
    attribute = ball.data.attributes.new(addon.core.identifiers.UP_ATTRIBUTE, "FLOAT_VECTOR", "FACE")
    attribute.data.foreach_set("vector", up.ravel())
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    area().spaces.active.region_3d.view_distance = 5.0
    yield from pixels()
    take_picture("missed_strokes")
    content = cache.entry(ball).content
    part, seen = view3d._seen[ball.data.session_uid, "missed_places"]
    toward = np.array(area().spaces.active.region_3d.view_rotation.to_matrix().col[2])
    facing = content.missed_places @ toward / np.linalg.norm(content.missed_places, axis=1)
    assert len(part) == len(content.missed_by) > 10
    assert seen[facing > 0.5].all() and not seen[facing < -0.3].any() and (facing > 0.5).sum() > 3
    settings = bpy.context.window_manager.cone_unwrap_overlay
    white = count((yield from pixels()), look().text)
    settings.up = False
    assert count((yield from pixels()), look().text) < white
    settings.up = True


def test_arrows_and_errors_are_drawn_at_marked_edges():
    ball = add_ball(cuts=9)
    attribute = ball.data.attributes.new(addon.core.identifiers.ALONG_ATTRIBUTE, "BOOLEAN", "EDGE")
    attribute.data.foreach_set("value", [number % 5 == 0 for number in range(len(ball.data.edges))])
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    area().spaces.active.region_3d.view_distance = 5.0
    shown = yield from pixels()
    take_picture("marked_edges")
    content = cache.entry(ball).content
    assert len(content.along_lines) == 3 * -(-len(ball.data.edges) // 5) and not len(content.up_lines)
    assert len(content.missed_by) > 10
    settings = bpy.context.window_manager.cone_unwrap_overlay
    settings.up = False
    hidden = yield from pixels()
    assert all(count(hidden, color) < count(shown, color) for color in (look().up, look().text))
    settings.up = True
    edit(ball, select="DESELECT")
    assert count((yield from pixels()), look().up) > count(hidden, look().up)


@pytest.mark.nightly
def test_flipped_and_overlapping_faces_are_drawn():
    cube = unwrapped(add_cone_cube)
    plain = yield from pixels()
    front = [face.index for face in cube.data.polygons if face.normal.y < -0.9]
    report = reports.find(cube.data)
    seen = {}
    for name in ("flipped", "overlapping"):
        reports.store(cube.data, replace(report, **{name: front}))
        seen[name] = yield from pixels()
        take_picture(f"{name}_faces")
        setattr(chosen(), name, False)
        without = yield from pixels()
        setattr(chosen(), name, True)
        assert np.abs(without - plain).max(axis=2).mean() < 0.01
    for picture, name in ((seen[name], name) for name in seen):
        tinted = np.abs(picture - plain).max(axis=2) > 0.1
        assert tinted.mean() > 0.05, name
        # Toward the color of the preferences.
        toward = np.linalg.norm(picture[tinted] - np.array(getattr(look(), name)[:3]), axis=1)
        assert (toward < np.linalg.norm(plain[tinted] - np.array(getattr(look(), name)[:3]), axis=1)).mean() > 0.95


@pytest.mark.nightly
def test_distortion_is_drawn_in_its_colors_with_a_scale():
    unwrapped(add_ball)
    plain = yield from pixels()
    bpy.ops.uv.cone_measure()
    pictures = {}
    for measure in ("CONFORMAL", "AREA", "STRETCH"):
        chosen().distortion = measure
        pictures[measure] = yield from pixels()
        take_picture(f"distortion_{measure.lower()}")
        assert (np.abs(pictures[measure] - plain).max(axis=2) > 0.1).mean() > 0.05
    assert (np.abs(pictures["CONFORMAL"] - pictures["AREA"]).max(axis=2) > 0.05).mean() > 0.03
    bpy.ops.uv.cone_measure(clear=True)
    again = yield from pixels()
    assert (np.abs(again - plain).max(axis=2) > 0.05).mean() < 0.01
    chosen().distortion = "NONE"


def test_drawing_again_builds_nothing_again_and_an_unwrap_does():
    cube = unwrapped(add_cone_cube)
    yield from pixels()
    entry = cache.entry(cube)
    batches = dict(entry.drawn)
    assert any("cuts" in key for key in batches)
    bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITLEFT")
    yield from pixels()
    assert cache.entry(cube) is entry
    assert all(entry.drawn[key] is batch for key, batch in batches.items())
    bpy.ops.uv.cone_unwrap(seamless=True)
    yield from pixels()
    assert cache.entry(cube) is not entry


def test_the_overlay_follows_undo():
    cube = add_cone_cube()
    name = cube.name
    edit(cube)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
    yield from pixels()
    assert len(cache.entry(bpy.data.objects[name]).content.cut_lines)
    bpy.ops.ed.undo()
    yield from pixels()
    assert not len(cache.entry(bpy.data.objects[name]).content.cut_lines)
    bpy.ops.ed.redo()
    yield from pixels()
    assert len(cache.entry(bpy.data.objects[name]).content.cut_lines)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_the_uv_editor_shows_the_cuts_in_the_same_colors():
    cube = unwrapped(add_cone_cube)
    edit(cube)
    bpy.context.tool_settings.use_uv_select_sync = False
    other = area("DOPESHEET_EDITOR") if any(a.type == "DOPESHEET_EDITOR" for a in bpy.context.screen.areas) else None
    place = other or area("PROPERTIES")
    before = place.ui_type
    in_view = yield from pixels()
    place.ui_type = "UV"
    yield 0.3
    with bpy.context.temp_override(area=place, region=region("WINDOW", "IMAGE_EDITOR")):
        bpy.ops.image.view_all(fit_view=True)
    # In an editor this small they cover the cuts.
    chosen().cones = False
    in_layout = yield from pixels(within="IMAGE_EDITOR")
    chosen().cones = True
    shown = [number > 10 for number in cut_pixels(in_layout)]
    # All cuts are in the layout, some of them in front.
    assert sum(shown) == len(reports.find(cube.data).paths), cut_pixels(in_layout)
    assert all(shown[i] for i, number in enumerate(cut_pixels(in_view)) if number > 100)
    place.ui_type = before
    bpy.ops.object.mode_set(mode="OBJECT")


def test_the_uv_editor_shows_cones_in_the_color_of_the_3d_view():
    cube = unwrapped(add_cone_cube)
    edit(cube)
    place = max((a for a in bpy.context.screen.areas if a.type != "VIEW_3D"), key=lambda a: a.height)
    before, place.ui_type = place.ui_type, "UV"
    yield 0.3
    with bpy.context.temp_override(area=place, region=region("WINDOW", "IMAGE_EDITOR")):
        bpy.ops.image.view_all(fit_view=True)
    chosen().cuts = False
    numbers = []
    for chosen().cones in (True, False):
        in_layout = yield from pixels(within="IMAGE_EDITOR")
        numbers.append(count(in_layout, look().tip))
    take_picture("cones_in_the_uv_editor")
    chosen().cones = chosen().cuts = True
    # All have the curvature from which on cones have this color.
    assert numbers[0] > 20 * len(cache.entry(cube).content.cones) and numbers[1] == 0, numbers
    place.ui_type = before
    bpy.ops.object.mode_set(mode="OBJECT")
