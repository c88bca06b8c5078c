# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw Texture Up with the mouse and the keyboard, and what the overlay shows of it.

Run by run_in_window.py; no pytest.
"""

import bpy
import numpy as np
from edit_tests import in_front, require_one_step_of_undo
from installed import addon
from scenes import add_ball, changed, edit, snapshot
from texture_ways import way_of
from windows import area, drag, place_of, press, running, take_picture, until

cache, identifiers = addon.overlay.cache, addon.core.identifiers


def ball():
    return bpy.data.objects["Ball"]


def drawing():
    return running("MESH_OT_cone_draw_up")


def arrows():
    return len(cache.entry(ball()).content.up_lines) // 3


def begin():
    """A ball in edit mode with the tool running."""
    add_ball(cuts=9)
    edit(ball(), select="DESELECT")
    seen = area().spaces.active.region_3d
    seen.view_perspective, seen.view_distance = "PERSP", 5.0
    bpy.ops.ed.undo_push(message="before")
    yield 0.3
    assert bpy.ops.mesh.cone_draw_up("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    assert drawing()


def ends():
    """Two vertices in front, some way apart."""
    seen = in_front(ball(), lambda vertex: True)
    places = np.array([ball().data.vertices[vertex].co for vertex in seen])
    return seen[0], seen[int(np.abs(np.linalg.norm(places - places[0], axis=1) - 0.6).argmin())]


def test_a_stroke_is_kept_as_one_step_of_undo_and_unwrapping_follows_it():
    yield from begin()
    before = snapshot(ball())
    start, end = ends()
    yield from drag(place_of(ball(), start), place_of(ball(), end), 12)
    yield from until(lambda: arrows() > 2)
    take_picture("a_stroke")
    assert changed(before, snapshot(ball())) == set()
    yield from press("RET", place_of(ball(), end))
    yield from until(lambda: not drawing())
    with addon.mesh.reader.readable_mesh(ball()) as mesh:
        assert arrows() == sum(any(item.vector) for item in mesh.attributes[identifiers.UP_ATTRIBUTE].data)
    yield from require_one_step_of_undo(before)


def test_strokes_are_undone_one_by_one_and_escape_leaves_no_trace():
    yield from begin()
    before = snapshot(ball())
    start, end = ends()
    yield from drag(place_of(ball(), start), place_of(ball(), end), 12)
    yield from until(lambda: arrows() > 2)
    drawn = arrows()
    yield from press("Z", place_of(ball(), end), ctrl=True)
    yield from until(lambda: arrows() == 0)
    yield from press("Z", place_of(ball(), end), ctrl=True, shift=True)
    yield from until(lambda: arrows() == drawn)
    yield from press("ESC", place_of(ball(), end))
    yield from until(lambda: not drawing())
    assert changed(before, snapshot(ball())) == set()


def test_the_texture_runs_along_a_stroke_and_its_axes_are_shown():
    yield from begin()
    start, end = ends()
    yield from drag(place_of(ball(), start), place_of(ball(), end), 12)
    yield from until(lambda: arrows() > 2)
    yield from press("RET", place_of(ball(), end))
    yield from until(lambda: not drawing())
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    bpy.context.window_manager.cone_unwrap_overlay.axes = True
    yield 0.5
    take_picture("texture_axes")
    bpy.ops.object.mode_set(mode="OBJECT")
    stored = np.array([item.vector for item in ball().data.attributes[identifiers.UP_ATTRIBUTE].data])
    drawn = np.flatnonzero(stored.any(axis=1))
    images = [way_of(ball(), stored[face], in_world=False)[face] for face in drawn]
    areas = np.array([ball().data.polygons[face].area for face in drawn])
    # The island has one rotation, with which the stroke is met in the sense of least squares.
    assert abs(np.angle(areas @ np.array(images) / 1j)) < np.radians(3)
