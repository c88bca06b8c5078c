# SPDX-License-Identifier: GPL-3.0-or-later
"""What marked seams mean in the three modes, and borders that run straight."""

import math

import bpy
import numpy as np
import pytest
from logged import refused
from scenes import (
    ANGLES,
    UV_ROUNDING,
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_tube,
    changed,
    corners,
    edges_where,
    edit,
    mark,
    mark_seams,
    snapshot,
    uv_key,
)

MODES = ["FOLLOW", "BOUNDARY", "IGNORE"]
# Turns between straight borders, in the single precision of UVs over the shortest edge of these meshes.
STRAIGHT = 1e-5


def ring_of(obj):
    """The edges of a former cube about its waist, known by their number on the cube."""
    cube = add_cone_cube("Waist")
    ring = edges_where(cube, lambda place: abs(place[2]) < 1e-6)
    bpy.data.objects.remove(cube)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert len(ring) == 16
    return ring


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("mode", MODES)
def test_ring_seam_that_separates(mode, in_edit_mode):
    ball = add_ball()
    ring = ring_of(ball)
    mark_seams(ball, ring)
    if in_edit_mode:
        edit(ball)
    before = snapshot(ball)
    assert bpy.ops.uv.cone_unwrap(seams=mode) == {"FINISHED"}
    assert changed(before, snapshot(ball)) == {uv_key()}
    uv_map = UvMap(ball)
    if mode == "IGNORE":
        assert uv_map.islands() == 1
        assert not ring <= uv_map.split_edges()
        assert uv_map.sister_difference() <= UV_ROUNDING
    else:
        assert uv_map.islands() == 2
        assert ring <= uv_map.split_edges()
        inner = uv_map.sides.keys() - ring
        assert uv_map.sister_difference(inner) <= UV_ROUNDING
        # One transition relates both sides of a seam that is followed; a border has none.
        assert (uv_map.sister_difference(ring) <= UV_ROUNDING) == (mode == "FOLLOW")


def test_following_is_the_default():
    ball = add_ball()
    mark_seams(ball, ring_of(ball))
    bpy.ops.uv.cone_unwrap()
    default = UvMap(ball).uv.tobytes()
    bpy.ops.uv.cone_unwrap(seams="BOUNDARY")
    assert UvMap(ball).uv.tobytes() != default
    bpy.ops.uv.cone_unwrap(seams="FOLLOW")
    assert UvMap(ball).uv.tobytes() == default


def test_ignored_seams_give_the_map_without_seams():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    without = UvMap(ball).uv.tobytes()
    mark_seams(ball, ring_of(ball))
    bpy.ops.uv.cone_unwrap(seams="IGNORE")
    assert UvMap(ball).uv.tobytes() == without


@pytest.mark.parametrize("mode", MODES)
def test_every_mode_leaves_the_seams_marked(mode):
    ball = add_ball()
    ring = ring_of(ball)
    mark_seams(ball, ring)
    bpy.ops.uv.cone_unwrap(seams=mode)
    assert UvMap(ball).seams == ring


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("mode", MODES)
def test_seams_on_a_torus(mode, in_edit_mode):
    bpy.ops.mesh.primitive_torus_add(major_segments=16, minor_segments=8)
    torus = bpy.context.object
    around = edges_where(torus, lambda place: abs(place[1]) < 1e-6 and place[0] > 0)
    along = edges_where(torus, lambda place: abs(np.hypot(place[0], place[1]) - 1.25) < 1e-6)
    assert (len(around), len(along)) == (8, 16)
    mark_seams(torus, around | along)
    if in_edit_mode:
        edit(torus)
    assert bpy.ops.uv.cone_unwrap(seams=mode) == {"FINISHED"}
    uv_map = UvMap(torus)
    assert uv_map.islands() == 1
    if mode != "IGNORE":
        assert uv_map.split_edges() == around | along
    if mode != "BOUNDARY":
        assert uv_map.sister_difference() <= UV_ROUNDING


def test_two_rings_cut_a_torus_in_two():
    bpy.ops.mesh.primitive_torus_add(major_segments=16, minor_segments=8)
    torus = bpy.context.object
    rings = edges_where(torus, lambda place: abs(place[1]) < 1e-6)
    mark_seams(torus, rings)
    for mode, islands in (("FOLLOW", 2), ("BOUNDARY", 2), ("IGNORE", 1)):
        assert bpy.ops.uv.cone_unwrap(seams=mode, pack=False) == {"FINISHED"}
        uv_map = UvMap(torus)
        assert uv_map.islands() == islands
        assert (rings <= uv_map.split_edges()) == (mode != "IGNORE")


def test_closed_sphere_is_opened_along_its_seams_without_cones(reports):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8)
    sphere = bpy.context.object
    mark_seams(sphere, edges_where(sphere, lambda place: abs(place[2]) < 1e-6))
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    # Not a warning: it is what was asked for.
    assert "Info: Sphere: A component has seams but no cones" in reports()
    assert UvMap(sphere).islands() == 2
    with refused("TOO_FEW_CONES"):
        bpy.ops.uv.cone_unwrap(seams="IGNORE")


def test_placing_cones_knows_what_seams_mean():
    ball = add_ball()
    mark_seams(ball, ring_of(ball))
    found = {}
    for mode in MODES:
        assert bpy.ops.mesh.cone_place(seams=mode, keep=False, automatic=False, count=3) == {"FINISHED"}
        group = ball.vertex_groups["uv_cones"].index
        found[mode] = sum(any(g.group == group and g.weight > 0 for g in v.groups) for v in ball.data.vertices)
    assert found["BOUNDARY"] == 6 and found["IGNORE"] == 3


def quarter_turns(uv_map):
    directions = uv_map.border_directions()
    return (directions - directions[0]) / (math.pi / 2)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_straight_border_makes_a_grid_with_four_corner_cones_a_rectangle(in_edit_mode):
    grid = add_grid(segments=8)
    for vertex in grid.data.vertices:
        x, y, _ = vertex.co
        vertex.co.z = 0.8 * math.exp(-3 * ((x - 0.2) ** 2 + y**2)) + 0.05 * math.sin(5 * x + y)
    chosen = [v.index for v in grid.data.vertices if abs(abs(v.co.x) - 1) < 1e-6 and abs(abs(v.co.y) - 1) < 1e-6]
    mark(grid, chosen)
    angles = grid.data.attributes.new(ANGLES, "FLOAT", "POINT")
    for vertex in chosen:
        angles.data[vertex].value = math.pi / 2
    if in_edit_mode:
        edit(grid)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    turns = quarter_turns(UvMap(grid))
    assert np.abs(turns - np.round(turns)).max() > 1e-3
    assert bpy.ops.uv.cone_unwrap(border="STRAIGHT") == {"FINISHED"}
    uv_map = UvMap(grid)
    turns = quarter_turns(uv_map)
    assert np.abs(turns - np.round(turns)).max() < STRAIGHT
    assert sorted(set(np.round(turns).astype(int) % 4)) == [0, 1, 2, 3]
    for vertex in chosen:
        assert uv_map.angle_sum(vertex) == pytest.approx(math.pi / 2, abs=STRAIGHT)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_straight_border_makes_a_tube_a_strip(in_edit_mode):
    tube = add_tube()
    if in_edit_mode:
        edit(tube)
    assert bpy.ops.uv.cone_unwrap(border="STRAIGHT") == {"FINISHED"}
    uv_map = UvMap(tube)
    directions = uv_map.border_directions()
    assert len(directions) == 32
    assert np.abs(np.sin(directions - directions[0])).max() < STRAIGHT
    assert uv_map.islands() == 1
    assert uv_map.sister_difference() <= UV_ROUNDING


def test_strips_make_a_tube_a_straight_strip_without_any_mark():
    tube = add_tube(taper=0.0)
    assert bpy.ops.uv.cone_unwrap(border="STRIPS") == {"FINISHED"}
    uv_map = UvMap(tube)
    directions = uv_map.border_directions()
    assert len(directions) == 32
    assert np.abs(np.sin(directions - directions[0])).max() < STRAIGHT
    assert uv_map.islands() == 1
    # Around is as long as sixteen sides of a circle of radius 1, along is 2.
    upright = uv_map.uv @ (1, 1j) * np.exp(-1j * directions[0])
    sides = np.ptp(upright.real), np.ptp(upright.imag)
    assert sides[0] / sides[1] == pytest.approx(16 * 2 * math.sin(math.pi / 16) / 2, rel=1e-4)


def test_cube_corners_stay_where_seams_are_borders():
    cube = add_cone_cube()
    upper = edges_where(cube, lambda place: abs(place[2] - 1) < 1e-6 and max(abs(place[0]), abs(place[1])) > 1 - 1e-6)
    assert len(upper) == 16
    mark_seams(cube, upper)
    assert bpy.ops.uv.cone_unwrap(seams="BOUNDARY") == {"FINISHED"}
    uv_map = UvMap(cube)
    assert uv_map.islands() == 2
    top = [v for v in corners(cube) if cube.data.vertices[v].co.z > 0]
    assert [uv_map.angle_sum(v) for v in top] == pytest.approx([1.5 * math.pi] * 4, abs=1e-3)
