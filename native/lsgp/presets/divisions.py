# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the islands of a map are divided to fill the square."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from ..api import Solver
from ..base.progress import Progress, share_of
from ..options import Options
from ..results import Result
from .completed_cones import CompletedCones
from .components import Components
from .objective import Candidate, Objective

# Where the square stays empty, islands are divided as if they had so many of them.
_SQUARES = 2.0
# What is expected of other divisions: about the medians of 172. Further ones fill more, up to so much of the square.
_ISLANDS_OF_MORE, _FILLED_BY_MORE, _MOST_FILLED = 1.4, 1.15, {"sparing": 0.55, "full": 0.72}
_ISLANDS_OF_LESS, _FILLED_BY_LESS = 0.6, {"sparing": 0.7, "full": 0.85}


@dataclass(frozen=True, slots=True)
class _Division:
    """Another one of the same map.  islands, filled: as multiples of those of the usual one."""

    name: str
    options: Options
    islands: float
    filled: float


def best_division(
    solver: Solver,
    cones: CompletedCones,
    usual: Result,
    options: Options,
    objective: Objective,
    progress: Progress | None = None,
) -> Result:
    """The map through these cones with its islands divided as they were, further, or less: what costs least.

    usual: the map with these options. progress: without time of its own.  Raises Cancelled.
    """
    if options.compact == "off" or options.square_share != 1 or options.seamless is not None:
        return usual
    surface = solver.surface
    least = Components.of(surface).count
    still = share_of(progress, 1.0, 1.0)
    quality = objective.quality(surface, usual, still)
    others = [
        _Division("further islands", replace(options, square_share=_SQUARES), _ISLANDS_OF_MORE, _FILLED_BY_MORE),
        _Division(
            "fewer islands",
            replace(options, compact="off" if options.compact == "sparing" else "sparing"),
            _ISLANDS_OF_LESS,
            _FILLED_BY_LESS.get(options.compact, 1.0),
        ),
    ]

    def expected(other: _Division) -> float | None:
        filled = 1 / (1 + quality.empty)
        islands = quality.islands * other.islands
        if other.islands < 1:
            if quality.islands <= least:
                return None
            islands = max(float(least), islands)
        else:
            islands = max(quality.islands + 1.0, islands)
        most = max(filled, _MOST_FILLED.get(options.compact, 0.0))
        then = replace(quality, islands=islands, empty=1 / min(most, filled * other.filled) - 1)
        return then.cost(objective.weights)

    def candidate(name: str, make: Callable[[], Result], estimate: Callable[[], float | None]) -> Candidate[Result]:
        return Candidate(name, estimate, lambda _: make(), partial(objective.quality, surface))

    def divided(other: _Division) -> Callable[[], Result]:
        return lambda: cones.told(cones.parameterize(solver, other.options, None, still), options)

    candidates = [candidate("islands as they are", lambda: usual, lambda: 0.0)]
    candidates += [candidate(other.name, divided(other), lambda other=other: expected(other)) for other in others]
    return objective.choose(candidates, still)
