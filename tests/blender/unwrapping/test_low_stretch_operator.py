# SPDX-License-Identifier: GPL-3.0-or-later
"""Low Stretch: less stretch with cuts as exact as before, and least where the artist says that it matters."""

import bpy
import numpy as np
import pytest
from scenes import UV_ROUNDING, UvMap, add_ball, changed, edit, mark, snapshot, uv_key

IMPORTANCE = "uv_importance"


@pytest.fixture
def suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    bpy.ops.mesh.cone_place(cuts="SHORTEST")
    return obj


def unwrap(obj, **options):
    assert bpy.ops.uv.cone_unwrap(pack=False, **options) == {"FINISHED"}
    return UvMap(obj)


@pytest.mark.one_blender
def test_suzanne_is_stretched_less_and_cuts_stay_exact(suzanne):
    conformal = unwrap(suzanne, overlaps="KEEP")
    before = snapshot(suzanne)
    low = unwrap(suzanne, mode="LOW_STRETCH", overlaps="KEEP")
    assert changed(before, snapshot(suzanne)) == {uv_key()}
    assert low.l2_stretch() < conformal.l2_stretch() - 0.005
    assert low.split_edges() == conformal.split_edges()
    assert low.sister_difference() <= UV_ROUNDING
    assert low.islands() == 3


@pytest.mark.slow
@pytest.mark.one_blender
def test_the_slider_leads_from_the_conformal_map_to_the_least_stretch(suzanne):
    conformal = unwrap(suzanne, overlaps="KEEP").l2_stretch()
    low = {"mode": "LOW_STRETCH", "overlaps": "KEEP"}
    stretches = [unwrap(suzanne, stretch=s, **low).l2_stretch() for s in (0.0, 0.3, 0.7, 1.0)]
    assert stretches == sorted(stretches, reverse=True)
    assert stretches[0] == pytest.approx(conformal, abs=1e-3)
    assert stretches[-1] < stretches[0] - 0.005


@pytest.mark.slow
@pytest.mark.one_blender
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_stretch_is_lowest_where_importance_is_high(suzanne, in_edit_mode):
    left = {v.index for v in suzanne.data.vertices if v.co.x < 0}
    face = [polygon.index for polygon in suzanne.data.polygons if set(polygon.vertices) <= left]
    mark(suzanne, left, IMPORTANCE)
    if in_edit_mode:
        edit(suzanne)
    rest = set(range(len(suzanne.data.polygons))) - set(face)
    even = unwrap(suzanne, mode="LOW_STRETCH")
    weighted = unwrap(suzanne, mode="LOW_STRETCH", use_weights=True, weight_factor=20.0)
    assert weighted.l2_stretch(face) < even.l2_stretch(face) - 0.002
    assert weighted.l2_stretch(rest) > even.l2_stretch(rest)
    assert weighted.sister_difference() <= UV_ROUNDING


@pytest.mark.parametrize(
    "options",
    [
        {"weight_factor": 0.0},
        {"weight_group": "no such group"},
        {"weight_group": ""},
        {"use_weights": False},
        {"mode": "CONFORMAL"},
    ],
    ids=str,
)
def test_importance_has_no_say_where_it_is_not_asked_for(options):
    ball = add_ball()
    mark(ball, range(20), IMPORTANCE)
    plain = unwrap(ball, mode=options.get("mode", "LOW_STRETCH")).uv
    asked = unwrap(ball, **{"mode": "LOW_STRETCH", "use_weights": True, **options}).uv
    assert np.array_equal(asked, plain)


def test_low_stretch_is_seamless_where_asked():
    ball = add_ball()
    conformal = unwrap(ball, seamless=True, tile_fit="TILES", tiles=64.0)
    low = unwrap(ball, seamless=True, tile_fit="TILES", tiles=64.0, mode="LOW_STRETCH")
    assert low.tile_error() == 0
    assert low.l2_stretch() < conformal.l2_stretch()
