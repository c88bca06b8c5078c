# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair Flips, and cone angles that no map has: reported, shown, and corrected as far as possible."""

import bmesh
import bpy
import numpy as np
import pytest
from logged import logged, refused
from scenes import ANGLES, UV_ROUNDING, UvMap, add_ball, changed, edit, mark, selected, snapshot


def ball_with_angle(turns):
    """A ball with one more cone of so many whole turns, and the vertex that is."""
    ball = add_ball(cuts=4)
    toward = [v.co.normalized().dot((0.2, 1.0, -0.3)) for v in ball.data.vertices]
    cone = int(np.argmax(toward))
    mark(ball, [cone])
    ball.data.attributes.new(ANGLES, "FLOAT", "POINT").data[cone].value = turns * 2 * np.pi
    edit(ball)
    return ball, cone


def flipped_faces(obj):
    """Those with a triangle that is flipped by more than single precision may flip the tiny ones of a stretched map."""
    uv_map = UvMap(obj)
    z = uv_map.uv[uv_map.triangles] @ (1, 1j)
    sides = z[:, 1] - z[:, 0], z[:, 2] - z[:, 0]
    rounding = np.finfo(np.float32).eps * (np.abs(sides[0]) + np.abs(sides[1]))
    areas = (sides[0].conj() * sides[1]).imag
    return set(uv_map.face_of_triangle[areas < -rounding].tolist())


def test_flips_are_repaired_unless_they_are_to_stay():
    ball, cone = ball_with_angle(1.9)
    with logged() as codes:
        assert bpy.ops.uv.cone_unwrap(repair=False) == {"FINISHED"}
    assert "FLIPPED_TRIANGLES" in codes
    flipped = flipped_faces(ball)
    assert flipped
    bpy.ops.mesh.cone_select_reported()
    assert flipped <= {face.index for face in bmesh.from_edit_mesh(ball.data).faces if face.select}

    bpy.ops.mesh.select_all(action="SELECT")
    with logged() as codes:
        assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert "FLIPPED_TRIANGLES" not in codes
    assert flipped_faces(ball) == set()
    repaired = UvMap(ball)
    assert repaired.angle_sum(cone) == pytest.approx(1.9 * 2 * np.pi, abs=1e-3)
    assert repaired.sister_difference() <= UV_ROUNDING


def test_an_angle_that_the_faces_around_cannot_carry_is_refused_and_shown():
    ball, cone = ball_with_angle(4.0)
    before = snapshot(ball)
    with refused("CONE_ANGLE_RANGE", r"Ball: "):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(ball)) == set()
    bpy.ops.mesh.cone_select_reported()
    assert selected(ball) == [cone]


def test_an_angle_that_no_map_comes_to_is_approached_and_the_cones_shown():
    ball, cone = ball_with_angle(2.999)  # the six triangles around it carry less than three turns
    with logged() as codes:
        assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert "ANGLES_ADJUSTED" in codes
    assert flipped_faces(ball) == set()
    bpy.ops.mesh.cone_select_reported()
    assert cone in selected(ball)
