# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions of Edit Cones: picking, editing, the updated map, and restoring everything."""

import math
import time
from dataclasses import replace

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import (
    ANGLES,
    UV_ROUNDING,
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_sphere,
    changed,
    corners,
    covered_twice,
    edit,
    joined,
    mark,
    marked,
    plain_copy,
    select_elements,
    selected,
    snapshot,
    uv_key,
)

cone_session, unwrapping, content = addon.jobs.sessions.cone_session, addon.jobs.tasks.unwrapping, addon.overlay.content
hints, finishing = addon.operators.cones.hints, addon.jobs.sessions.finishing
status_bar = addon.operators.shared.status_bar
angle_table, picking, edited_objects = (
    addon.jobs.angles.angle_table,
    addon.jobs.sessions.picking,
    addon.jobs.sessions.edited_objects,
)
following, edit_history = addon.jobs.sessions.following, addon.jobs.sessions.edit_history
changes = addon.mesh.changes
reports, screens, typed_number = addon.mesh.reports, addon.core.screen, addon.operators.cones.typed_number
lsgp = addon.core.native.lsgp

SIZE = 400
AS_THEY_ARE = addon.jobs.layouts.maps.PackSettings(False, False, 0.001)
PACKED = replace(AS_THEY_ARE, pack=True)


def begin(obj, **options):
    """A session on an object, which is brought into edit mode."""
    if obj.mode != "EDIT":
        edit(obj, select="DESELECT")
    cuts = addon.jobs.tasks.cuts.CutChoice()
    settings = unwrapping.UnwrapSettings(lsgp.Options(**options), "uv_cones", None, 0.0, True, False, True, cuts)
    return cone_session.ConeSession(obj, settings)


def follow(session):
    step = session.draft()
    unwrapped = step.solve()
    session.show(step, unwrapped)
    return unwrapped


def finish(session, placing):
    """Raises what kept the mesh from being unwrapped."""
    (outcome,) = finishing.finish([session], [], placing)
    if isinstance(outcome, Exception):
        raise outcome
    return outcome


def vertex_at(session, x, y):
    hit = picking.Picker.of_mesh(session.mesh).vertex_at(from_above(), x, y)
    return None if hit is None else hit.vertex


def cone_at(session, x, y, radius):
    hit = picking.Picker.of_mesh(session.mesh).cone_at(from_above(), session.cones.vertices, x, y, radius)
    return None if hit is None else hit.vertex


def from_above():
    """An orthographic view along -z of the region within 2 of the origin in x and y."""
    return screens.Screen(np.diag([0.5, 0.5, -0.1, 1.0]), SIZE, SIZE)


def pixel(x, y):
    return (x / 2 + 1) * SIZE / 2, (y / 2 + 1) * SIZE / 2


def vertex_near(obj, *place):
    return min(obj.data.vertices, key=lambda v: (v.co - type(v.co)(place)).length).index


def stored_angle(obj, vertex):
    mesh = plain_copy(obj)
    attribute = mesh.attributes.get(ANGLES)
    angle = 0.0 if attribute is None else attribute.data[vertex].value
    bpy.data.meshes.remove(mesh)
    return angle


def test_pixels_and_rays_are_inverse_in_perspective():
    projection = np.array([(1.5, 0, 0, 0), (0, 2, 0, 0), (0, 0, -1.02, -0.2), (0, 0, -1, 0)])
    view = np.eye(4)
    view[:3, 3] = 0.3, -0.2, -4
    screen = screens.Screen(projection @ view, 640, 480)
    place = np.array([0.4, 0.7, -0.5])
    x, y, _ = screen.pixels(place)[0]
    origin, direction = screen.ray(x, y)
    assert np.linalg.norm(np.cross(place - origin, direction)) < 1e-9
    assert (place - origin) @ direction > 0
    assert np.isnan(screen.pixels([0, 0, 5.0])).all()


def test_the_vertex_under_the_cursor_is_the_nearest_of_the_face_there():
    cube = add_cone_cube()
    session = begin(cube)
    expected = vertex_near(cube, 0.5, -0.5, 1.0)
    assert vertex_at(session, *pixel(0.5, -0.5)) == expected
    assert vertex_at(session, *pixel(0.3, -0.68)) == expected
    assert vertex_at(session, *pixel(1.5, 0.0)) is None
    session.restore()


def test_the_cone_under_the_cursor_is_seen_and_near():
    cube = add_cone_cube()
    mark(cube, [vertex_near(cube, 0.0, 0.0, -1.0)])
    session = begin(cube)
    x, y = pixel(1.0, 1.0)
    # Right behind it is another one.
    assert cone_at(session, x + 5, y, 10) == vertex_near(cube, 1.0, 1.0, 1.0)
    assert cone_at(session, x + 15, y, 10) is None
    assert cone_at(session, *pixel(0.0, 0.0), 10) is None
    session.restore()


def test_hidden_faces_are_not_picked():
    cube = add_cone_cube()
    edit(cube)
    bpy.ops.mesh.hide(unselected=False)
    session = begin(cube)
    assert vertex_at(session, *pixel(0.5, 0.5)) is None
    session.restore()


def test_the_map_follows_a_cone_that_is_moved():
    ball = add_ball(cuts=5)
    session = begin(ball)
    start = marked(ball)[0]
    session.cones.add(start)
    assert not session.cones.changed
    target = neighbor(ball, start)
    assert session.cones.move(target) and session.cones.vertices == sorted({*marked(ball)} - {start} | {target})
    follow(session)
    uv = UvMap(ball)
    assert abs(uv.angle_sum(start) - 2 * math.pi) < 1e-3
    assert abs(uv.angle_sum(target) - session.angle(target)) < 1e-3
    assert abs(session.angle(target) - 2 * math.pi) > 0.1
    assert uv.sister_difference() < UV_ROUNDING
    # Only the map: the cones are stored at the end.
    assert start in marked(ball) and target not in marked(ball)
    session.restore()


def neighbor(obj, vertex):
    edge = next(edge for edge in obj.data.edges if vertex in edge.vertices[:])
    return next(v for v in edge.vertices if v != vertex)


def test_a_cone_does_not_move_onto_another():
    ball = add_ball()
    session = begin(ball)
    first, second, *_ = session.cones.vertices
    session.cones.add(first)
    assert not session.cones.move(second) and not session.cones.changed
    session.restore()


@pytest.mark.parametrize("has_uv", [True, False])
def test_putting_back_leaves_no_trace(has_uv):
    ball = add_ball()
    if not has_uv:
        ball.data.uv_layers.remove(ball.data.uv_layers[0])
    edit(ball, select="DESELECT")
    before = snapshot(ball)
    session = begin(ball)
    session.cones.add(20)
    follow(session)
    session.cones.set_angle(math.pi)
    follow(session)
    session.cones.remove(session.cones.vertices[0])
    follow(session)
    session.restore()
    assert changed(before, snapshot(ball)) == set()


def test_finishing_changes_the_map_the_cones_and_their_angles_alone():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    edit(ball, select="DESELECT")
    before, start = snapshot(ball), marked(ball)
    session = begin(ball)
    session.cones.add(start[0])
    session.cones.move(neighbor(ball, start[0]))
    session.cones.set_angle(math.radians(300))
    finish(session, AS_THEY_ARE)
    expected = sorted({*start[1:], session.cones.active})
    assert marked(ball) == expected and selected(ball) == []
    assert stored_angle(ball, session.cones.active) == np.float32(math.radians(300))
    assert abs(UvMap(ball).angle_sum(session.cones.active) - math.radians(300)) < 1e-3
    names = {f"attribute {ANGLES} POINT FLOAT", f"attribute {ANGLES}_kind POINT INT"}
    assert changed(before, snapshot(ball)) == {uv_key(), "weights"} | names
    report = reports.find(ball.data)
    assert sorted(report.cones) == expected


def test_the_finished_map_is_that_of_the_operator():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    session = begin(ball)
    session.cones.remove(session.cones.vertices[0])
    finish(session, AS_THEY_ARE)
    edited = UvMap(ball)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    direct = UvMap(ball)
    assert edited.split_edges() == direct.split_edges()
    assert abs(edited.l2_stretch() - direct.l2_stretch()) < 1e-4


def test_the_stretch_told_is_that_of_the_map():
    ball = add_ball()
    session = begin(ball)
    assert session.stretch is None
    session.cones.add(session.cones.vertices[0])
    session.cones.set_angle(math.pi)
    follow(session)
    sharp = session.stretch
    assert abs(sharp - UvMap(ball).l2_stretch()) < 1e-4
    session.cones.set_angle(None)
    follow(session)
    assert session.stretch < sharp
    session.restore()


def test_islands_stay_where_they_were():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    uv = UvMap(ball).uv
    moved = 0.5 * uv @ np.array([(0.6, 0.8), (-0.8, 0.6)]) + (2, 3)
    ball.data.uv_layers.active.uv.foreach_set("vector", moved.astype(np.float32).ravel())
    # The report is on the map that was; place the moved one by an unwrap of ours.
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    before = UvMap(ball).uv
    session = begin(ball)
    first = session.cones.vertices[0]
    session.cones.add(first)
    session.cones.set_angle(session.angle(first) + math.radians(5))
    follow(session)
    after = UvMap(ball).uv
    assert np.abs(after - before).max() < 0.2 * np.ptp(before, axis=0).max()
    assert np.abs(after.mean(axis=0) - before.mean(axis=0)).max() < 0.02 * np.ptp(before, axis=0).max()
    session.restore()


def test_a_changed_angle_takes_no_factorization():
    ball = add_ball(cuts=7)
    session = begin(ball, factorization="cut")
    session.cones.add(session.cones.vertices[0])
    session.cones.set_angle(math.radians(280))
    assert follow(session).result.factorizations > 0
    session.turn_angle(math.radians(15), 1)
    assert session.angle(session.cones.active) == pytest.approx(math.radians(300))
    assert follow(session).result.factorizations == 0
    session.restore()


def test_angles_turn_by_multiples_and_return_to_automatic():
    cube = add_cone_cube()
    session = begin(cube)
    session.cones.add(session.cones.vertices[0])
    session.cones.set_angle(None)
    assert session.cones.is_automatic(session.cones.active)
    follow(session)
    assert session.angle(session.cones.active) == pytest.approx(1.5 * math.pi, abs=1e-3)
    session.turn_angle(math.radians(15), -1)
    assert session.angle(session.cones.active) == pytest.approx(math.radians(255))
    session.turn_angle(math.radians(15), -100)
    assert session.angle(session.cones.active) == pytest.approx(math.radians(15))
    session.restore()


def test_what_cannot_be_unwrapped_leaves_the_map_and_keeps_the_cones():
    sphere = add_sphere()
    before = snapshot(sphere)
    session = begin(sphere)
    session.cones.add(30)
    with pytest.raises(lsgp.LsgpError):
        follow(session)
    with pytest.raises(lsgp.LsgpError):
        finish(session, AS_THEY_ARE)
    assert marked(sphere) == [30]
    assert uv_key() not in changed(before, snapshot(sphere))


def test_parts_whose_cones_are_not_edited_keep_their_map():
    cube = joined(add_cone_cube("Cube"), add_cone_cube("Other"))
    before = UvMap(cube).uv
    session = begin(cube)
    first = session.cones.vertices[0]
    session.cones.remove(first)
    follow(session)
    uv = UvMap(cube)
    same = (uv.uv == before).all(axis=1)
    near = uv.positions[uv.vertex][:, 0] < 2
    assert same[~near].all() and not same[near].any()
    session.restore()


def test_found_angles_are_automatic_once_the_cones_of_their_part_are_others():
    ball = add_ball()
    bpy.ops.mesh.cone_place(automatic=False, count=8)
    session = begin(ball)
    first, second, *_ = session.cones.vertices
    found = session.cones.current().angles
    assert None not in found
    session.cones.remove(first)
    assert session.cones.current().angles == [None] * 7
    finish(session, AS_THEY_ARE)
    assert stored_angle(ball, second) == 0.0


def test_open_borders_need_no_cone():
    grid = add_grid()
    session = begin(grid)
    middle = vertex_near(grid, 0.0, 0.0, 0.0)
    session.cones.add(middle)
    session.cones.set_angle(math.radians(330))
    finish(session, AS_THEY_ARE)
    assert abs(UvMap(grid).angle_sum(middle) - math.radians(330)) < 1e-3


def test_numbers_are_typed_key_by_key():
    typed = typed_number.TypedNumber()
    for key, character in (("TWO", "2"), ("SEVEN", "7"), ("COMMA", ","), ("FIVE", "5"), ("PERIOD", ".")):
        typed.press(key, character)
    assert typed.text == "27.5" and typed.value == 27.5
    assert typed.press("BACK_SPACE", "") and typed.value == 27.0
    assert not typed.press("X", "x")
    typed.clear()
    assert typed.value is None


@pytest.mark.parametrize("build", [add_ball, add_grid])
def test_a_session_shows_what_the_overlay_shows_of_the_same_map(build):
    obj = build()
    mark(obj, marked(obj) or [0, 24])
    bpy.ops.uv.cone_unwrap()
    edit(obj, select="DESELECT")
    hidden = [face.index for face in obj.data.polygons][::16]
    select_elements(obj, "faces", hidden)
    bpy.ops.mesh.hide()
    session = begin(obj)
    for _ in range(2):
        report = session.report()
        report = replace(report, flipped=[1, 2], overlapping=[3]) if report else None
        expected = content.build_content(obj, report, marked=session.cones.current())
        found = content.build_content(obj, report, session.mesh, session.cones.current())
        assert found.cones == expected.cones
        for name in (
            "cone_places",
            "cone_uv",
            "cone_rows",
            "cut_lines",
            "cut_paths",
            "cut_uv",
            "flipped",
            "overlapping",
        ):
            np.testing.assert_allclose(getattr(found, name), getattr(expected, name), atol=1e-6)
        session.cones.add(vertex_near(obj, 0.4, 0.3, 0.5))
        follow(session)
    assert len(found.cut_lines) and len(found.cut_lines) == len(content.session_content(obj, session).cut_lines)


def until_idle(follower):
    """How often something was shown, or failed, until the map is up to date."""
    shown = 0
    while follower.outdated or follower.is_busy:
        shown += follower.follow()
    return shown


def test_the_map_follows_to_the_newest_state():
    ball = add_ball(cuts=5)
    session = begin(ball)
    follower = following.Follower(session)
    assert not follower.follow() and not follower.is_busy
    session.cones.add(session.cones.vertices[0])
    for degrees in (200, 220, 240):
        session.cones.set_angle(math.radians(degrees))
        follower.outdated = True
        follower.follow()
    until_idle(follower)
    followed = UvMap(ball).uv
    assert UvMap(ball).angle_sum(session.cones.active) == pytest.approx(math.radians(240), abs=1e-3)
    follow(session)
    np.testing.assert_array_equal(UvMap(ball).uv, followed)
    session.restore()


def test_a_step_that_fails_is_told_until_one_succeeds():
    session = begin(add_cone_cube())
    follower = following.Follower(session)
    first = session.cones.vertices[0]
    session.cones.add(first)
    for cone in session.cones.vertices[1:]:
        session.cones.remove(cone)
    follower.outdated = True
    assert until_idle(follower) == 1
    assert "Mark more cones" in follower.problem
    for cone in corners(session._obj)[1:]:
        session.cones.add(cone)
    follower.outdated = True
    assert until_idle(follower) == 1
    assert follower.problem == ""
    session.restore()


def test_stopping_leaves_no_computation_and_shows_nothing(monkeypatch):
    def endless(_step, progress):
        while progress(0.5):
            time.sleep(0.01)
        raise lsgp.Cancelled("CANCELLED", "Stopped.")

    monkeypatch.setattr(cone_session.Step, "solve", endless)
    ball = add_ball()
    session = begin(ball)
    follower = following.Follower(session)
    before = UvMap(ball).uv
    session.cones.remove(session.cones.vertices[0])
    follower.outdated = True
    assert not follower.follow() and follower.is_busy
    follower.stop()
    assert not follower.is_busy and not follower.follow()
    np.testing.assert_array_equal(UvMap(ball).uv, before)
    session.restore()


def history_of(session):
    return edit_history.EditHistory(session.cones.state, session.cones.put)


def test_steps_are_undone_and_redone_with_the_angles_the_active_cone_and_the_map():
    ball = add_ball()
    bpy.ops.mesh.cone_place(automatic=False, count=8)
    bpy.ops.uv.cone_unwrap()
    session = begin(ball)
    history, follower = history_of(session), following.Follower(session)
    seen = [(session.cones.current(), session.cones.active, UvMap(ball).uv)]

    def change(name, work):
        history.begin(name)
        work()
        follower.outdated = True
        until_idle(follower)
        seen.append((session.cones.current(), session.cones.active, UvMap(ball).uv))

    first = session.cones.vertices[0]
    free = next(v for v in range(len(ball.data.vertices)) if v not in session.cones)
    change("Add Cone", lambda: session.cones.add(free))
    change("Set Angle", lambda: session.cones.set_angle(math.radians(350)))
    change("Remove Cone", lambda: session.cones.remove(first))

    def compare(expected):
        follower.outdated = True
        until_idle(follower)
        cones, active, uv = expected
        assert session.cones.current().angles == cones.angles and session.cones.active == active
        np.testing.assert_array_equal(session.cones.current().cones, cones.cones)
        np.testing.assert_allclose(UvMap(ball).uv, uv, atol=1e-5)

    names = ["Add Cone", "Set Angle", "Remove Cone"]
    for number in (2, 1, 0):
        assert history.undoes == names[number] and history.undo()
        compare(seen[number])
    assert not session.cones.changed and not history.undo() and history.undoes is None
    np.testing.assert_array_equal(UvMap(ball).uv, seen[0][2])
    for number in (1, 2, 3):
        assert history.redoes == names[number - 1] and history.redo()
        compare(seen[number])
    assert not history.redo()
    assert history.undo()
    change("Change Angle", lambda: session.turn_angle(math.radians(15), 1))
    assert history.redoes is None and history.undoes == "Change Angle"
    session.restore()


def test_steps_that_change_nothing_are_none():
    session = begin(add_ball())
    history = history_of(session)
    first = session.cones.vertices[0]
    history.begin("Remove Cone")
    session.cones.remove(first)
    history.begin("Move Cone")
    session.cones.add(session.cones.vertices[0])
    assert history.undoes == "Remove Cone" and history.undo()
    assert first in session.cones and history.undoes is None
    session.restore()


def test_a_step_stays_while_it_is_shown_before_anything_changes():
    session = begin(add_ball())
    history = history_of(session)
    first = session.cones.vertices[0]
    history.begin("Remove Cone")
    assert history.undoes is None
    session.cones.remove(first)
    assert history.undoes == "Remove Cone" and history.undo()
    assert first in session.cones
    session.restore()


def test_undone_steps_give_the_parts_they_touched_back():
    cube = joined(add_cone_cube("Cube"), add_cone_cube("Other"))
    bpy.ops.uv.cone_unwrap()
    before = UvMap(cube).uv
    session = begin(cube)
    history = history_of(session)
    near, far = session.cones.vertices[0], session.cones.vertices[-1]
    for cone in (near, far):
        history.begin("Remove Cone")
        session.cones.remove(cone)
        follow(session)
    history.undo()
    follow(session)
    uv = UvMap(cube)
    same = (uv.uv == before).all(axis=1)
    is_near = uv.positions[uv.vertex][:, 0] < 2
    assert same[~is_near].all() and not same[is_near].any()
    session.restore()


def is_in_tile(uv, column=0, row=0):
    return bool((uv >= (column - 1e-5, row - 1e-5)).all() and (uv <= (column + 1 + 1e-5, row + 1 + 1e-5)).all())


def with_a_sharp_cone(build, placing):
    """The map of an object that was unwrapped and then got a sharp cone in place of two blunt ones."""
    obj = build()
    bpy.ops.uv.cone_unwrap()
    assert is_in_tile(UvMap(obj).uv)
    session = begin(obj)
    session.cones.remove(session.cones.vertices[0])
    session.cones.remove(session.cones.vertices[-1])
    session.cones.add(session.cones.vertices[2])
    session.cones.set_angle(math.radians(120))
    finish(session, placing)
    report = reports.find(obj.data)
    assert report.texel_density is not None and sorted(report.cones) == marked(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    return UvMap(obj)


@pytest.mark.parametrize("build", [add_ball, add_cone_cube])
def test_what_does_not_fit_into_its_place_is_packed_again(build):
    left, packed = (with_a_sharp_cone(build, placing) for placing in (AS_THEY_ARE, PACKED))
    assert not is_in_tile(left.uv) and is_in_tile(packed.uv)
    assert packed.sister_difference() < 4 * UV_ROUNDING
    assert packed.split_edges() == left.split_edges()
    assert packed.l2_stretch() == pytest.approx(left.l2_stretch(), abs=1e-4)


def two_cubes(place):
    """Two cubes in one mesh, unwrapped; place: where their UVs go then."""
    cube = joined(add_cone_cube("Cube", 1), add_cone_cube("Other", 1))
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(cube)
    is_near = uv_map.positions[uv_map.vertex][:, 0] < 2
    uv = place(uv_map.uv, is_near).astype(np.float32)
    cube.data.attributes["UVMap"].data.foreach_set("vector", uv.ravel())
    # The report is on the map that was.
    reports.store(cube.data, reports._parsed(cube.data.cone_unwrap_report.partition("\n")[2]))
    return cube


def overlap_after(place, placing):
    """The overlapping share of the map of two cubes after one of them is edited; and the map."""
    cube = two_cubes(place)
    session = begin(cube)
    near = [cone for cone in session.cones.vertices if cube.data.vertices[cone].co.x < 2]
    for cone in near[4:]:
        session.cones.remove(cone)
    finish(session, placing)
    uv_map = UvMap(cube)
    return covered_twice([uv_map], 150), uv_map


def placed(*middles):
    """Moves the UVs of the two cubes so that these are the middles of their boxes."""

    def place(uv, is_near):
        out = uv.copy()
        for part, middle in zip((is_near, ~is_near), middles, strict=True):
            low, high = uv[part].min(axis=0), uv[part].max(axis=0)
            out[part] = middle + (uv[part] - (low + high) / 2) * (0.25 / (high - low).max())
        return out

    return place


def test_islands_that_came_to_lie_on_others_are_packed():
    overlap, _ = overlap_after(lambda uv, _near: uv, AS_THEY_ARE)
    assert overlap > 0
    bpy.ops.object.mode_set(mode="OBJECT")
    overlap, uv_map = overlap_after(lambda uv, _near: uv, PACKED)
    assert overlap == 0 and is_in_tile(uv_map.uv)


@pytest.mark.slow
def test_islands_that_lay_on_each_other_stay_so():
    """Both are in the middle of the square, where edited islands would be placed."""
    overlap, uv_map = overlap_after(placed((0.5, 0.5), (0.5, 0.5)), PACKED)
    assert overlap > 0
    assert np.abs(uv_map.uv - 0.5).max() < 0.3


def test_maps_on_another_tile_stay_there():
    _, uv_map = overlap_after(placed((3.25, 1.5), (3.75, 1.5)), PACKED)
    assert is_in_tile(uv_map.uv, 3, 1)


SETTINGS = angle_table.TableSettings("uv_cones", "follow", "free")


def test_the_table_of_angles_follows():
    ball = add_ball()
    edit(ball, select="DESELECT")
    uid = ball.data.session_uid
    stored = angle_table.current_table(ball, SETTINGS)
    session = begin(ball)
    angle_table.follow(uid, session.table())
    assert angle_table.current_table(ball, SETTINGS) == stored
    first, *others = session.cones.vertices
    session.cones.add(first)
    session.cones.set_angle(math.radians(200))
    (part,) = angle_table.current_table(ball, SETTINGS)
    assert [row.vertex for row in part.rows] == [first, *others]
    assert part.rows[0].angle == math.radians(200) and part.ledger.assigned == pytest.approx(math.radians(160))
    assert angle_table.current_table(ball, SETTINGS)[0] is part
    session.cones.remove(others[0])
    assert len(angle_table.current_table(ball, SETTINGS)[0].rows) == len(others)
    session.restore()
    angle_table.unfollow(uid)
    assert angle_table.current_table(ball, SETTINGS) == stored


def seen_from_above(obj):
    """As `from_above`, of an object anywhere."""
    screen = from_above()
    return screens.Screen(screen.matrix @ np.array(obj.matrix_world, np.float64), SIZE, SIZE)


FROM_ABOVE = edited_objects.Sight(seen_from_above)


def alone(shown):
    """As in a local view."""
    return edited_objects.Sight(lambda obj: seen_from_above(obj) if obj == shown else None)


def begin_together(*objects, **options):
    if objects[0].mode != "EDIT":
        edit(*objects, select="DESELECT")
    cuts = addon.jobs.tasks.cuts.CutChoice()
    settings = unwrapping.UnwrapSettings(lsgp.Options(**options), "uv_cones", None, 0.0, True, False, True, cuts)
    return edited_objects.EditedObjects(objects, settings)


def add_upper_and_lower():
    """Two cubes over each other, the upper one half as wide and twice as flat."""
    lower, upper = add_cone_cube("Lower"), add_cone_cube("Upper")
    upper.scale, upper.location = (0.5, 0.5, 0.25), (0.0, 0.0, 3.0)
    bpy.context.view_layer.update()
    return lower, upper


def test_the_nearest_object_in_the_world_is_picked():
    lower, upper = add_upper_and_lower()
    objects = begin_together(lower, upper)
    edited, hit = objects.vertex_at(FROM_ABOVE, *pixel(0.2, 0.25))
    assert edited.obj == upper and hit.vertex == vertex_near(upper, 0.5, 0.5, 1.0)
    edited, hit = objects.vertex_at(FROM_ABOVE, *pixel(0.8, 0.9))
    assert edited.obj == lower and hit.vertex == vertex_near(lower, 1.0, 1.0, 1.0)
    assert objects.vertex_at(FROM_ABOVE, *pixel(1.5, 0.0)) is None
    only_lower = objects.vertex_at(alone(lower), *pixel(0.2, 0.25))
    assert only_lower[0].obj == lower
    assert objects.begun == []
    objects.end()


def test_cones_behind_another_object_are_not_picked():
    lower, upper = add_upper_and_lower()
    hidden = vertex_near(lower, 0.0, 0.0, 1.0)
    mark(lower, [hidden])
    objects = begin_together(lower, upper)
    edited, hit = objects.cone_at(FROM_ABOVE, *pixel(0.5, 0.5), 10)
    assert edited.obj == upper and hit.vertex == vertex_near(upper, 1.0, 1.0, 1.0)
    edited, hit = objects.cone_at(FROM_ABOVE, *pixel(1.0, 1.0), 10)
    assert edited.obj == lower and hit.vertex == vertex_near(lower, 1.0, 1.0, 1.0)
    assert objects.cone_at(FROM_ABOVE, *pixel(0.0, 0.0), 10) is None
    found = objects.cone_at(alone(lower), *pixel(0.0, 0.0), 10)
    assert found[0].obj == lower and found[1].vertex == hidden
    objects.end()


def until_all_idle(objects):
    while any(edited.follower.outdated or edited.follower.is_busy for edited in objects.begun):
        objects.follow()


def test_objects_are_edited_undone_and_put_back_together():
    first, second, third = add_ball("First"), add_ball("Second"), add_ball("Third")
    second.scale = 1.0, 1.0, 2.0
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    edit(first, second, third, select="DESELECT")
    before = [snapshot(obj) for obj in (first, second, third)]
    objects = begin_together(first, second, third)
    assert changes.is_suspended(third.data)
    for edited in objects._all[:2]:
        objects.activate(edited)
        objects.history.begin("Remove Cone")
        edited.session.cones.remove(edited.cones[0])
        edited.follower.outdated = True
    until_all_idle(objects)
    assert len(objects.begun) == 2 and objects.count() == 22 and objects.active.obj == second
    maps = [UvMap(obj).uv for obj in (first, second)]
    assert objects.history.undo()
    until_all_idle(objects)
    assert objects.count() == 23 and objects.active_cones is None
    assert uv_key() not in changed(before[1], snapshot(second))
    np.testing.assert_array_equal(UvMap(first).uv, maps[0])
    assert objects.history.redo()
    until_all_idle(objects)
    np.testing.assert_allclose(UvMap(second).uv, maps[1], atol=1e-5)
    objects.restore()
    objects.end()
    assert not changes.is_suspended(third.data)
    for obj, state in zip((first, second, third), before, strict=True):
        assert changed(state, snapshot(obj)) == set()


def test_one_object_that_cannot_be_unwrapped_does_not_keep_others_from_it():
    good, bad = add_ball("Good"), add_cone_cube("Bad")
    objects = begin_together(good, bad)
    for edited in objects._all:
        objects.activate(edited)
        for cone in edited.cones[1 if edited.obj == good else 0 :][: 1 if edited.obj == good else 7]:
            edited.session.cones.remove(cone)
    finished = objects.finish(PACKED)
    objects.end()
    assert [isinstance(outcome, Exception) for _, outcome in finished] == [False, True]
    assert len(marked(good)) == 7 and len(marked(bad)) == 1
    assert reports.find(good.data) is not None


def test_a_dragged_cone_stays_on_its_connected_part():
    cube = joined(add_cone_cube("Cube"), add_cone_cube("Other"))
    session = begin(cube)
    near, far = vertex_near(cube, 0.0, 0.0, 1.0), vertex_near(cube, 5.0, 0.0, 1.0)
    session.cones.add(session.cones.vertices[0])
    assert session.cones.move(near)
    assert not session.cones.move(far)
    assert session.cones.active == near and far not in session.cones
    session.restore()


class StatusBar:
    """Stands for a header and its layout, and keeps its labels."""

    def __init__(self):
        self.layout, self.labels = self, []

    def label(self, text, icon):
        self.labels.append((text, icon))

    def separator_spacer(self):
        pass

    template_reports_banner = template_running_jobs = separator_spacer


def test_the_status_bar_has_icons_where_blender_has_them_and_names_the_steps():
    shown = hints.hints("Add Cone", None)
    wheel = next(hint for hint in shown if hint.keys == "Wheel")
    icons = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
    present = [hint for hint in shown if all(icon in icons for icon in hint.icons)]
    bar = StatusBar()
    status_bar.status(present)(bar, bpy.context)
    assert ("", "EVENT_CTRL") in bar.labels and ("Undo Add Cone", "EVENT_Z") in bar.labels
    assert [text for text, _ in bar.labels if text] == [hint.text for hint in present]
    missing = replace(wheel, icons=("NO_SUCH_ICON",))
    text = status_bar.status([*present, missing])
    assert text.startswith("Click: Add  |  Drag: Move") and text.endswith("Wheel: Angle")
    assert "Ctrl-Shift-Z: Redo" not in text
    assert [hint.text for hint in hints.hints(None, "Move Cone")].count("Redo Move Cone") == 1


def shared_square(place):
    """Three cubes in a mesh each, unwrapped together, their islands then moved; place: the middles of their boxes."""
    cubes = [add_cone_cube(name, 1) for name in ("First", "Second", "Third")]
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    for cube, middle in zip(cubes, place, strict=True):
        uv = UvMap(cube).uv
        low, high = uv.min(axis=0), uv.max(axis=0)
        uv = middle + (uv - (low + high) / 2) * (0.3 / (high - low).max())
        cube.data.attributes["UVMap"].data.foreach_set("vector", uv.astype(np.float32).ravel())
        reports.store(cube.data, reports._parsed(cube.data.cone_unwrap_report.partition("\n")[2]))
    return cubes


def with_fewer_cones_on_the_first(place):
    """The maps of three cubes before and after one of them gets another shape in the map."""
    cubes = shared_square(place)
    before = [UvMap(cube).uv for cube in cubes]
    objects = begin_together(*cubes)
    objects.activate(objects._all[0])
    for cone in objects._all[0].cones[4:]:
        objects.active.session.cones.remove(cone)
    objects.finish(PACKED)
    objects.end()
    assert all(reports.find(cube.data) is not None for cube in cubes)
    return before, [UvMap(cube) for cube in cubes]


def test_objects_that_share_the_square_make_room():
    _, maps = with_fewer_cones_on_the_first([(0.2, 0.5), (0.5, 0.5), (0.8, 0.5)])
    assert covered_twice(maps, 100) == 0
    assert all(is_in_tile(uv_map.uv) for uv_map in maps)


def test_objects_that_do_not_share_the_square_stay():
    before, maps = with_fewer_cones_on_the_first([(0.5, 0.5)] * 3)
    for uv, uv_map in zip(before[1:], maps[1:], strict=True):
        np.testing.assert_array_equal(uv_map.uv, uv)
    assert is_in_tile(maps[0].uv)


def over_the_layout(*, selected=False):
    """A UV editor that shows the unit square, SIZE pixels wide."""
    matrix = np.array([(2.0, 0, 0, -1), (0, 2.0, 0, -1), (0, 0, -0.5, 0), (0, 0, 0, 1)])
    return edited_objects.Sight(lambda _obj: screens.Screen(matrix, SIZE, SIZE), layout=True, selected=selected)


def test_vertices_and_cones_are_picked_in_the_layout():
    ball = add_ball(cuts=2)
    bpy.ops.uv.cone_unwrap()
    uv = UvMap(ball)
    objects = begin_together(ball)
    for triangle in uv.triangles[::7]:
        corners_uv = uv.uv[triangle]
        near = 0.5 * corners_uv[1] + 0.25 * (corners_uv[0] + corners_uv[2])
        nearest = triangle[np.linalg.norm(corners_uv - near, axis=1).argmin()]
        _, hit = objects.vertex_at(over_the_layout(), *(SIZE * near))
        assert hit.vertex == uv.vertex[nearest]
    for loop in np.flatnonzero(np.isin(uv.vertex, marked(ball))):
        _, hit = objects.cone_at(over_the_layout(), *(SIZE * uv.uv[loop] + (1, 0)), 3)
        assert hit.vertex == uv.vertex[loop]
    assert objects.vertex_at(over_the_layout(selected=True), *(SIZE * near)) is None
    objects.end()


def test_the_layout_is_picked_as_it_was_while_a_cone_is_dragged_in_it():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    before = UvMap(ball)
    objects = begin_together(ball)
    (edited,) = objects._all
    place = before.uv[before.triangles[10]].mean(axis=0)
    _, first = objects.vertex_at(over_the_layout(), *(SIZE * place))
    objects.hold_layouts(True)
    objects.activate(edited)
    edited.session.cones.add(first.vertex)
    edited.session.cones.set_angle(math.radians(200))
    edited.follower.outdated = True
    until_all_idle(objects)
    after = UvMap(ball)
    triangle = after.triangles[40]
    held = objects.vertex_at(over_the_layout(), *(SIZE * before.uv[triangle].mean(axis=0)))
    assert held[1].vertex in before.vertex[triangle]
    objects.hold_layouts(False)
    now = objects.vertex_at(over_the_layout(), *(SIZE * after.uv[triangle].mean(axis=0)))
    assert now[1].vertex in after.vertex[triangle]
    assert np.abs(after.uv - before.uv).max() > 0.05
    objects.restore()
    objects.end()


def test_a_mesh_without_a_layout_is_not_picked_there():
    ball = add_ball()
    ball.data.uv_layers.remove(ball.data.uv_layers[0])
    objects = begin_together(ball, add_ball("Other"))
    assert objects.vertex_at(over_the_layout(), SIZE / 2, SIZE / 2) is None
    objects.end()
