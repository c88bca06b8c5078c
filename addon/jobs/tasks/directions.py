# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the texture should run: what the artist chose, as directions of a region's triangles. Touches nothing in
Blender."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused

if TYPE_CHECKING:
    import argparse

    from ...core.region import Region

UP = (0.0, 0.0, 1.0)
"""What Blender calls up, in the world."""


@dataclass(frozen=True, slots=True)
class DirectionChoice:
    """What v is to run along.

    axis: (3,) in the world; None: nothing. by_edge: the region's active edge instead, on a face beside it. if_drawn: as
    drawn on the region instead, where anything is.
    """

    axis: tuple[float, float, float] | None = None
    by_edge: bool = False
    if_drawn: bool = False


def direction_choice(args: argparse.Namespace) -> DirectionChoice:
    """The choice on the command line."""
    if args.up is None:
        return DirectionChoice(UP if args.preset == "tile" else None, if_drawn=True)
    up = native.part("run.unwrap_options").up_of(args)
    return DirectionChoice(None if up is None else tuple(up))


def upward(along: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """A direction, (3,), or its opposite: that which is rather up than down in the world, or else runs along its first
    axis that it is not across; so that it does not matter in which order an edge has its vertices.

    axes: (3, 3), which take directions to the world.
    """
    world = axes @ along
    return along * next((np.sign(part) for part in world[::-1] if abs(part) > 1e-6 * np.abs(world).max()), 1.0)


def with_directions(region: Region, choice: DirectionChoice) -> Region:
    """The region with directions of its triangles.  Raises Refused."""
    surface = region.surface
    if choice.if_drawn and region.drawn_up is not None:
        return replace(region, surface=replace(surface, directions=region.drawn_up))
    if not choice.by_edge:
        if choice.axis is None:
            return region
        return replace(region, surface=replace(surface, directions=np.array(choice.axis) @ region.axes))
    if region.active_edge is None:
        raise Refused("no edge of the selected faces is active; select one last in edit mode, or choose an axis")
    first, last = region.active_edge
    along = surface.positions[last] - surface.positions[first]
    beside = (surface.triangles == first).any(axis=1) & (surface.triangles == last).any(axis=1)
    directions = np.zeros(surface.triangles.shape)
    # On one side alone: should a cut run along the edge, both sides cannot be met.
    directions[np.flatnonzero(beside)[0]] = upward(along, region.axes)
    return replace(region, surface=replace(surface, directions=directions))
