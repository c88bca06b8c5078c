# SPDX-License-Identifier: GPL-3.0-or-later
"""`pad_mip_levels`: lookups match across cuts at levels for which the gutters of the image are too narrow."""

from __future__ import annotations

import itertools

import lsgp
import meshes
import numpy as np
import pytest
from gutter_checks import bake, both_sides, difference_across_cuts, inset, lookup, unwrapped
from map_checks import surface

SIZE = 256
NARROW = [2.0] * 4
WHOLE, UV = unwrapped(meshes.bumpy_sphere(2))
UV = inset(UV, 8 / SIZE)
IMAGE, COVERED = bake(WHOLE, UV, SIZE)


def across(level: np.ndarray, step: float = 1 / SIZE) -> float:
    left, right, _ = both_sides(WHOLE, UV, step)
    return float(np.abs(lookup(level, left) - lookup(level, right)).mean())


def test_narrow_gutters_suffice_at_all_levels() -> None:
    levels = lsgp.pad_mip_levels(IMAGE, WHOLE, UV, NARROW)
    boxes = difference_across_cuts(WHOLE, UV, levels[0], 4)
    ours = [across(level) for level in levels]
    assert ours[0] == pytest.approx(boxes[0])
    assert ours[2] < boxes[2] / 4 and ours[3] < boxes[3] / 4


def test_each_level_is_padded_from_the_means_of_the_last() -> None:
    levels = lsgp.pad_mip_levels(IMAGE, WHOLE, UV, NARROW)
    assert [level.shape for level in levels] == [(SIZE >> k, SIZE >> k) for k in range(4)]
    for last, level in itertools.pairwise(levels):
        means = last.reshape(len(level), 2, len(level), 2).mean(axis=(1, 3))
        assert np.abs(level - lsgp.pad_image(means, WHOLE, UV, 2.0)).max() < 1e-12


@pytest.mark.parametrize(("height", "width"), [(7, 12), (5, 1), (13, 9)])
def test_odd_sizes_are_halved_by_area(height: int, width: int) -> None:
    # A triangle over the whole image: nothing is padded.
    whole = surface(meshes.make([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    image = np.random.default_rng(2).random((height, width))
    half = lsgp.pad_mip_levels(image, whole, [[[0, 0], [1e-6, 0], [0, 1e-6]]], [0.0, 0.0])[1]
    rows, columns = half.shape
    assert (rows, columns) == (height // 2, max(width // 2, 1))
    # By repeated texels: each is rows x columns of a grid in which both sizes are whole.
    fine = np.kron(image, np.ones((rows, columns)))
    assert np.abs(half - fine.reshape(rows, height, columns, width).mean(axis=(1, 3))).max() < 1e-12


def test_integers_are_rounded_only_in_the_end() -> None:
    levels = lsgp.pad_mip_levels(np.rint(IMAGE * 255).astype(np.uint8), WHOLE, UV, NARROW)
    exact = lsgp.pad_mip_levels(np.rint(IMAGE * 255), WHOLE, UV, NARROW)
    for k, (level, values) in enumerate(zip(levels, exact, strict=True)):
        assert level.dtype == np.uint8
        # The first level's gutters are rounded before they are averaged.
        assert np.abs(level - values).max() <= (0.5 if k == 0 else 1.0) + 1e-9


def test_normals_of_integers_are_turned_about_their_own_middle() -> None:
    # Near to the middle, so that turned normals stay in the range.
    normals = np.rint(255 * (0.35 + 0.3 * np.stack([IMAGE, 1 - IMAGE], axis=-1))).astype(np.uint8)
    ints = lsgp.pad_mip_levels(normals, WHOLE, UV, NARROW, normal_map=True)
    floats = lsgp.pad_mip_levels(normals / 255, WHOLE, UV, NARROW, normal_map=True)
    for one, other in zip(ints, floats, strict=True):
        assert np.abs(one / 255 - other).max() < 1.01 / 255


@pytest.mark.parametrize("margins", [[], [1.0] * 10])
def test_more_levels_than_the_image_has_are_refused(margins: list[float]) -> None:
    with pytest.raises(lsgp.InputError, match="mip levels are 9") as refusal:
        lsgp.pad_mip_levels(IMAGE, WHOLE, UV, margins)
    assert refusal.value.code == "WRONG_PARAMETER"
