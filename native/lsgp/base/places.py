# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices at the same place, and vertices that are linked."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .arguments import FloatArray, IndexArray

# Odd factors that spread the bits of coordinates over a hash.
_SPREAD = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def first_at_place(positions: FloatArray) -> IndexArray:
    """(n,) the first vertex at exactly the same place as each; no distance can tell those from small features.

    positions: (n, 3). A place that is not finite has one vertex only.
    """
    with np.errstate(invalid="ignore"):  # a NaN of any kind
        exact = np.ascontiguousarray(positions + 0.0)  # -0 is 0
    mixed = (exact.view(np.uint64) * _SPREAD).sum(axis=1, dtype=np.uint64)
    _, index, inverse = np.unique(mixed, return_index=True, return_inverse=True)
    first = index[inverse].astype(np.int32)
    is_finite = np.isfinite(exact).all(axis=1)
    first[~is_finite] = np.flatnonzero(~is_finite)
    # Different places with one hash, of which there are hardly ever any: their order tells which are the same.
    others = np.flatnonzero(is_finite & (exact != exact[first]).any(axis=1))
    order = others[np.lexsort(exact[others].T)]
    new = np.ones(len(order), bool)
    new[1:] = (exact[order[1:]] != exact[order[:-1]]).any(axis=1)
    first[order] = order[new][np.cumsum(new) - 1]  # the sort is stable
    return first


def lowest_linked(pairs: NDArray[np.integer], count: int) -> IndexArray:
    """(n,) the lowest vertex among all that are linked with each by pairs, (p, 2)."""
    lowest = np.arange(count, dtype=np.int32)
    while True:
        lower = lowest.copy()
        ends = lowest[pairs]
        np.minimum.at(lower, ends, ends.min(axis=1, keepdims=True))
        lower = lower[lower]
        if np.array_equal(lower, lowest):
            return lowest
        lowest = lower
