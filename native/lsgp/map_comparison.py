# SPDX-License-Identifier: GPL-3.0-or-later
"""What a map with symmetric cones, or with those for creases, may cost compared with the map that it replaces."""

from __future__ import annotations

from functools import partial

import numpy as np

from .api import Result
from .triangles import uv_area

# Of the L2 stretch that the other one has, of the edges that it cuts, and of what it fills of the square; one island
# more for so many.
_MOST_L2 = 1.01
_LEAST_FILLED = 0.97
_MOST_CUTS = 1.25
_ISLANDS_FOR_ONE = 10
_FEW_ISLANDS = 4
# The same for creases along the lattice, and what share of their length has to lie there.
_MOST_L2_FOR_FEATURES = 1.1
_LEAST_FEATURES = 0.25


def may_replace_map(symmetric: Result, usual: Result, square_share: float = 1.0) -> bool:
    """Whether a map through symmetric cones costs little: L2 stretch up to 1 % more, a quarter more of edges cut, one
    island more, or one for ten if there are as many, the square filled at most 3 % less, and no further defects.

    Both as from `parameterize`, with islands on shelves, for this share of a square. How far these fill the square says
    how far they do once they are packed tightly only where they are few and have one square. Elsewhere it is how far
    they fill their boxes, and at most what the longest island leaves them of one square.
    """
    islands = len(np.unique(usual.island[usual.solved]))
    has_one_square = square_share <= 1 and usual.seamless is None
    filled = _filled_square if islands <= _FEW_ISLANDS and has_one_square else partial(_filled_boxes, has_one_square)
    return (
        symmetric.solved.tolist() == usual.solved.tolist()
        and _defects(symmetric) <= _defects(usual)
        and symmetric.distortion.l2_stretch <= _MOST_L2 * usual.distortion.l2_stretch
        and len(symmetric.cut_edges) <= _MOST_CUTS * len(usual.cut_edges)
        and len(np.unique(symmetric.island[symmetric.solved])) <= islands + max(islands // _ISLANDS_FOR_ONE, 1)
        and filled(symmetric) >= _LEAST_FILLED * filled(usual)
    )


def runs_along_features(result: Result) -> bool:
    """Whether a seamless map has a quarter of the length of creases along its lattice."""
    return result.seamless.feature_share is not None and result.seamless.feature_share >= _LEAST_FEATURES


def may_replace_for_features(along: Result, usual: Result) -> bool:
    """Whether a seamless map through cones for creases runs along them, at up to a tenth more of L2 stretch and without
    further defects. Both as from `parameterize`.
    """
    return (
        along.solved.tolist() == usual.solved.tolist()
        and _defects(along) <= _defects(usual)
        and along.distortion.l2_stretch <= _MOST_L2_FOR_FEATURES * usual.distortion.l2_stretch
        and runs_along_features(along)
    )


def _defects(result: Result) -> int:
    return len(result.flipped) + len(result.wrong_angle_sums) + len(result.overlapping)


def _filled_square(result: Result) -> float:
    """The part of the unit square that the islands fill."""
    return uv_area(result.corner_uv[result.solved])


def _filled_boxes(has_one_square: bool, result: Result) -> float:
    """The part that islands fill of all their boxes, or of the square around the longest one, if that is less."""
    uv = result.corner_uv[result.solved]
    if not len(uv):
        return 1.0
    _, island = np.unique(result.island[result.solved], return_inverse=True)
    low, high = np.full((island.max() + 1, 2), np.inf), np.full((island.max() + 1, 2), -np.inf)
    np.minimum.at(low, island.ravel(), uv.min(axis=1))
    np.maximum.at(high, island.ravel(), uv.max(axis=1))
    boxes = float((high - low).prod(axis=1).sum())
    room = max(boxes, float((high - low).max()) ** 2) if has_one_square else boxes
    return uv_area(uv) / room if room > 0 else 1.0
