# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map with symmetric cones, or with those for creases, may cost compared with the map that it replaces."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from .api import Progress, Result
from .errors import InputError
from .lattice import island_boxes
from .packing import pack_islands, packer_name
from .triangles import uv_area

# Of the L2 stretch that the other one has, of the edges that it cuts, and of what it fills of the square: a tenth less
# is a twentieth of the texel density. One island more for so many; one for fewer, or a pair that fills the square as
# well.
_MOST_L2 = 1.01
_LEAST_FILLED = 0.9
_MOST_CUTS = 1.25
_ISLANDS_FOR_ONE = 10
_PAIR = 2
# More than this lie on shelves too differently to compare them; packing more than that takes long.
_FEW_ISLANDS = 4
_MOST_PACKED = 32
# The same for creases along the lattice, and what share of their length has to lie there.
_MOST_L2_FOR_FEATURES = 1.1
_LEAST_FEATURES = 0.25
_MOST_FEATURES = 0.95


def may_replace_map(
    symmetric: Result, usual: Result, square_share: float = 1.0, progress: Progress | None = None
) -> bool:
    """Whether a map through symmetric cones costs little: L2 stretch up to 1 % more, a quarter more of edges cut, the
    square filled at most a tenth less, no further defects, and one island more, or one for ten if there are as many;
    two of fewer than ten only if the square is not filled less.

    Both as from `parameterize`, with islands on shelves, for this share of a square. They are packed tightly if the
    packer is installed. How far many islands, several squares and seamless layouts are filled follows from the boxes of
    the islands, and in one square from the longest island. progress: of packing.  Raises Cancelled.
    """
    islands = _island_count(usual)
    more = _island_count(symmetric) - islands
    has_few = islands < _ISLANDS_FOR_ONE
    if not (
        symmetric.solved.tolist() == usual.solved.tolist()
        and _defects(symmetric) <= _defects(usual)
        and symmetric.distortion.l2_stretch <= _MOST_L2 * usual.distortion.l2_stretch
        and len(symmetric.cut_edges) <= _MOST_CUTS * len(usual.cut_edges)
        and more <= (_PAIR if has_few else islands // _ISLANDS_FOR_ONE)
    ):
        return False
    least = 1.0 if has_few and more == _PAIR else _LEAST_FILLED
    filled = _measure_of_filling(usual, square_share, progress)
    return filled(symmetric) >= least * filled(usual)


def runs_along_features(result: Result) -> bool:
    """Whether a seamless map has a quarter of the length of marked features along its lattice, or of creases if none
    are marked."""
    return _feature_share(result) >= _LEAST_FEATURES


def releases_features(result: Result | None) -> bool:
    """Whether a seamless map has more than a twentieth of that length off its lattice."""
    return result is not None and _feature_share(result) < _MOST_FEATURES


def _feature_share(result: Result) -> float:
    if result.features is not None:
        return result.features.share
    return result.seamless.feature_share or 0.0


def may_replace_for_features(along: Result, usual: Result) -> bool:
    """Whether a seamless map through cones for features runs along them, at up to a tenth more of L2 stretch and
    without further defects; at least as far as the usual one. Both as from `parameterize`.
    """
    if _feature_share(usual) > _feature_share(along):
        return False
    return (
        along.solved.tolist() == usual.solved.tolist()
        and _defects(along) <= _defects(usual)
        and along.distortion.l2_stretch <= _MOST_L2_FOR_FEATURES * usual.distortion.l2_stretch
        and runs_along_features(along)
    )


def _defects(result: Result) -> int:
    return len(result.flipped) + len(result.wrong_angle_sums) + len(result.overlapping)


def _island_count(result: Result) -> int:
    return len(np.unique(result.island[result.solved]))


def _measure_of_filling(usual: Result, square_share: float, progress: Progress | None) -> Callable[[Result], float]:
    """What tells how far a map that is compared with the usual one fills its part of the square."""
    islands = _island_count(usual)
    has_one_square = square_share <= 1 and usual.seamless is None
    if has_one_square and islands <= _MOST_PACKED and packer_name() is not None:
        return partial(_filled_when_packed, progress=progress)
    return _filled_square if has_one_square and islands <= _FEW_ISLANDS else partial(_filled_boxes, has_one_square)


def _filled_when_packed(result: Result, progress: Progress | None) -> float:
    """The part of the unit square that the islands fill once they are packed tightly; 0 if they cannot be."""
    turned = result.direction_error is None
    try:
        packed = pack_islands(result.corner_uv, result.island, turned=turned, progress=progress)
    except InputError:
        return 0.0
    return uv_area(packed[result.solved])


def _filled_square(result: Result) -> float:
    """The part of the unit square that the islands fill."""
    return uv_area(result.corner_uv[result.solved])


def _filled_boxes(has_one_square: bool, result: Result) -> float:
    """The part that islands fill of all their boxes, or of the square around the longest one, if that is less."""
    boxes = island_boxes(result.corner_uv, result.island)
    size = boxes[:, 2:] - boxes[:, :2]
    room = float(size.prod(axis=1).sum())
    if has_one_square:
        room = max(room, float(size.max(initial=0.0)) ** 2)
    return uv_area(result.corner_uv[result.solved]) / room if room > 0 else 1.0
