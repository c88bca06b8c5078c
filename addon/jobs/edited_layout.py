# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that have grown out of their place while cones were edited: finding that out, and packing them again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import native
from ..core.islands import Islands
from . import packing
from .areas import total_area
from .maps import FILLED, PackSettings

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
        """Whether islands lie on each other, as far as a raster tells."""
        corners = self.corner_uv[self.island >= 0]
        island = self.island[self.island >= 0]
        low = corners.min(axis=(0, 1), initial=np.inf)
        size = (corners.max(axis=(0, 1), initial=-np.inf) - low).max(initial=0.0)
        if not (np.isfinite(size) and size > 0):
            return False
        raster = native.lsgp.texel_raster
        shape = RASTER, RASTER
        places = raster.to_pixels((corners - low) / size, shape)
        # Of two triangles at a texel one comes first in this order, and the other one in the opposite order.
        first = raster.covering_triangles(places, shape)
        last = len(corners) - 1 - raster.covering_triangles(places[::-1], shape)
        covered = first >= 0
        return bool((island[first[covered]] != island[last[covered]]).any())


def packed(
    triangles: NDArray[np.int32],
    layout: Layout,
    pinned: NDArray[np.bool_],
    aspect: float,
    settings: PackSettings,
) -> NDArray[np.float64]:
    """The coordinates with all islands packed, as they are but for one scale; what is in no island stays.

    triangles: (m, 3). pinned: (m, 3). aspect: as of `Islands`.  Raises Refused.
    """
    inside = layout.island >= 0
    corners, fixed = layout.corner_uv[inside], pinned[inside]
    # So that a margin that is added before scaling is about what was asked for.
    scale = 1.0 if fixed.any() else np.sqrt(FILLED / total_area(corners))
    _, island = np.unique(layout.island[inside], return_inverse=True)
    part = Islands(triangles[inside], scale * corners, island.ravel().astype(np.int32), fixed, aspect)
    out = layout.corner_uv.copy()
    out[inside] = packing.pack(
        [part], settings.margin_method, settings.margin, turned=settings.turned, udim=settings.udim
    )[0]
    return out
