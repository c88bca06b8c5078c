# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones with the mouse and the keyboard: drag, add, remove, angles, Esc, one step of undo.

Run by run_in_window.py; no pytest.
"""

import bpy
import numpy as np
from mathutils import Quaternion, Vector
from scenes import ANGLES, add_ball, changed, edit, marked, plain_copy, snapshot
from windows import area, click, drag, event, move_to, place_of, press, region, running, take_picture, type_text, until


def editing():
    return running("MESH_OT_cone_edit")


def begin(cuts=5):
    """A ball in edit mode, unwrapped, seen from the front, with the tool running."""
    ball = add_ball(cuts=cuts)
    edit(ball, select="DESELECT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    bpy.ops.mesh.select_all(action="DESELECT")
    seen = area().spaces.active.region_3d
    seen.view_perspective = "PERSP"
    seen.view_rotation = Quaternion((0.7071, 0.7071, 0, 0)) @ Quaternion((0, 1, 0), 0.3)
    seen.view_location, seen.view_distance = Vector((0, 0, 0)), 5.0
    bpy.ops.ed.undo_push(message="before")
    yield 0.3
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    assert editing()


def ball():
    return bpy.data.objects["Ball"]


def in_front(obj, accept):
    """Vertices whose normals look at the eye, the most so first."""
    seen = area().spaces.active.region_3d
    toward = seen.view_matrix.inverted().translation.normalized()
    facing = [(vertex.normal @ toward, vertex.index) for vertex in obj.data.vertices]
    return [index for share, index in sorted(facing, reverse=True) if share > 0.5 and accept(index)]


def uv_of(obj):
    mesh = plain_copy(obj)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uv)
    bpy.data.meshes.remove(mesh)
    return uv.tobytes()


def angle_of(obj, vertex):
    mesh = plain_copy(obj)
    attribute = mesh.attributes.get(ANGLES)
    degrees = 0.0 if attribute is None else np.degrees(attribute.data[vertex].value)
    bpy.data.meshes.remove(mesh)
    return degrees


def test_dragging_a_cone_moves_it_and_the_map_follows_as_one_step_of_undo():
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    start = in_front(ball(), lambda v: v in cones)[0]
    end = in_front(ball(), lambda v: v not in cones)[0]
    uv = uv_of(ball())
    yield from drag(place_of(ball(), start), place_of(ball(), end))
    yield from until(lambda: uv_of(ball()) != uv)
    take_picture("dragging_a_cone")
    assert marked(ball()) == cones
    yield from press("RET", place_of(ball(), end))
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted({*cones} - {start} | {end})
    after = snapshot(ball())
    bpy.ops.ed.undo()
    yield 0.2
    assert changed(before, snapshot(ball())) == set()
    bpy.ops.ed.redo()
    yield 0.2
    assert changed(after, snapshot(ball())) == set()


def test_clicks_add_and_remove_and_digits_give_angles():
    yield from begin()
    cones = marked(ball())
    removed = in_front(ball(), lambda v: v in cones)[0]
    added = in_front(ball(), lambda v: v not in cones)[0]
    yield from click(place_of(ball(), removed), ctrl=True)
    place = place_of(ball(), added)
    yield from click(place)
    yield from type_text("270", place)
    yield from press("RET", place)
    assert editing()
    event("WHEELUPMOUSE", "PRESS", place)
    yield 0.2
    yield from press("RET", place)
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted({*cones} - {removed} | {added})
    assert abs(angle_of(ball(), added) - 285) < 1e-4


def left_as_it_was(key):
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    uv = uv_of(ball())
    start = in_front(ball(), lambda v: v in cones)[0]
    end = in_front(ball(), lambda v: v not in cones)[0]
    yield from click(place_of(ball(), end))
    yield from type_text("300", place_of(ball(), end))
    yield from drag(place_of(ball(), start), np.array(place_of(ball(), start)) + 40)
    yield from until(lambda: uv_of(ball()) != uv)
    yield from press(key, place_of(ball(), end))
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()


def test_esc_leaves_everything_as_it_was():
    yield from left_as_it_was("ESC")


def test_the_right_mouse_button_leaves_everything_as_it_was():
    yield from left_as_it_was("RIGHTMOUSE")


def test_the_wheel_zooms_beside_cones_and_other_keys_do_nothing():
    yield from begin()
    before = snapshot(ball())
    seen = area().spaces.active.region_3d
    distance = seen.view_distance
    within = region()
    # Neither the ball nor the toolbar.
    corner = within.x + round(0.85 * within.width), within.y + round(0.1 * within.height)
    yield from move_to(corner)
    event("WHEELDOWNMOUSE", "PRESS", corner)
    yield from until(lambda: seen.view_distance > distance)
    for key in ("X", "TAB", "G"):
        yield from press(key, corner)
    assert editing()
    yield from press("RET", corner)
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()


def test_opening_a_file_ends_the_tool():
    yield from begin()
    bpy.app.timers.register(lambda: bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True) and None)
    yield from until(lambda: not editing(), 8.0)
