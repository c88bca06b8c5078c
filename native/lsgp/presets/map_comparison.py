# SPDX-License-Identifier: GPL-3.0-or-later
"""What maps with symmetric cones or cones for creases may cost compared with the usual map."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import side_keys
from ..base.progress import Progress
from ..errors import InputError
from ..lattice import island_boxes
from ..layouts.packing import Turned, pack_islands, turns_of
from ..options import Options
from ..results import Result
from ..surface import Surface
from ..triangles import uv_area
from .components import Components, keys_of

# Of the L2 stretch that the other one has, of the edges that it cuts, and of what it fills of the square: a tenth less
# is a twentieth of the texel density. One island more for so many; one for fewer, or a pair that fills the square as
# well. One of few that is saved is worth a fifth of what is filled, a tenth of the texel density; a pair, or a tenth of
# many, three tenths.
_MOST_L2 = 1.01
_LEAST_FILLED = 0.9
_LEAST_FILLED_BY_ONE_FEWER = 0.8
_LEAST_FILLED_BY_FEWER = 0.7
_MOST_CUTS = 1.25
# Where the other one is stretched as well, far fewer edges cut are worth the stretch that cones are placed for, and
# more of the square.
_FAR_FEWER_CUTS = 0.6
_ISOMETRIC_L2 = 1.001
_TARGET_L2 = 1.05
_LEAST_FILLED_FOR_CUTS = 0.75
ISLANDS_FOR_ONE = 10
# More of the square than this is rarely filled.
WELL_FILLED = 0.6
# Where islands need not be few, those of small meshes are divided otherwise up to here, as that often fills a tenth
# more; on others it takes seconds.
_NEARLY_FILLED = 0.7
SMALL_MESH = 5000  # triangles
# What twice as many islands have to fill in addition where islands need not be few.
_FILLED_FOR_TWICE = 0.3
_PAIR = 2
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


def may_replace_map(
    symmetric: Result, usual: Result, square_share: float = 1.0, progress: Progress | None = None
) -> bool:
    """Whether a map through symmetric cones costs little: L2 stretch up to 1 % more, a quarter more of edges cut, the
    square filled at most a tenth less, no further defects, and one island more, or one for ten if there are as many;
    two of fewer than ten only if the square is not filled less. One island fewer, of fewer than ten, allows for a
    fifth less, and two fewer, or one for ten, for three tenths. If it cuts at most three fifths of the edges, its
    stretch may be up to 1.05 and the square filled a quarter less, unless the other map is isometric.

    Both as from `parameterize`, with islands on shelves, for this share of a square, in which they are packed tightly,
    turned by quarters. How far several squares and seamless layouts are filled follows from the boxes of the islands.
    progress: of packing.  Raises Cancelled.
    """
    islands = island_count(usual)
    more = island_count(symmetric) - islands
    has_few = islands < ISLANDS_FOR_ONE
    saves_cuts = _saves_many_cuts(symmetric, usual)
    most_l2 = _MOST_L2 * usual.distortion.l2_stretch
    if saves_cuts:
        most_l2 = max(most_l2, _TARGET_L2)
    if not (
        is_as_good(symmetric, usual, most_l2)
        and len(symmetric.cut_edges) <= _MOST_CUTS * len(usual.cut_edges)
        and more <= (_PAIR if has_few else islands // ISLANDS_FOR_ONE)
    ):
        return False
    filled = measure_of_filling(usual, square_share, progress, turned="quarters")
    return filled(symmetric) >= least_filled(more, usual, saves_cuts) * filled(usual)


def least_filled(more: int, usual: Result, saves_cuts: bool = False) -> float:
    """How far the square has to be filled with so many more islands, relative to the usual map."""
    if more <= -worthwhile(usual):
        return _LEAST_FILLED_BY_FEWER
    least = _LEAST_FILLED_FOR_CUTS if saves_cuts else _LEAST_FILLED
    if island_count(usual) >= ISLANDS_FOR_ONE or more not in (_PAIR, -1):
        return least
    return 1.0 if more == _PAIR else min(least, _LEAST_FILLED_BY_ONE_FEWER)


def fills_badly(usual: Result, progress: Progress | None = None) -> bool:
    """Whether two fifths of the square, three tenths with a small mesh, stay empty even if it is packed tightly."""
    most = _NEARLY_FILLED if len(usual.island) <= SMALL_MESH else WELL_FILLED
    return _filled_when_packed(usual, progress) < most


def may_replace_undivided(divided: Result, usual: Result, progress: Progress | None = None) -> bool:
    """Whether further divisions are worth their islands, which need not be few: twice as many have to fill three tenths
    more of the square, fewer further ones proportionally less, at L2 stretch up to 1 % more and no further defects.
    progress: of packing.  Raises Cancelled.
    """
    if not is_as_good(divided, usual):
        return False
    islands, more = island_count(usual), island_count(divided) - island_count(usual)
    most = 1 / (1 + _FILLED_FOR_TWICE * max(0, more) / islands)
    return _filled_when_packed(usual, progress) < most * _filled_when_packed(divided, progress)


def is_as_good(other: Result, usual: Result, most_l2: float | None = None) -> bool:
    """Whether another map has the same triangles, no further defects, and up to this L2 stretch; None: 1 % more."""
    if most_l2 is None:
        most_l2 = _MOST_L2 * usual.distortion.l2_stretch
    return (
        other.solved.tolist() == usual.solved.tolist()
        and defects(other) <= defects(usual)
        and other.distortion.l2_stretch <= most_l2
    )


def mirrored_cuts_cost_islands(mirrored: Result, usual: Result) -> bool:
    """Whether a map through symmetric cones with symmetric cuts is stretched little, but has at least two islands more
    than the usual map, a tenth more if there are many: other cuts for the same cones may leave fewer.
    """
    within_stretch = mirrored.distortion.l2_stretch <= _MOST_L2 * usual.distortion.l2_stretch
    return within_stretch and island_count(mirrored) - island_count(usual) >= worthwhile(usual)


def saves_islands(free: Result, mirrored: Result, usual: Result) -> bool:
    """Whether a map with other cuts for symmetric cones has as many islands fewer than the one with symmetric cuts as
    `mirrored_cuts_cost_islands` says.
    """
    return island_count(mirrored) - island_count(free) >= worthwhile(usual)


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


def costs_little(components: Components, symmetric: Result, usual: Result) -> NDArray[np.bool_]:
    """On which components symmetric cones cost little, (c,): L2 stretch up to 1 % more, a quarter more of edges cut,
    and no further islands or defects."""
    stretches, other_stretches = (components.stretches(result) for result in (symmetric, usual))
    return (
        (components.solved(symmetric) == components.solved(usual))
        & (components.defects(symmetric) <= components.defects(usual))
        & (stretches <= _MOST_L2 * other_stretches)
        & (components.cuts(symmetric) <= _MOST_CUTS * components.cuts(usual))
        & (components.islands(symmetric) <= components.islands(usual))
    )


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


def _saves_many_cuts(symmetric: Result, usual: Result) -> bool:
    """Whether it has far fewer, and the other one is stretched for all of its own."""
    has_far_fewer = len(symmetric.cut_edges) <= _FAR_FEWER_CUTS * len(usual.cut_edges)
    return has_far_fewer and usual.distortion.l2_stretch > _ISOMETRIC_L2


def defects(result: Result) -> int:
    return len(result.flipped) + len(result.wrong_angle_sums) + len(result.overlapping)


def worthwhile(usual: Result) -> int:
    """How many islands fewer are worth a less full square, or cuts that are not symmetric."""
    return max(_PAIR, island_count(usual) // ISLANDS_FOR_ONE)


def island_count(result: Result) -> int:
    return len(np.unique(result.island[result.solved]))


def measure_of_filling(
    usual: Result, square_share: float, progress: Progress | None, turned: Turned = True
) -> Callable[[Result], float]:
    """The measure of how well a map that is compared with the usual one fills its part of the square.  turned: as of
    `pack_islands`."""
    if square_share <= 1 and usual.seamless is None:
        return partial(_filled_when_packed, progress=progress, turned=turned)
    return _filled_boxes


def _filled_when_packed(result: Result, progress: Progress | None, turned: Turned = True) -> float:
    """The part of the unit square that the islands fill once they are packed tightly; 0 if they cannot be."""
    allowed = turns_of(result)
    may_turn = turned if allowed is True else allowed
    try:
        packed = pack_islands(result.corner_uv, result.island, turned=may_turn, effort="quick", progress=progress)
    except InputError:
        return 0.0
    return uv_area(packed[result.solved])


def _filled_boxes(result: Result) -> float:
    """The part of all their boxes that islands fill."""
    boxes = island_boxes(result.corner_uv, result.island)
    room = float((boxes[:, 2:] - boxes[:, :2]).prod(axis=1).sum())
    return uv_area(result.corner_uv[result.solved]) / room if room > 0 else 1.0
