# SPDX-License-Identifier: GPL-3.0-or-later
"""From regions to cones placed on them. Nothing is written before all of it is computed.

`place_all` runs in a thread of its own while Blender continues, so it does not touch Blender's data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core import native
from ...core.cone_angles import Kind
from ...mesh import angles, cones
from .cuts import CutChoice, with_cut_costs
from .solving import solve_all

if TYPE_CHECKING:
    import lsgp

    from ...core.cone_angles import ConeAngles
    from ...core.region import Region
    from .solving import Progress


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
    threads: int = 0


@dataclass(frozen=True, slots=True)
class PlacementTask:
    """Everything that the cones of one region are placed from.

    marked: the present cones of the region. keep: whether they stay; otherwise they are replaced. cuts: where those
    that cones ask for should run.
    """

    region: Region
    marked: ConeAngles
    keep: bool
    settings: PlacementSettings
    cuts: CutChoice

    @property
    def threads(self) -> int:
        return self.settings.threads

    def with_threads(self, count: int) -> PlacementTask:
        return replace(self, settings=replace(self.settings, threads=count))


def place_all(tasks: Sequence[PlacementTask], progress: Progress | None = None) -> list[lsgp.Placement | Exception]:
    """The cones of all tasks; an error in place of each that could not be computed.  Raises Cancelled."""
    return solve_all(tasks, _place, progress)


def _place(task: PlacementTask, progress: Progress | None) -> lsgp.Placement:
    present, present_angles = (task.marked.cones, task.marked.fixed()) if task.keep else ((), None)
    surface = with_cut_costs(task.region, task.cuts).surface
    return native.lsgp.place_cones(surface, present, present_angles, **asdict(task.settings), progress=progress)


def write_placement(obj: bpy.types.Object, group: str, task: PlacementTask, placement: lsgp.Placement) -> int:
    """Mark the cones, store their angles and clear those that were replaced.  Returns how many cones are new."""
    new = np.setdiff1d(placement.cones, task.marked.cones)
    replaced = np.setdiff1d(task.marked.cones, placement.cones) if not task.keep else ()
    if len(replaced):
        cones.clear_cones(obj, group, replaced)
        angles.forget_angles(obj, replaced)
    if len(new):
        cones.mark_cones(obj, group, new)
    chosen = dict(zip(task.marked.cones.tolist(), task.marked.fixed(), strict=True)) if task.keep else {}
    _write_found(obj, placement, chosen)
    return len(new)


def mark_placed(obj: bpy.types.Object, group: str, marked: ConeAngles, result: lsgp.Result) -> None:
    """Mark the cones of a map that were not marked before, and store the angles that the artist did not choose."""
    cones.mark_cones(obj, group, np.setdiff1d(result.cones, marked.cones))
    _write_found(obj, result, dict(zip(marked.cones.tolist(), marked.fixed(), strict=True)))


def _write_found(
    obj: bpy.types.Object, computed: lsgp.Placement | lsgp.Result, chosen: dict[int, float | None]
) -> None:
    """Store the angles of these cones, but for those that were chosen."""
    found = {
        vertex: angle
        for vertex, angle in zip(computed.cones.tolist(), computed.cone_angles.tolist(), strict=True)
        if chosen.get(vertex) is None
    }
    if found:
        angles.write_angles(obj, found.keys(), list(found.values()), [Kind.FOUND] * len(found))
