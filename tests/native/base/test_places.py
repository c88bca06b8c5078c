# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at the same place, and vertices that are linked."""

from __future__ import annotations

import numpy as np
import pytest
from lsgp.base import places
from lsgp.base.places import first_at_place, lowest_linked


def with_one_hash() -> np.ndarray:
    """Two different places, each twice, of which a hash does not tell that they differ."""
    x, y, _ = places._SPREAD
    here = np.array([1.0, 1.0, 1.0])
    bits = here.view(np.uint64) + np.array([y, 0, 0], np.uint64) - np.array([0, x, 0], np.uint64)
    there = bits.view(np.float64)
    assert np.isfinite(there).all() and (here != there).any()
    return np.array([here, there, here, there])


def test_the_first_vertex_at_a_place_stands_for_all() -> None:
    near = np.nextafter(1.0, 2.0)
    positions = np.array([[1, 0, 0], [near, 0, 0], [1, -0.0, 0], [0, 0, 0], [near, 0, 0], [1, 0, 0]])
    assert first_at_place(positions).tolist() == [0, 1, 0, 3, 1, 0]
    assert first_at_place(np.empty((0, 3))).tolist() == []


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_place_that_is_not_finite_has_one_vertex(value: float) -> None:
    positions = np.array([[value, 0, 0], [value, 0, 0], [0, 0, 0], [0, 0, 0]])
    assert first_at_place(positions).tolist() == [0, 1, 2, 2]


def test_places_with_one_hash_are_told_apart() -> None:
    assert first_at_place(with_one_hash()).tolist() == [0, 1, 0, 1]


def test_the_lowest_of_all_that_are_linked_is_found() -> None:
    chain = np.c_[np.arange(1, 100), np.arange(99)]
    assert lowest_linked(np.random.default_rng(0).permutation(chain), 100).tolist() == [0] * 100
    assert lowest_linked(np.array([[4, 2], [2, 5], [3, 1]]), 6).tolist() == [0, 1, 2, 1, 2, 2]
    assert lowest_linked(np.empty((0, 2), np.int32), 3).tolist() == [0, 1, 2]
