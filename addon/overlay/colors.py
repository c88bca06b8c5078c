# SPDX-License-Identifier: GPL-3.0-or-later
"""Applies the colors of the preferences to what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .content import Cone, Content

if TYPE_CHECKING:
    from .look import OverlayLook

FloatArray = NDArray[np.float32]

# Radians of curvature.
FULL = np.pi / 2


def repeated(color: Sequence[float], count: int) -> FloatArray:
    """(count, 4), one color repeated."""
    return np.tile(np.array(color, np.float32), (count, 1))


def of_cones(cones: Sequence[Cone], look: OverlayLook) -> FloatArray:
    """(k, 4) by curvature: from the color of flat cones to that of tips or saddles, reached at FULL."""
    return np.array([_of_cone(cone.curvature, look) for cone in cones], np.float32).reshape(-1, 4)


def _of_cone(curvature: float | None, look: OverlayLook) -> FloatArray:
    if curvature is None:
        return np.array(look.automatic, np.float32)
    share = min(abs(curvature) / FULL, 1.0)
    return share * np.array(look.tip if curvature > 0 else look.saddle) + (1 - share) * np.array(look.flat)


def of_cuts(content: Content, rows: NDArray[np.bool_], look: OverlayLook, by: str) -> FloatArray:
    """Of these segments of cuts.  by: one of `settings.CUT_COLORS`."""
    numbers = content.cut_paths[rows]
    if by != "KIND" or not content.kinds:
        return of_paths(numbers, look)
    of_path = np.array([getattr(look, f"{kind}_cut")[:] for kind in content.kinds], np.float32)
    return of_path[numbers]


def of_paths(numbers: NDArray[np.int32], look: OverlayLook) -> FloatArray:
    """(s, 4) of the paths with these numbers: the colors in turn, lighter in every other round."""
    colors = np.array([color[:] for color in look.cut_colors()], np.float32)
    turn, place = np.divmod(numbers, len(colors))
    found = colors[place]
    tinted = turn % 2 == 1
    found[tinted, :3] = (found[tinted, :3] + 1) / 2
    return found
