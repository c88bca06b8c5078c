# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands spread over several UDIM tiles, all of them at one scale, so that they become as large as possible."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress, Steps, share_of, tell
from ..errors import InputError
from ..triangles import uv_areas
from .chart_packer import Indices, Islands, Layout, Square
from .layout_search import LayoutSearch, Turned, islands_of
from .texels import TILES_IN_ROW

# How often an island is moved from the fullest tile to the emptiest at most, and what each move has to gain.
_MOST_MOVES = 8
_GAIN = 0.995
# By how much the side of all tiles grows until all fit with margins of one width.
_GROWTH = 1.01
_MOST_GROWTHS = 100
# Of the time of a search: preparing its islands.
_PREPARING = 0.2


@dataclass(frozen=True, slots=True)
class _Tile:
    """Islands of a tile and their layout."""

    islands: Islands
    layout: Layout


@dataclass(frozen=True, slots=True)
class _Spread:
    """The tile of each island, (islands,), and the tiles, each with a layout of its own size."""

    tile: Indices
    tiles: list[_Tile]

    @property
    def side(self) -> float:
        """Of the largest."""
        return max(one.layout.side for one in self.tiles)


def spread_over_tiles(
    uv: FloatArray,
    island: IndexArray,
    margin: float,
    tiles: int,
    may_turn: Turned,
    progress: Progress | None,
) -> FloatArray:
    """The coordinates, (m, 3, 2), in this many tiles, or in fewer if more do not make islands larger.

    uv: (m, 3, 2). island: (m,), 0 or more. margin: around each island, of a tile's side.
    Raises InputError where margins leave no room, Cancelled.
    """
    number = np.unique(island, return_inverse=True)[1].ravel()
    area = np.bincount(number, uv_areas(uv))
    search = _Search(uv, number, margin, may_turn, progress)
    spread = _fewest_tiles(search, area, _evened_out(search, area, min(tiles, len(area))))
    side, found = _of_one_side(search, spread)
    out = np.empty_like(uv)
    for t, one in enumerate(found):
        row, column = divmod(t, TILES_IN_ROW)
        place = (one.layout.place - one.layout.low) / side + complex(column, row)
        out[spread.tile[number] == t] = np.stack([place.real, place.imag], axis=-1)[one.islands.triangles] + margin
    tell(progress, 1.0)
    return out


def _evened_out(search: _Search, area: FloatArray, tiles: int) -> _Spread:
    """Islands distributed over this many tiles that need about the same side.  area: (islands,)."""
    tile = _shared_out(area, tiles)
    found = [search.filled(tile == t) for t in range(tiles)]
    for _ in range(_MOST_MOVES):
        sides = np.array([one.layout.side for one in found])
        pair = int(sides.argmax()), int(sides.argmin())
        moved = _with_one_moved(area, tile, *pair)
        if moved is None:
            break
        tried = [search.filled(moved == t) for t in pair]
        if max(one.layout.side for one in tried) > sides.max() * _GAIN:
            break
        tile = moved
        found[pair[0]], found[pair[1]] = tried
    return _Spread(tile, found)


def _fewest_tiles(search: _Search, area: FloatArray, spread: _Spread) -> _Spread:
    """Without tiles that are there for nothing, where an island that is alone in one decides how large all get."""
    sides = [one.layout.side for one in spread.tiles]
    if spread.tiles[int(np.argmax(sides))].islands.count > 1:
        return spread
    low, high = 1, len(spread.tiles)
    while low < high:
        middle = (low + high) // 2
        fewer = _evened_out(search, area, middle)
        if fewer.side <= max(sides) / _GAIN:
            spread, high = fewer, middle
        else:
            low = middle + 1
    return spread


def _shared_out(area: FloatArray, tiles: int) -> Indices:
    """(islands,), the tile of each: the largest island first, to the tile that has least, of those without area to one
    without islands. So none is empty.  tiles: no more than islands."""
    tile = np.empty(len(area), np.int64)
    filled = [(0.0, False, t) for t in range(tiles)]  # its area, and whether it has islands
    for i in np.argsort(-area, kind="stable").tolist():
        least, _, tile[i] = filled[0]
        heapq.heapreplace(filled, (least + area[i], True, tile[i]))
    return tile


def _with_one_moved(area: FloatArray, tile: Indices, fullest: int, emptiest: int) -> Indices | None:
    """The tiles of islands with one moved from the fullest to the emptiest, that which evens their areas out best; None
    where the fullest has but one, or is the emptiest."""
    candidates = np.flatnonzero(tile == fullest)
    if len(candidates) == 1 or fullest == emptiest:
        return None
    surplus = area[candidates].sum() - area[tile == emptiest].sum()
    moved = tile.copy()
    moved[candidates[np.abs(area[candidates] - surplus / 2).argmin()]] = emptiest
    return moved


def _of_one_side(search: _Search, spread: _Spread) -> tuple[float, list[_Tile]]:
    """The side of all tiles, and their layouts with margins as wide as it asks for.  Raises InputError."""
    side = spread.side
    if search.margin == 0 or len(spread.tiles) == 1:
        return side, spread.tiles
    for _ in range(_MOST_GROWTHS):
        side *= _GROWTH
        found = [
            search.run(spread.tile == t, Square(search.margin * side, fill=False)) for t in range(len(spread.tiles))
        ]
        largest = max(one.layout.side for one in found)
        if largest <= side:
            return side, found
        side = largest
    raise InputError(
        "WRONG_PARAMETER",
        f"With a margin of {search.margin:.4g} the islands do not fit into tiles. Pass a smaller margin.",
    )


class _Search:
    """Looks for layouts of some islands, and tells progress as a part of the searches that may be needed."""

    def __init__(
        self,
        uv: FloatArray,
        number: Indices,
        margin: float,
        may_turn: Turned,
        progress: Progress | None,
    ) -> None:
        """uv: (m, 3, 2). number: (m,), the island of each triangle. margin: of a tile's side."""
        self.margin = margin
        self._uv, self._number, self._may_turn = uv, number, may_turn
        self._island_count = int(number.max()) + 1
        self._steps = Steps(progress)

    def filled(self, wanted: NDArray[np.bool_]) -> _Tile:
        """The islands that are wanted, (islands,), in as small a tile as is found.  Raises InputError, Cancelled."""
        return self.run(wanted, Square(self.margin, fill=True))

    def run(self, wanted: NDArray[np.bool_], square: Square) -> _Tile:
        """The same with another margin."""
        inside, progress = wanted[self._number], self._steps.next()
        islands = islands_of(self._uv[inside], self._number[inside])
        preparing = share_of(progress, 0.0, _PREPARING)
        search = LayoutSearch(islands, square, preparing, island_count=self._island_count)
        return _Tile(islands, search.best(self._may_turn, share_of(progress, _PREPARING, 1.0)))
