# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished maps on their way to the mesh: final placement of the islands, report, writing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.islands import Islands
from ...core.text import counted
from ...mesh import reports
from ...mesh.uv_write import write_uv
from ..tasks import cells
from ..tasks.areas import size_in_texels, total_area
from ..tasks.directions import drawn_directions
from ..tasks.summaries import unwrap_summary
from ..tasks.unwrapping import Unwrapped
from ..uv_maps.texels import map_density
from . import packing
from .densities import packed_at_density
from .stacking import packed_in_stacks

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region

TEXTURE_SIZE = 1024
"""Side, in texels, of the texture for which errors of seams are reported."""


@dataclass(frozen=True, slots=True)
class PackSettings:
    """How islands are placed: packed, those of all objects together, or not; by whole cells or not.

    margin, turned, udim: as of `packing.pack`; udim not by cells, and islands are not turned where the
    texture of a map follows directions. texels: the layout at a texel density,
    with its own margin and tiles, per `unit` of length in Blender's own; None: the square is filled. stack: whether
    islands of one shape are stacked, as of `lsgp.auto_unwrap`; not at a texel density and not by cells.
    """

    pack: bool
    by_cells: bool
    margin: float
    turned: bool = True
    udim: int = 1
    texels: lsgp.TexelLayout | None = None
    unit: float = 1.0
    stack: str | None = None


def turned_for(regions: Iterable[Region], settings: PackSettings) -> PackSettings:
    """The settings, without rotating islands where the texture on a region follows directions."""
    return replace(settings, turned=all(region.surface.directions is None for region in regions))


def final_layouts(solved: Sequence[Unwrapped], settings: PackSettings) -> list[NDArray[np.float64]]:
    """The coordinates of each map as they are to be written, (m, 3, 2) arrays.  Raises Refused; InputError at a texel
    density that the tiles do not hold."""
    return stacked_layouts(solved, settings)[0]


def stacked_layouts(solved: Sequence[Unwrapped], settings: PackSettings) -> tuple[list[NDArray[np.float64]], int]:
    """As above, and how many islands are stacked on others."""
    if not settings.pack or not solved:
        return [unwrapped.corner_uv for unwrapped in solved], 0
    if settings.by_cells:
        return cells.pack(solved), 0
    settings = turned_for([unwrapped.region for unwrapped in solved], settings)
    parts = _with_one_density(solved)
    if settings.texels is not None:
        alike = _whole(solved, [part.corner_uv for part in parts])
        return packed_at_density(solved, alike, settings.texels, turned=settings.turned, unit=settings.unit), 0
    packed, stacked = _packed(parts, settings)
    return _whole(solved, packed), stacked


def _packed(parts: Sequence[Islands], settings: PackSettings) -> tuple[list[NDArray[np.float64]], int]:
    def pack(kept: Sequence[Islands]) -> list[NDArray[np.float64]]:
        return packing.pack(kept, settings.margin, turned=settings.turned, udim=settings.udim)

    if settings.stack is None:
        return pack(parts), 0
    return packed_in_stacks(parts, pack, mirrored=settings.stack == "mirrored")


def _whole(solved: Sequence[Unwrapped], of_islands: Sequence[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """The coordinates of each map, (m, 3, 2), with these of its solved triangles."""
    layouts = [unwrapped.corner_uv.copy() for unwrapped in solved]
    for unwrapped, layout, uv in zip(solved, layouts, of_islands, strict=True):
        layout[unwrapped.result.solved] = uv
    return layouts


def _with_one_density(solved: Sequence[Unwrapped]) -> list[Islands]:
    """The islands of each map, at one scale for all objects but for their density weights; those with pins keep
    theirs."""
    sizes = np.array([size_in_texels(unwrapped.region, unwrapped.result.solved) for unwrapped in solved])
    sizes /= np.sqrt((sizes**2).sum())
    parts = []
    for unwrapped, size in zip(solved, sizes, strict=True):
        part = unwrapped.islands()
        scale = size / np.sqrt(total_area(part.corner_uv))
        stays = part.stays[:, None, None]
        parts.append(replace(part, corner_uv=np.where(stays, part.corner_uv, scale * part.corner_uv)))
    return parts


def write_map(obj: bpy.types.Object, unwrapped: Unwrapped, corner_uv: NDArray[np.float64]) -> None:
    """Write the coordinates, (m, 3, 2), and store the report on them."""
    found = replace(report_on(unwrapped), texel_density=map_density(unwrapped.region, corner_uv))
    report = reports.joined(reports.find(obj.data), found, unwrapped.region)
    write_uv(obj, unwrapped.region, unwrapped.result.solved, corner_uv)
    reports.store(obj.data, report)


def map_summary(unwrapped: Unwrapped, corner_uv: NDArray[np.float64]) -> str:
    """A map in one line, with the number of islands that lose their shape in single precision, in which Blender stores
    UVs.  corner_uv: (m, 3, 2), final."""
    summary = unwrap_summary(unwrapped)
    tiny = tiny_findings(unwrapped, corner_uv)
    if not tiny:
        return summary
    count = len(np.unique(unwrapped.result.island[tiny[0].elements.indices]))
    return f"{summary}; {counted(count, 'island')} too small for UV coordinates to keep in shape"


def tiny_findings(unwrapped: Unwrapped, corner_uv: NDArray[np.float64]) -> list[lsgp.Finding]:
    """The warning of tiny islands in a final layout, (m, 3, 2), unless the map has it already, as from Auto Unwrap."""
    if any(finding.code == "ISLANDS_TINY" for finding in unwrapped.result.warnings):
        return []
    return native.part("layouts.texels").tiny_findings(corner_uv, unwrapped.result.island)


def report_on(unwrapped: Unwrapped) -> reports.Report:
    """What is kept of a finished map."""
    result, region = unwrapped.result, unwrapped.region
    certificate = None
    if result.seamless is not None:
        certificate = native.lsgp.certificate.certificate(result.seamless, TEXTURE_SIZE)
    drawn, drawn_errors = _drawn_errors(unwrapped)
    return reports.Report(
        paths=[path.tolist() for path in result.cut_paths],
        kinds=list(result.cut_kinds),
        cones=result.cones.tolist(),
        cone_angles=result.cone_angles.tolist(),
        flipped=np.unique(region.triangle_faces[result.flipped]).tolist(),
        overlapping=np.unique(region.triangle_faces[result.overlapping]).tolist(),
        faces=len(np.unique(region.triangle_faces[result.solved])),
        islands=int(result.island.max()) + 1,
        distortion=asdict(result.distortion),
        seams=asdict(result.seams),
        overlap_area=result.overlap_area,
        certificate=certificate,
        drawn=drawn,
        drawn_errors=drawn_errors,
    )


def _drawn_errors(unwrapped: Unwrapped) -> tuple[list[int], list[float]]:
    """The faces on which a direction is drawn or which have a marked edge, and how far the map is from it, the largest
    of their triangles; none where it follows something else."""
    errors, region = unwrapped.result.direction_errors, unwrapped.region
    if errors is None or not np.array_equal(region.surface.directions, drawn_directions(region)):
        return [], []
    has_error = np.isfinite(errors)
    faces, number = np.unique(region.triangle_faces[has_error], return_inverse=True)
    largest = np.zeros(len(faces))
    np.maximum.at(largest, number, errors[has_error])
    return faces.tolist(), largest.tolist()
