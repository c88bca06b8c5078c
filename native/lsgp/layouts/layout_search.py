# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest layout of islands among those with different turns."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress, Steps, share_of, tell
from ..triangles import uv_area
from .chart_packer import Islands, Layout, Packer, Square
from .island_gaps import ComplexArray, border_edges

# Whether islands may be turned, or by quarters alone.
Turned = bool | Literal["quarters"]

# Ways to turn islands that are tried, by quarter turns and then by any; of many islands fewer, since each takes longer.
_TRIES = 24, 12
_ISLANDS_OF_ALL_TRIES = 64
# Of the islands of the best layout, so many keep their turn when some are turned.
_KEPT = 0.7
_QUARTER_TURNS = np.array([1, 1j, -1, -1j])
# Within a quarter turn; by so much the square around an island may be larger than with the best of them.
_DIRECTIONS = np.exp(0.5j * np.pi * np.arange(90) / 90)
_AS_SMALL = 1e-3
# Where so little of the square is filled, sides along the axes are given up for a layout whose side is so much shorter,
# as of strips along the diagonal. Unfolded boxes fill more.
HARDLY_FILLED = 0.3
SHORTER_UNALIGNED = 0.9
# Of an edge along an axis, radians; coordinates may come from files of few digits.
_TILT = 1e-3


def islands_of(uv: FloatArray, island: IndexArray) -> Islands:
    """uv: (m, 3, 2), finite. island: (m,), of any number each."""
    _, of_triangle = np.unique(island, return_inverse=True)
    corners, owner = uv.reshape(-1, 2) + 0.0, np.repeat(of_triangle.ravel(), 3)  # -0.0 is 0.0
    order = np.lexsort((corners[:, 1], corners[:, 0], owner))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(owner[order]) != 0) | (np.diff(corners[order], axis=0) != 0).any(axis=1)
    vertices = np.empty(len(order), np.int64)
    vertices[order] = np.cumsum(new) - 1
    place = corners[order[new]] @ np.array([1, 1j])
    triangles = vertices.reshape(-1, 3)
    triangle, corner = border_edges(triangles)
    return Islands(
        place=place,
        triangles=triangles,
        island=owner[order[new]],
        borders=np.stack([triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]], axis=1),
        area=uv_area(uv),
    )


class LayoutSearch:
    """Looks for the smallest layout of islands.  Those turned by quarters are looked for once: maps are compared so
    turned, and then the chosen one is packed with any turns, of which quarters are tried first.
    """

    def __init__(
        self,
        islands: Islands,
        square: Square,
        progress: Progress | None = None,
        *,
        island_count: int | None = None,
    ) -> None:
        """progress: of preparing them. island_count: of all squares together, if these are those of one of several; the
        more there are, the fewer turns are tried in each.  Raises Cancelled."""
        self.islands, self._square = islands, square
        self._all_islands = island_count or islands.count
        self._packer = Packer(islands, square, progress)
        # The best layout, its turns, and where the random numbers stand.
        self._by_quarters: tuple[Layout, ComplexArray, Any] | None = None

    def best(self, may_turn: Turned, progress: Progress | None) -> Layout:
        """The smallest of the layouts tried.  Raises InputError, Cancelled.

        may_turn: True: islands that lie along the axes, as straight sides do, are turned by quarters as well, unless
            that leaves most of the square empty.
        """
        count = self.islands.count
        sharing = max(self._all_islands, _ISLANDS_OF_ALL_TRIES)
        middle, free = (max(1, tries * _ISLANDS_OF_ALL_TRIES // sharing) for tries in _TRIES)
        tries = middle if may_turn else 1
        by_quarters = self._by_quarters if may_turn else None
        begin = 0 if by_quarters is None else middle
        if may_turn is True:
            least = begin / (middle + max(2, free))
            turning = share_of(progress, least, least)
            is_aligned, sides = lie_along_axes(self.islands), sides_when_turned(self.islands, turning)
            squarest = _DIRECTIONS[(sides <= (1 + _AS_SMALL) * sides.min(axis=0)).argmax(axis=0)]
            tries += 2 if is_aligned.all() else free
        # The generator whose numbers never change with the version of numpy.
        random = np.random.RandomState(0)
        best: Layout | None = None
        turns = best_turns = np.ones(count, np.complex128)
        if by_quarters is not None:
            best, best_turns, numbers = by_quarters
            random.set_state(numbers)
        for number in range(begin, tries):
            tell(progress, number / tries)
            shorter = 1.0
            if number == middle:
                turns = np.where(is_aligned, best_turns, squarest)
            elif number == middle + 1 and self.islands.area < HARDLY_FILLED * best.side**2:
                turns, shorter = squarest, SHORTER_UNALIGNED
            elif number == 1:
                turns = np.full(count, 1j)
            elif number > 1:
                # Half of the first ones from the best so far, of which some islands are turned, and all of the others.
                kept = random.random_sample(count) < _KEPT if number % 2 or number > middle else np.zeros(count, bool)
                further = _QUARTER_TURNS[random.randint(0, 4, count)]
                if number > middle:
                    kept[random.randint(count)] = False
                    fits = sides < best.side * (1 - 2 * self._square.share(best.side))
                    direction = _DIRECTIONS[(random.random_sample(sides.shape) * fits).argmax(axis=0)]
                    further = np.where(is_aligned, further, direction * further)
                turns = np.where(kept, best_turns, further)
            steps = Steps(share_of(progress, number / tries, (number + 1) / tries))
            found = self._packer.improved(turns, best, steps, shorter)
            if found is not None:
                best, best_turns = found, turns
            if number == middle - 1:
                self._by_quarters = best, best_turns, random.get_state()
        tell(progress, 1.0)
        return best


def lie_along_axes(islands: Islands) -> NDArray[np.bool_]:
    """(islands,), whether most of the border of each is parallel to one of the axes."""
    edges = islands.place[islands.borders[:, 1]] - islands.place[islands.borders[:, 0]]
    length, island = np.abs(edges), islands.island[islands.borders[:, 0]]
    along = np.minimum(np.abs(edges.real), np.abs(edges.imag)) <= _TILT * length
    whole, aligned = (np.bincount(island, of, islands.count) for of in (length, along * length))
    return 2 * aligned >= whole


def sides_when_turned(islands: Islands, progress: Progress | None = None) -> FloatArray:
    """(directions, islands), of the square around each island, turned into each direction.

    progress: without time of its own.  Raises Cancelled.
    """
    # Islands that are closed have no border, but count.
    ends = np.union1d(islands.borders, np.unique(islands.island, return_index=True)[1])
    around = replace(islands, place=islands.place[ends], island=islands.island[ends])
    sides = np.empty((len(_DIRECTIONS), islands.count))
    for number, turn in enumerate(_DIRECTIONS):
        tell(progress, 0.0)
        size = around.boxes(around.place * turn)[1]
        sides[number] = np.maximum(size.real, size.imag)
    return sides
