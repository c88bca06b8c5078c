# SPDX-License-Identifier: GPL-3.0-or-later
"""Where cuts should run: what the artist chose, as costs of a region's edges. Touches nothing in Blender."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...core import native

if TYPE_CHECKING:
    import argparse

    from ...core.region import Region

FRONT = (0.0, -1.0, 0.0)
"""What Blender calls the front, in the world."""


@dataclass(frozen=True, slots=True)
class CutChoice:
    """by_cost: whether cuts are to run where they are cheap rather than the shortest way. front: (3,) in the world, the
    direction from the model to the viewer, from whom cuts are hidden; None: from nobody."""

    by_cost: bool = True
    front: tuple[float, float, float] | None = FRONT


def cut_choice(args: argparse.Namespace) -> CutChoice:
    """The choice on the command line."""
    front = tuple(args.front or FRONT) if args.cuts == "hidden" else None
    return CutChoice(args.cuts != "shortest", front)


def with_cut_costs(region: Region, choice: CutChoice) -> Region:
    """The region with costs of its edges.  Raises LsgpError."""
    if not choice.by_cost:
        return region
    surface = region.surface
    costs = native.lsgp.cut_costs(
        surface,
        None if choice.front is None else np.array(choice.front) @ region.axes,
        sharp=region.sharp,
        paint=region.cut_paint,
    )
    return replace(region, surface=replace(surface, cut_costs=costs))
