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
    drawn and marked on the region instead, where anything is.
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


def drawn_directions(region: Region) -> NDArray[np.float64] | None:
    """(m, 3) what is drawn on faces, and on the others what is marked on edges beside them; None where nothing is."""
    if not len(region.along):
        return region.drawn_up
    along = _along_edges(region, region.along)
    if region.drawn_up is None:
        return along
    return np.where(region.drawn_up.any(axis=1, keepdims=True), region.drawn_up, along)


def with_directions(region: Region, choice: DirectionChoice) -> Region:
    """The region with directions of its triangles.  Raises Refused."""
    surface = region.surface
    drawn = drawn_directions(region) if choice.if_drawn else None
    if drawn is not None:
        return replace(region, surface=replace(surface, directions=drawn))
    if not choice.by_edge:
        if choice.axis is None:
            return region
        return replace(region, surface=replace(surface, directions=np.array(choice.axis) @ region.axes))
    if region.active_edge is None:
        raise Refused("no edge of the selected faces is active; select one last in edit mode, or choose an axis")
    directions = _along_edges(region, np.array([region.active_edge]))
    # On one side alone: should a cut run along the edge, both sides cannot be met.
    directions[np.flatnonzero(directions.any(axis=1))[1:]] = 0
    return replace(region, surface=replace(surface, directions=directions))


def _along_edges(region: Region, edges: NDArray[np.integer]) -> NDArray[np.float64]:
    """(m, 3) of v along edges of the region, (e, 2), rather up than down in the world."""
    surface = region.surface
    in_world = native.lsgp.Surface(surface.positions @ region.axes.T, surface.triangles, may_collapse=True)
    return native.lsgp.edge_directions(in_world, edges, up=UP) @ region.axes
