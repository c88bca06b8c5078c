# SPDX-License-Identifier: GPL-3.0-or-later
"""What presets choose by: the quality of a map, what each part of it is worth, and the choice among candidates."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from ..base.arguments import FloatArray, IndexArray, number, refuse
from ..base.counted import counted
from ..base.progress import Progress, Steps, share_of, tell
from ..errors import Cancelled, InputError, LsgpError
from ..lattice import island_boxes
from ..layouts.packing import pack_islands, turns_of
from ..results import Choice, Result
from ..surface import Surface
from ..triangles import uv_area
from .components import Components
from .map_comparison import cost_on_lattice, defects, island_count

T = TypeVar("T")

# How far estimates are off, in hundredths of L2 stretch: what is expected to cost more than the best one made by this
# is not made. Half of the estimates of further islands are off by less; most of those of other cones and cuts are too
# low, so that more than this gains nothing.
ERROR_OF_ESTIMATES = 0.15
# What is less is rounding, which is to decide nothing: the first of two such candidates is taken.
_ROUNDING = 0.01
# Up to so many islands each counts in full, of more of them what makes the tenth part.
FEW_ISLANDS = 10


@dataclass(frozen=True, slots=True)
class Weights:
    """What the parts of a map's quality are worth in a choice, in hundredths of L2 stretch.

    islands: each one; a tenth of them where there are more than ten. cuts: those as long as the square root of the
    surface's area. borders: the same at creases, across which the texture does not run on. cones: each one, around
    which it turns; of several components by the square root of their share of the area. square: as much of the texture
    as islands fill, left empty. symmetry: that cuts run alike on both sides of a mirror plane; half of it, that cones
    do.

    A larger weight is obeyed at the cost of the others, 0 is no wish at all.  Raises InputError.
    """

    islands: float = 0.4
    cuts: float = 0.3
    borders: float = 0.3
    cones: float = 0.1
    square: float = 1.2
    symmetry: float = 1.0

    def __post_init__(self) -> None:
        for name in self.__slots__:
            remedy = "pass a finite number that is not negative"
            if not 0 <= number(f"weights.{name}", getattr(self, name), remedy) < math.inf:
                refuse(f"weights.{name}", getattr(self, name), remedy)


@dataclass(frozen=True, slots=True)
class Quality:
    """What came out.

    left_out: triangles without a map. defects: flipped and overlapping triangles, and wrong angle sums. stretch: the
    excess of L2 stretch over 1, in hundredths. islands: their number. cones: theirs, on several components times the
    square roots of their shares of the area. cuts, borders: their length in square
    roots of the area. empty: the area of the texture that is left empty, as a multiple of that which is filled.
    asymmetry: 0 where cuts run alike on both sides of the mirror plane, or there is none; 0.5 where only cones do; 1
    where nothing does. on_lattice: of seamless layouts, what features off the lattice and small tiles cost, in
    hundredths of L2 stretch, less than 0 where they are large.
    """

    left_out: int
    defects: int
    stretch: float
    islands: float
    cuts: float
    borders: float
    cones: float
    empty: float
    asymmetry: float = 0.0
    on_lattice: float = 0.0

    def cost(self, weights: Weights) -> float:
        """In hundredths of L2 stretch."""
        islands = (
            self.islands if self.islands <= FEW_ISLANDS else FEW_ISLANDS * (1 + math.log(self.islands / FEW_ISLANDS))
        )
        return (
            self.stretch
            + weights.islands * islands
            + weights.cuts * self.cuts
            + weights.borders * self.borders
            + weights.cones * self.cones
            + weights.square * self.empty
            + weights.symmetry * self.asymmetry
            + self.on_lattice
        )


@dataclass(frozen=True, slots=True)
class Candidate(Generic[T]):
    """One of several maps to choose from.

    name: for the trace. expected: what it will cost, told without a map, from those made so far; None where it cannot
    be made, or is one of them. make: raises LsgpError where it cannot be made. quality: what came out. name_of: another
    name, by what came out.
    """

    name: str
    expected: Callable[[], float | None]
    make: Callable[[Progress | None], T]
    quality: Callable[[T, Progress | None], Quality]
    name_of: Callable[[T], str] | None = None


class Objective:
    """By which the maps of one surface are compared.

    weights: of its parts. square_share: as of `Options`.
    """

    def __init__(self, weights: Weights, square_share: float = 1.0) -> None:
        self.weights, self._square_share = weights, square_share
        self._known: list[tuple[FloatArray, Quality]] = []  # of maps, by their coordinates
        self.choices: list[Choice] = []
        self._components: Components | None = None  # of the latest surface
        self._bound = math.inf

    def quality(
        self, surface: Surface, result: Result, progress: Progress | None = None, asymmetry: float = 0.0
    ) -> Quality:
        """Of a map of a surface.  progress: of packing.  Raises Cancelled."""
        for known, found in self._known:
            if known is result.corner_uv:
                return replace(found, asymmetry=asymmetry)
        of = self._components_of(surface)
        size = math.sqrt(float(of.areas().sum())) or 1.0
        found = Quality(
            left_out=int(np.count_nonzero(~result.solved)),
            defects=defects(result),
            stretch=100 * (result.distortion.l2_stretch - 1),
            islands=island_count(result),
            cuts=_length(surface, result.cut_edges) / size,
            borders=_length(surface, surface.borders) / size,
            cones=float((of.counts(result.cones) * np.sqrt(of.areas() / of.areas().sum())).sum()),
            empty=1 / max(self.filled(result, progress), 1e-3) - 1,
            on_lattice=cost_on_lattice(result),
        )
        self._known.append((result.corner_uv, found))
        return replace(found, asymmetry=asymmetry)

    def _components_of(self, surface: Surface) -> Components:
        if self._components is None or self._components.surface is not surface:
            self._components = Components.of(surface)
        return self._components

    def costs(self, components: Components, result: Result) -> tuple[FloatArray, FloatArray]:
        """What each component costs in a map, (c,), but for the square and symmetry, and its stretch of that."""
        weights, areas = self.weights, components.areas()
        lengths = weights.cuts * components.lengths(result.cut_edges)
        lengths += weights.borders * components.lengths(result.borders)
        stretch = 100 * components.excess(result)
        costs = stretch + lengths / math.sqrt(areas.sum()) + self.price_of_island(result) * components.islands(result)
        return costs + weights.cones * components.counts(result.cones) * np.sqrt(areas / areas.sum()), stretch

    def price_of_island(self, result: Result) -> float:
        """Of one among those of a map."""
        return self.weights.islands * min(1.0, FEW_ISLANDS / max(1, island_count(result)))

    def filled(self, result: Result, progress: Progress | None = None) -> float:
        """The part of its texture that a map fills: packed, or of several squares and seamless layouts the part of the
        boxes of its islands.  progress: of packing.  Raises Cancelled."""
        if self._square_share <= 1 and result.seamless is None:
            return filled_when_packed(result, progress)
        return filled_boxes(result)

    @contextmanager
    def bounded(self, cost: float) -> Iterator[None]:
        """Meanwhile nothing is made that is expected to cost more than another map does."""
        self._bound = cost
        try:
            yield
        finally:
            self._bound = math.inf

    def note(self, name: str, quality: Quality, estimate: float = math.inf, *, is_best: bool) -> None:
        """Add a map to the trace."""
        self.choices.append(Choice(name, estimate, quality.cost(self.weights), _in_words(quality), is_best))

    def choose(self, candidates: Sequence[Candidate[T]], progress: Progress | None = None) -> T:
        """The candidate with the fewest triangles left out, the fewest defects, and the lowest cost.

        The one that is expected to cost least is made first; then others as long as they may cost less than the best.
        Raises Cancelled, and what the last one raises where none can be made.
        """
        best: T | None = None
        rank = (math.inf, math.inf, math.inf)
        waiting, steps, failed = list(candidates), Steps(progress), None
        while waiting:
            possible = [(estimate, i) for i, one in enumerate(waiting) if (estimate := one.expected()) is not None]
            if not possible:
                break
            estimate, least = min(possible)
            if rank[:2] <= (0, 0) and estimate - ERROR_OF_ESTIMATES >= min(rank[2], self._bound):
                break
            candidate = waiting.pop(least)
            try:
                step = steps.next()
                made = candidate.make(step)
            except Cancelled:
                raise
            except LsgpError as error:
                failed = error
                self.choices.append(Choice(candidate.name, estimate, None, f"is refused: {error.code}"))
                continue
            quality = candidate.quality(made, share_of(step, 1.0, 1.0))
            cost = quality.cost(self.weights)
            own = (quality.left_out, quality.defects, cost)
            is_best = own[:2] < rank[:2] or (own[:2] == rank[:2] and cost < rank[2] - _ROUNDING)
            if is_best:
                best, rank = made, own
            name = candidate.name if candidate.name_of is None else candidate.name_of(made)
            self.note(name, quality, estimate, is_best=is_best)
        for candidate, estimate in zip(waiting, (one.expected() for one in waiting), strict=True):
            if estimate is not None:
                self.choices.append(Choice(candidate.name, estimate, None, "is expected to cost more"))
        if best is None:
            assert failed is not None
            raise failed
        tell(progress, 1.0)
        return best


def _length(surface: Surface, edges: IndexArray) -> float:
    ends = surface.positions[edges]
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


def _in_words(quality: Quality) -> str:
    said = (
        f"stretch {quality.stretch:.2f} %, {counted(int(quality.islands), 'island')}, {quality.cones:.3g} cones, "
        f"cuts {quality.cuts:.2f}, {100 / (1 + quality.empty):.0f} % filled"
    )
    if quality.borders:
        said += f", borders {quality.borders:.2f}"
    if quality.asymmetry:
        said += f", asymmetry {quality.asymmetry:.2g}"
    if quality.defects:
        said += f", {quality.defects} defects"
    return said + (f", {quality.left_out} triangles left out" if quality.left_out else "")


def filled_when_packed(result: Result, progress: Progress | None) -> float:
    """The part of the unit square that islands fill once they are packed quickly; 0 if they cannot be."""
    try:
        packed = pack_islands(
            result.corner_uv, result.island, turned=turns_of(result), effort="quick", progress=progress
        )
    except InputError:
        return 0.0
    return uv_area(packed[result.solved])


def filled_boxes(result: Result) -> float:
    """The part of all their boxes that islands fill."""
    boxes = island_boxes(result.corner_uv, result.island)
    room = float((boxes[:, 2:] - boxes[:, :2]).prod(axis=1).sum())
    return uv_area(result.corner_uv[result.solved]) / room if room > 0 else 1.0
