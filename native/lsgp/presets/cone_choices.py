# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones among which the map decides: usual ones, symmetric ones, and those for features that run along u and v."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..api import Solver
from ..base.arguments import FloatArray
from ..base.progress import Progress, share_of
from ..errors import Elements, Finding
from ..options import Options
from ..results import Result
from ..surface import Pins, Surface, surface_arrays
from ..triangles import triangle_areas
from .completed_cones import TARGET, CompletedCones, GivenCones, complete_cones, or_none
from .components import Components
from .map_comparison import (
    cost_on_lattice,
    feature_share,
    gains_features,
    has_direction,
    may_replace_for_features,
    may_replace_straighter,
    releases_features,
    runs_along_features,
    worth_along_features,
)
from .objective import Candidate, Objective, Quality

MapThrough = tuple[CompletedCones, Result]

# Of the time of cones and maps: where those for features are placed, and then placing cones.
_FEATURES = 0.1
PLACING = 0.6
_TRYING = 0.5
# By which a map without creases along the lattice has to be better, where most run along it.
_WORTH_OF_DIRECTION = 0.15
# Of the islands of one map, what is hoped of another; over 88 pairs of maps the mean is 0.95.
_ISLANDS_OF_OTHERS = 0.75
# Of the stretch that cones are placed for, what low stretch leaves: 0.25 to 0.57 on 22 meshes.
_LOW_STRETCH = 0.5
# What tells that a component is not symmetric.
_ODD = "NOT_SYMMETRIC"


def follows_features(surface: Surface, options: Options) -> bool:
    """Whether marked features or creases of hard surfaces are to run along the lattice."""
    is_square = options.seamless is not None and options.seamless.lattice == "square"
    has_features = options.straighten or len(surface.features) > 0
    return is_square and has_features and options.prescription is None and not len(surface.seams)


def straightens_marked(surface: Surface, options: Options) -> bool:
    """Whether marked features are to run along u and v of a map that is not seamless."""
    is_low_stretch = options.seamless is None and options.mode == "low-stretch"
    has_features = len(surface.features) > 0 and not len(surface.seams)
    return is_low_stretch and has_features and options.prescription is None and options.border == "free"


def feature_cones(
    solver: Solver, options: Options, progress: Progress | None = None, target: float = TARGET
) -> CompletedCones | None:
    """Cones with which marked features and, in seamless layouts with `Options.straighten`, creases of hard surfaces can
    run along u and v, and those of `complete_cones` on other components; None without features, or if there are no such
    cones.

    target: for the others, as of `place_cones`.
    """
    arrays = surface_arrays(solver.surface)
    has_creases = options.straighten and options.seamless is not None
    chosen = or_none(lambda: _lsgp.feature_cones(arrays, has_creases, share_of(progress, 0.0, _TRYING)))
    if chosen is None or not len(chosen[0]):
        return None
    given = GivenCones.of(*chosen, target=target)
    return or_none(lambda: complete_cones(solver, given, options, share_of(progress, _TRYING, 1.0)))


def best_map(
    solver: Solver,
    given: GivenCones,
    options: Options,
    objective: Objective,
    pins: Pins | None = None,
    progress: Progress | None = None,
    *,
    symmetric: bool = False,
) -> MapThrough:
    """The best map through the given cones and others where these do not suffice: usual ones, symmetric ones, or those
    with which features can run along u and v, or along the lattice of seamless layouts.

    Of several components, only those have cones for features that gain by them.
    symmetric: whether to try symmetric ones, where no cones are given. pins, errors: as for `parameterize` and
    `complete_cones`.
    """
    follows = follows_features(solver.surface, options) or straightens_marked(solver.surface, options)
    for_features = None
    if given.is_free and follows:
        for_features = feature_cones(solver, options, share_of(progress, 0.0, _FEATURES), given.target)
        progress = share_of(progress, _FEATURES, 1.0)
    maps = _Maps(solver, pins)
    cones = _ConeChoice(maps, given, objective, symmetric and not len(given.cones))
    if for_features is None:
        best = cones.best(options, progress)
    elif options.seamless is None:
        # The other map has no time of its own.
        usual = cones.best(options, progress)
        usual = usual[0], usual[0].told(usual[1], options)
        return _straighter(maps, for_features, usual, options, share_of(progress, 1.0, 1.0))
    else:
        best = _best_with_features(maps, cones, for_features, options, progress)
    if options.seamless is not None:
        best = _without_creases(maps, best, options, share_of(progress, 1.0, 1.0))
    return best[0], best[0].told(best[1], options)


def _best_with_features(
    maps: _Maps, cones: _ConeChoice, for_features: CompletedCones, options: Options, progress: Progress | None
) -> MapThrough:
    """The best seamless map through cones for features, or the other ones."""
    along = maps.attempt(for_features, options, share_of(progress, 0.0, 1 / 3))
    if along is not None and not runs_along_features(along[1]):
        along = None
    # Creases along the lattice take time: they are tried with the cones that are chosen.
    # Those that are released run along it through other cones, perhaps.
    is_chosen = releases_features(along and along[1])
    best = cones.best(options if is_chosen else replace(options, straighten=False), share_of(progress, 1 / 3, 2 / 3))
    last = share_of(progress, 2 / 3, 1.0)
    if along is not None:
        return _best_along(maps, along, best, options, is_chosen, last)
    return best if is_chosen else maps.through(best[0], options, last)


class _ConeChoice:
    """The choice between usual cones and symmetric ones, each of them placed once it may gain.

    maps: of the surface. given: to be completed. symmetric: whether to try symmetric ones.
    """

    def __init__(self, maps: _Maps, given: GivenCones, objective: Objective, symmetric: bool) -> None:
        self._maps, self._given, self._objective, self._tries_symmetric = maps, given, objective, symmetric
        self._components = Components.of(maps.solver.surface)
        self._options = Options()
        self._alike: CompletedCones | None = None  # symmetric ones, once they are placed
        self._share = 0.0  # of the area, of symmetric components
        self._made: dict[str, tuple[MapThrough, Quality]] = {}

    def best(self, options: Options, progress: Progress | None) -> MapThrough:
        """The best map with these options.  Raises what `complete_cones` and `parameterize` raise."""
        self._options, self._made = options, {}
        usual = self._candidate("usual cones", 1.0, self._expected_of_usual, self._usual)
        if not self._tries_symmetric:
            return self._objective.choose([usual], progress)
        candidates = [self._candidate("symmetric cones and cuts", 0.0, self._expected_of_symmetric, self._symmetric)]
        if not options.mirrored_cuts:
            candidates.append(
                self._candidate("symmetric cones, other cuts", 0.5, partial(self._expected_of_others, 0.5), self._free)
            )
        candidates.append(usual)
        if self._components.count > 1:
            partly = self._candidate("some cones symmetric", 0.5, self._expected_of_partly, self._partly)
            candidates.append(partly)
        return self._objective.choose(candidates, progress)

    def _candidate(
        self,
        name: str,
        asymmetry: float,
        expected: Callable[[], float | None],
        make: Callable[[Progress | None], MapThrough],
    ) -> Candidate[MapThrough]:
        def quality(made: MapThrough, progress: Progress | None) -> Quality:
            found = self._objective.quality(self._maps.solver.surface, made[1], progress, asymmetry * self._share)
            self._made[name] = made, found
            return found

        def name_of(made: MapThrough) -> str:
            return name if self._alike is not None or not self._tries_symmetric else "usual cones"

        return Candidate(name, expected, make, quality, name_of)

    def _expected_of_symmetric(self) -> float:
        return 0.0

    def _expected_of_usual(self) -> float | None:
        if not self._made:
            return math.inf
        return self._expected_of_others(1.0) if self._alike is not None else None

    def _expected_of_others(self, asymmetry: float) -> float | None:
        """Of maps with other cones or cuts than those that were made: stretched as much, unless that is more than cones
        are placed for, with three quarters of the islands."""
        if not self._made or self._alike is None:
            return None
        (_, result), quality = min(self._made.values(), key=lambda one: one[1].cost(self._objective.weights))
        if quality.asymmetry > asymmetry * self._share:
            return None
        islands = max(self._components.count, _ISLANDS_OF_OTHERS * quality.islands)
        most = 100 * (self._given.target - 1) * (_LOW_STRETCH if self._options.mode == "low-stretch" else 1.0)
        stretch = min(quality.stretch, most)
        on_lattice = cost_on_lattice(result, even=True)
        other = replace(
            quality, stretch=stretch, islands=islands, asymmetry=asymmetry * self._share, on_lattice=on_lattice
        )
        return other.cost(self._objective.weights)

    def _placed(self, progress: Progress | None, *, symmetric: bool) -> CompletedCones:
        placing = share_of(progress, 0.0, PLACING)
        return complete_cones(self._maps.solver, self._given, self._options, placing, symmetric=symmetric)

    def _symmetric(self, progress: Progress | None) -> MapThrough:
        alike = self._alike
        if alike is None:
            alike = self._placed(progress, symmetric=True)
        placement = alike.placement
        if self._alike is None and placement is not None:
            surface = self._maps.solver.surface
            odd = [finding.elements.indices for finding in placement.warnings if finding.code == _ODD]
            is_odd = np.zeros(len(surface.triangles), bool)
            is_odd[np.concatenate([np.empty(0, np.intp), *odd])] = True
            areas = triangle_areas(surface)
            others = [finding for finding in placement.warnings if finding.code != _ODD]
            alike = replace(alike, placement=replace(placement, warnings=others), is_symmetric=not is_odd.all())
            if alike.is_symmetric:
                self._alike, self._share = alike, float(areas[~is_odd].sum() / areas.sum())
        return self._maps.through(alike, self._options, share_of(progress, PLACING, 1.0))

    def _free(self, progress: Progress | None) -> MapThrough:
        assert self._alike is not None
        return self._maps.through(replace(self._alike, is_symmetric=False), self._options, progress)

    def _usual(self, progress: Progress | None) -> MapThrough:
        cones = self._placed(progress, symmetric=False)
        return self._maps.through(cones, self._options, share_of(progress, PLACING, 1.0))

    def _partly(self, progress: Progress | None) -> MapThrough:
        alike, usual = (self._made[name][0][0] for name in ("symmetric cones and cuts", "usual cones"))
        cones = usual.joined(alike, self._maps.solver.surface, self._cheaper()[self._components.of_vertex])
        return self._maps.through(replace(cones, is_symmetric=True), self._options, progress)

    def _expected_of_partly(self) -> float | None:
        if not {"symmetric cones and cuts", "usual cones"} <= self._made.keys() or self._alike is None:
            return None
        is_cheaper = self._cheaper()
        if is_cheaper.all() or not is_cheaper.any():
            return None
        quality = self._made["symmetric cones and cuts"][1]
        saved = (self._costs("symmetric cones and cuts") - self._costs("usual cones"))[~is_cheaper].sum()
        return quality.cost(self._objective.weights) - float(saved)

    def _cheaper(self) -> NDArray[np.bool_]:
        """On which components the symmetric map costs no more, (c,)."""
        return self._costs("symmetric cones and cuts") <= self._costs("usual cones")

    def _costs(self, name: str) -> FloatArray:
        """What each component costs in a map, (c,), but for the square; infinite with further defects."""
        (_, result), quality = self._made[name]
        of = self._components
        costs, _ = self._objective.costs(of, result)
        costs = costs + self._objective.weights.symmetry * of.areas() / of.areas().sum() * (quality.asymmetry > 0)
        return np.where(of.defects(result) > 0, np.inf, costs)


@dataclass(frozen=True, slots=True)
class _Maps:
    """Maps of one surface.  pins: of `best_map`"""

    solver: Solver
    pins: Pins | None

    def through(self, cones: CompletedCones, options: Options, progress: Progress | None) -> MapThrough:
        return cones, cones.parameterize(self.solver, options, self.pins, progress)

    def attempt(self, cones: CompletedCones, options: Options, progress: Progress | None) -> MapThrough | None:
        """None if the library refuses it."""
        return or_none(partial(self.through, cones, options, progress))


def _best_along(
    maps: _Maps,
    along: MapThrough,
    best: MapThrough,
    options: Options,
    is_straightened: bool,
    progress: Progress | None,
) -> MapThrough:
    """The map through cones for creases, the best other one, or one through cones of both, by component.

    is_straightened: whether the other one is made with the options, not without straight creases.
    """
    surface = maps.solver.surface
    components = Components.of(surface)
    is_other = _have_other_cones(components, along[0], best[0])
    gain = gains_features(components, along[1], best[1], is_straightened)
    if not (is_straightened or gain[is_other].all()):
        # Along creases the usual one is stretched as well.
        best = maps.through(best[0], options, share_of(progress, 0.0, _TRYING))
        gain = gains_features(components, along[1], best[1], True)
    if gain[is_other].all():
        return along
    candidates = [along]
    if gain[is_other].any():
        cones = best[0].joined(along[0], surface, gain[components.of_vertex])
        joint = maps.attempt(cones, options, share_of(progress, _TRYING, 1.0))
        if joint is not None:
            candidates.insert(0, joint)
    better = [candidate for candidate in candidates if may_replace_for_features(candidate[1], best[1])]
    return max([*better, best], key=lambda candidate: worth_along_features(candidate[1]))


def _straighter(
    maps: _Maps, for_features: CompletedCones, usual: MapThrough, options: Options, progress: Progress | None
) -> MapThrough:
    """The usual map, or where it releases marked features the one through cones for them, if that is worth it."""
    if not releases_features(usual[1]):
        return usual
    along = maps.attempt(for_features, options, progress)
    if along is None or not may_replace_straighter(along[1], usual[1]):
        return usual
    return along[0], along[0].told(along[1], options)


def _without_creases(maps: _Maps, along: MapThrough, options: Options, progress: Progress | None) -> MapThrough:
    """The map, or the one in which no creases run along the lattice, where not all of them can and that is better."""
    is_marked = along[1].features is not None
    if is_marked or not len(along[1].seamless.creases) or not releases_features(along[1]):
        return along
    share, found = feature_share(along[1]), along[1].seamless
    least = worth_along_features(along[1]) + (_WORTH_OF_DIRECTION if has_direction(share) else 0)
    plain = maps.attempt(along[0], replace(options, straighten=False), progress)
    if plain is None or worth_along_features(plain[1]) <= least:
        return along
    released = Finding(
        "FEATURES_OFF_LATTICE",
        f"No creases run along the lattice: only {100 * share:.0f} % of their length can, at an L2 stretch of "
        f"{along[1].distortion.l2_stretch:.4g} and with tiles that are {found.tile_size:.3g} wide on the surface. Mark "
        "as features those that have to.",
        Elements("edges", found.creases),
    )
    return plain[0], replace(plain[1], warnings=[*plain[1].warnings, released])


def _have_other_cones(components: Components, one: CompletedCones, other: CompletedCones) -> NDArray[np.bool_]:
    """Which components have other cones, or other angles of them, in one choice than in the other, (c,)."""
    own = set(zip(one.cones.tolist(), one.angles, strict=True))
    differing = own ^ set(zip(other.cones.tolist(), other.angles, strict=True))
    out = np.zeros(components.count, bool)
    out[components.of_vertex[[cone for cone, _ in differing]]] = True
    return out
