# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected islands of UV maps in other shapes and places.  Nothing is written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.region import Region
from ...core.text import counted
from ...mesh.reports import Report
from .texels import map_density

if TYPE_CHECKING:
    import lsgp

FloatArray = NDArray[np.float64]

# Longer to shorter side of a cut: up to here both match.
_MATCH = 1 + 1e-4
_NO_ISLAND = "the UV map has no islands there; unwrap the mesh first"


@dataclass(frozen=True, slots=True)
class Map:
    """A UV map, (m, 3, 2) in units of the image's height, and its islands.

    region: all faces. chosen: (m,) bool, the triangles that are asked about. island: (m,), -1 for none.
    """

    region: Region
    chosen: NDArray[np.bool_]
    corner_uv: FloatArray
    island: NDArray[np.int32]

    @property
    def chosen_islands(self) -> NDArray[np.intp]:
        return np.unique(self.island[self.chosen & (self.island >= 0)])

    @property
    def pinned_islands(self) -> NDArray[np.intp]:
        return np.unique(self.island[self.region.pinned.any(axis=1) & (self.island >= 0)])

    @property
    def boxes(self) -> FloatArray:
        return native.lsgp.lattice.island_boxes(self.corner_uv, self.island)


@dataclass(frozen=True, slots=True)
class ChangedMap:
    """corner_uv: (m, 3, 2), as stored. moved: (m,) bool. done: how much was done, in words; empty: nothing was. notes:
    what else is to be told. keeps_tiles: whether islands were moved by whole tiles alone."""

    region: Region
    corner_uv: FloatArray
    moved: NDArray[np.bool_]
    done: str
    notes: list[str] = field(default_factory=list)
    warnings: list[lsgp.Finding] = field(default_factory=list)
    keeps_tiles: bool = False


def read_map(region: Region, chosen: NDArray[np.bool_]) -> Map:
    """Raises LsgpError; Refused where nothing is mapped there."""
    uv = region.corner_uv * _unit(region)
    found = Map(region, chosen, uv, native.lsgp.measure_distortion(region.surface, uv).island)
    if not len(found.chosen_islands):
        raise Refused(_NO_ISLAND)
    return found


def with_islands_of(found: Map, vertices: NDArray[np.int32]) -> Map:
    """With all triangles of the islands that have these vertices as chosen ones.  Raises Refused."""
    at = np.isin(found.region.surface.triangles, vertices).any(axis=1) & (found.island >= 0)
    if not at.any():
        raise Refused(_NO_ISLAND)
    return replace(found, chosen=np.isin(found.island, np.unique(found.island[at])))


def shaped(found: Map, shape: str, corners: Sequence[int] | NDArray[np.int32] = ()) -> ChangedMap:
    """The chosen faces in another shape.  shape, corners: as of `lsgp.shape_patches`.  Raises LsgpError."""
    region = found.region
    pinned = np.flatnonzero(region.pinned.ravel())
    triangles = np.flatnonzero(found.chosen & (found.island >= 0))
    result = native.lsgp.shape_patches(
        region.surface, found.corner_uv, triangles, shape, corners=corners, pinned=pinned
    )
    moved = np.zeros(len(found.island), bool)
    moved[result.moved] = True
    return changed_map(found, result.corner_uv, moved, counted(result.patches, "patch", "patches"), result.warnings)


def turned(found: Map, turns: FloatArray, tiles: Tiles | None) -> ChangedMap:
    """The chosen islands turned about their middles, but for those with pins; (islands,) radians.

    tiles: those of a seamless layout, in which islands are turned only so that they match as before.
    """
    wanted, kept = _free(found)
    of_free = np.isin(np.arange(len(turns)), wanted)
    turns = np.where(of_free, turns, 0.0)
    if tiles is not None:
        step = 2 * math.pi / tiles.rotation_order
        turns = np.round(turns / step) * step
    uv = native.lsgp.turn_islands(found.corner_uv, found.island, turns)
    if tiles is not None:
        uv = _on_tiles(found, uv, turns, tiles)
    moved = (uv != found.corner_uv).any(axis=(1, 2)) & (found.island >= 0)
    return changed_map(found, uv, moved, _turned_text(turns, wanted), notes=kept)


def upright_turns(found: Map, up: FloatArray) -> FloatArray:
    """(islands,) the turns after which v runs along a direction of the region's shape, (3,)."""
    return native.lsgp.upright_turns(found.region.surface, found.corner_uv, found.island, up)


def turns_along(found: Map, edge: tuple[int, int]) -> FloatArray:
    """(islands,) the turns after which the islands at an edge have it upright, as little as that takes; 0 of others."""
    triangles = found.region.surface.triangles
    turns = np.zeros(int(found.island.max()) + 1)
    for triangle in np.flatnonzero(np.isin(triangles, edge).sum(axis=1) == 2).tolist():
        island = found.island[triangle]
        if island < 0:
            continue
        first, second = (found.corner_uv[triangle][triangles[triangle] == end][0] for end in edge)
        angle = math.pi / 2 - math.atan2(*(second - first)[::-1].tolist())
        turns[island] = (angle + math.pi / 2) % math.pi - math.pi / 2
    return turns


@dataclass(frozen=True, slots=True)
class Tiles:
    """Of a seamless layout: as in its certificate."""

    rotation_order: int
    cell: float


def tiles_of(report: Report | None) -> Tiles | None:
    certificate = None if report is None else report.certificate
    return None if certificate is None else Tiles(certificate["rotation_order"], certificate["cell"])


def island_of_face(found: Map, face: int) -> int | None:
    """The chosen island that has a face of the mesh; None where none has."""
    islands = found.island[found.chosen & (found.region.triangle_faces == face) & (found.island >= 0)]
    return int(islands[0]) if len(islands) else None


def aligned(
    parts: Sequence[Map], side: str, tiles: Sequence[Tiles | None], active: tuple[int, int] | None = None
) -> list[ChangedMap]:
    """The chosen islands of all maps with one side, as of `lsgp.align_islands`, on one line; pinned ones stay, and give
    the line, unless one is active, which then gives it. Those of seamless layouts move by whole tiles, as near to it as
    these permit.

    active: the map, and the island of it."""
    boxes = [part.boxes[part.chosen_islands] for part in parts]
    place, island = active or (-1, -1)
    stays = np.concatenate([np.isin(part.chosen_islands, part.pinned_islands) for part in parts])
    is_active = np.concatenate([(part.chosen_islands == island) & (i == place) for i, part in enumerate(parts)])
    moves = native.lsgp.align_islands(np.concatenate(boxes), side, fixed=stays if active is None else is_active)
    moves[stays] = 0.0
    outcomes = []
    of_part = np.split(moves, np.cumsum([len(rows) for rows in boxes])[:-1])
    for part, rows, of_tiles in zip(parts, of_part, tiles, strict=True):
        if of_tiles is not None:
            rows = native.lsgp.lattice.whole_cells(rows, of_tiles.rotation_order, of_tiles.cell)
        shift = np.zeros((int(part.island.max()) + 2, 2))
        shift[part.chosen_islands] = rows
        uv = part.corner_uv + shift[part.island][:, None]
        moved = (shift[part.island] != 0).any(axis=1)
        done = counted(len(rows), "island") + " aligned"
        outcomes.append(replace(changed_map(part, uv, moved, done), keeps_tiles=of_tiles is not None))
    return outcomes


def stitched(found: Map, edges: NDArray[np.int32]) -> ChangedMap:
    """The islands on both sides of edges, (e, 2), joined; pinned ones stay.  Raises LsgpError; Refused where there is
    nothing to join."""
    surface = found.region.surface
    result = native.lsgp.stitch_islands(surface, found.corner_uv, found.island, edges, fixed=found.pinned_islands)
    if not result.joined:
        if result.pinned.any():
            raise Refused("the islands on both sides are pinned; unpin one")
        if result.within.any():
            raise Refused("both sides of the cut are of one island and cannot be joined by moving it; unwrap again")
        raise Refused("no selected edge is cut between two islands; select some that are")
    notes = []
    if result.inexact:
        notes.append(
            f"{counted(result.inexact, 'island')} scaled to fit, as the sides did not match; the texture shows it"
        )
    if result.within.any():
        notes.append(f"{counted(int(result.within.sum()), 'edge')} left cut, as both sides are of one island")
    if result.pinned.any():
        notes.append(f"{counted(int(result.pinned.sum()), 'edge')} left cut between pinned islands")
    return changed_map(found, result.corner_uv, result.moved, f"{counted(result.joined, 'island')} joined", notes=notes)


def ripped_patches(found: Map) -> NDArray[np.int32]:
    """(m,) numbers of the patches of the chosen faces, that are to be islands of their own; -1 for all others.

    Raises Refused where they are islands already.
    """
    inside = found.chosen & (found.island >= 0)
    whole = ~np.isin(found.island, found.island[~found.chosen & (found.island >= 0)])
    taken = inside & ~whole
    if not taken.any():
        raise Refused("the selected faces are whole islands already; select a part of one")
    if (taken & found.region.pinned.any(axis=1)).any():
        raise Refused("some of the selected faces are pinned and cannot be moved away; unpin them")
    numbers = np.full(len(inside), -1, np.int32)
    uv = np.where(taken[:, None, None], found.corner_uv, np.nan)
    numbers[taken] = native.lsgp.measure_distortion(found.region.surface, uv).island[taken]
    return numbers


def changed_map(
    found: Map,
    corner_uv: FloatArray,
    moved: NDArray[np.bool_],
    done: str,
    warnings: Sequence[lsgp.Finding] = (),
    notes: Sequence[str] = (),
) -> ChangedMap:
    """corner_uv: (m, 3, 2) in units of the image's height. moved: (m,) bool, the triangles that have new ones."""
    stored = np.where(moved[:, None, None], corner_uv / _unit(found.region), found.region.corner_uv)
    return ChangedMap(found.region, stored, moved, done, list(notes), list(warnings))


def report_on_changed(report: Report, changed: ChangedMap, found: lsgp.Measurement) -> Report:
    """The report on a map that was changed.  found: measured on it."""
    return replace(
        report,
        islands=int(found.island.max(initial=-1)) + 1,
        flipped=np.unique(changed.region.triangle_faces[found.flipped]).tolist(),
        distortion=asdict(found.distortion),
        seams=asdict(found.seams),
        certificate=report.certificate if changed.keeps_tiles else None,
        texel_density=map_density(changed.region, changed.corner_uv),
        overlaps_known=False,
        square_used=None,
    )


def transition_notes(report: Report | None, changed: ChangedMap, found: lsgp.Measurement) -> list[str]:
    """What is to be told of the cuts of a map that matched.  found: measured on it.  Raises LsgpError."""
    before = native.lsgp.measure_distortion(changed.region.surface, changed.region.corner_uv).seams
    if before.sister_ratio_max <= _MATCH < found.seams.sister_ratio_max:
        return ["the texture no longer continues across all cuts"]
    if report is not None and report.certificate is not None and not changed.keeps_tiles:
        return ["the layout is no longer certified as seamless"]
    return []


def _unit(region: Region) -> FloatArray:
    """By which stored coordinates are multiplied to be those of an image as high as 1."""
    return np.array([region.image_aspect, 1.0])


def _free(found: Map) -> tuple[NDArray[np.intp], list[str]]:
    """The chosen islands without pins, and what is told of the others.  Raises Refused where there are none."""
    wanted = np.setdiff1d(found.chosen_islands, found.pinned_islands)
    if not len(wanted):
        raise Refused("the islands are pinned; unpin them")
    left = len(found.chosen_islands) - len(wanted)
    return wanted, [f"{counted(left, 'pinned island')} left alone"] if left else []


def _turned_text(turns: FloatArray, wanted: NDArray[np.intp]) -> str:
    count = int((turns[wanted] != 0).sum())
    return f"{counted(count, 'island')} turned" if count else "islands are upright already"


def _on_tiles(found: Map, uv: FloatArray, turns: FloatArray, tiles: Tiles) -> FloatArray:
    """With the islands that were turned, by the lattice's rotations about their middles, where tiles match."""
    lattice, island = native.lsgp.lattice, found.island
    out = uv.copy()
    if tiles.rotation_order not in (2, 4):
        return out
    for number in np.flatnonzero(turns).tolist():
        inside = island == number
        quarters = round(turns[number] / (math.pi / 2))
        z = found.corner_uv[inside] @ np.array([1, 1j]) * (1, 1j, -1, -1j)[quarters % 4]
        turned_uv = np.stack([z.real, z.imag], axis=-1)
        away = uv[inside].mean(axis=(0, 1)) - turned_uv.mean(axis=(0, 1))
        out[inside] = turned_uv + lattice.whole_cells(away, tiles.rotation_order, tiles.cell)
    return out
