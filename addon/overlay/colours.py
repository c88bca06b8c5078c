# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours of the preferences for what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .content import FLAT_CONE, SADDLE, TIP, UNKNOWN, Cone

if TYPE_CHECKING:
    from ..preferences import ConeUnwrapPreferences

FloatArray = NDArray[np.float32]


def repeated(colour: Sequence[float], count: int) -> FloatArray:
    """(count, 4) of one colour."""
    return np.tile(np.array(colour, np.float32), (count, 1))


def of_cones(cones: Sequence[Cone], look: ConeUnwrapPreferences) -> FloatArray:
    """(k, 4) by the sign of their curvature."""
    by_kind = {TIP: look.tip, SADDLE: look.saddle, FLAT_CONE: look.flat, UNKNOWN: look.automatic}
    return np.array([by_kind[cone.kind][:] for cone in cones], np.float32).reshape(-1, 4)


def of_paths(numbers: NDArray[np.int32], look: ConeUnwrapPreferences) -> FloatArray:
    """(s, 4) of the paths with these numbers: the colours in turn, every other time round as tints."""
    colours = np.array([colour[:] for colour in look.cut_colours()], np.float32)
    turn, place = np.divmod(numbers, len(colours))
    found = colours[place]
    tinted = turn % 2 == 1
    found[tinted, :3] = (found[tinted, :3] + 1) / 2
    return found
