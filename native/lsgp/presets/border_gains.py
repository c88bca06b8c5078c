# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map has to gain by borders at creases, compared with the usual map without them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress
from ..base.unique_rows import unique_rows
from ..results import Result
from .components import Components, keys_of
from .map_comparison import (
    has_direction,
    is_as_good,
    run_along_axes,
    seamless_worth,
)
from .objective import ERROR_OF_ESTIMATES, Objective, Quality

# More of the square than this is rarely filled.
_WELL_FILLED = 0.65
# Share of creases along the lattice that is worth as much as a texture that runs on across them.
_WORTH_OF_RUNNING_ON = 0.15
_MOST_L2 = 1.1
# Of the area, where the mesh is not small: seamless layouts take long, and what is smaller is hardly seen.
_LEAST_AREA = 0.05
SMALL_MESH = 5000  # triangles


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
class LowerCost:
    """Maps of the surface that cost less.

    components: of the surface. borders: (b, 2), the possible ones. objective: by which maps are compared.
    """

    components: Components
    borders: IndexArray
    objective: Objective

    def may_gain(self, usual: Result, chosen: NDArray[np.intp], progress: Progress | None) -> NDArray[np.bool_]:
        """Those that are expected to cost less: they keep a tenth of their stretch, are as many islands as pieces
        between creases, and fill the square well if they do not."""
        of, weights = self.components, self.objective.weights
        surface = of.surface
        opened = replace(surface, borders=np.concatenate([surface.borders, self.borders]))
        pieces = Components.of(opened).of_triangle
        of_piece = unique_rows(np.stack([of.of_triangle, pieces], axis=1)[(of.of_triangle >= 0) & (pieces >= 0)]).rows
        count = np.bincount(of_piece[:, 0], minlength=of.count)
        present, stretch = self.objective.costs(of, usual)
        expected = 0.1 * stretch + self.objective.price_of_island(usual) * count
        expected += weights.borders * of.lengths(self.borders) / math.sqrt(of.areas().sum())
        of_square = weights.square * max(0.0, self._quality(usual, progress).empty + 1 - 1 / _WELL_FILLED)
        return (present - expected + of_square * of.areas() / of.areas().sum())[chosen] > -ERROR_OF_ESTIMATES

    def gains(self, bordered: Result, usual: Result, chosen: NDArray[np.intp]) -> NDArray[np.bool_]:
        """All of them if the whole map costs less, otherwise those that do."""
        is_best = self.may_replace(bordered, usual, None)
        self.objective.note("boundaries at creases", self._quality(bordered, None), is_best=is_best)
        if is_best:
            return np.ones(len(chosen), bool)
        one, other = (self.objective.costs(self.components, result)[0] for result in (bordered, usual))
        return (one < other)[chosen]

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where it costs less as a whole, with no further defects."""
        return is_as_good(bordered, usual, np.inf) and self.cost(bordered, progress) < self.cost(usual, progress)

    def cost(self, result: Result, progress: Progress | None) -> float:
        """Of a map of the surface that may end at borders.  progress: of packing.  Raises Cancelled."""
        return self._quality(result, progress).cost(self.objective.weights)

    def _quality(self, result: Result, progress: Progress | None) -> Quality:
        bordered = replace(self.components.surface, borders=result.borders)
        return self.objective.quality(bordered, result, progress)


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
