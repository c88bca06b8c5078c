# SPDX-License-Identifier: GPL-3.0-or-later
"""Steer Cuts: weights at the selected vertices and nowhere else, and cuts that follow them."""

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, changed, edit, marked, select_elements, snapshot

GROUP = "uv_seam_cost"
cones, reader = addon.mesh.cones, addon.mesh.reader.reader


def weights(ball):
    return cones.weights_in(ball, GROUP, reader(ball.data), outside=0.5)


def test_only_the_selected_vertices_get_weights_and_lose_them_again():
    ball = add_ball()
    edit(ball, select="DESELECT")
    before = snapshot(ball)
    select_elements(ball, "verts", [3, 5, 8])
    assert bpy.ops.mesh.cone_steer_cuts(effect="AWAY") == {"FINISHED"}
    assert np.flatnonzero(weights(ball) == 1).tolist() == [3, 5, 8]
    assert bpy.ops.mesh.cone_steer_cuts(effect="AWAY") == {"CANCELLED"}
    select_elements(ball, "verts", [5])
    assert bpy.ops.mesh.cone_steer_cuts(effect="ATTRACT") == {"FINISHED"}
    assert (weights(ball)[[3, 5, 8]] == [1, 0, 1]).all() and (weights(ball) == 0.5).sum() == len(weights(ball)) - 3
    select_elements(ball, "verts", range(len(ball.data.vertices)))
    assert bpy.ops.mesh.cone_steer_cuts(effect="CLEAR") == {"FINISHED"}
    assert (weights(ball) == 0.5).all()
    assert "weights" not in {name for name in changed(before, snapshot(ball)) if name != "groups"}
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No vertex is selected"):
        bpy.ops.mesh.cone_steer_cuts(effect="AWAY")


def test_cuts_keep_away():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    inside = {vertex for edge in UvMap(ball).split_edges() for vertex in edge} - set(marked(ball))
    edit(ball, select="DESELECT")
    select_elements(ball, "verts", sorted(inside)[::2])
    bpy.ops.mesh.cone_steer_cuts(effect="AWAY")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    now = {vertex for edge in UvMap(ball).split_edges() for vertex in edge}
    assert len(now & set(sorted(inside)[::2])) < len(sorted(inside)[::2]) / 2
