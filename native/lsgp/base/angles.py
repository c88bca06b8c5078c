# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles that are rounded alike wherever the C library is the same."""

from __future__ import annotations

import math

import numpy as np

from .arguments import FloatArray

_arctan2 = np.frompyfunc(math.atan2, 2, 1)


def arctan2(y: FloatArray, x: FloatArray) -> FloatArray:
    """As that of numpy, which has several implementations and takes the one for the processor's instructions."""
    return np.asarray(_arctan2(y, x), np.float64)
