# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones with the mouse and the keyboard: drag, add, remove, angles, Esc, one step of undo.

Run by run_in_window.py; no pytest.
"""

import os
import time
from importlib import import_module

import bpy
import numpy as np
from mathutils import Quaternion, Vector
from scenes import ANGLES, add_ball, changed, edit, marked, plain_copy, snapshot

EXTENSION = os.environ["CONE_UNWRAP_EXTENSION"]
STEP = 0.05
NAMES = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
screens = import_module(f"{EXTENSION}.screen")


def window():
    return bpy.context.window_manager.windows[0]


def view():
    area = next(area for area in window().screen.areas if area.type == "VIEW_3D")
    return area, next(region for region in area.regions if region.type == "WINDOW")


def editing():
    return any(operator.bl_idname == "MESH_OT_cone_edit" for operator in window().modal_operators)


def until(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"waited {seconds} seconds in vain"
        yield STEP


def place_of(obj, vertex):
    """Pixels of a vertex in the window."""
    area, region = view()
    matrix = area.spaces.active.region_3d.perspective_matrix @ obj.matrix_world
    screen = screens.Screen(np.array(matrix, np.float64), region.width, region.height)
    x, y, _ = screen.pixels(obj.data.vertices[vertex].co)[0]
    return round(x) + region.x, round(y) + region.y


def event(key, value, place, **keys):
    window().event_simulate(type=key, value=value, x=place[0], y=place[1], **keys)


def move_to(place):
    event("MOUSEMOVE", "NOTHING", place)
    yield STEP


def click(place, **keys):
    yield from move_to(place)
    event("LEFTMOUSE", "PRESS", place, **keys)
    event("LEFTMOUSE", "RELEASE", place, **keys)
    yield STEP


def press(key, place, unicode=None):
    event(key, "PRESS", place, **({} if unicode is None else {"unicode": unicode}))
    event(key, "RELEASE", place)
    yield STEP


def type_text(text, place):
    names = dict(zip("0123456789", NAMES, strict=True))
    for character in text:
        yield from press(names[character], place, character)


def begin(cuts=5):
    """A ball in edit mode, unwrapped, seen from the front, with the tool running."""
    ball = add_ball(cuts=cuts)
    edit(ball, select="DESELECT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    bpy.ops.mesh.select_all(action="DESELECT")
    seen = view()[0].spaces.active.region_3d
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
    seen = view()[0].spaces.active.region_3d
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


def drag(start, end, steps=6):
    yield from move_to(start)
    event("LEFTMOUSE", "PRESS", start)
    for share in np.linspace(0, 1, steps + 1)[1:]:
        x, y = np.array(start) + share * (np.array(end) - start)
        yield from move_to((round(x), round(y)))
    yield 0.2
    event("LEFTMOUSE", "RELEASE", end)
    yield STEP


def test_dragging_a_cone_moves_it_and_the_map_follows_as_one_step_of_undo():
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    start = in_front(ball(), lambda v: v in cones)[0]
    end = in_front(ball(), lambda v: v not in cones)[0]
    uv = uv_of(ball())
    yield from drag(place_of(ball(), start), place_of(ball(), end))
    yield from until(lambda: uv_of(ball()) != uv)
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
    seen = view()[0].spaces.active.region_3d
    distance = seen.view_distance
    region = view()[1]
    # Neither the ball nor the toolbar.
    corner = region.x + round(0.85 * region.width), region.y + round(0.1 * region.height)
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
