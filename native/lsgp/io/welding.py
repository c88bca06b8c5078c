# SPDX-License-Identifier: GPL-3.0-or-later
"""Merges vertices that a file repeats for each triangle or for display."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def weld(positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The places (k, 3), each once, in the order of their first vertex, and the one of each vertex, (n,).

    Only vertices at exactly the same place are one; no distance can tell those from small features.
    """
    exact = positions + 0.0  # -0 is 0
    order = np.lexsort(exact.T[::-1])
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(exact[order], axis=0) != 0).any(axis=1)  # NaN is never one with another
    first = order[new]  # the sort is stable
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    index = np.empty(len(order), np.int64)
    index[order] = rank[np.cumsum(new) - 1]
    return exact[np.sort(first)], index
