# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of polygons of any size, in linear memory and nearly linear time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp


def clip_ears(points: NDArray[np.float64], is_taken: Callable[[int, int], bool] | None = None) -> NDArray[np.int64]:
    """Triangles (k, n - 2, 3), local corners, of k counter-clockwise polygons (k, n, 2) of the size of 1.

    is_taken: whether a diagonal between two corners is to be avoided.
    The ear with the shortest diagonal is tried first, thin ones and those with a diagonal that is to be avoided after
    the others, those of which two corners coincide last, and put aside if another corner lies in it. Where ears run
    out, corners close to the diagonal are allowed, then corners inside, then the rest becomes a fan. After an ear the
    test is strict again. A polygon that crosses itself all over, so that tests take too long, is cut without them.
    Polygons may run to other loops and back along one edge, whose ends they then have twice.
    """
    return _lsgp.clip_ears(points, is_taken)
