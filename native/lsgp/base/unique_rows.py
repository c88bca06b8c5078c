# SPDX-License-Identifier: GPL-3.0-or-later
"""The different rows of an array."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class UniqueRows(NamedTuple):
    """rows: (k, c), the different ones in ascending order. first: (k,), where each occurs first. index: (n,), which of
    them each row of the array is. counts: (k,), how often each occurs."""

    rows: NDArray[Any]
    first: NDArray[np.intp]
    index: NDArray[np.intp]
    counts: NDArray[np.intp]


def unique_rows(array: NDArray[Any]) -> UniqueRows:
    """The different rows of an array (n, c), as of `numpy.unique(array, axis=0)`.

    That one compares records, and where Ctrl-C arrives meanwhile numpy raises a TypeError in place of
    KeyboardInterrupt (numpy 2.4).
    """
    order = np.lexsort(array.T[::-1])
    ascending = array[order]
    is_new = np.ones(len(array), bool)
    is_new[1:] = (ascending[1:] != ascending[:-1]).any(axis=1)
    index = np.empty(len(array), np.intp)
    index[order] = np.cumsum(is_new) - 1
    counts = np.diff(np.flatnonzero(is_new), append=len(array))
    return UniqueRows(ascending[is_new], order[is_new], index, counts)
