# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions to finished maps: pins in, the library's result, aspect and placement, nothing written.

Runs in a thread of its own while Blender goes on: nothing here touches what is Blender's.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import cells, native
from .packing import Islands

if TYPE_CHECKING:
    import lsgp

    from .angles import ConeAngles
    from .mesh_read import Region

    Progress = Callable[[float], bool | None]

T = TypeVar("T")
R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Task:
    """All that the map of one object's region is computed from.

    cones: those of the region and their angles. pinned: (m, 3) bool, the corners to hold. keep_placement: of the
    islands in the region's old coordinates. aspect: of the image the coordinates are for; 1 where they are not to be
    corrected for one.
    """

    region: Region
    cones: ConeAngles
    options: lsgp.Options
    pinned: NDArray[np.bool_]
    keep_placement: bool
    aspect: float


@dataclass(frozen=True, slots=True)
class Unwrapped:
    """A finished map.

    corner_uv: (m, 3, 2) float64 as they are to be written, NaN where not solved. pinned: (m, 3) bool, the corners that
    were held. aspect: as in the task. step: the side of the cells that islands of a seamless layout may be moved by;
    None for other layouts.
    """

    region: Region
    result: lsgp.Result
    corner_uv: NDArray[np.float64]
    pinned: NDArray[np.bool_]
    aspect: float
    step: float | None

    def islands(self) -> Islands:
        """The solved islands as the packer takes them."""
        solved = self.result.solved
        region, island = self.region, self.result.island
        return Islands(
            region.surface.triangles[solved], self.corner_uv[solved], island[solved], self.pinned[solved], self.aspect
        )


def unwrap_all(tasks: Sequence[Task], progress: Progress | None = None) -> list[Unwrapped | Exception]:
    """The maps of all tasks; in the place of one that cannot be solved, why.  Raises Cancelled.

    progress: as the library's, over all tasks.
    """
    return solve_all(tasks, unwrap, progress)


def solve_all(
    tasks: Sequence[T], solve: Callable[[T, Progress | None], R], progress: Progress | None
) -> list[R | Exception]:
    """What solve(task, progress) returns for each task; in the place of one that cannot be solved, why.

    Raises Cancelled.  progress: over all tasks, whose regions say how much work they are.
    """
    sizes = [len(task.region.surface.triangles) for task in tasks]
    outcomes: list[R | Exception] = []
    for i, task in enumerate(tasks):
        try:
            outcomes.append(solve(task, _part_of(progress, sum(sizes[:i]) / sum(sizes), sizes[i] / sum(sizes))))
        except native.lsgp.Cancelled:
            raise
        except (native.lsgp.LsgpError, MemoryError) as error:
            outcomes.append(error)
    return outcomes


def _part_of(progress: Progress | None, begin: float, share: float) -> Progress | None:
    return None if progress is None else lambda done: progress(begin + share * done)


def unwrap(task: Task, progress: Progress | None, solver: lsgp.Solver | None = None) -> Unwrapped:
    """The map of one task.  Raises LsgpError.  solver: one of the region's surface that keeps what it may use again."""
    lsgp = native.lsgp
    region, pinned = task.region, task.pinned
    # The library solves where lengths are equal both ways.
    squeeze = lsgp.correct_aspect((1.0, 1.0), task.aspect)
    pins = _pins(region, pinned, region.corner_uv / squeeze)
    held = task.cones.held(region.surface, task.options)
    parameterize = partial(lsgp.parameterize, region.surface) if solver is None else solver.parameterize
    result = parameterize(held.cones, held.angles, task.options, pins, progress)
    uv = result.corner_uv
    step = None if result.seamless is None else cells.step(task.options.seamless)
    if task.keep_placement and step is not None:
        uv = cells.keep_places(region, result, step)
    elif task.keep_placement:
        old = region.corner_uv / squeeze
        # Pins have placed their island already.
        old[np.isin(result.island, result.island[pinned.any(axis=1)])] = np.nan
        uv = lsgp.fit_placement(uv, old, result.island)
    uv = lsgp.correct_aspect(uv, task.aspect)
    # A pinned UV keeps its bytes; it would return from double precision up to rounding.
    held = pinned & result.solved[:, None]
    uv[held] = region.corner_uv[held]
    return Unwrapped(region, result, uv, held, task.aspect, step)


def _pins(region: Region, pinned: NDArray[np.bool_], uv: NDArray[np.float64]) -> lsgp.Pins | None:
    """Each pinned loop once; the triangles of a polygon share loops."""
    corners = np.flatnonzero(pinned)
    if not len(corners):
        return None
    _, first = np.unique(region.triangle_loops.ravel()[corners], return_index=True)
    corners = corners[np.sort(first)]
    return native.lsgp.Pins(corners.astype(np.int32), uv.reshape(-1, 2)[corners])
