# SPDX-License-Identifier: GPL-3.0-or-later
"""The gain from one more cone."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ..tasks.cuts import with_cut_costs

if TYPE_CHECKING:
    import lsgp

    from ...core.cone_angles import ConeAngles
    from ...core.region import Region
    from ..tasks.cuts import CutChoice


def best_gain(region: Region, cones: ConeAngles, options: lsgp.Options, cuts: CutChoice) -> lsgp.ConeGains:
    """The gains on the connected part with the best place for one more cone; of all parts if there is no such place.

    cuts: where they should run; the best place is one that they reach cheaply.  Raises LsgpError.
    """
    fixed, surface = cones.fixed(), with_cut_costs(region, cuts).surface
    gains = native.lsgp.cone_gains(surface, cones.cones, fixed, seams=options.seams)
    parts = native.lsgp.build_ledger(surface, cones.cones, fixed, options, gets_cones=True)
    if gains.best is None or len(parts) == 1:
        return gains
    part = next(part for part in parts if (surface.triangles[part.triangles] == gains.best).any())
    # The part by itself has no costs of cuts.
    return replace(_part_gains(surface, cones, part, options), best=gains.best)


def gain_at_vertices(surface: lsgp.Surface, cones: ConeAngles, options: lsgp.Options) -> NDArray[np.float64]:
    """(n,) by how much a cone at each vertex lowers the L2 stretch of its part; 0 where none may be placed.

    Raises LsgpError.
    """
    lowered = np.zeros(len(surface.positions))
    for part in native.lsgp.build_ledger(surface, cones.cones, cones.fixed(), options, gets_cones=True):
        gains = _part_gains(surface, cones, part, options)
        # A part that needs a cone has infinite stretch without one; compare with the worst place for it instead.
        worst = np.nanmax(gains.predicted_l2, initial=1.0)
        of_part = min(gains.present_l2, worst) - gains.predicted_l2
        lowered = np.maximum(lowered, np.nan_to_num(of_part, nan=0.0, posinf=0.0, neginf=0.0))
    return lowered


def _part_gains(
    surface: lsgp.Surface, cones: ConeAngles, part: lsgp.LedgerPart, options: lsgp.Options
) -> lsgp.ConeGains:
    own, fixed = part.cones, cones.fixed()
    of_part = native.lsgp.part_surface(surface, part)
    return native.lsgp.cone_gains(of_part, cones.cones[own], [fixed[i] for i in own], seams=options.seams)
