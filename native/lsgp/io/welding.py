# SPDX-License-Identifier: GPL-3.0-or-later
"""Merges vertices that a file repeats for each triangle or for display."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..base.places import first_at_place


def weld(positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The places (k, 3), each once, in the order of their first vertex, and the one of each vertex, (n,)."""
    first, index = np.unique(first_at_place(positions), return_inverse=True)
    return positions[first] + 0.0, index  # -0 is 0
