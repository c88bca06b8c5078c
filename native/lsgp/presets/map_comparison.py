# SPDX-License-Identifier: GPL-3.0-or-later
"""What maps whose features run along u and v, or that follow strokes, may cost compared with the usual map."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import side_keys
from ..options import Options
from ..results import Result
from ..surface import Surface
from .components import Components, keys_of

# Of the L2 stretch that the other one has.
_MOST_L2 = 1.01
# The same for creases along the lattice, and what share of their length has to lie there.
_MOST_L2_FOR_FEATURES = 1.1
_LEAST_FEATURES = 0.25
_MOST_FEATURES = 0.95
_MANY_FEATURES = 0.9
# Shares of features that are worth as much as L2 stretch of 1, and as tiles twice as large.
_FEATURES_FOR_STRETCH = 2.5
_FEATURES_FOR_TILES = 0.25
# Where more creases than these are off the lattice, as on a coarse model of a round shape, the texture has no direction
# in common with them, and those along it are worth half.
_FEATURES_IN_COMMON = 0.75
_WORTH_WITHOUT_DIRECTION = 0.5
# The same for strokes, and the mean angle to them that is worth another map, radians.
_MOST_L2_FOR_STROKES = 1.1
LEAST_DIRECTION_ERROR = 0.01
# Of the length of an edge along an axis.
_ROUNDING = 1e-6


def is_as_good(other: Result, usual: Result, most_l2: float | None = None) -> bool:
    """Whether another map has the same triangles, no further defects, and up to this L2 stretch; None: 1 % more."""
    if most_l2 is None:
        most_l2 = _MOST_L2 * usual.distortion.l2_stretch
    return (
        other.solved.tolist() == usual.solved.tolist()
        and defects(other) <= defects(usual)
        and other.distortion.l2_stretch <= most_l2
    )


def runs_along_features(result: Result) -> bool:
    """Whether a seamless map has a quarter of the length of marked features along its lattice, or of creases if none
    are marked."""
    return feature_share(result) >= _LEAST_FEATURES


def releases_features(result: Result | None) -> bool:
    """Whether a seamless map has more than a twentieth of that length off its lattice."""
    return result is not None and feature_share(result) < _MOST_FEATURES


def releases_many_features(result: Result) -> bool:
    """Whether a seamless map has more than a tenth of that length off its lattice."""
    return feature_share(result) < _MANY_FEATURES


def feature_share(result: Result) -> float:
    """Of the length of marked features, or of creases if none are marked: what runs along the lattice."""
    if result.features is not None:
        return result.features.share
    return result.seamless.feature_share or 0.0


def may_replace_for_features(along: Result, usual: Result) -> bool:
    """Whether a seamless map through cones for features runs along them, at up to a tenth more of L2 stretch and
    without further defects; at least as far as the usual one. Both as from `parameterize`.
    """
    if feature_share(usual) > feature_share(along):
        return False
    most_l2 = _most_growth(feature_share(usual)) * usual.distortion.l2_stretch
    return is_as_good(along, usual, most_l2) and runs_along_features(along)


def may_replace_straighter(straighter: Result, usual: Result) -> bool:
    """Whether a map that is not seamless has more of its marked features along u and v and is worth more for that, at
    up to a tenth more of L2 stretch and without further islands or defects."""
    gain = feature_share(straighter) - feature_share(usual)
    cost = straighter.distortion.l2_stretch - usual.distortion.l2_stretch
    return (
        is_as_good(straighter, usual, _MOST_L2_FOR_FEATURES * usual.distortion.l2_stretch)
        and island_count(straighter) <= island_count(usual)
        and gain > max(0.0, _FEATURES_FOR_STRETCH * cost)
    )


def follows_strokes_better(toward: Result, usual: Result) -> bool:
    """Whether a map whose angles are chosen for the surface's directions is nearer to them by 0.01 radians or more, at
    up to a tenth more of L2 stretch, and without further islands or defects."""
    return (
        is_as_good(toward, usual, _MOST_L2_FOR_STROKES * usual.distortion.l2_stretch)
        and island_count(toward) <= island_count(usual)
        and direction_error(toward) < direction_error(usual) - LEAST_DIRECTION_ERROR
    )


def direction_error(result: Result) -> float:
    """The mean angle to the surface's directions, radians; 0 without any."""
    return result.direction_error or 0.0


def has_direction(share: FloatArray | float) -> NDArray[np.bool_] | bool:
    """Whether most creases run along the lattice, with this share of them."""
    return share >= _FEATURES_IN_COMMON


def worth_along_features(result: Result) -> float:
    """By which seamless maps are compared: features along the lattice, little stretch, and large tiles everywhere."""
    return float(seamless_worth(feature_share(result), result.distortion.l2_stretch, result))


def seamless_worth(share: FloatArray | float, l2_stretch: FloatArray | float, result: Result) -> FloatArray:
    """The same of parts of the result with these shares of features and these stretches."""
    is_uneven = any(finding.code == "HIGH_DISTORTION" for finding in result.warnings)
    return (
        share * np.where(has_direction(share), 1.0, _WORTH_WITHOUT_DIRECTION)
        - _FEATURES_FOR_STRETCH * np.asarray(l2_stretch)
        + _FEATURES_FOR_TILES * (math.log2(result.seamless.tile_size) - is_uneven)
    )


def cost_on_lattice(result: Result, *, even: bool = False) -> float:
    """What a seamless layout is worth but for its stretch, in hundredths of L2 stretch; 0 for other ones.

    even: as if tiles were as large on all components.
    """
    if result.seamless is None:
        return 0.0
    if even:
        result = replace(result, warnings=[])
    return -100 * float(seamless_worth(feature_share(result), 0.0, result)) / _FEATURES_FOR_STRETCH


def run_along_axes(surface: Surface, result: Result, edges: IndexArray) -> NDArray[np.bool_]:
    """Whether edges, (e, 2), are parallel to u or v, on one of their sides at least."""
    along = np.abs(np.roll(result.corner_uv, -1, axis=1) - result.corner_uv).reshape(-1, 2)
    with np.errstate(invalid="ignore"):
        is_along = along.min(axis=1) <= _ROUNDING * along.max(axis=1)
    return np.isin(keys_of(edges, surface), side_keys(surface.triangles, len(surface.positions))[is_along])


def reached_up_to(target: float, result: Result, options: Options) -> float:
    """The L2 stretch up to which a map reaches a target that is meant for conformal ones, which are judged when cones
    are placed: low stretch may reach it where these do not, and features along the lattice may cost a tenth."""
    if result.seamless is not None and runs_along_features(result):
        return _MOST_L2_FOR_FEATURES * target
    return target if options.mode == "low-stretch" else 0.0


def gains_features(components: Components, along: Result, usual: Result, is_straightened: bool) -> NDArray[np.bool_]:
    """On which components the map through cones for features may replace the usual one, (c,), by the same measures.

    is_straightened: whether features run along the lattice in the usual one as far as they can.
    """
    shares, other_shares = (_feature_shares(components, result) for result in (along, usual))
    stretches, other_stretches = (components.stretches(result) for result in (along, usual))
    return (
        (shares >= np.maximum(other_shares, _LEAST_FEATURES))
        & (components.solved(along) == components.solved(usual))
        & (components.defects(along) <= components.defects(usual))
        & (stretches <= (_most_growth(other_shares) if is_straightened else _MOST_L2_FOR_FEATURES) * other_stretches)
    )


def _most_growth(share: FloatArray | float) -> FloatArray:
    """Of the L2 stretch through cones for features, from a map with this share of features along the lattice: these
    cones may cost a tenth, and features, where none are along it yet, another."""
    return np.where(share >= _LEAST_FEATURES, 1.0, _MOST_L2_FOR_FEATURES) * _MOST_L2_FOR_FEATURES


def _feature_shares(components: Components, result: Result) -> FloatArray:
    """The `feature_share` of each component, 0 without features."""
    report = result.features
    if report is not None:
        every = components.lengths(components.surface.features)
        paths = [np.stack([one.path[:-1], one.path[1:]], axis=1) for one in report.released]
        off = components.lengths(np.concatenate([np.empty((0, 2), np.int32), *paths]))
    else:
        every = components.lengths(result.seamless.creases)
        off = components.lengths(result.seamless.creases[~result.seamless.is_crease_aligned])
    return np.where(every > 0, 1 - off / np.where(every > 0, every, 1), 0.0)


def defects(result: Result) -> int:
    """Flipped and overlapping triangles, and wrong angle sums."""
    return len(result.flipped) + len(result.wrong_angle_sums) + len(result.overlapping)


def island_count(result: Result) -> int:
    """Of those that have a map."""
    return len(np.unique(result.island[result.solved]))
