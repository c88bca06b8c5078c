# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the texture should run: what the artist chose, as directions of a region's triangles. Touches nothing in
Blender."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...core import native
from ...core.errors import Refused

if TYPE_CHECKING:
    import argparse

    from ...core.region import Region

UP = (0.0, 0.0, 1.0)
"""What Blender calls up, in the world."""


@dataclass(frozen=True, slots=True)
class DirectionChoice:
    """What v is to run along. axis: (3,) in the world; None: nothing. by_edge: the region's active edge instead, on a
    face beside it."""

    axis: tuple[float, float, float] | None = None
    by_edge: bool = False

    @property
    def is_any(self) -> bool:
        return self.by_edge or self.axis is not None


def direction_choice(args: argparse.Namespace) -> DirectionChoice:
    """The choice on the command line."""
    if args.up is None:
        return DirectionChoice(UP if args.preset == "tile" else None)
    up = native.part("run.unwrap_options").up_of(args)
    return DirectionChoice(None if up is None else tuple(up))


def with_directions(region: Region, choice: DirectionChoice) -> Region:
    """The region with directions of its triangles.  Raises Refused."""
    if not choice.is_any:
        return region
    surface = region.surface
    if not choice.by_edge:
        return replace(region, surface=replace(surface, directions=np.array(choice.axis) @ region.axes))
    if region.active_edge is None:
        raise Refused("no edge of the selected faces is active; select one last in edit mode, or choose an axis")
    first, last = region.active_edge
    along = surface.positions[last] - surface.positions[first]
    # The same whichever way the edge runs: rather up than down, or else along the first axis that is not 0.
    world = region.axes @ along
    sign = next((np.sign(part) for part in world[::-1] if abs(part) > 1e-6 * np.abs(world).max()), 1.0)
    beside = (surface.triangles == first).any(axis=1) & (surface.triangles == last).any(axis=1)
    directions = np.zeros(surface.triangles.shape)
    # On one side alone: should a cut run along the edge, both sides cannot be met.
    directions[np.flatnonzero(beside)[0]] = sign * along
    return replace(region, surface=replace(surface, directions=directions))
