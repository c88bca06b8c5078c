# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones with their angles and where each angle comes from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import native

if TYPE_CHECKING:
    import lsgp


class Kind(IntEnum):
    """Where an angle comes from; the values are stored in files."""

    PRESCRIBED = 0
    """Set by the artist."""
    FOUND = 1
    """Computed by Place Cones or Spread the Rest for the cones of that moment."""
    SNAPPED = 2
    """Rounded to a turn of a pattern."""


@dataclass(frozen=True, slots=True)
class ConeAngles:
    """Cones (k,) int32, ascending; the angle of each in radians, None for automatic; and where it comes from."""

    cones: NDArray[np.int32]
    angles: list[float | None]
    kinds: list[Kind]

    @classmethod
    def none(cls) -> ConeAngles:
        return cls(np.empty(0, np.int32), [], [])

    def on(self, accepted: NDArray[np.bool_]) -> ConeAngles:
        """Those at accepted vertices.  accepted: (n,) bool."""
        rows = np.flatnonzero(accepted[self.cones])
        return ConeAngles(self.cones[rows], [self.angles[i] for i in rows], [self.kinds[i] for i in rows])

    @property
    def found(self) -> NDArray[np.bool_]:
        """(k,) bool, which angles were computed."""
        return np.array([kind == Kind.FOUND for kind in self.kinds], bool)

    def fixed(self) -> list[float | None]:
        """The angles that the artist chose; None for the others."""
        return [None if kind == Kind.FOUND else angle for angle, kind in zip(self.angles, self.kinds, strict=True)]

    def without_stale(self, surface: lsgp.Surface, options: lsgp.Options) -> ConeAngles:
        """With computed angles only where they still form a complete set; the others become automatic."""
        angles = native.lsgp.hold_complete(surface, self.cones, self.angles, self.found, options)
        return replace(self, angles=angles)
