# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that overlap themselves: reported, shown, and split if requested."""

import re

import bmesh
import bpy
import numpy as np
import pytest
from scenes import UV_ROUNDING, UvMap, add_ramp, changed, covered_twice, edit, pin, set_uv, snapshot, uv_key


def unwrap(obj, **options):
    assert bpy.ops.uv.cone_unwrap(**options) == {"FINISHED"}
    return UvMap(obj)


def test_overlaps_are_counted_and_shown(reports):
    ramp = add_ramp()
    edit(ramp)
    reports()
    uv_map = unwrap(ramp, overlaps="KEEP")
    said = reports()
    faces = uv_map.overlapping()
    assert uv_map.islands() == 1 and len(faces) > 60
    assert float(re.search(r"(\S+) % overlapping", said)[1]) == pytest.approx(100 * uv_map.overlap_area(), rel=0.03)
    triangles = int(re.search(r"(\d+) triangles overlap others", said)[1])
    assert "set Overlaps to Split" in said
    assert len(faces) <= triangles <= 2 * len(faces)
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    selected = {face.index for face in bmesh.from_edit_mesh(ramp.data).faces if face.select}
    assert selected == faces


def test_without_overlaps_nothing_is_said(reports):
    ramp = add_ramp(turns=0.8)
    reports()
    uv_map = unwrap(ramp)
    assert uv_map.overlapping() == set()
    assert "overlap" not in reports()


@pytest.mark.parametrize("mode", ["CONFORMAL", "LOW_STRETCH"])
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_split_islands_lie_neither_on_themselves_nor_on_others(in_edit_mode, mode, reports):
    ramp = add_ramp()
    if in_edit_mode:
        edit(ramp)
    before = snapshot(ramp)
    reports()
    uv_map = unwrap(ramp, overlaps="SPLIT", mode=mode)
    assert changed(before, snapshot(ramp)) == {uv_key()}
    assert uv_map.islands() > 1
    assert uv_map.overlapping() == set()
    assert uv_map.sister_difference() <= UV_ROUNDING
    assert uv_map.uv.min() >= 0.0 and uv_map.uv.max() <= 1.0
    said = reports()
    assert f"{uv_map.islands()} islands" in said
    assert "overlapping" not in said and "overlap others" not in said


def island_boxes(uv_map):
    islands = np.array(uv_map.island_of_face())
    boxes = []
    for island in sorted(set(islands)):
        loops = np.concatenate([uv_map.loops_of_face[face] for face in np.flatnonzero(islands == island)])
        boxes.append((uv_map.uv[loops].min(axis=0), uv_map.uv[loops].max(axis=0)))
    return boxes


def test_split_islands_are_packed_with_the_margin_asked_for():
    ramp = add_ramp()
    # So large a margin leaves less room for the islands.
    sizes = [
        max(np.ptp(np.array(box), axis=0).max() for box in island_boxes(unwrap(ramp, overlaps="SPLIT", **margin)))
        for margin in ({"margin": 0.0}, {"margin": 0.1})
    ]
    assert sizes[1] < 0.8 * sizes[0]


def test_split_islands_of_all_objects_are_packed_together_unless_they_are_not_to_be_packed():
    ramps = [add_ramp("First"), add_ramp("Second")]
    assert bpy.ops.uv.cone_unwrap(pack=False) == {"FINISHED"}
    alone = [UvMap(ramp) for ramp in ramps]
    assert np.array_equal(alone[0].uv, alone[1].uv)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    together = [UvMap(ramp) for ramp in ramps]
    assert covered_twice(alone) > 0
    assert covered_twice(together) == 0
    assert all(uv_map.uv.min() >= 0.0 and uv_map.uv.max() <= 1.0 for uv_map in together)


def test_split_islands_keep_their_place_as_asked():
    ramp = add_ramp()
    corners = np.array([tuple(ramp.data.vertices[loop.vertex_index].co) for loop in ramp.data.loops])
    # Far from the unit square: height and radius, which flattens the ramp without overlaps.
    set_uv(ramp, np.stack([corners[:, 2] + 5, np.hypot(corners[:, 0], corners[:, 1])], axis=1))
    kept = unwrap(ramp, overlaps="SPLIT", keep_placement=True)
    assert kept.islands() > 1
    assert kept.uv[:, 0].min() > 4
    packed = unwrap(ramp, overlaps="SPLIT")
    assert packed.uv.max() <= 1.0


@pytest.mark.parametrize("pack", [False, True])
def test_seamless_islands_are_split_and_stay_on_their_tiles(pack):
    ramp = add_ramp()
    uv_map = unwrap(ramp, overlaps="SPLIT", seamless=True, tile_fit="TILES", tiles=12.0, pack=pack)
    assert uv_map.islands() > 1
    assert uv_map.overlapping() == set()
    assert uv_map.tile_error() == 0
    # Not scaled into the unit square, as Blender's packer would.
    assert np.ptp(uv_map.uv, axis=0).max() > 6


def test_pinned_islands_stay_whole_and_what_overlaps_is_told(reports):
    ramp = add_ramp()
    uv = unwrap(ramp, overlaps="KEEP").uv
    loops = [0, len(uv) - 1]
    pin(ramp, loops, uv[loops])
    reports()
    uv_map = unwrap(ramp, overlaps="SPLIT")
    assert uv_map.islands() == 1
    assert np.array_equal(uv_map.uv[loops], uv[loops])
    assert "overlap others" in reports()
