# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles of cones before unwrapping: whether they are possible, snapped to a pattern, computed from the rest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native

if TYPE_CHECKING:
    import lsgp

    from ...core.cone_angles import ConeAngles

# Codes of errors that changing other angles can still correct.
CORRECTABLE = {"GAUSS_BONNET", "TOO_FEW_CONES"}
# Radians; smaller differences are rounding.
SAME_ANGLE = 1e-6


@dataclass(frozen=True, slots=True)
class NewAngles:
    """Angles in radians by vertex, and the library's prescription that they are part of."""

    angles: dict[int, float]
    prescription: lsgp.Prescription

    def flat(self) -> int:
        """The number of prescribed cones with a full turn, which makes them ordinary vertices."""
        return int((np.abs(self.prescription.cone_angles - 2 * math.pi) < SAME_ANGLE).sum())


def snapped(surface: lsgp.Surface, cones: ConeAngles, options: lsgp.Options) -> NewAngles:
    """The angles that rounding to the turns of the options' lattice changes or adds.  Raises LsgpError."""
    fixed = cones.fixed()
    found = native.lsgp.prescribe_curvature(surface, cones.cones, fixed, options)
    before = {vertex: angle for vertex, angle in zip(cones.cones.tolist(), fixed, strict=True) if angle is not None}
    return NewAngles(
        {
            vertex: angle
            for vertex, angle in zip(found.cones.tolist(), found.cone_angles.tolist(), strict=True)
            if abs(angle - before.get(vertex, math.inf)) > SAME_ANGLE
        },
        found,
    )


def spread(
    surface: lsgp.Surface, cones: NDArray[np.int32], kept: list[float | None], options: lsgp.Options
) -> NewAngles:
    """The angles with the least distortion for the cones that are None in ``kept``.  Raises LsgpError."""
    found = native.lsgp.prescribe_curvature(surface, cones, kept, options)
    angle_at = dict(zip(found.cones.tolist(), found.cone_angles.tolist(), strict=True))
    free = [vertex for vertex, angle in zip(cones.tolist(), kept, strict=True) if angle is None]
    return NewAngles({vertex: angle_at[vertex] for vertex in free if vertex in angle_at}, found)


def missing_curvature(
    surface: lsgp.Surface,
    cones: NDArray[np.int32],
    angles: list[float | None],
    changed: NDArray[np.intp],
    options: lsgp.Options,
) -> float:
    """The curvature, in radians, missing in parts whose ledger does not close, which other angles can still correct.

    changed: rows of the cones whose parts are looked at.  Raises LsgpError where no other angles can correct it.
    """
    lsgp = native.lsgp
    missing = 0.0
    for part in lsgp.build_ledger(surface, cones, angles, options):
        own = part.cones
        if not np.isin(own, changed).any():
            continue
        missing += 0.0 if part.closes else part.missing
        try:
            lsgp.prescribe_curvature(lsgp.part_surface(surface, part), cones[own], [angles[i] for i in own], options)
        except lsgp.LsgpError as error:
            if error.code not in CORRECTABLE:
                raise
    return missing
