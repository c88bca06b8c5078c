# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cuts with the mouse and the keyboard: highlight, drag, Esc, single steps and one step of undo.

Run by run_in_window.py; no pytest.
"""

from itertools import pairwise

import bpy
from edit_tests import ball, in_front, require_one_step_of_undo, uv_of
from installed import addon
from mathutils import Quaternion, Vector
from scenes import UvMap, add_ball, changed, edit, snapshot
from windows import area, drag, move_to, place_of, press, running, take_picture, until

cache, reports = addon.overlay.cache, addon.mesh.reports


def editing():
    return running("MESH_OT_cone_edit_cuts")


def begin():
    """A ball in edit mode, unwrapped, seen from behind, where its cuts are, with the tool running."""
    add_ball(cuts=5)
    edit(ball(), select="SELECT")
    bpy.ops.uv.cone_unwrap()
    bpy.ops.mesh.select_all(action="DESELECT")
    seen = area().spaces.active.region_3d
    seen.view_perspective = "PERSP"
    seen.view_rotation = Quaternion((0, 0, 1), 3.3) @ Quaternion((1, 0, 0), 1.4)
    seen.view_location, seen.view_distance = Vector((0, 0, 0)), 5.0
    bpy.ops.ed.undo_push(message="before")
    yield 0.3
    assert bpy.ops.mesh.cone_edit_cuts("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    assert editing()


def on_a_cut():
    """A vertex inside a cut and a neighboring one that is on no cut, both in front."""
    paths = reports.find(ball().data).paths
    inside = {vertex for path in paths for vertex in path[1:-1]}
    taken = {vertex for path in paths for vertex in path}
    start = in_front(ball(), lambda vertex: vertex in inside)[0]
    places = ball().data.vertices
    free = in_front(ball(), lambda vertex: vertex not in taken)
    return start, min(free, key=lambda vertex: (places[vertex].co - places[start].co).length)


def is_cut_at(vertex):
    return any(vertex in edge for edge in UvMap(ball()).split_edges())


def test_dragging_a_cut_moves_it_as_one_step_of_undo():
    yield from begin()
    before = snapshot(ball())
    start, end = on_a_cut()
    yield from move_to(place_of(ball(), start))
    yield from until(lambda: cache.entry(ball()).content.active_path is not None)
    take_picture("a_cut_under_the_mouse")
    uv = uv_of(ball())
    yield from drag(place_of(ball(), start), place_of(ball(), end))
    yield from until(lambda: uv_of(ball()) != uv)
    take_picture("a_dragged_cut")
    assert is_cut_at(end)
    yield from press("RET", place_of(ball(), end))
    yield from until(lambda: not editing())
    assert {edge for path in reports.find(ball().data).paths for edge in map(frozenset, pairwise(path))} == {
        frozenset(edge) for edge in UvMap(ball()).split_edges()
    }
    yield from require_one_step_of_undo(before)


def test_single_steps_of_cuts_are_undone_and_escape_leaves_no_trace():
    yield from begin()
    before = snapshot(ball())
    start, end = on_a_cut()
    uv = uv_of(ball())
    yield from drag(place_of(ball(), start), place_of(ball(), end))
    yield from until(lambda: uv_of(ball()) != uv)
    moved = uv_of(ball())
    yield from press("Z", place_of(ball(), end), ctrl=True)
    yield from until(lambda: uv_of(ball()) == uv)
    yield from press("Z", place_of(ball(), end), ctrl=True, shift=True)
    yield from until(lambda: uv_of(ball()) == moved)
    yield from press("ESC", place_of(ball(), end))
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()
