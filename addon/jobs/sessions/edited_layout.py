# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that have grown out of their place while cones were edited: finding that out, and packing them again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.islands import Islands
from ..layouts import packing
from ..layouts.maps import PackSettings

# Of a tile; coordinates have single precision.
ROUNDING = 1e-5
# Texels along each side of a raster on which overlaps are looked for.
RASTER = 1024


@dataclass(frozen=True, slots=True)
class Layout:
    """corner_uv: (m, 3, 2). island: (m,) int32, -1 for none."""

    corner_uv: NDArray[np.float64]
    island: NDArray[np.int32]

    def crosses_tiles(self, triangles: NDArray[np.bool_]) -> bool:
        """Whether one of the islands of these triangles is not inside a single UDIM tile."""
        boxes = native.lsgp.lattice.island_boxes(self.corner_uv, self.island)
        boxes = boxes[np.unique(self.island[triangles & (self.island >= 0)])]
        low, high = boxes[:, :2] + ROUNDING, boxes[:, 2:] - ROUNDING
        return bool(((low < 0) | (np.floor(low) != np.floor(high))).any())

    def overlaps(self) -> bool:
        """Whether islands overlap each other, as far as a raster tells."""
        corners = self.corner_uv[self.island >= 0]
        island = self.island[self.island >= 0]
        low = corners.min(axis=(0, 1), initial=np.inf)
        size = (corners.max(axis=(0, 1), initial=-np.inf) - low).max(initial=0.0)
        if not (np.isfinite(size) and size > 0):
            return False
        raster = native.part("images.texel_raster")
        shape = RASTER, RASTER
        places = raster.to_pixels((corners - low) / size, shape)
        # Of two triangles at a texel one comes first in this order, and the other one in the opposite order.
        first = raster.covering_triangles(places, shape)
        last = len(corners) - 1 - raster.covering_triangles(places[::-1], shape)
        covered = first >= 0
        return bool((island[first[covered]] != island[last[covered]]).any())


@dataclass(frozen=True, slots=True)
class Placement:
    """The islands of one mesh, now and before its cones were edited.

    triangles: (m, 3). edited: (m,) bool, those that were unwrapped again. pinned: (m, 3) bool. aspect: as of `Islands`.
    """

    triangles: NDArray[np.int32]
    now: Layout
    before: Layout
    edited: NDArray[np.bool_]
    pinned: NDArray[np.bool_]
    aspect: float

    def islands(self) -> Islands:
        """For the packer."""
        inside = self.now.island >= 0
        _, island = np.unique(self.now.island[inside], return_inverse=True)
        corners = self.now.corner_uv[inside]
        return Islands(
            self.triangles[inside], corners, island.ravel().astype(np.int32), self.pinned[inside], self.aspect
        )


def packed_where_needed(placements: Sequence[Placement], settings: PackSettings) -> list[Layout | None]:
    """The layouts of meshes with their islands packed again, None for those that stay as they are.

    Those that shared the square are packed together, each other mesh by itself.  Raises Refused.
    """
    if not settings.pack or settings.by_cells:
        return [None] * len(placements)
    shared = not joined([placement.before for placement in placements]).overlaps()
    groups = [range(len(placements))] if shared else [[number] for number in range(len(placements))]
    layouts: list[Layout | None] = [None] * len(placements)
    for group in groups:
        members = [placements[number] for number in group]
        if _is_needed(members):
            for number, layout in zip(group, _packed(members, settings), strict=True):
                layouts[number] = layout if (layout.island >= 0).any() else None
    return layouts


def joined(layouts: Sequence[Layout]) -> Layout:
    """All islands in one layout."""
    counts = [int(layout.island.max(initial=-1)) + 1 for layout in layouts]
    first = np.cumsum([0, *counts])[:-1]
    island = [np.where(layout.island < 0, -1, layout.island + at) for layout, at in zip(layouts, first, strict=True)]
    return Layout(np.concatenate([layout.corner_uv for layout in layouts]), np.concatenate(island).astype(np.int32))


def _is_needed(placements: Sequence[Placement]) -> bool:
    """Whether an edited island is outside the square, or islands overlap each other and did not before."""
    now, before = (joined([getattr(placement, when) for placement in placements]) for when in ("now", "before"))
    edited = np.concatenate([placement.edited for placement in placements])
    return edited.any() and (now.crosses_tiles(edited) or (now.overlaps() and not before.overlaps()))


def _packed(placements: Sequence[Placement], settings: PackSettings) -> list[Layout]:
    """With all islands packed together, as they are but for one scale."""
    parts = [placement.islands() for placement in placements]
    packed = iter(
        packing.pack(
            [part for part in parts if len(part.triangles)],
            settings.margin,
            turned=settings.turned,
            udim=settings.udim,
        )
    )
    layouts = []
    for placement in placements:
        corner_uv = placement.now.corner_uv.copy()
        inside = placement.now.island >= 0
        if inside.any():
            corner_uv[inside] = next(packed)
        layouts.append(Layout(corner_uv, placement.now.island))
    return layouts
