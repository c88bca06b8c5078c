# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished maps on their way to the mesh: final placement of the islands, report, writing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import object_errors
from ...core.islands import Islands, Surroundings
from ...core.text import counted
from ...mesh import reports
from ...mesh.uv_write import write_uv
from ..tasks import cells
from ..tasks.areas import size_in_texels, total_area
from ..tasks.directions import drawn_directions
from ..tasks.summaries import unwrap_summary
from ..tasks.unwrapped import Unwrapped
from ..tasks.unwrapping import UnwrapTask
from ..uv_maps.texels import map_density
from . import in_place, packing, upright
from .densities import packed_at_density
from .inside import find_hidden, with_less_inside
from .remembered import unwrap_all_once
from .stacking import packed_in_stacks

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region
    from ..tasks.solving import Progress

# Of the time of an unwrap, that of packing.
_PACKING_SHARE = {"good": 0.2, "best": 0.9}
# Of the time of packing, where islands are looked for that nothing outside can see.
_LOOKING_INSIDE = 0.3

TEXTURE_SIZE = 1024
"""Side, in texels, of the texture for which errors of seams are reported."""


@dataclass(frozen=True, slots=True)
class PackSettings:
    """How islands are placed: packed, those of all objects together, or not; by whole cells or not.

    margin, turned, udim: as of `packing.pack`; udim not by cells, and islands are not turned where the
    texture of a map follows directions. texels: the layout at a texel density,
    with its own margin and tiles, per `unit` of length in Blender's own; None: the square is filled. stack: whether
    islands of one shape are stacked, as of `lsgp.auto_unwrap`; not at a texel density and not by cells. effort: as of
    `lsgp.pack_islands`. inside: as of `lsgp.auto_unwrap`, among the unwrapped faces of each object; not at a texel
    density.
    surroundings: of a selection that is placed as by `packing.pack_in_place`; None: all faces are unwrapped, or
    islands are packed as if they were all.
    """

    pack: bool
    by_cells: bool
    margin: float
    turned: bool = True
    udim: int = 1
    texels: lsgp.TexelLayout | None = None
    unit: float = 1.0
    stack: str | None = None
    effort: str = "good"
    inside: float = 1.0
    surroundings: Surroundings | None = None


def turned_for(regions: Iterable[Region], settings: PackSettings) -> PackSettings:
    """The settings, without rotating islands where the texture on a region follows directions."""
    return replace(settings, turned=all(region.surface.directions is None for region in regions))


def unwrap_and_place(
    settings: PackSettings, tasks: Sequence[UnwrapTask], progress: Progress | None = None
) -> list[Unwrapped | Exception]:
    """The maps of all tasks in their final place; an error in place of each that there is none of.  Raises
    Cancelled."""
    part = _PACKING_SHARE.get(settings.effort, 0.0) if settings.pack else 0.0
    share_of = native.part("base.progress").share_of
    outcomes = unwrap_all_once(tasks, share_of(progress, 0.0, 1.0 - part))
    numbers = [i for i, outcome in enumerate(outcomes) if isinstance(outcome, Unwrapped)]
    try:
        placed = placed_maps([outcomes[i] for i in numbers], settings, share_of(progress, 1.0 - part, 1.0))
    except native.lsgp.Cancelled:
        raise
    except object_errors() as error:
        placed = [error] * len(numbers)
    for i, one in zip(numbers, placed, strict=True):
        outcomes[i] = one
    return outcomes


def placed_maps(
    solved: Sequence[Unwrapped], settings: PackSettings, progress: Progress | None = None
) -> list[Unwrapped]:
    """The maps with the coordinates that are to be written.  Raises Refused; InputError at a texel density that the
    tiles do not hold."""
    if not settings.pack or not solved:
        return list(solved)
    if settings.by_cells:
        return _at(solved, cells.pack(solved))
    settings = turned_for([unwrapped.region for unwrapped in solved], settings)
    how = {"turned": settings.turned, "effort": settings.effort, "progress": progress}
    parts = _with_one_density(solved)
    if settings.texels is not None:
        alike = _whole(solved, [part.corner_uv for part in parts])
        place = None if settings.surroundings is None else in_place.place_of(solved, settings.surroundings)
        return _at(solved, packed_at_density(solved, alike, settings.texels, unit=settings.unit, place=place, **how))
    margin, notes = settings.margin, []
    hidden = None
    if settings.inside < 1:
        share_of = native.part("base.progress").share_of
        hidden = find_hidden(solved, parts, share_of(progress, 0.0, _LOOKING_INSIDE))
        how["progress"] = share_of(progress, _LOOKING_INSIDE, 1.0)
    if settings.surroundings is not None:
        place, parts = in_place.at_density(solved, parts, settings.surroundings, hidden)
    if hidden is not None:
        solved, parts, count = with_less_inside(solved, parts, hidden, settings.inside)
        if count:
            notes.append(f"{counted(count, 'island')} inside smaller")
    pack = partial(packing.pack, margin=margin, udim=settings.udim, **how)
    if settings.surroundings is not None:
        pack = partial(packing.pack_in_place, margin=margin, place=place, **how)
    if settings.stack is None:
        packed = pack(parts)
    else:
        packed, stacked = packed_in_stacks(parts, pack, mirrored=settings.stack == "mirrored")
        if stacked:
            notes.append(f"{counted(stacked, 'island')} stacked on others")
    if settings.turned and settings.surroundings is None and settings.stack is None and settings.udim == 1:
        packed = upright.standing(solved, parts, packed, margin)
    if settings.surroundings is not None:
        notes += in_place.told(place, [part.corner_uv for part in parts], packed)
    fills = settings.surroundings is None and settings.stack is None and settings.udim == 1
    used = sum(map(total_area, packed)) if fills and not any(part.stays.any() for part in parts) else None
    return _at(solved, _whole(solved, packed), "; ".join(notes), used)


def _at(
    solved: Sequence[Unwrapped], layouts: Sequence[NDArray[np.float64]], note: str = "", used: float | None = None
) -> list[Unwrapped]:
    """note: told of the last one. used: the part of the square that all cover."""
    notes = [*[""] * (len(solved) - 1), note]
    return [
        replace(unwrapped, corner_uv=uv, note=said, square_used=used)
        for unwrapped, uv, said in zip(solved, layouts, notes, strict=True)
    ]


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


def write_map(obj: bpy.types.Object, unwrapped: Unwrapped) -> None:
    """Write the coordinates, and store the report on them."""
    found = replace(report_on(unwrapped), texel_density=map_density(unwrapped.region, unwrapped.corner_uv))
    report = reports.joined(reports.find(obj.data), found, unwrapped.region)
    write_uv(obj, unwrapped.region, unwrapped.result.solved, unwrapped.corner_uv)
    reports.store(obj.data, report)


def map_summary(unwrapped: Unwrapped) -> str:
    """A map in one line, with the number of islands that lose their shape in single precision, in which Blender stores
    UVs."""
    summary = unwrap_summary(unwrapped)
    tiny = tiny_findings(unwrapped, unwrapped.corner_uv)
    if tiny:
        count = len(np.unique(unwrapped.result.island[tiny[0].elements.indices]))
        summary += f"; {counted(count, 'island')} too small for UV coordinates to keep in shape"
    return f"{summary}; {unwrapped.note}" if unwrapped.note else summary


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
        square_used=unwrapped.square_used,
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
