# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas of regions and of layouts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region


def total_area(corners: NDArray[np.float64]) -> float:
    """Of triangles, (m, 3, 2) or (m, 3, 3)."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    squared = (first**2).sum(axis=1) * (second**2).sum(axis=1) - (first * second).sum(axis=1) ** 2
    return float(np.sqrt(np.maximum(squared, 0.0)).sum()) / 2


def size_in_texels(region: Region, triangles: NDArray[np.bool_] | slice = slice(None)) -> float:
    """Square root of the area of some triangles of a region in the world, times its density weight."""
    surface = region.surface
    corners = surface.positions[surface.triangles[triangles]]
    return float(np.sqrt(total_area(corners))) * (region.texel_scale or region.density_weight)


def mean_tile_size(region: Region, result: lsgp.Result) -> float:
    """Side of a tile of a seamless layout on the surface, at the size of the mesh: the mean over its area, as the map
    came out; 0 where it covers nothing."""
    surface, covered = region.surface, total_area(result.corner_uv[result.solved])
    area = total_area(surface.positions[surface.triangles[result.solved]])
    return float(np.sqrt(area / covered)) * result.seamless.cell if covered else 0.0
