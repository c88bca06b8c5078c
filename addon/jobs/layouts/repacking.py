# SPDX-License-Identifier: GPL-3.0-or-later
"""The islands of UV maps packed again, as they are.  Nothing is written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused, object_errors
from ...core.islands import Islands, Place
from ..tasks.areas import total_area
from ..uv_maps.texels import Scaled
from . import in_place, packing

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region
    from ..tasks.solving import Progress

FloatArray = NDArray[np.float64]

# Of boxes around islands that lie on each other; coordinates have single precision.
SAME_PLACE = 1e-5


@dataclass(frozen=True, slots=True)
class RepackSettings:
    """margin, turned, udim, effort: as of `packing.pack`. fill: whether islands get as large as there is room; if not,
    they keep their density, if there is; None: they do where others stay beside them. keep_stacks: whether those that
    lie on each other stay so. in_place: whether others have a say. others: (k, 3, 2), triangles beside them, of objects
    of which nothing is packed."""

    margin: float
    turned: bool = True
    udim: int = 1
    effort: str = "good"
    fill: bool | None = None
    keep_stacks: bool = True
    in_place: bool = True
    others: FloatArray = field(default_factory=lambda: np.empty((0, 3, 2)))


@dataclass(frozen=True, slots=True)
class RepackTask:
    """region: all faces of a mesh. chosen: (m,) bool, the triangles whose islands are packed."""

    region: Region
    chosen: NDArray[np.bool_]

    @property
    def threads(self) -> int:
        return 1

    def with_threads(self, _count: int) -> RepackTask:
        return self


@dataclass(frozen=True, slots=True)
class Repacked:
    """scaled: the new coordinates and what was moved. note: what is to be told of all. square_used: the part of the UV
    square that all cover; None where some stay, share texels, or are not packed into it."""

    region: Region
    scaled: Scaled
    note: str = ""
    square_used: float | None = None
    warnings: list[lsgp.Finding] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class _Found:
    """The islands of a task.  island: (m,), -1 for none; those that lie on each other have one number, if they are to
    stay so. moved: (m,) bool, those that are packed."""

    island: NDArray[np.int32]
    moved: NDArray[np.bool_]
    parts: Islands
    stacked: bool


def repack(
    settings: RepackSettings, tasks: Sequence[RepackTask], progress: Progress | None = None
) -> list[Repacked | Exception]:
    """The new layout of each task, all together, or why there is none.  Raises Cancelled."""
    if not tasks:
        return []
    try:
        found = [_islands(task, settings) for task in tasks]
        return _packed(tasks, found, settings, progress)
    except native.lsgp.Cancelled:
        raise
    except object_errors() as error:
        return [error] * len(tasks)


def _islands(task: RepackTask, settings: RepackSettings) -> _Found:
    region, uv = task.region, task.region.corner_uv
    island = native.lsgp.measure_distortion(region.surface, uv).island
    count = int(island.max(initial=-1)) + 1
    if settings.keep_stacks:
        island = _merged(uv, island)
    moved = (island >= 0) & np.isin(island, island[task.chosen & (island >= 0)])
    if not moved.any():
        raise Refused("the UV map has no islands there; unwrap the mesh first")
    own = np.unique(island[moved], return_inverse=True)[1].ravel().astype(np.int32)
    parts = Islands(region.surface.triangles[moved], uv[moved], own, region.pinned[moved], region.image_aspect)
    return _Found(island, moved, parts, int(island.max()) + 1 < count)


def _merged(uv: FloatArray, island: NDArray[np.int32]) -> NDArray[np.int32]:
    """With one number for islands that lie on each other."""
    if not (island >= 0).any():
        return island
    boxes = native.lsgp.lattice.island_boxes(uv, island)
    number = np.unique(np.round(boxes / SAME_PLACE).astype(np.int64), axis=0, return_inverse=True)[1].ravel()
    return np.where(island < 0, -1, number[island]).astype(np.int32)


def _box(parts: Sequence[Islands]) -> FloatArray:
    """(2, 2), the low and the high corner of the rectangle around islands."""
    corners = np.concatenate([part.corner_uv.reshape(-1, 2) for part in parts])
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def _packed(
    tasks: Sequence[RepackTask], found: Sequence[_Found], settings: RepackSettings, progress: Progress | None
) -> list[Repacked | Exception]:
    parts = [one.parts for one in found]
    others = np.empty((0, 3, 2))
    if settings.in_place:
        left = [task.region.corner_uv[~one.moved] for task, one in zip(tasks, found, strict=True)]
        others = np.concatenate([settings.others, *(uv[np.isfinite(uv).all(axis=(1, 2))] for uv in left)])
    fill = not len(others) if settings.fill is None else settings.fill
    how = {"turned": settings.turned, "effort": settings.effort, "progress": progress}
    place = Place(others, _box(parts) if len(others) else None, keeps_density=not fill)
    if len(others) or not fill:
        packed = packing.pack_in_place(parts, settings.margin, place, **how)
    else:
        packed = packing.pack(parts, settings.margin, udim=settings.udim, **how)
    whole = settings.udim == 1 and fill and not len(others)
    alone = whole and not any(one.parts.stays.any() or one.stacked for one in found)
    used = sum(map(total_area, packed)) if alone else None
    notes = in_place.told(place, [part.corner_uv for part in parts], packed)
    outcomes = []
    for task, one, uv in zip(tasks, found, packed, strict=True):
        corner_uv = task.region.corner_uv.copy()
        corner_uv[one.moved] = uv
        islands, total = len(np.unique(one.island[one.moved])), len(np.unique(one.island[one.island >= 0]))
        alike = islands == total and not one.parts.stays.any()
        scaled = Scaled(corner_uv, one.moved, islands, 0, total, alike)
        outcomes.append(Repacked(task.region, scaled, square_used=used))
    outcomes[-1] = replace(outcomes[-1], note="; ".join(notes))
    return outcomes
