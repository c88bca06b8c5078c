# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions to cones placed on them, nothing written.

Runs in a thread of its own while Blender goes on: nothing here touches what is Blender's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import native
from .unwrapping import solve_all

if TYPE_CHECKING:
    import lsgp

    from .angles import ConeAngles
    from .mesh_read import Region
    from .unwrapping import Progress


@dataclass(frozen=True, slots=True)
class PlacementSettings:
    """How to place cones; as in the library's `place_cones`."""

    count: int | None
    target: float
    lattice: str | None
    prefer_sharp: bool
    symmetric: bool
    mirror: tuple[tuple[float, float, float], tuple[float, float, float]] | None
    seams: str


@dataclass(frozen=True, slots=True)
class PlacementTask:
    """All that the cones of one object's region are placed from.

    marked: the cones of the region. keep: whether they stay; otherwise they give way.
    """

    region: Region
    marked: ConeAngles
    keep: bool
    settings: PlacementSettings

    def place(self, progress: Progress | None) -> lsgp.Placement:
        """Raises LsgpError."""
        how = {name: getattr(self.settings, name) for name in PlacementSettings.__slots__}
        cones, angles = (self.marked.cones, self.marked.fixed()) if self.keep else ((), None)
        return native.lsgp.place_cones(self.region.surface, cones, angles, **how, progress=progress)

    def dropped(self, placement: lsgp.Placement) -> NDArray[np.int32]:
        """The marked cones that gave way."""
        return np.empty(0, np.int32) if self.keep else np.setdiff1d(self.marked.cones, placement.cones)


def place_all(tasks: Sequence[PlacementTask], progress: Progress | None = None) -> list[lsgp.Placement | Exception]:
    """The cones of all tasks; in the place of one that cannot be solved, why.  Raises Cancelled."""
    return solve_all(tasks, PlacementTask.place, progress)
