# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed islands that stand upright where that takes no room."""

import math
from pathlib import Path

import lsgp
import numpy as np
import pytest
from packing_checks import border, least_gap

MODEL = Path(__file__).resolve().parents[3] / "examples" / "model.obj"
MARGIN = 0.01
UP = (0.0, 1.0, 0.0)


def rectangle(left, bottom, right, top):
    """Two triangles."""
    a, b, c, d = (left, bottom), (right, bottom), (right, top), (left, top)
    return np.array([[a, b, c], [a, c, d]])


def test_rectangles_are_turned_by_half_and_squares_by_quarters():
    uv = np.concatenate([rectangle(0.01, 0.01, 0.31, 0.91), rectangle(0.33, 0.01, 0.53, 0.21)])
    island = np.array([0, 0, 1, 1])
    for half, quarter in ((math.pi, math.pi / 2), (-math.pi + 0.2, -math.pi / 2 - 0.3)):
        turned = lsgp.stand_upright(uv, island, [half, quarter], margin=MARGIN, whole=False)
        boxes = [lsgp.lattice.island_boxes(one, island) for one in (uv, turned)]
        np.testing.assert_allclose(*boxes, atol=1e-12)
        # The first corner has come to the opposite side, and to the next one.
        np.testing.assert_allclose(turned[0, 0], (0.31, 0.91), atol=1e-12)
        corner = (0.53, 0.01) if quarter > 0 else (0.33, 0.21)
        np.testing.assert_allclose(turned[2, 0], corner, atol=1e-12)


def test_what_would_come_too_near_stays():
    # Turned by a quarter, the first one would lie across the second.
    uv = np.concatenate([rectangle(0.4, 0.05, 0.5, 0.95), rectangle(0.52, 0.4, 0.72, 0.6)])
    island = np.array([0, 0, 1, 1])
    kept = lsgp.stand_upright(uv, island, [math.pi / 2, 0.0], margin=MARGIN, whole=False)
    assert np.array_equal(kept, uv)
    # And so would a triangle that is turned by half, in whose bay another lies.
    corner = np.array([[[0.1, 0.1], [0.5, 0.1], [0.1, 0.5]], [[0.32, 0.34], [0.5, 0.5], [0.32, 0.5]]])
    assert np.array_equal(lsgp.stand_upright(corner, [0, 1], [math.pi, 0.0], margin=MARGIN, whole=False), corner)


@pytest.mark.parametrize("layers", ["a face twice", "turned over", "folded", "mirrored"])
def test_what_lies_on_itself_is_in_the_way_as_well(layers):
    """Its sides are those of several triangles on one side of them."""
    corner = np.array([[0.49, 0.7], [0.51, 0.7], [0.5, 0.72]])
    second = {"a face twice": corner, "turned over": corner[::-1], "folded": [corner[1], corner[0], [0.5, 0.74]]}
    small = np.array([corner, second[layers]]) if layers in second else corner[None, ::-1]
    uv = np.concatenate([rectangle(0.2, 0.3, 0.8, 0.5), small])
    island = np.array([0, 0, *np.ones(len(small), int)])
    kept = lsgp.stand_upright(uv, island, [math.pi / 2, 0.0], margin=MARGIN, whole=False)
    assert np.array_equal(kept, uv)
    # Where nothing is in the way it turns.
    uv[2:, :, 0] += 0.2
    turned = lsgp.stand_upright(uv, island, [math.pi / 2, 0.0], margin=MARGIN, whole=False)
    assert np.ptp(turned[:2, :, 1]) == pytest.approx(0.6) and np.array_equal(turned[2:], uv[2:])


def test_most_of_the_area_decides_how_the_whole_is_turned():
    uv = np.concatenate([rectangle(0.01, 0.01, 0.99, 0.6), rectangle(0.01, 0.62, 0.3, 0.99)])
    island = np.array([0, 0, 1, 1])
    turned = lsgp.stand_upright(uv, island, [math.pi / 2, 0.0], margin=MARGIN)
    np.testing.assert_allclose(turned[0, 0], (0.99, 0.01), atol=1e-12)
    assert (turned.min(), turned.max()) == pytest.approx((0.01, 0.99))
    assert np.array_equal(lsgp.stand_upright(uv, island, [0.0, 0.0], margin=MARGIN), uv)


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_layouts_lose_nothing_and_more_of_them_is_upright(preset):
    surface = lsgp.read_mesh_file(MODEL).surface()
    packed = {"preset": preset, "margin": MARGIN, "pack": "tight"}
    result = lsgp.auto_unwrap(surface, **packed)
    gained = []
    for up in (UP, (0.0, -1.0, 0.0)):
        upright = lsgp.auto_unwrap(surface, **packed, up=up)
        assert np.array_equal(result.island, upright.island)
        lengths = [np.linalg.norm(np.diff(one.corner_uv, axis=1), axis=2) for one in (result, upright)]
        np.testing.assert_allclose(*lengths, rtol=1e-9)
        assert upright.corner_uv.min() >= MARGIN - 1e-9
        assert upright.corner_uv.max() <= 1 - MARGIN + 1e-9
        triangle, corner = border(result.corner_uv, result.island)
        z = upright.corner_uv @ (1, 1j)
        segments = np.stack([z[triangle, corner], z[triangle, (corner + 1) % 3]], axis=1)
        assert least_gap(segments, upright.island[triangle], 3 * MARGIN) >= 2 * MARGIN - 1e-9
        gained.append(standing(surface, upright, up) - standing(surface, result, up))
    assert min(gained) >= 0
    # It cannot be upright both ways.
    assert max(gained) > 0.1


def standing(surface, result, up):
    """The mean of the cosine of the angle between v and the image of up, by area, over islands."""
    turns = lsgp.upright_turns(surface, result.corner_uv, result.island, up)
    first, second = np.moveaxis(result.corner_uv[:, 1:] - result.corner_uv[:, :1], 1, 0)
    area = np.bincount(result.island, abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]))
    return (area * np.cos(turns)).sum() / area.sum()


def test_directions_have_precedence():
    surface = lsgp.read_mesh_file(MODEL).surface()
    directed = lsgp.Surface(surface.positions, surface.triangles, directions=(1.0, 0.0, 0.0))
    plain = lsgp.auto_unwrap(directed, preset="bake")
    assert np.array_equal(plain.corner_uv, lsgp.auto_unwrap(directed, preset="bake", up=UP).corner_uv)
