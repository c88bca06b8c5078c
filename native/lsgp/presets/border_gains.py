# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map has to gain by borders at creases, compared with the usual map without them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress
from ..results import Result
from .components import Components, keys_of
from .map_comparison import (
    SMALL_MESH,
    WELL_FILLED,
    has_direction,
    is_as_good,
    island_count,
    least_filled,
    measure_of_filling,
    run_along_axes,
    seamless_worth,
    worthwhile,
)

# Borders are worth their islands if they remove half of the stretch, and so much of it for each further island; a fifth
# of it without further ones. So many cones that they spare pay for an island, as each has a cut that ends inside; on
# what is small they are hardly seen. What is stretched less than this has none that one sees.
_SEEN_EXCESS = 0.002
_MOST_EXCESS = 0.5
_MOST_EXCESS_WITHOUT_ISLANDS = 0.8
_EXCESS_FOR_ISLAND = 0.004
_CONES_FOR_ISLAND = 2
_LEAST_FILLED_WITH_BORDERS = 0.7
# Share of creases along the lattice that is worth as much as a texture that runs on across them.
_WORTH_OF_RUNNING_ON = 0.15
_MOST_L2 = 1.1
# Of the area, where the mesh is not small: seamless layouts take long, and what is smaller is hardly seen.
_LEAST_AREA = 0.05
# Of the stretch of maps that are the same but for rounding.
_ROUNDING = 1e-6


class BorderGain(Protocol):
    """A reason for which components may end at creases.

    chosen: (k,) numbers of components. progress: of packing, to compare.  Raises Cancelled.
    """

    def may_gain(self, usual: Result, chosen: NDArray[np.intp], progress: Progress | None) -> NDArray[np.bool_]:
        """Whether a map with borders is worth a try on each of these components, (k,)."""

    def gains(self, bordered: Result, usual: Result, chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Whether each of these components, all of which end at creases in the first map, gains by that, (k,)."""

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Whether the map is better as a whole."""


@dataclass(frozen=True, slots=True)
class LessStretch:
    """Maps of the surface that are stretched visibly less.

    components: of the surface. square_share: as of `measure_of_filling`.
    """

    components: Components
    square_share: float

    def may_gain(self, usual: Result, chosen: NDArray[np.intp], progress: Progress | None) -> NDArray[np.bool_]:
        """Those that are stretched visibly: where they are small beside the others, that counts less."""
        excess = self.components.stretches(usual)[chosen] - 1
        return self._weights(usual)[chosen] * excess > _SEEN_EXCESS

    def gains(self, bordered: Result, usual: Result, chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Where borders halve the excess of L2 stretch over 1, and reduce it by 0.004 for each further island; without
        further ones, where they reduce it by a fifth. On those that are not small, an island for two cones fewer is no
        further one.
        """
        of = self.components
        weights = self._weights(usual)
        spared = np.maximum(0, of.counts(usual.cones) - of.counts(bordered.cones)) // _CONES_FOR_ISLAND
        more = of.islands(bordered) - of.islands(usual) - np.where(weights == 1, spared, 0)
        most = np.where(more > 0, _MOST_EXCESS, _MOST_EXCESS_WITHOUT_ISLANDS)
        one, other = (of.stretches(result) for result in (bordered, usual))
        with np.errstate(invalid="ignore"):
            gain = (one - 1 <= most * (other - 1)) & (weights * (other - one) >= _EXCESS_FOR_ISLAND * more)
        return gain[chosen]

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where the map is stretched no more, has no further defects and fills the square at most three tenths less."""
        if not is_as_good(bordered, usual, usual.distortion.l2_stretch):
            return False
        filled = measure_of_filling(usual, self.square_share, progress)
        return filled(bordered) >= _LEAST_FILLED_WITH_BORDERS * filled(usual)

    def _weights(self, result: Result) -> FloatArray:
        """The area of each component relative to that of an average island, at most 1."""
        areas = self.components.areas()
        return np.minimum(1.0, areas / (areas.sum() / max(1, island_count(result))))


@dataclass(frozen=True, slots=True)
class FullerSquare:
    """Maps of the surface that are no worse and fill the square clearly more.

    keeps_few: whether only two islands more, or a tenth more of many, are acceptable. Others: as of `LessStretch`.
    """

    components: Components
    square_share: float
    keeps_few: bool

    def may_gain(self, usual: Result, chosen: NDArray[np.intp], progress: Progress | None) -> NDArray[np.bool_]:
        """All of them, if more than two fifths of the square are empty."""
        filled = measure_of_filling(usual, self.square_share, progress)
        return np.full(len(chosen), filled(usual) < WELL_FILLED)

    def gains(self, bordered: Result, usual: Result, chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Where borders cost no stretch: how islands lie in the square depends on all of them."""
        one, other = (self.components.stretches(result)[chosen] for result in (bordered, usual))
        return one <= (1 + _ROUNDING) * other

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where the usual map, whose square is emptier, does not make up for that by fewer islands."""
        more = island_count(bordered) - island_count(usual)
        has_few = not self.keeps_few or more <= worthwhile(usual)
        if not (has_few and is_as_good(bordered, usual, (1 + _ROUNDING) * usual.distortion.l2_stretch)):
            return False
        filled = measure_of_filling(usual, self.square_share, progress)
        return filled(usual) < least_filled(-more, bordered) * filled(bordered)


@dataclass(frozen=True, slots=True)
class AlongLattice:
    """Seamless maps of the surface whose marked features, or creases if none are marked, run along the lattice, at
    little stretch and with large tiles.

    components: of the surface. borders: (b, 2), the possible ones.
    """

    components: Components
    borders: IndexArray

    def may_gain(self, usual: Result, chosen: NDArray[np.intp], progress: Progress | None) -> NDArray[np.bool_]:
        """Those many of whose creases do not, or that are stretched by more than a tenth, if they are not small."""
        is_stretched = self.components.stretches(usual) > _MOST_L2
        shares = self._shares(usual, self._creases(usual))
        return self._if_large((is_stretched | ~has_direction(shares))[chosen], chosen)

    def gains(self, bordered: Result, usual: Result, chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Where that is worth that the texture does not run on across their creases, if they are not small."""
        creases = self._creases(bordered, usual)
        one, other = (
            seamless_worth(self._shares(result, creases), self.components.stretches(result), result)
            for result in (bordered, usual)
        )
        return self._if_large((one >= other + _WORTH_OF_RUNNING_ON)[chosen], chosen)

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where all have gained, and it has no further defects."""
        return is_as_good(bordered, usual, np.inf)

    def _if_large(self, is_some: NDArray[np.bool_], chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        areas = self.components.areas()
        is_large = areas[chosen][is_some].sum() >= _LEAST_AREA * areas.sum()
        return is_some & (is_large or len(self.components.surface.triangles) <= SMALL_MESH)

    def _creases(self, *results: Result) -> IndexArray:
        """The marked features, (e, 2), or the possible borders and the creases found in any of these."""
        if len(self.components.surface.features):
            return self.components.surface.features
        edges = np.concatenate([self.borders, *(result.seamless.creases for result in results)])
        return edges[np.unique(keys_of(edges, self.components.surface), return_index=True)[1]]

    def _shares(self, result: Result, edges: IndexArray) -> FloatArray:
        """Of the length of each component's edges, (e, 2) in all, what runs along the lattice, (c,); 1 without any."""
        every, along = (
            self.components.lengths(some)
            for some in (edges, edges[run_along_axes(self.components.surface, result, edges)])
        )
        return np.where(every > 0, along / np.where(every > 0, every, 1), 1.0)
