# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map has to gain by borders at creases, compared with the usual map without them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..base.arguments import IndexArray
from ..base.progress import Progress
from ..results import Result
from ..surface import Surface
from ..triangles import singular_values, triangle_areas
from .map_comparison import WELL_FILLED, defects, island_count, least_filled, measure_of_filling, worthwhile

# Borders are worth their islands if they remove half of the stretch, and so much of it for each further island; a fifth
# of it without further ones. So many cones that they spare pay for an island, as each has a cut that ends inside; on
# what is small they are hardly seen. What is stretched less than this has none that one sees.
_SEEN_EXCESS = 0.002
_MOST_EXCESS = 0.5
_MOST_EXCESS_WITHOUT_ISLANDS = 0.8
_EXCESS_FOR_ISLAND = 0.004
_CONES_FOR_ISLAND = 2
_LEAST_FILLED_WITH_BORDERS = 0.7
# Of the stretch of maps that are the same but for rounding.
_ROUNDING = 1e-6


class BorderGain(Protocol):
    """A reason for which components may end at creases; each is given by its triangles, (k,).

    progress: of packing, to compare.  Raises Cancelled.
    """

    def may_gain(self, usual: Result, components: Sequence[IndexArray], progress: Progress | None) -> list[bool]:
        """Whether a map with borders is worth a try on each of these components."""

    def gains(self, bordered: Result, usual: Result, components: Sequence[IndexArray]) -> list[bool]:
        """Whether each of these components, all of which end at creases in the first map, gains by that."""

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Whether the map is better as a whole."""


@dataclass(frozen=True, slots=True)
class LessStretch:
    """Maps of the surface that are stretched visibly less.

    square_share: as of `measure_of_filling`.
    """

    surface: Surface
    square_share: float

    def may_gain(self, usual: Result, components: Sequence[IndexArray], progress: Progress | None) -> list[bool]:
        """Those that are stretched visibly: where they are small beside the others, that counts less."""
        weights = _weights(self.surface, usual, components)
        stretches = _stretches(self.surface, usual, components)
        return [weight * (one - 1) > _SEEN_EXCESS for weight, one in zip(weights, stretches, strict=True)]

    def gains(self, bordered: Result, usual: Result, components: Sequence[IndexArray]) -> list[bool]:
        """Where borders halve the excess of L2 stretch over 1, and reduce it by 0.004 for each further island; without
        further ones, where they reduce it by a fifth. On those that are not small, an island for two cones fewer is no
        further one.
        """
        out = []
        weights = _weights(self.surface, usual, components)
        stretches = (_stretches(self.surface, result, components) for result in (bordered, usual))
        for part, weight, one, other in zip(components, weights, *stretches, strict=True):
            more = len(np.unique(bordered.island[part])) - len(np.unique(usual.island[part]))
            if weight == 1:
                more -= max(0, self._cones_on(usual, part) - self._cones_on(bordered, part)) // _CONES_FOR_ISLAND
            most = _MOST_EXCESS if more > 0 else _MOST_EXCESS_WITHOUT_ISLANDS
            out.append(bool(one - 1 <= most * (other - 1) and weight * (other - one) >= _EXCESS_FOR_ISLAND * more))
        return out

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where the map is stretched no more, has no further defects and fills the square at most three tenths less."""
        if not _is_as_good(bordered, usual, usual.distortion.l2_stretch):
            return False
        filled = measure_of_filling(usual, self.square_share, progress)
        return filled(bordered) >= _LEAST_FILLED_WITH_BORDERS * filled(usual)

    def _cones_on(self, result: Result, component: IndexArray) -> int:
        return int(np.isin(result.cones, self.surface.triangles[component]).sum())


@dataclass(frozen=True, slots=True)
class FullerSquare:
    """Maps of the surface that are no worse and fill the square clearly more.

    keeps_few: whether only two islands more, or a tenth more of many, are acceptable. Others: as of `LessStretch`.
    """

    surface: Surface
    square_share: float
    keeps_few: bool

    def may_gain(self, usual: Result, components: Sequence[IndexArray], progress: Progress | None) -> list[bool]:
        """All of them, if more than two fifths of the square are empty."""
        filled = measure_of_filling(usual, self.square_share, progress)
        return [filled(usual) < WELL_FILLED] * len(components)

    def gains(self, bordered: Result, usual: Result, components: Sequence[IndexArray]) -> list[bool]:
        """Where borders cost no stretch: how islands lie in the square depends on all of them."""
        stretches = (_stretches(self.surface, result, components) for result in (bordered, usual))
        return [one <= (1 + _ROUNDING) * other for one, other in zip(*stretches, strict=True)]

    def may_replace(self, bordered: Result, usual: Result, progress: Progress | None) -> bool:
        """Where the usual map, whose square is emptier, does not make up for that by fewer islands."""
        more = island_count(bordered) - island_count(usual)
        has_few = not self.keeps_few or more <= worthwhile(usual)
        if not (has_few and _is_as_good(bordered, usual, (1 + _ROUNDING) * usual.distortion.l2_stretch)):
            return False
        filled = measure_of_filling(usual, self.square_share, progress)
        return filled(usual) < least_filled(-more, bordered) * filled(bordered)


def _is_as_good(bordered: Result, usual: Result, most_l2: float) -> bool:
    return (
        bordered.solved.tolist() == usual.solved.tolist()
        and defects(bordered) <= defects(usual)
        and bordered.distortion.l2_stretch <= most_l2
    )


def _weights(surface: Surface, result: Result, components: Sequence[IndexArray]) -> list[float]:
    """The area of each of these components relative to that of an average island, at most 1."""
    areas = triangle_areas(surface)
    average = areas.sum() / max(1, island_count(result))
    return [min(1.0, float(areas[part].sum() / average)) for part in components]


def _stretches(surface: Surface, result: Result, components: Sequence[IndexArray]) -> list[float]:
    """The L2 stretch of each of these components, at a common scale of its own; NaN where one is not solved."""
    areas = triangle_areas(surface)
    largest, smallest = singular_values(surface, result.corner_uv)
    with np.errstate(divide="ignore", invalid="ignore"):
        image, spread = areas * largest * smallest, areas * (1 / largest**2 + 1 / smallest**2) / 2
        flat = areas == 0
        image[flat] = spread[flat] = 0.0
        return [float(np.sqrt(spread[part].sum() * image[part].sum()) / areas[part].sum()) for part in components]
