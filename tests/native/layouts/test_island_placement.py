# SPDX-License-Identifier: GPL-3.0-or-later
"""Placement of finished islands: one similarity each onto the old coordinates, and the aspect of an image."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from map_checks import unwrap

PARTS = meshes.merge([meshes.cube(2), meshes.hill(6), meshes.flower(1)])


@cache
def unwrapped() -> lsgp.Result:
    return unwrap(PARTS)


@pytest.fixture
def parts() -> lsgp.Result:
    return unwrapped()


def similar(uv: np.ndarray, factor: complex, shift: complex) -> np.ndarray:
    moved = factor * (uv[..., 0] + 1j * uv[..., 1]) + shift
    return np.stack([moved.real, moved.imag], axis=-1)


def test_islands_already_in_place_do_not_move(parts: lsgp.Result) -> None:
    placed = lsgp.fit_placement(parts.corner_uv, parts.corner_uv, parts.island)
    assert np.abs(placed - parts.corner_uv).max() <= 1e-15


@given(
    turns=st.lists(st.floats(-np.pi, np.pi), min_size=3, max_size=3),
    sizes=st.lists(st.floats(0.01, 10.0), min_size=3, max_size=3),
    shifts=st.lists(st.complex_numbers(max_magnitude=2.0), min_size=3, max_size=3),
)
def test_a_similarity_of_each_island_is_recovered(turns, sizes, shifts) -> None:
    parts = unwrapped()
    old = parts.corner_uv.copy()
    for i in range(3):
        old[parts.island == i] = similar(old[parts.island == i], sizes[i] * np.exp(1j * turns[i]), shifts[i])
    placed = lsgp.fit_placement(parts.corner_uv, old, parts.island)
    assert np.abs(placed - old).max() <= 1e-12 * max(1.0, *sizes)


def ratios(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The complex factor of every triangle edge: turn and scale."""
    edges = [np.roll(uv, 1, axis=1) - uv for uv in (before, after)]
    before, after = (edge[..., 0] + 1j * edge[..., 1] for edge in edges)
    return after / before


def test_whatever_the_old_coordinates_an_island_moves_by_one_similarity(parts: lsgp.Result) -> None:
    old = np.random.default_rng(5).normal(size=parts.corner_uv.shape)
    placed = lsgp.fit_placement(parts.corner_uv, old, parts.island)
    for i in range(3):
        factors = ratios(parts.corner_uv[parts.island == i], placed[parts.island == i])
        assert np.abs(factors - factors[0, 0]).max() <= 1e-9 * abs(factors[0, 0])
    surface = lsgp.Surface(PARTS.positions, PARTS.triangles)
    seams = lsgp.measure_distortion(surface, placed, parts.cones).seams
    assert seams.sister_ratio_max - 1 <= 1e-9
    assert seams.rotation_residual <= 1e-9


def test_no_turn_fits_better(parts: lsgp.Result) -> None:
    """Also where the old island has another shape; the middle and the mean size are exactly the old ones."""
    old = similar(parts.corner_uv, 0.7 * np.exp(0.8j), 0.3 - 0.1j)
    old = old * [1.0, 0.6] + 0.02 * np.sin(9 * old[..., ::-1])
    placed = lsgp.fit_placement(parts.corner_uv, old, parts.island)
    for i in range(3):
        here, there = placed[parts.island == i].reshape(-1, 2), old[parts.island == i].reshape(-1, 2)
        middle = there.mean(axis=0)
        assert here.mean(axis=0) == pytest.approx(middle, abs=1e-12)
        here, there = here - middle, there - middle
        assert (here**2).sum() == pytest.approx((there**2).sum(), rel=1e-12)
        miss = ((here - there) ** 2).sum()
        for turn in (-0.1, -0.001, 0.001, 0.1):
            assert ((similar(here, np.exp(1j * turn), 0) - there) ** 2).sum() > miss


@pytest.mark.parametrize("square", [False, True])
def test_mirrored_islands_are_not_mirrored_and_keep_their_size(square: bool) -> None:
    """A mirrored square fits no turn better than another, and in least squares no size above zero."""
    mesh = meshes.grid(4, 4) if square else meshes.hill(6)
    result = unwrap(mesh)
    mirrored = result.corner_uv * [-1.0, 1.0] + [3.0, 0.0]
    placed = lsgp.fit_placement(result.corner_uv, mirrored, result.island)
    assert np.abs(np.abs(ratios(result.corner_uv, placed)) - 1).max() <= 1e-9
    a, b = placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all()
    assert placed.reshape(-1, 2).mean(axis=0) == pytest.approx(mirrored.reshape(-1, 2).mean(axis=0), abs=1e-12)


@pytest.mark.parametrize("value", [0.0, 0.25, np.nan, np.inf])
def test_islands_without_usable_old_coordinates_stay(parts: lsgp.Result, value: float) -> None:
    old = similar(parts.corner_uv, 2j, 1)
    second = parts.island == 1
    if np.isfinite(value):
        # Blender stores single precision: the corners of one point may differ in the last digit.
        old[second] = value + 1e-8 * np.random.default_rng(2).random((int(second.sum()), 3, 2))
        old[second] = old[second].astype(np.float32) if value else 0.0
    else:
        old[np.flatnonzero(second)[2], 1, 0] = value
    placed = lsgp.fit_placement(parts.corner_uv, old, parts.island)
    assert placed[second].tobytes() == parts.corner_uv[second].tobytes()
    assert np.abs(placed[~second] - old[~second]).max() <= 1e-12


def test_unsolved_triangles_stay_unsolved(parts: lsgp.Result) -> None:
    uv, island = parts.corner_uv.copy(), parts.island.copy()
    uv[island == 0], island[island == 0] = np.nan, -1
    placed = lsgp.fit_placement(uv, similar(parts.corner_uv, 0.5, 0), island)
    assert np.isnan(placed[island == -1]).all()
    assert np.abs(placed[island >= 0] - similar(parts.corner_uv, 0.5, 0)[island >= 0]).max() <= 1e-12
    nothing = lsgp.fit_placement(np.empty((0, 3, 2)), np.empty((0, 3, 2)), np.empty(0, np.int32))
    assert nothing.shape == (0, 3, 2)


def test_the_arguments_are_not_changed(parts: lsgp.Result) -> None:
    uv, old = parts.corner_uv.copy(), similar(parts.corner_uv, 2j, 1)
    kept = old.copy()
    lsgp.fit_placement(uv, old, parts.island)
    assert uv.tobytes() == parts.corner_uv.tobytes() and old.tobytes() == kept.tobytes()


def test_shapes_that_do_not_belong_together_are_refused(parts: lsgp.Result) -> None:
    with pytest.raises(lsgp.InputError, match="old_uv") as refused:
        lsgp.fit_placement(parts.corner_uv, parts.corner_uv[1:], parts.island)
    assert refused.value.code == "WRONG_SHAPE"


@pytest.mark.parametrize("aspect", [0.25, 1.0, 2.0])
def test_aspect_makes_lengths_equal_on_the_image(aspect: float) -> None:
    uv = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    corrected = lsgp.correct_aspect(uv, aspect)
    width, height = np.ptp(corrected, axis=0)
    assert width * aspect == pytest.approx(height, rel=1e-15)
    assert corrected.min() == 0.0 and corrected.max() == 1.0


@pytest.mark.parametrize("aspect", [0.0, -1.0, np.nan, np.inf])
def test_an_impossible_aspect_is_refused(aspect: float) -> None:
    with pytest.raises(lsgp.InputError, match="aspect"):
        lsgp.correct_aspect(np.zeros((1, 3, 2)), aspect)
