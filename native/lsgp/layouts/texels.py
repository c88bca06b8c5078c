# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density: the number of texels per unit of length on the surface; and layouts of a given density."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.frozen import set_field
from ..errors import Elements, Finding, InputError
from ..lattice import island_boxes
from ..results import Result
from ..surface import Surface
from ..triangles import singular_values, triangle_areas

MOST_TILES = 100
"""A UDIM number counts tiles in rows of ten; more rows than ten are not in use."""
TILES_IN_ROW = 10
DEFAULT_MARGIN = 4.0
"""Texels around each island."""

# Rounding of sums of sizes, in tiles.
_ROUNDING = 1e-12
# Units in the last place of single precision that an island of some shape spans: less than half a texel of the largest
# textures, 65536, at the far end of the square.
_LEAST_UNITS = 100


@dataclass(frozen=True, slots=True)
class TexelDensity:
    """Texels per unit of length of a map: the square root of texels per area.

    minimum, median, maximum: over the triangles with an area, the median by area on the surface. mean: of the map as a
    whole, all its texels over the whole area.
    """

    minimum: float
    median: float
    maximum: float
    mean: float


@dataclass(frozen=True, slots=True)
class TexelLayout:
    """A layout of a given texel density, in place of one that fills the unit square.

    density: `TexelDensity.mean` of the whole layout, texels per unit of length. texture_size: side of the texture or of
    each UDIM tile, in texels. udim: the most UDIM tiles that islands are spread over, from 1001 on, each island inside
    one tile; None: islands are not rearranged. margin: texels around each island, with udim.
    Raises InputError: WRONG_PARAMETER.
    """

    density: float
    texture_size: int
    udim: int | None = None
    margin: float = DEFAULT_MARGIN

    def __post_init__(self) -> None:
        density = arguments.positive("density", self.density, "pass texels per unit of length, above 0")
        size = arguments.whole_number("texture_size", self.texture_size, 1, "pass the number of texels of a side")
        margin = arguments.number("margin", self.margin, "pass texels around each island")
        tiles = None if self.udim is None else tile_count(self.udim)
        if not 0 <= margin < (math.inf if tiles is None else size / 2):
            arguments.refuse("margin", self.margin, "pass texels around each island, less than half a tile")
        for name, value in {"density": density, "texture_size": size, "udim": tiles, "margin": margin}.items():
            set_field(self, name, value)


def tile_count(udim: int) -> int:
    """A number of UDIM tiles.  Raises InputError."""
    remedy = f"pass a number of tiles from 1 to {MOST_TILES}"
    count = arguments.whole_number("udim", udim, 1, remedy)
    if count > MOST_TILES:
        arguments.refuse("udim", udim, remedy)
    return count


def refuse_of_seamless() -> NoReturn:
    """Raises InputError: a seamless layout has its own texel density."""
    raise InputError(
        "WRONG_PARAMETER",
        "A seamless layout has the size of its tiles. Choose that by tiles or tile_size, or leave the texel density "
        "out.",
    )


def triangle_texel_density(surface: Surface, corner_uv: ArrayLike, texture_size: float | Sequence[float]) -> FloatArray:
    """(m,) texels per unit of length on each triangle; NaN if it has no area on the surface or no coordinates.

    corner_uv: (m, 3, 2). texture_size: side of the texture in texels, or its width and its height.
    Raises InputError.
    """
    unit, surface = _of_unit_size(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    # Areas of coordinates of any size can be computed in a unit of theirs.
    extent = float(np.abs(uv).max(initial=0.0, where=np.isfinite(uv))) or 1.0
    largest, smallest = singular_values(surface, uv / extent)
    in_units = np.sqrt(largest) * np.sqrt(smallest)
    # What has no area has no texels, however large the unit is.
    with np.errstate(over="ignore"):
        return np.multiply(in_units, _side(texture_size) * (extent / unit), out=in_units, where=in_units != 0)


def texel_density(surface: Surface, corner_uv: ArrayLike, texture_size: float | Sequence[float]) -> TexelDensity:
    """The texel density of a map.  Arguments and errors as for `triangle_texel_density`; NO_UV if nothing is mapped.

    Triangles without area on the surface or without coordinates do not count.
    """
    densities = triangle_texel_density(surface, corner_uv, texture_size)
    counted = ~np.isnan(densities)
    if not counted.any():
        raise InputError("NO_UV", "No triangle has an area and texture coordinates. Unwrap the surface first.")
    areas, densities = triangle_areas(_of_unit_size(surface)[1])[counted], densities[counted]
    order = np.argsort(densities, kind="stable")
    below = np.cumsum(areas[order])
    middle = order[np.searchsorted(below, below[-1] / 2)]
    largest = densities.max()
    share = densities / largest if largest > 0 else densities
    return TexelDensity(
        minimum=float(densities.min()),
        median=float(densities[middle]),
        maximum=float(largest),
        mean=float(largest * math.sqrt((areas * share**2).sum() / areas.sum())),
    )


def at_texel_density(surface: Surface, result: Result, layout: TexelLayout) -> Result:
    """The result with its layout at a texel density: one scale for all islands, so that cuts still match.

    Without `layout.udim` the layout keeps its arrangement and its corner at the origin; if it is larger than the
    square, ISLANDS_OUTSIDE is among the warnings. With it, islands lie in rows in tiles 1001, 1002, ..., without
    rotation. ISLANDS_TINY names islands that do not keep their shape in single precision, as at a low density beside
    wide margins.
    Raises InputError: WRONG_PARAMETER, also for seamless layouts, whose size is given by their tiles; ISLAND_TOO_LARGE
    if one does not fit a tile; TOO_FEW_TILES.
    """
    arguments.require_type("result", result, Result)
    arguments.require_type("layout", layout, TexelLayout)
    if result.seamless is not None:
        refuse_of_seamless()
    with np.errstate(over="ignore", invalid="ignore"):
        mean = texel_density(surface, result.corner_uv, layout.texture_size).mean
        uv = result.corner_uv * np.divide(layout.density, mean)
        extent = 2 * np.abs(uv[result.solved]).max(initial=0.0) * layout.texture_size  # at most
    if not np.isfinite(extent):
        arguments.refuse("density", layout.density, "pass fewer texels per unit, which is more than numbers can hold")
    if layout.udim is None:
        outside = outside_findings(uv, result.island)
        return with_tiny_findings(replace(result, corner_uv=uv, warnings=[*result.warnings, *outside]))
    boxes = island_boxes(uv, result.island)
    shifts = _tile_places(boxes, result.island, layout)
    solved = result.island >= 0
    uv[solved] += shifts[result.island[solved], None]
    return with_tiny_findings(replace(result, corner_uv=uv))


def _of_unit_size(surface: Surface) -> tuple[float, Surface]:
    """The largest coordinate and the surface in this unit, whose areas can be computed whatever its size is. Texels are
    counted in space, whatever the scale of the metric."""
    arguments.require_type("surface", surface, Surface)
    surface = replace(surface, scale=None)
    unit = float(np.abs(surface.positions).max(initial=0.0))
    return (unit, replace(surface, positions=surface.positions / unit)) if 0 < unit < math.inf else (1.0, surface)


def _side(texture_size: float | Sequence[float]) -> float:
    """Side of a square with as many texels."""
    remedy = "pass texels of a side, above 0, or of width and height"
    if arguments.is_number(texture_size):
        return arguments.positive("texture_size", texture_size, remedy)
    try:
        width, height = texture_size
    except (TypeError, ValueError):
        arguments.refuse("texture_size", texture_size, remedy)
    sides = (arguments.positive("texture_size", side, remedy) for side in (width, height))
    return math.prod(map(math.sqrt, sides))


def outside_findings(uv: FloatArray, island: IndexArray) -> list[Finding]:
    """The warning of islands outside the unit square, where there are any."""
    boxes = island_boxes(uv, island)
    outside = (boxes[:, :2] < -_ROUNDING).any(axis=1) | (boxes[:, 2:] > 1 + _ROUNDING).any(axis=1)
    count = int(outside.sum())
    if not count:
        return []
    message = (
        f"{_of_islands(count, len(boxes))} outside the unit square: at this texel density the layout reaches "
        f"up to {np.nanmax(uv):.4g}. Lower it, take a larger texture, or spread the islands over UDIM tiles."
    )
    return [Finding("ISLANDS_OUTSIDE", message, _triangles_of(np.flatnonzero(outside), island))]


def _tile_places(boxes: FloatArray, island: IndexArray, layout: TexelLayout) -> FloatArray:
    """(islands, 2), moves of islands into rows in UDIM tiles, the highest first.  Raises InputError."""
    texture_size, margin = layout.texture_size, layout.margin
    free = margin / texture_size
    sizes = boxes[:, 2:] - boxes[:, :2] + 2 * free
    large = np.flatnonzero((sizes > 1 + _ROUNDING).any(axis=1))
    if len(large):
        width, height = (sizes[large[np.argmax(sizes[large].max(axis=1))]] * texture_size).tolist()
        most = layout.density * ((texture_size - 2 * margin) / (max(width, height) - 2 * margin))
        raise InputError(
            "ISLAND_TOO_LARGE",
            f"{_of_islands(len(large), len(boxes))} larger than a tile: the largest is {_texels(width)} x "
            f"{_texels(height)} texels with its margin, a tile {texture_size} x {texture_size}. Lower the texel "
            f"density to {_rounded_down(most)}, take a larger texture, or cut it by seams.",
            _triangles_of(large, island),
        )
    places, tile_of = _rows_in_tiles(sizes)
    needed = int(tile_of.max(initial=-1)) + 1
    tiles = layout.udim
    if needed > tiles:
        raise InputError(
            "TOO_FEW_TILES",
            f"At this texel density the islands take {needed} tiles of {texture_size} x {texture_size} texels, and "
            f"there {'is 1' if tiles == 1 else f'are {tiles}'}. Take {needed} tiles or a larger texture, or lower "
            "the texel density.",
            _triangles_of(np.flatnonzero(tile_of >= tiles), island),
        )
    return places + free + np.stack([tile_of % TILES_IN_ROW, tile_of // TILES_IN_ROW], axis=1) - boxes[:, :2]


def _rows_in_tiles(sizes: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """(k, 2), the lower left corners of boxes in their tiles, and (k,), these tiles: each box, the highest first, lies
    in the first row that has room for it.  sizes: (k, 2), at most 1."""
    places, tile_of = np.empty((len(sizes), 2)), np.empty(len(sizes), np.int64)
    # Of each row: its tile, its lower end, and where it is free from.
    rows = np.empty((len(sizes), 3))
    count = 0
    tops: list[float] = []
    for i in np.argsort(-sizes[:, 1], kind="stable").tolist():
        width, height = sizes[i]
        fits = np.flatnonzero(rows[:count, 2] + width <= 1 + _ROUNDING)
        if len(fits):
            row = fits[0]
        else:
            tile = next((k for k, top in enumerate(tops) if top + height <= 1 + _ROUNDING), len(tops))
            if tile == len(tops):
                tops.append(0.0)
            row, count = count, count + 1
            rows[row] = tile, tops[tile], 0.0
            tops[tile] += height
        tile_of[i], places[i] = rows[row, 0], (rows[row, 2], rows[row, 1])
        rows[row, 2] += width
    return places, tile_of


def tiny_islands(uv: FloatArray, island: IndexArray) -> NDArray[np.intp]:
    """The islands that single precision, in which files and programs store coordinates, does not keep in shape there.

    uv: (m, 3, 2). island: (m,), -1 for none."""
    boxes = island_boxes(uv, island)
    with np.errstate(invalid="ignore", over="ignore"):
        unit = np.spacing(np.abs(boxes).max(axis=1).astype(np.float32))
        return np.flatnonzero((boxes[:, 2:] - boxes[:, :2]).max(axis=1) < _LEAST_UNITS * unit)


def with_tiny_findings(result: Result) -> Result:
    """A result that warns of the islands that are tiny in its layout, and no longer of others."""
    others = [finding for finding in result.warnings if finding.code != "ISLANDS_TINY"]
    return replace(result, warnings=[*others, *tiny_findings(result.corner_uv, result.island)])


def tiny_findings(uv: FloatArray, island: IndexArray) -> list[Finding]:
    """The warning of tiny islands, where there are any.  Arguments as above."""
    tiny = tiny_islands(uv, island)
    if not len(tiny):
        return []
    message = (
        f"{_of_islands(len(tiny), int(island.max()) + 1)} so small in the layout that they lose their shape where "
        "coordinates are stored in single precision, as in most files and programs. Unwrap these parts separately, or "
        "delete them if they are debris."
    )
    return [Finding("ISLANDS_TINY", message, _triangles_of(tiny, island))]


def _of_islands(count: int, total: int) -> str:
    return f"{count} of {total} islands {'is' if count == 1 else 'are'}"


def _texels(count: float) -> str:
    """All digits that matter."""
    return f"{count:.0f}" if count < 1e9 else f"{count:.3g}"


def _rounded_down(value: float) -> str:
    """With four digits, never more than the value."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 3)
    return f"{math.floor(value / unit) * unit:.4g}"


def _triangles_of(islands: NDArray[np.integer], island: IndexArray) -> Elements:
    return Elements("triangles", np.flatnonzero(np.isin(island, islands)).astype(np.int32))
