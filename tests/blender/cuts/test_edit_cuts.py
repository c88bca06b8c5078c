# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions of Edit Cuts: dragging, undoing, restoring, and what is preserved of an edited map."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import (
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_texture,
    changed,
    edit,
    pin,
    set_uv,
    snapshot,
    uv_key,
)

edited_cuts, cut_session = addon.jobs.sessions.edited_cuts, addon.jobs.sessions.cut_session
reports, screens, content = addon.mesh.reports, addon.core.screen, addon.overlay.content
picked_objects, picking = addon.jobs.sessions.picked_objects, addon.jobs.sessions.picking
Refused, lsgp = addon.core.errors.Refused, addon.core.native.lsgp

CHOICE = addon.jobs.tasks.cuts.CutChoice(front=None)
SIZE = 400


def unwrapped(obj, **options):
    assert bpy.ops.uv.cone_unwrap(**options) == {"FINISHED"}
    edit(obj, select="DESELECT")
    return obj


def begin(obj):
    return cut_session.CutSession(obj, CHOICE)


def along(paths):
    return {tuple(sorted(pair)) for path in paths for pair in pairwise(path)}


def beside(session, number):
    """The middle edge of a cut, and vertices near it that are on no cut, nearest first."""
    path = session.paths[number]
    step = (len(path) - 1) // 2
    places, middle = session.mesh.places, session.mesh.places[path[step]]
    on_cuts = {vertex for one in session.paths for vertex in one}
    near = np.argsort(np.linalg.norm(places - middle, axis=1), kind="stable").tolist()
    return step, [vertex for vertex in near[:40] if vertex not in on_cuts]


def drag_somewhere(session, number=None):
    """Drag the longest cut, or another one, to the first vertex beside it that it can run by way of; returns that."""
    if number is None:
        number = max(range(len(session.paths)), key=lambda i: len(session.paths[i]))
    step, near = beside(session, number)
    session.grab(number, step, session.paths[number][step])
    for vertex in near:
        try:
            if session.drag(vertex):
                session.drop()
                return vertex
        except lsgp.TopologyError as error:
            assert error.code == "CUT_NOT_MOVABLE"
    raise AssertionError("the cut moves nowhere")


@pytest.mark.parametrize("seamless", [False, True])
def test_the_map_is_cut_where_a_cut_was_dragged_to_and_seams_still_match(seamless):
    ball = unwrapped(add_ball(), seamless=seamless)
    before = UvMap(ball)
    session = begin(ball)
    number = max(range(len(session.paths)), key=lambda i: len(session.paths[i]))
    ends = session.paths[number][0], session.paths[number][-1]
    vertex = drag_somewhere(session, number)
    moved = session.paths[number]
    assert vertex in moved and (moved[0], moved[-1]) == ends
    after = UvMap(ball)
    assert after.split_edges() == along(session.paths) != before.split_edges()
    assert after.sister_difference() < 1e-5
    assert abs(after.l2_stretch() - before.l2_stretch()) < 1e-6
    if seamless:
        assert after.tile_error() == 0
    session.restore()


def test_putting_back_leaves_no_trace():
    ball = unwrapped(add_ball())
    before = snapshot(ball)
    session = begin(ball)
    drag_somewhere(session)
    drag_somewhere(session, 0)
    session.restore()
    assert changed(before, snapshot(ball)) == set()


def test_only_the_map_and_the_report_on_it_change():
    ball = unwrapped(add_ball())
    before, earlier = snapshot(ball), reports.find(ball.data)
    session = begin(ball)
    drag_somewhere(session)
    session.store()
    assert {name for name in changed(before, snapshot(ball)) if "report" not in name} == {uv_key()}
    report = reports.find(ball.data)
    moved = {tuple(sorted(edge)) for edge in report.edges_of("moved")}
    assert UvMap(ball).split_edges() - along(earlier.paths) <= moved < UvMap(ball).split_edges()
    assert along(report.paths) == UvMap(ball).split_edges() != along(earlier.paths)
    assert report.overlapping == sorted(UvMap(ball).overlapping())
    assert (report.cones, report.distortion) == (earlier.cones, earlier.distortion)


def test_steps_are_undone_and_redone_to_the_last_bit():
    ball = unwrapped(add_ball())
    objects = edited_cuts.CutObjects([ball], CHOICE)
    session = objects.begun[0].session
    states = [snapshot(ball)[uv_key()]]
    for number in (0, 1):
        objects.history.begin("Move Cut")
        drag_somewhere(session, number)
        states.append(snapshot(ball)[uv_key()])
    assert objects.history.undo() and snapshot(ball)[uv_key()] == states[1]
    assert objects.history.undo() and snapshot(ball)[uv_key()] == states[0]
    assert not objects.history.undo() and not objects.changed
    assert objects.history.redo() and objects.history.redo()
    assert snapshot(ball)[uv_key()] == states[2] and not objects.history.redo()
    objects.history.begin("Move Cut")
    objects.restore()
    objects.end()
    assert snapshot(ball)[uv_key()] == states[0]


def test_a_second_drag_leaves_the_first_one_where_it_is():
    ball = unwrapped(add_ball(cuts=5))
    session = begin(ball)
    number = max(range(len(session.paths)), key=lambda i: len(session.paths[i]))
    first = drag_somewhere(session, number)
    path = session.paths[number]
    at = path.index(first)
    step = at // 2 if at > len(path) - 1 - at else (at + len(path) - 1) // 2
    session.grab(number, step, path[step if step != at else step + 1])
    places = session.mesh.places
    for vertex in np.argsort(np.linalg.norm(places - places[path[step]], axis=1)).tolist()[:30]:
        try:
            if vertex not in path and session.drag(vertex):
                break
        except lsgp.TopologyError:
            continue
    assert {first, vertex} <= set(session.paths[number])
    assert UvMap(ball).split_edges() == along(session.paths)
    session.restore()


def add_halves(place_right):
    """A grid in edit mode, its left half beside u = 1 in the map; the places of its right half are mapped on."""
    grid = add_grid()
    right = {face.index for face in grid.data.polygons if face.center.x > 0}
    uv = np.zeros((len(grid.data.loops), 2), np.float32)
    for face in grid.data.polygons:
        for loop in face.loop_indices:
            place = grid.data.vertices[grid.data.loops[loop].vertex_index].co
            uv[loop] = 1 + place.x / 2, (place.y + 1) / 2
            if face.index in right:
                uv[loop] = place_right(*uv[loop])
    set_uv(grid, uv)
    edit(grid)
    return grid


def test_a_cut_between_two_islands_moves_too():
    grid = add_halves(lambda u, v: (u + 5, v))
    session = begin(grid)
    assert len(session.paths) == 1
    drag_somewhere(session)
    assert UvMap(grid).split_edges() == along(session.paths)
    assert UvMap(grid).islands() == 2
    session.restore()


def test_a_map_that_leaves_its_tile_is_noticed():
    grid = add_halves(lambda u, v: (u - 1, v))
    session = begin(grid)
    assert not session.leaves_tile
    drag_somewhere(session)
    assert session.leaves_tile
    session.restore()


def test_faces_that_come_to_lie_on_others_are_noticed():
    # Turned by half a turn, so that beyond the cut is the left half.
    grid = add_halves(lambda u, v: (1.45 - u, 1 - v))
    session = begin(grid)
    assert session.overlapping == []
    (path,) = session.paths
    session.grab(0, 2, path[2])
    left = np.flatnonzero(session.mesh.places[:, 0] < -0.1)
    assert session.drag(int(left[np.argmin(np.linalg.norm(session.mesh.places[left], axis=1))]))
    session.drop()
    assert set(session.overlapping) == UvMap(grid).overlapping() != set()
    session.put(session._begun_with)
    assert session.overlapping == []
    session.restore()


def test_maps_for_images_that_are_not_square():
    ball = add_ball()
    add_texture(ball, 200, 100)
    unwrapped(ball, correct_aspect=True)
    session = begin(ball)
    drag_somewhere(session)
    assert UvMap(ball).split_edges() == along(session.paths)
    session.restore()


def test_pinned_uvs_stay():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    pin(ball, range(len(ball.data.loops)))
    edit(ball, select="DESELECT")
    session = begin(ball)
    before = snapshot(ball)[uv_key()]
    step, near = beside(session, 0)
    session.grab(0, step, session.paths[0][step])
    with pytest.raises(Refused, match="pinned"):
        for vertex in near:
            try:
                session.drag(vertex)
            except lsgp.TopologyError:
                continue
    assert snapshot(ball)[uv_key()] == before
    session.restore()


def test_meshes_without_cuts_are_refused():
    ball, grid = add_ball(), add_grid()
    ball.data.uv_layers.remove(ball.data.uv_layers[0])
    edit(ball, grid)
    with pytest.raises(Refused, match="no UV map"):
        begin(ball)
    with pytest.raises(Refused, match="no edge is cut"):
        begin(grid)
    with pytest.raises(Refused):
        edited_cuts.CutObjects([ball, grid], CHOICE)


def from_above(_obj):
    return screens.Screen(np.diag([0.5, 0.5, -0.1, 1.0]), SIZE, SIZE)


def pixel(x, y):
    return (x / 2 + 1) * SIZE / 2, (y / 2 + 1) * SIZE / 2


def test_the_cut_under_the_cursor_is_near_and_seen():
    cube = unwrapped(add_cone_cube(cuts=1), cuts="SHORTEST")
    objects = edited_cuts.CutObjects([cube], CHOICE)
    session, sight = objects.begun[0].session, picked_objects.Sight(from_above)
    places, found = session.mesh.places, 0
    for first, second in sorted(along(session.paths)):
        a, b = places[first], places[second]
        x, y = pixel(*(0.7 * a + 0.3 * b)[:2])
        pick = objects.cut_at(sight, (x, y), 3)
        if min(a[2], b[2]) < 0.9:
            continue
        hit = pick[1]
        number, step = edited_cuts.place_of(session, hit.edge)
        assert {first, second} == set(session.paths[number][step : step + 2]) and hit.vertex == first
        objects.highlight(pick)
        assert objects.highlight(pick) == []
        assert content.cuts_content(cube, session).active_path == number
        found += 1
    assert found
    assert objects.cut_at(sight, pixel(1.8, 1.8), 5) is None
    objects.restore()
    objects.end()


def test_the_overlay_shows_the_cuts_as_they_are_dragged():
    ball = unwrapped(add_ball())
    session = begin(ball)
    drag_somewhere(session)
    shown = content.cuts_content(ball, session)
    assert len(shown.cut_lines) == len(shown.cut_uv) == 2 * len(along(session.paths))
    assert set(shown.cut_paths.tolist()) == set(range(len(session.paths)))
    session.restore()
