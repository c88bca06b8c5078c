# SPDX-License-Identifier: GPL-3.0-or-later
"""From regions to meshes of quads. Nothing is written.

Runs in a thread of its own while Blender continues, so nothing here touches Blender's data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core import native
from ...core.errors import Refused
from .directions import DirectionChoice, with_directions
from .solving import solve_all

if TYPE_CHECKING:
    import lsgp
    import numpy as np
    from numpy.typing import NDArray

    from ...core.cone_angles import ConeAngles
    from ...core.region import Region
    from .solving import Progress

# How many times as many quads there are, on the same area, where the weight of density is 1 as where it is 0.
MOST_DENSITY = 16.0


@dataclass(frozen=True, slots=True)
class QuadSettings:
    """What the artist chose.

    options: of the layout. target: how many quads; None if the size determines it. size: the side of a quad in the
    world, None likewise. direction: where rows of quads run. polish: as of `remesh_to_quads`.
    """

    options: lsgp.Options
    target: int | None
    size: float | None
    direction: DirectionChoice
    polish: bool


@dataclass(frozen=True, slots=True)
class QuadTask:
    """Everything that the quads of one region are computed from.

    cones: those of the region with their angles. target, size: as in the settings, but for the size of the mesh.
    density: (n,) that of quads at each vertex; None where it is the same everywhere.
    """

    region: Region
    cones: ConeAngles
    options: lsgp.Options
    target: int | None
    size: float | None
    polish: bool
    density: NDArray[np.float64] | None

    @property
    def threads(self) -> int:
        return self.options.threads

    def with_threads(self, count: int) -> QuadTask:
        return replace(self, options=replace(self.options, threads=count))


def quad_task(region: Region, settings: QuadSettings) -> QuadTask:
    """What the quads of the region are computed from.  Raises Refused."""
    size = settings.size
    if size is not None:
        if not region.object_scale:
            raise Refused("the object is scaled to zero, so quads have no size on it; scale it up or give their number")
        size /= region.object_scale
    # Quads run on across seams, which therefore do not matter to the angles of cones either.
    region = replace(region, surface=replace(region.surface, seams=None))
    region = with_directions(region, settings.direction)
    density = None if region.weights is None else MOST_DENSITY**region.weights
    return QuadTask(region, region.own_cones, settings.options, settings.target, size, settings.polish, density)


def remesh_all(tasks: Sequence[QuadTask], progress: Progress | None = None) -> list[lsgp.QuadRemesh | Exception]:
    """The quads of all tasks; an error in place of each that could not be computed.  Raises Cancelled."""
    return solve_all(tasks, _remesh, progress)


def _remesh(task: QuadTask, progress: Progress | None) -> lsgp.QuadRemesh:
    """Raises LsgpError."""
    surface = task.region.surface
    imposed = task.cones.without_stale(surface, task.options)
    return native.lsgp.remesh_to_quads(
        surface,
        imposed.cones,
        imposed.angles,
        target=task.target,
        size=task.size,
        options=task.options,
        polish=task.polish,
        density=task.density,
        progress=progress,
    )
