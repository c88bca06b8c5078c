# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands turned, aligned and joined."""

import math
from dataclasses import replace
from pathlib import Path

import lsgp
import numpy as np
import pytest

MODEL = Path(__file__).resolve().parents[3] / "examples" / "model.obj"


@pytest.fixture(scope="module")
def duck():
    surface = lsgp.read_mesh_file(MODEL).surface()
    several_islands = replace(lsgp.preset_weights("bake"), islands=0.0)
    return surface, lsgp.auto_unwrap(surface, preset="bake", weights=several_islands)


def test_upright_islands_have_up_along_v_on_the_average(duck):
    surface, result = duck
    up = np.array([0.0, 1.0, 0.0])
    turns = lsgp.upright_turns(surface, result.corner_uv, result.island, up)
    turned = lsgp.turn_islands(result.corner_uv, result.island, turns)
    assert abs(lsgp.upright_turns(surface, turned, result.island, up)).max() < 1e-9
    # The same by solving for the image of the projected direction in each triangle.
    sums = np.zeros(result.island.max() + 1, complex)
    for corners, uv, island in zip(surface.positions[surface.triangles], turned, result.island, strict=True):
        sides = np.diff(corners, axis=0).T
        weights = np.linalg.lstsq(sides, up, rcond=None)[0]
        along = np.diff(uv, axis=0).T @ weights
        if along.any():
            area = np.linalg.norm(np.cross(*sides.T))
            sums[island] += area * np.linalg.norm(sides @ weights) * complex(*along) / np.linalg.norm(along)
    np.testing.assert_allclose(np.angle(sums), math.pi / 2, atol=1e-9)


def test_turns_are_about_the_middle_and_quarters_exact(duck):
    surface, result = duck
    count = result.island.max() + 1
    boxes = lsgp.lattice.island_boxes(result.corner_uv, result.island)
    for quarters in range(4):
        turned = lsgp.turn_islands(result.corner_uv, result.island, np.full(count, quarters * math.pi / 2))
        after = lsgp.lattice.island_boxes(turned, result.island)
        np.testing.assert_allclose(after[:, :2] + after[:, 2:], boxes[:, :2] + boxes[:, 2:], atol=1e-12)
        sides = (boxes[:, 2:] - boxes[:, :2])[:, :: 1 if quarters % 2 == 0 else -1]
        np.testing.assert_allclose(after[:, 2:] - after[:, :2], sides, atol=1e-12)
    seams = lsgp.measure_distortion(surface, turned).seams
    assert seams.sister_ratio_max - 1 < 1e-9


def test_table_top_is_upright_by_z_and_a_sphere_not_at_all():
    square = lsgp.Surface([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], [[0, 2, 1], [0, 3, 2]])
    uv = square.positions[square.triangles][:, :, [2, 0]]
    (turn,) = lsgp.upright_turns(square, uv, [0, 0], (0, 1, 0))
    turned = lsgp.turn_islands(uv, [0, 0], [turn])
    np.testing.assert_allclose(np.ptp(turned.reshape(-1, 2), axis=0), 1)
    where = dict(zip(square.triangles.ravel().tolist(), turned.reshape(-1, 2), strict=True))
    np.testing.assert_allclose(where[3] - where[0], (0, 1), atol=1e-12)


@pytest.mark.parametrize("side", ["left", "right", "bottom", "top", "center", "middle"])
def test_sides_of_boxes_are_on_one_line(side):
    boxes = np.array([[0, 0, 1, 2], [3, 1, 5, 2], [-2, 4, -1, 5.0]])
    moved = boxes + np.tile(lsgp.align_islands(boxes, side), 2)
    values = {
        "left": moved[:, 0],
        "right": moved[:, 2],
        "bottom": moved[:, 1],
        "top": moved[:, 3],
        "center": moved[:, 0] + moved[:, 2],
        "middle": moved[:, 1] + moved[:, 3],
    }[side]
    assert np.ptp(values) == 0
    axis = 0 if side in ("left", "right", "center") else 1
    assert np.array_equal(moved[:, 1 - axis], boxes[:, 1 - axis])
    low, high = boxes[:, axis].min(), boxes[:, 2 + axis].max()
    assert moved[:, axis].min() >= low
    assert moved[:, 2 + axis].max() <= high
    fixed = np.array([False, True, False])
    assert not lsgp.align_islands(boxes, side, fixed=fixed)[1].any()
    held = boxes + np.tile(lsgp.align_islands(boxes, side, fixed=fixed), 2)
    assert held[0].tolist() != boxes[0].tolist() or held[2].tolist() != boxes[2].tolist()


def test_exact_islands_are_joined_without_any_change_of_shape(duck):
    surface, result = duck
    stitched = lsgp.stitch_islands(surface, result.corner_uv, result.island, result.cut_edges)
    assert stitched.joined == result.island.max()
    assert stitched.inexact == 0
    before = lsgp.measure_distortion(surface, result.corner_uv)
    after = lsgp.measure_distortion(surface, stitched.corner_uv)
    assert after.island.max() == 0
    assert after.distortion.l2_stretch == pytest.approx(before.distortion.l2_stretch, abs=1e-9)
    assert after.seams.sister_ratio_max - 1 < 1e-9
    lengths = [np.linalg.norm(np.diff(uv, axis=1), axis=2) for uv in (result.corner_uv, stitched.corner_uv)]
    np.testing.assert_allclose(*lengths, atol=1e-12)
    # What is cut within one island stays cut.
    assert stitched.within.sum() == len(after.cut_edges)


def test_fixed_islands_stay(duck):
    surface, result = duck
    smallest = int(np.bincount(result.island).argmin())
    stitched = lsgp.stitch_islands(surface, result.corner_uv, result.island, result.cut_edges, fixed=[smallest])
    assert not stitched.moved[result.island == smallest].any()
    every = np.arange(result.island.max() + 1)
    held = lsgp.stitch_islands(surface, result.corner_uv, result.island, result.cut_edges, fixed=every)
    assert (held.joined, held.moved.any()) == (0, False)
    assert held.pinned.any()


def test_the_island_with_less_area_is_joined_to_the_other_whatever_their_triangles():
    """A square of two triangles beside one of half its area with four."""
    places = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1.5, 0, 0], [1.5, 1, 0], [1.25, 0.5, 0]]
    flat = lsgp.Surface(places, [[0, 1, 2], [0, 2, 3], [1, 4, 6], [4, 5, 6], [5, 2, 6], [2, 1, 6]])
    uv = flat.positions[flat.triangles][:, :, :2]
    island = np.array([0, 0, 1, 1, 1, 1])
    apart = uv + np.where(island == 1, 3.0, 0.0)[:, None, None]
    stitched = lsgp.stitch_islands(flat, apart, island, [[1, 2]])
    assert stitched.moved.tolist() == (island == 1).tolist()
    np.testing.assert_allclose(stitched.corner_uv, uv, atol=1e-12)
    fixed = lsgp.stitch_islands(flat, apart, island, [[1, 2]], fixed=[1])
    assert fixed.moved.tolist() == (island == 0).tolist()


def test_islands_that_do_not_match_are_scaled_and_put_together():
    flat = lsgp.Surface(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]
    )
    uv = flat.positions[flat.triangles][:, :, :2]
    apart = np.concatenate([uv[:2], 0.5 * uv[2:] @ [[0, 1], [-1, 0]] + 7])
    stitched = lsgp.stitch_islands(flat, apart, [0, 0, 1, 1], [[1, 2]])
    assert (stitched.joined, stitched.inexact) == (1, 1)
    np.testing.assert_allclose(stitched.corner_uv, uv, atol=1e-12)
    assert lsgp.measure_distortion(flat, stitched.corner_uv).island.max() == 0
    nothing = lsgp.stitch_islands(flat, apart, [0, 0, 1, 1], [[0, 1], [0, 2]])
    assert (nothing.joined, nothing.moved.any(), nothing.within.any()) == (0, False, False)
