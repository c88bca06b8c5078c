# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates of about unit size: neither squares of them overflow nor lengths vanish."""

from __future__ import annotations

import math

import numpy as np

from .arguments import FloatArray


def unit_exponent(coordinates: FloatArray, least: float = 0.0) -> int:
    """The power of two by which to divide, as np.ldexp does, so that the largest finite one or `least` is about 1; no
    digit depends on it."""
    return math.frexp(max(float(np.abs(coordinates).max(initial=0.0, where=np.isfinite(coordinates))), least))[1]
