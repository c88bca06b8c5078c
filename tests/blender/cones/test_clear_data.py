# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear Cone Data: removes all data of the add-on from a mesh, and nothing else."""

import bpy
import pytest
from installed import addon
from scenes import add_ball, add_cube, changed, corners, edit, mark, snapshot, uv_key

saved_reports = addon.mesh.reports


def everything_of_ours(obj):
    """Cones with angles, cut costs, marked edges, a map, its distortion and a preview."""
    bpy.ops.mesh.cone_place()
    obj.vertex_groups.new(name="uv_seam_cost").add([1, 2], 1.0, "REPLACE")
    obj.data.attributes.new("uv_cone_feature", "BOOLEAN", "EDGE").data[0].value = True
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.uv.cone_measure() == {"FINISHED"}
    assert bpy.ops.mesh.cone_preview(gains=True) == {"FINISHED"}
    assert {attribute.name for attribute in obj.data.attributes if attribute.name.startswith("uv_cone_")} == {
        *["uv_cone_angle", "uv_cone_angle_kind", "uv_cone_log_scale", "uv_cone_gain", "uv_cone_feature"],
        *["uv_cone_distortion_conformal", "uv_cone_distortion_area", "uv_cone_distortion_stretch"],
    }


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_all_of_it_is_removed_and_the_uv_map_stays(in_edit_mode):
    ball = add_ball()
    ball.vertex_groups.clear()
    ball.vertex_groups.new(name="Arm").add([0, 5], 0.5, "REPLACE")
    before = snapshot(ball)
    everything_of_ours(ball)
    if in_edit_mode:
        edit(ball)
    assert bpy.ops.mesh.cone_clear_data() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    differences = {name for name in changed(before, snapshot(ball)) if "select" not in name}
    assert differences <= {uv_key(), "active group"}
    assert not ball.data.cone_unwrap_report and not ball.data.cone_unwrap_measured
    assert saved_reports.current(ball.data) is None


def test_what_has_no_data_is_left_alone_and_told(reports):
    cube = add_cube()
    before = snapshot(cube)
    reports()
    assert bpy.ops.mesh.cone_clear_data() == {"CANCELLED"}
    assert "nothing to clear" in reports()
    assert changed(before, snapshot(cube)) == set()


def test_the_group_that_is_named_is_removed():
    cube = add_cube()
    mark(cube, corners(cube), group="points")
    mark(cube, corners(cube))
    assert bpy.ops.mesh.cone_clear_data(vertex_group="points") == {"FINISHED"}
    assert [group.name for group in cube.vertex_groups] == ["uv_cones"]
