# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours of the preferences for what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .content import Cone

if TYPE_CHECKING:
    from ..preferences import ConeUnwrapPreferences

FloatArray = NDArray[np.float32]

# Radians of curvature.
FULL = np.pi / 2


def repeated(colour: Sequence[float], count: int) -> FloatArray:
    """(count, 4) of one colour."""
    return np.tile(np.array(colour, np.float32), (count, 1))


def of_cones(cones: Sequence[Cone], look: ConeUnwrapPreferences) -> FloatArray:
    """(k, 4) by their curvature: between the colours of flat and of tips or saddles, whose it is from FULL on."""
    return np.array([_of_cone(cone.curvature, look) for cone in cones], np.float32).reshape(-1, 4)


def _of_cone(curvature: float | None, look: ConeUnwrapPreferences) -> FloatArray:
    if curvature is None:
        return np.array(look.automatic, np.float32)
    share = min(abs(curvature) / FULL, 1.0)
    return share * np.array(look.tip if curvature > 0 else look.saddle) + (1 - share) * np.array(look.flat)


def of_paths(numbers: NDArray[np.int32], look: ConeUnwrapPreferences) -> FloatArray:
    """(s, 4) of the paths with these numbers: the colours in turn, every other time round as tints."""
    colours = np.array([colour[:] for colour in look.cut_colours()], np.float32)
    turn, place = np.divmod(numbers, len(colours))
    found = colours[place]
    tinted = turn % 2 == 1
    found[tinted, :3] = (found[tinted, :3] + 1) / 2
    return found
