# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a map whose islands are to be few is divided to fill the square."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..base.progress import Progress
from ..options import Options
from ..results import Result
from ..surface import Surface
from .components import Components
from .map_comparison import ISLANDS_FOR_ONE, is_as_good, island_count, measure_of_filling

MakeDivided = Callable[[Options], Result | None]

# What each further island has to fill in addition, of many islands a tenth of them; more than so much of the square
# counts for no island.
_MORE_FOR_ONE = 1.2
_WELL_FILLED = 0.53
# Islands are divided as if they had such a part of the square: less of it, and only what saves most is cut.
_SHARES = (0.25, 0.5, 1.0, 2.0)


def worth_of_filling(filled: float, islands: int, fewest: int) -> float:
    """By which divisions are compared of which one has so few islands: the part of the square that is filled, up to
    0.53, as a fifth more of it is worth one island, or a tenth of many."""
    return min(filled, _WELL_FILLED) / _MORE_FOR_ONE ** (islands / _further(fewest))


def best_of_few(
    usual: Result, options: Options, surface: Surface, divide: MakeDivided, progress: Progress | None = None
) -> Result:
    """The map that is worth most: whole, as usual, or divided less or further.

    usual: of the surface, with islands made compact as the options say. divide: makes the map with other options; None
    if it cannot be made. progress: of packing.  Raises Cancelled.
    """
    filled = measure_of_filling(usual, 1.0, progress)
    whole = None
    if island_count(usual) > 1 and island_count(usual) > Components.of(surface).count:
        whole = _as_good(divide(replace(options, compact="off")), usual)
    best = usual if whole is None else whole
    fewest = island_count(best)
    best_worth = worth_of_filling(filled(best), fewest, fewest)
    for share in _SHARES:
        # What has more islands need not be made or packed if it cannot be worth as much.
        expected = island_count(usual) if share == 1 else island_count(best) + 1
        has_room = share >= 1 or expected < island_count(usual)
        if not (has_room and _may_gain(best_worth, fewest, expected)):
            continue
        other = usual if share == 1 else _as_good(divide(replace(options, square_share=share)), usual)
        if other is None or not _may_gain(best_worth, fewest, island_count(other)):
            continue
        worth = worth_of_filling(filled(other), island_count(other), fewest)
        if worth > best_worth:
            best, best_worth = other, worth
    return best


def _may_gain(best_worth: float, fewest: int, islands: int) -> bool:
    return worth_of_filling(1.0, islands, fewest) > best_worth


def _further(fewest: int) -> float:
    """How many further islands count as one."""
    return max(1.0, fewest / ISLANDS_FOR_ONE)


def _as_good(divided: Result | None, usual: Result) -> Result | None:
    """None if it is worse but for its islands."""
    return divided if divided is not None and is_as_good(divided, usual) else None
