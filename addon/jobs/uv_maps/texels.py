# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel densities of faces and islands, in texels per unit of length of the world.  Nothing is written."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.region import Region
from ...mesh.reports import Report

# Relative, of factors from coordinates in single precision.
ALIKE = 1e-5

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Texels:
    """A map and a texture on it.

    region: all faces. chosen: (m,) bool, the triangles that are asked about. area: (m,) of the triangles in the world.
    density: (m,) texels per unit of length in the world; NaN where there is no area.
    """

    region: Region
    chosen: NDArray[np.bool_]
    area: FloatArray
    density: FloatArray

    def texels(self) -> FloatArray:
        """(m,) how many texels each triangle has; 0 where it has no area."""
        return np.where(np.isnan(self.density), 0.0, self.density**2 * self.area)


def measure_texels(region: Region, chosen: NDArray[np.bool_], size: tuple[int, int]) -> Texels:
    """size: width and height of the texture in texels.  Raises LsgpError; Refused where lengths have no meaning."""
    if not region.object_scale:
        raise Refused("the object is scaled to zero, so texels have no size on it; scale it up")
    corners = region.surface.positions[region.surface.triangles] * region.object_scale
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    density = native.lsgp.triangle_texel_density(region.surface, region.corner_uv, size) / region.object_scale
    return Texels(region, chosen, area, density)


def overall_density(parts: list[Texels]) -> float:
    """Of all chosen triangles together; 0 where they have no texels, NaN where they have no area."""
    area = sum(part.area[part.chosen].sum() for part in parts)
    texels = sum(part.texels()[part.chosen].sum() for part in parts)
    return float(np.sqrt(texels / area)) if area > 0 else float("nan")


def face_densities(measured: Texels) -> FloatArray:
    """(f,) density of each face; NaN where it has no area or no triangle."""
    count, faces = len(measured.region.face_loop_start), measured.region.triangle_faces
    area = np.bincount(faces, measured.area, minlength=count)
    texels = np.bincount(faces, measured.texels(), minlength=count)
    return np.sqrt(np.divide(texels, area, out=np.full(count, np.nan), where=area > 0))


@dataclass(frozen=True, slots=True)
class Scaled:
    """corner_uv: (m, 3, 2). moved: (m,) bool, the triangles of islands that were scaled. islands: how many were, and
    skipped: how many were not, as they have no area in the map. total: how many there are. alike: whether all were
    scaled, and by one factor."""

    corner_uv: FloatArray
    moved: NDArray[np.bool_]
    islands: int
    skipped: int
    total: int
    alike: bool


def scale_islands(measured: Texels, density: float) -> Scaled:
    """The islands of the chosen triangles at a density, each about the middle of its bounds.

    Raises LsgpError; Refused where there is no island.
    """
    region, uv = measured.region, measured.region.corner_uv
    island = native.lsgp.measure_distortion(region.surface, uv).island
    inside = island >= 0
    if not inside.any():
        raise Refused("the UV map has no finite coordinates; unwrap the mesh again")
    count = int(island.max()) + 1
    asked = np.zeros(count, bool)
    asked[island[inside & measured.chosen]] = True
    area = np.bincount(island[inside], measured.area[inside], minlength=count)
    texels = np.bincount(island[inside], measured.texels()[inside], minlength=count)
    has_size = (area > 0) & (texels > 0)
    factor = np.where(has_size, density * np.sqrt(area / np.where(has_size, texels, 1.0)), 1.0)
    boxes = native.lsgp.lattice.island_boxes(uv, island)
    middle = (boxes[:, :2] + boxes[:, 2:]) / 2
    moved = inside & (asked & has_size)[island]
    of_island = island[moved]
    scaled = uv.copy()
    center = middle[of_island, None]
    scaled[moved] = center + factor[of_island, None, None] * (uv[moved] - center)
    factors = np.where(asked & has_size, factor, 1.0)
    return Scaled(
        corner_uv=scaled,
        moved=moved,
        islands=int((asked & has_size).sum()),
        skipped=int((asked & ~has_size).sum()),
        total=count,
        alike=bool(np.ptp(factors) <= ALIKE * factors.max()),
    )


def report_on_scaled(report: Report, region: Region, scaled: Scaled) -> Report:
    """The report on a map whose islands were scaled.  Raises LsgpError."""
    if not scaled.alike:
        # Of one scale, quality and seams are what they were computed to be, before coordinates were rounded.
        found = native.lsgp.measure_distortion(region.surface, scaled.corner_uv)
        report = replace(report, distortion=asdict(found.distortion), seams=asdict(found.seams))
    return replace(
        report,
        certificate=None,
        texel_density=map_density(region, scaled.corner_uv),
        overlaps_known=report.overlaps_known and scaled.total == 1,
        square_used=None,
    )


def map_density(region: Region, corner_uv: FloatArray) -> list[float] | None:
    """Least, median and largest length in the map of a unit in the world, each the square root of an area by that of
    its triangle; None where the object has no size."""
    if not region.object_scale:
        return None
    found = native.lsgp.texel_density(region.surface, corner_uv, 1)
    return [value / region.object_scale for value in (found.minimum, found.median, found.maximum)]
