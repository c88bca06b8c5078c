# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones among which the map decides: usual ones, symmetric ones, and those for features that run along u and v."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..api import Solver
from ..base.progress import Progress, share_of
from ..errors import Elements, Finding
from ..options import Options
from ..results import Result
from ..surface import Pins, Surface, surface_arrays
from .completed_cones import TARGET, CompletedCones, GivenCones, complete_cones, or_none
from .components import Components
from .few_islands import best_of_few
from .map_comparison import (
    costs_little,
    feature_share,
    gains_features,
    has_direction,
    may_replace_for_features,
    may_replace_map,
    may_replace_straighter,
    mirrored_cuts_cost_islands,
    releases_features,
    runs_along_features,
    saves_islands,
    worth_along_features,
)

MapThrough = tuple[CompletedCones, Result]

# Of the time of placing cones: where those for creases are placed.
_BEFORE_FEATURES = 0.9
# And what two attempts, with and without symmetry, have each.
_TRYING = 0.5
# By which a map without creases along the lattice has to be better, where most run along it.
_WORTH_OF_DIRECTION = 0.15
# What tells that a component is not symmetric.
_ODD = "NOT_SYMMETRIC"


@dataclass(frozen=True, slots=True)
class ConeChoices:
    """Cones among which `best_map` chooses, each as of `complete_cones`.

    usual: symmetric ones if all components are symmetric. symmetric: those that differ from the usual ones, or have
    other cuts; None without. for_features: those with which creases can run along the lattice, or marked features along
    u and v; None without.
    """

    usual: CompletedCones
    symmetric: CompletedCones | None = None
    for_features: CompletedCones | None = None


def possible_cones(
    solver: Solver, given: GivenCones, options: Options, symmetric: bool, progress: Progress | None = None
) -> ConeChoices:
    """Those of `complete_cones`, and symmetric ones and those for creases, where there are such.

    symmetric: whether to try, where no cones are given. Errors as of `complete_cones`.
    """
    follows = follows_features(solver.surface, options) or straightens_marked(solver.surface, options)
    if not (given.is_free and follows):
        return _symmetric_cones(solver, given, options, symmetric, progress)
    found = _symmetric_cones(solver, given, options, symmetric, share_of(progress, 0.0, _BEFORE_FEATURES))
    for_features = feature_cones(solver, options, share_of(progress, _BEFORE_FEATURES, 1.0), given.target)
    return replace(found, for_features=for_features)


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


def _symmetric_cones(
    solver: Solver, given: GivenCones, options: Options, symmetric: bool, progress: Progress | None
) -> ConeChoices:
    """Those of `complete_cones` and, where a component is symmetric, symmetric ones; if these are the same, their cuts
    may still be others."""
    if not symmetric or len(given.cones):
        return ConeChoices(complete_cones(solver, given, options, progress))
    alike = or_none(lambda: complete_cones(solver, given, options, share_of(progress, 0.0, _TRYING), symmetric=True))
    if alike is not None:
        odd = [finding for finding in alike.placement.warnings if finding.code == _ODD]
        others = [finding for finding in alike.placement.warnings if finding.code != _ODD]
        alike = replace(alike, placement=replace(alike.placement, warnings=others))
        if sum(len(finding.elements.indices) for finding in odd) == len(solver.surface.triangles):
            return ConeChoices(alike)
        alike = replace(alike, is_symmetric=True)
    usual = complete_cones(solver, given, options, share_of(progress, _TRYING, 1.0))
    if alike is None:
        return ConeChoices(usual)
    is_same = set(alike.cones.tolist()) == set(usual.cones.tolist())
    return ConeChoices(usual, replace(usual, is_symmetric=True) if is_same else alike)


def best_map(
    solver: Solver,
    choices: ConeChoices,
    options: Options,
    pins: Pins | None = None,
    progress: Progress | None = None,
) -> MapThrough:
    """The map through the cones of `possible_cones`: the symmetric ones, or those for creases, if that costs little.

    Where symmetric cuts cost islands, the symmetric cones are tried with other cuts as well. Of several components,
    only those have cones for creases that gain by them.
    pins, progress, errors: as for `parameterize`.
    """
    symmetric, for_features = choices.symmetric, choices.for_features
    maps = _Maps(solver, pins)
    if for_features is not None and options.seamless is None:
        usual = best_map(solver, replace(choices, for_features=None), options, pins, progress)
        # The other map has no time of its own.
        return _straighter(maps, for_features, usual, options, share_of(progress, 1.0, 1.0))
    share = 1.0 / (1 + (symmetric is not None) + 2 * (for_features is not None))
    stages = iter([share_of(progress, i * share, (i + 1) * share) for i in range(round(1 / share))])
    along = None
    if for_features is not None:
        along = maps.attempt(for_features, options, next(stages))
        if along is not None and not runs_along_features(along[1]):
            along = None
    # Creases along the lattice take time: they are tried with the cones that are chosen.
    # Those that are released run along it through other cones, perhaps.
    is_chosen = for_features is None or (along is None and symmetric is None) or releases_features(along and along[1])
    tried = options if is_chosen else replace(options, straighten=False)
    best = maps.through(choices.usual, tried, next(stages))
    if symmetric is not None:
        # Comparing, and the map with other cuts, which few models need, have no time of their own.
        end = (2 + (for_features is not None)) * share
        mapping, still = next(stages), share_of(progress, end, end)
        best = _best_symmetric(maps, symmetric, best, tried, (mapping, still))
    if along is not None:
        best = _best_along(maps, along, best, options, is_chosen, next(stages))
    elif not is_chosen:
        best = maps.through(best[0], options, next(stages))
    if options.seamless is not None:
        best = _without_creases(maps, best, options, share_of(progress, 1.0, 1.0))
    return best[0], best[0].told(best[1], options)


@dataclass(frozen=True, slots=True)
class _Maps:
    """Maps of one surface.  pins: of `best_map`"""

    solver: Solver
    pins: Pins | None

    def through(self, cones: CompletedCones, options: Options, progress: Progress | None) -> MapThrough:
        usual = cones.parameterize(self.solver, options, self.pins, progress)
        if options.compact != "sparing" or options.square_share != 1 or self.pins is not None:
            return cones, usual
        # Other divisions of the same map have no time of their own.
        end = share_of(progress, 1.0, 1.0)

        def divide(other: Options) -> Result | None:
            return or_none(partial(cones.parameterize, self.solver, other, None, end))

        return cones, best_of_few(usual, options, self.solver.surface, divide, end)

    def attempt(self, cones: CompletedCones, options: Options, progress: Progress | None) -> MapThrough | None:
        """None if the library refuses it."""
        return or_none(partial(self.through, cones, options, progress))


def _best_symmetric(
    maps: _Maps,
    symmetric: CompletedCones,
    usual: MapThrough,
    options: Options,
    progress: tuple[Progress | None, Progress | None],
) -> MapThrough:
    """The usual map, or one through symmetric cones if that costs little, or with symmetric cones on the components
    where it does: with symmetric cuts, and where these cost islands, with other cuts that save them.

    progress: of the first map and of the other ones
    """
    mirrored = maps.attempt(symmetric, options, progress[0])
    if mirrored is None:
        return usual
    may_replace = partial(may_replace_map, square_share=options.square_share, progress=progress[1])
    best = mirrored if may_replace(mirrored[1], usual[1]) else usual
    if best is usual:
        partly = _partly_symmetric(maps, mirrored, usual, options, progress[1])
        if partly is not None and may_replace(partly[1], usual[1]):
            return partly
    has_other_cones = set(symmetric.cones.tolist()) != set(usual[0].cones.tolist())
    frees_cuts = not options.mirrored_cuts
    if not (frees_cuts and has_other_cones and mirrored_cuts_cost_islands(mirrored[1], usual[1])):
        return best
    free = maps.attempt(replace(symmetric, is_symmetric=False), options, progress[1])
    if free is None or not saves_islands(free[1], mirrored[1], usual[1]) or not may_replace(free[1], usual[1]):
        return best
    return free if best is usual or may_replace(free[1], best[1]) else best


def _partly_symmetric(
    maps: _Maps, mirrored: MapThrough, usual: MapThrough, options: Options, progress: Progress | None
) -> MapThrough | None:
    """The map with symmetric cones on the components where these cost little; None if these are none or all."""
    surface = maps.solver.surface
    components = Components.of(surface)
    if components.count == 1:
        return None
    is_other = _have_other_cones(components, mirrored[0], usual[0])
    is_cheap = costs_little(components, mirrored[1], usual[1])
    if not (is_other & is_cheap).any() or not (is_other & ~is_cheap).any():
        return None
    cones = usual[0].joined(mirrored[0], surface, is_cheap[components.of_vertex])
    return maps.attempt(replace(cones, is_symmetric=True), options, progress)


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
