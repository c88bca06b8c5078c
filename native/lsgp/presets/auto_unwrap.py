# SPDX-License-Identifier: GPL-3.0-or-later
"""From a surface to a finished map in one call: presets, and automatic cones if the given ones do not suffice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import compress
from typing import Literal, TypeVar, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _lsgp
from ..api import Solver, crease_borders
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys
from ..base.progress import Progress, share_of
from ..errors import Cancelled, Finding, InputError, LsgpError
from ..layouts.packing import Pack, Packing, Stack, laid_out, packing_once
from ..layouts.texels import TexelLayout, at_texel_density, with_tiny_findings
from ..ledger import LedgerPart, build_ledger, surface_of_triangles
from ..options import Options, Seamless
from ..results import Placement, Result
from ..surface import Pins, Surface, surface_arrays
from .border_gains import BorderGain, FullerSquare, LessStretch
from .map_comparison import (
    fills_badly,
    may_replace_for_features,
    may_replace_map,
    may_replace_undivided,
    mirrored_cuts_cost_islands,
    releases_features,
    runs_along_features,
    saves_islands,
)

Preset = Literal["paint", "tile", "bake"]

T = TypeVar("T")
Mapped = tuple[Surface, "CompletedCones", Result]
MakeMap = Callable[[Surface, Progress | None], tuple["CompletedCones", Result]]

# The stretch of the map that automatic cones are to reach, as of `place_cones`.
TARGET = 1.05
# Fraction of an unwrap's time that placing cones takes.
PLACING = 0.6
# And with making the map, where islands are packed afterward.
PACKING = 0.9
# Of the time of placing cones: where those for creases are placed.
_BEFORE_FEATURES = 0.9
# Of the time of placing cones: what two attempts, with and without symmetry, have each.
TRYING = 0.5
# Where the square stays empty, islands are divided as if they had so many of them.
_SQUARES = 2.0
# What tells that a component is not symmetric.
_ODD = "NOT_SYMMETRIC"
# Hard surfaces end at their creases where their curvature sits at more corners than these, at which cones serve as
# well and the texture runs on; None: it has to run on everywhere.
_MOST_CORNERS: dict[Preset, int | None] = {"paint": 24, "tile": None, "bake": 0}
# Other components may end there, too, where creases carry this share of their curvature, if their map gains by it.
_LEAST_SHARE_TO_TRY = 0.5

# Islands are split in all of them: what lies on itself can neither be painted nor baked, and the cuts of a seamless
# layout show nowhere.
_PRESETS: dict[Preset, Options] = {
    "paint": Options(mode="low-stretch", straighten=True, overlaps="split", compact="sparing"),
    "tile": Options(seamless=Seamless(lattice="square"), straighten=True, overlaps="split"),
    "bake": Options(mode="low-stretch", straighten=True, overlaps="split", compact="full"),
}


def preset_options(preset: Preset) -> Options:
    """The options of a preset of `auto_unwrap`; `dataclasses.replace` changes some of them.

    preset: "paint" preserves lengths, for texture painting, and cuts islands that would leave most of the square empty;
        "tile" makes seams invisible for a tileable texture of squares; "bake" is for computed textures: it preserves
        lengths, cuts islands so that they fill the square, and hard surfaces at their creases.
    With every preset no island overlaps itself.  Raises InputError.
    """
    arguments.require_choice("preset", preset, get_args(Preset))
    return _PRESETS[preset]


def auto_unwrap(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | FloatArray | None = None,
    *,
    preset: Preset = "paint",
    options: Options | None = None,
    count: int | None = None,
    symmetric: bool = True,
    creases: bool = True,
    sharp: ArrayLike | None = None,
    pins: Pins | None = None,
    pack: Pack | None = None,
    margin: float | None = None,
    udim: int | None = None,
    stack: Stack | None = None,
    texels: TexelLayout | None = None,
    progress: Progress | None = None,
) -> Result:
    """Unwrap a surface ready for use: place missing cones and apply a preset.

    cones, angles: as for `parameterize`; they are kept. A component without cones gets the number that its stretch
        requires, which may be 0; one whose cones cannot take up its curvature gets more.
    options: instead of `preset_options(preset)`. count: cones on each component that gets some, as for `place_cones`;
        None: the fewest that bring the L2 stretch to 1.05.
    symmetric: whether cones are placed alike on both sides of a mirror plane, and on components that mirror each other,
        as by `place_cones`, and cuts run alike on both sides, as with `Options.mirrored_cuts`, if that costs little: at
        most 1 % of L2 stretch, one island (one for ten if there are more; two if the square is not filled less), a
        quarter of the edges cut, and a tenth of the filled part of the square (a fifth where it saves one island of
        few, three tenths where it saves two, or a tenth of many), packed tightly if the packer is installed. Where two
        fifths of the cuts are saved, L2 stretch may be up to 1.05 and the filled part a quarter less, unless the usual
        map is isometric. Where symmetric cuts cost two islands (or a tenth), symmetric cones get other cuts if these
        save them. Only without cones and `count`.
    creases: whether hard surfaces may be cut at their creases, as by `crease_borders`, which takes `sharp`; and with
        half of the curvature on creases, or few corners, where that halves the excess of L2 stretch over 1, and removes
        0.004 of it for each further island (without further ones: a fifth of it), and fills the square at most three
        tenths less, where it exceeds 0.002; an island for two cones fewer is no further one, unless the component is
        small. Or where less than three fifths of the square are filled, and at no cost of stretch a tenth more with
        them, a quarter for one further island, or two fifths for two (or a tenth; with "bake" any number). The latter
        two only without cones, `count` or pins.
    pack: "tight": as by `pack_islands`; "shelves": in rows; None: tight if `packer_name` returns a packer. Layouts that
        are seamless, pinned or in UDIM tiles at a texel density are never packed.
    margin: with "tight", around each island, as a fraction of the square's side; None: 4 / 1024, before the layout gets
        a texel density. udim: most UDIM tiles that a tight layout is spread over, as for `pack_islands`, and its
        `Options.square_share`; not with texels, which have their own.
    stack: in tight layouts, islands of one shape lie on each other, as by `find_stacks`: "same", or "mirrored", which
        includes reflected ones. `ISLANDS_STACKED` among the warnings says how many; they do not count as overlaps.
    texels: a layout at a texel density, as by `at_texel_density`; None: it fills the unit square. Not with pins.
    pins, progress, errors and the result as for `parameterize`; `Result.cones` includes the placed cones, its warnings
        those of the placement, and ISLANDS_TINY names islands that do not keep their shape in single precision.

    >>> result = lsgp.auto_unwrap(surface, preset="bake")
    >>> result.corner_uv.shape, len(result.overlapping)
    ((4, 3, 2), 0)
    """
    chosen = preset_options(preset)
    if options is not None:
        arguments.require_type("options", options, Options)
        chosen = options
    arguments.require_callable(progress)
    given = GivenCones.of(cones, angles, count)
    choices = CreaseChoices(surface)
    if arguments.flag("creases", creases):
        choices = crease_choices(surface, given, preset, chosen, sharp)
    if pins is not None:
        choices = replace(choices, possible=None)
    if texels is not None:
        arguments.require_type("texels", texels, TexelLayout)
        if pins is not None:
            raise InputError("WRONG_PARAMETER", "pins and texels both say how large islands are; pass one of them.")
    packing = Packing(pack, margin, udim, stack)
    if udim is not None:
        chosen = replace(chosen, square_share=float(udim))
    packs = _may_pack(packing, chosen, pins, texels)
    is_free = arguments.flag("symmetric", symmetric) and count is None
    solvers = Solvers()

    def make(opened: Surface, share: Progress | None) -> tuple[CompletedCones, Result]:
        solver = solvers.of(opened)
        found = possible_cones(solver, given, chosen, is_free, share_of(share, 0.0, PLACING))
        return best_map(solver, found, chosen, pins, share_of(share, PLACING, 1.0))

    with packing_once():
        mapping = share_of(progress, 0.0, PACKING if packs else 1.0)
        found = best_at_creases(choices, chosen, make, mapping)
        surface, result = found[0], found[2]
        if pins is None:
            result = best_division(found, chosen, solvers, share_of(mapping, 1.0, 1.0))
        if packs:
            result = laid_out(surface, result, packing, texels, share_of(progress, PACKING, 1.0)).result
        elif texels is not None:
            result = at_texel_density(surface, result, texels)
    return with_tiny_findings(result)


def _may_pack(packing: Packing, options: Options, pins: Pins | None, texels: TexelLayout | None) -> bool:
    """Whether islands are packed; raises InputError where they may not be and that is asked for."""
    fixed = {
        "seamless, on whole tiles": options.seamless is not None,
        "pinned": pins is not None,
        "in UDIM tiles": texels is not None and texels.udim is not None,
    }
    for why, is_so in fixed.items():
        if is_so and packing.pack == "tight":
            arguments.refuse("pack", packing.pack, f"leave it out, since this layout is {why}")
        if is_so and packing.udim is not None:
            arguments.refuse("udim", packing.udim, f"leave it out, since this layout is {why}")
        if is_so and packing.stack is not None:
            arguments.refuse("stack", packing.stack, f"leave it out, since this layout is {why}")
    if texels is not None and packing.udim is not None:
        arguments.refuse("udim", packing.udim, "leave it out and pass that of texels, whose density says the size")
    return packing.is_tight and not any(fixed.values())


@dataclass(frozen=True, slots=True)
class CreaseChoices:
    """Borders at creases among which `best_at_creases` chooses.

    surface: with its own borders and those that the preset requires. possible: (b, 2) int32, further ones, of
    components that end there if their maps gain by it; None without. preset: "paint" keeps islands few.
    """

    surface: Surface
    possible: IndexArray | None = None
    preset: Preset = "paint"


def crease_choices(
    surface: Surface,
    given: GivenCones,
    preset: Preset,
    options: Options,
    sharp: ArrayLike | None = None,
) -> CreaseChoices:
    """The borders of `crease_borders` that a preset requires, and those with which it may become better.

    "bake" requires all; "paint" those of components with curvature at more than 24 vertices, since fewer can be cones,
    across which the texture continues. Both may gain by those of other components with half of their curvature on
    creases, unless the number of cones is given. "tile", and options for seamless layouts, straight borders or
    prescribed turning: none.
    sharp, errors: as for `crease_borders`.
    """
    most_corners = _MOST_CORNERS[preset]
    if most_corners is None or options.seamless is not None or options.border != "free" or options.loop_turning:
        return CreaseChoices(surface)
    required = crease_borders(surface, given.cones, sharp=sharp, most_corners=most_corners)
    if given.count is not None:
        return CreaseChoices(_ending_at(surface, required))
    possible = crease_borders(surface, given.cones, sharp=sharp, least_share=_LEAST_SHARE_TO_TRY)
    further = possible[~np.isin(_keys(possible, surface), _keys(required, surface))]
    return CreaseChoices(_ending_at(surface, required), further if len(further) else None, preset)


class Solvers:
    """A solver for each surface: what one call computes serves the next ones."""

    def __init__(self) -> None:
        self._known: list[Solver] = []

    def of(self, surface: Surface) -> Solver:
        for solver in self._known:
            if solver.surface is surface:
                return solver
        self._known.append(Solver(surface))
        return self._known[-1]


def best_at_creases(
    choices: CreaseChoices,
    options: Options,
    make: MakeMap,
    progress: Progress | None = None,
) -> Mapped:
    """The surface with the best borders among the possible ones, its cones and its map.

    Other borders are tried on components that are stretched without them, and then on others that leave much of the
    square empty.
    make: the cones and the map of a surface, as of `possible_cones` and `best_map`. progress, errors: of `make`.
    """
    surface, is_possible = choices.surface, choices.possible is not None
    best = surface, *make(surface, share_of(progress, 0.0, TRYING if is_possible else 1.0))
    if is_possible:
        parts = _parts_with_borders(surface, choices.possible)
        middle = (TRYING + 1.0) / 2
        gains = (
            (LessStretch(surface, options.square_share), TRYING, middle),
            (FullerSquare(surface, options.square_share, choices.preset == "paint"), middle, 1.0),
        )
        for gain, begin, end in gains:
            best = _gaining(gain, parts, best, make, share_of(progress, begin, end))
    if progress is not None:
        progress(1.0)  # maps that were not needed leave their time
    return best


def best_division(mapped: Mapped, options: Options, solvers: Solvers, progress: Progress | None = None) -> Result:
    """The map with its islands divided further, or less, where much of the square stays empty and the packer fills it
    better then.

    Dividing them goes by an estimate of what they take; which of several layouts is the smallest only packing can tell.
    mapped: as of `best_at_creases`. solvers: those it was made with. progress: without time of its own.
    Raises Cancelled.
    """
    surface, cones, usual = mapped
    keeps_few = options.compact == "sparing"
    if options.compact == "off" or options.square_share != 1 or not fills_badly(usual, keeps_few, progress):
        return usual
    best, others = usual, [replace(options, square_share=_SQUARES)]
    if not keeps_few:
        others.append(replace(options, compact="sparing"))
    for other in others:
        divided = or_none(partial(_map_through, solvers.of(surface), cones, other, None, progress))
        if divided is not None and may_replace_undivided(divided, best, keeps_few, progress):
            best = cones.told(divided, options)
    return best


def _gaining(
    gain: BorderGain,
    parts: list[_PartWithBorders],
    usual: Mapped,
    make: MakeMap,
    progress: Progress | None,
) -> Mapped:
    """The usual map, or a better one, in which parts that gain by their borders end there."""
    # Comparing, and the map of those parts that gain, where others do not, have no time of their own.
    begin, end = (share_of(progress, done, done) for done in (0.0, 1.0))
    surface = usual[0]
    parts = [part for part in parts if not part.is_open(surface)]
    parts = list(compress(parts, gain.may_gain(usual[2], [part.triangles for part in parts], begin)))
    for stage in (progress, end):
        if not parts:
            break
        opened = _ending_at(surface, np.concatenate([part.borders for part in parts]))
        found = or_none(partial(make, opened, stage))
        if found is None:
            break
        gains = gain.gains(found[1], usual[2], [part.triangles for part in parts])
        if all(gains):
            return (opened, *found) if gain.may_replace(found[1], usual[2], end) else usual
        parts = list(compress(parts, gains))
    return usual


@dataclass(frozen=True, slots=True)
class _PartWithBorders:
    """The triangles of a connected component, and the borders at which it may end, (b, 2)."""

    triangles: IndexArray
    borders: IndexArray

    def is_open(self, surface: Surface) -> bool:
        """Whether the surface ends there."""
        return bool(np.isin(_keys(self.borders, surface), _keys(surface.borders, surface)).all())


def _parts_with_borders(surface: Surface, borders: IndexArray) -> list[_PartWithBorders]:
    components = build_ledger(surface, ())
    component = np.full(len(surface.triangles), -1)
    for i, found in enumerate(components):
        component[found.triangles] = i
    edges = _keys(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), surface)
    order = np.argsort(edges, kind="stable")
    triangle = order[np.searchsorted(edges, _keys(borders, surface), sorter=order)] // 3
    of_border = component[triangle]
    return [_PartWithBorders(components[i].triangles, borders[of_border == i]) for i in np.unique(of_border)]


def _keys(edges: IndexArray, surface: Surface) -> NDArray[np.int64]:
    return edge_keys(edges[:, 0], edges[:, 1], len(surface.positions))


def _ending_at(surface: Surface, borders: IndexArray) -> Surface:
    return replace(surface, borders=np.concatenate([surface.borders, borders]))


@dataclass(frozen=True, slots=True)
class GivenCones:
    """Cones that are to be completed.

    cones: (k,) int32. angles: one each, None = automatic. count: the number on each component, as of `place_cones`.
    """

    cones: IndexArray
    angles: list[float | None]
    count: int | None = None

    @classmethod
    def of(
        cls,
        cones: ArrayLike = (),
        angles: Sequence[float | None] | FloatArray | None = None,
        count: int | None = None,
    ) -> GivenCones:
        """cones, angles, count: as of `place_cones`.  Raises InputError where there are not as many angles as cones."""
        given = arguments.index_vector("cones", cones)
        return cls(given, list(arguments.cone_angles("angles", angles, len(given))), count)

    @property
    def is_free(self) -> bool:
        """Whether neither cones nor their number are given."""
        return self.count is None and not len(self.cones)


@dataclass(frozen=True, slots=True)
class CompletedCones:
    """Given cones and those placed in addition.

    cones: (k,) int32, given ones first. angles: one each for `parameterize`, None = automatic. placement: on the
    components that needed or were tried for cones; None if there are none. by_target: whether the number was determined
    by a target stretch. is_symmetric: whether they mirror each other, so that cuts may as well.
    """

    cones: IndexArray
    angles: list[float | None]
    placement: Placement | None
    by_target: bool = True
    is_symmetric: bool = False

    def options_of_map(self, options: Options) -> Options:
        """Those of a map through these cones."""
        return replace(options, mirrored_cuts=options.mirrored_cuts or self.is_symmetric)

    def told(self, result: Result, options: Options) -> Result:
        """The result of a map through these cones with the applicable warnings of it and of their placement."""
        # Presets have cuts mirrored where that is possible; nobody has to be told where it is not.
        of_map = [finding for finding in result.warnings if finding.code != "CUTS_NOT_MIRRORED"]
        if self.placement is None:
            return replace(result, warnings=of_map)
        findings = [_true_of_map(finding, result) for finding in self.placement.warnings]
        if self.by_target and options.mode == "low-stretch" and result.distortion.l2_stretch <= TARGET:
            # It speaks of the conformal map, and this one reaches the target.
            findings = [finding for finding in findings if finding.code != "PLACEMENT_NOT_REACHED"]
        return replace(result, warnings=joined_warnings(findings, of_map))


def complete_cones(
    solver: Solver,
    given: GivenCones,
    options: Options,
    progress: Progress | None = None,
    *,
    symmetric: bool = False,
) -> CompletedCones:
    """Cones for a map with these options: the given ones, and automatic ones where they do not suffice.

    Components without cones get some as far as they need them, and so do those whose ledger does not close.
    progress and errors as of `place_cones`, symmetric as well if no cones are given.
    """
    if not len(given.cones):
        return _completed(given, options, _place(solver, given, options, progress, symmetric))
    ledger = build_ledger(solver.surface, given.cones, given.angles, options, gets_cones=True)
    lacking = [component for component in ledger if _lacks(component)]
    if not lacking:
        return CompletedCones(given.cones, given.angles, None)
    triangles = np.sort(np.concatenate([component.triangles for component in lacking]))
    present = np.unique(np.concatenate([component.cones for component in lacking]))
    own = Solver(surface_of_triangles(solver.surface, triangles))
    part = GivenCones(given.cones[present], [given.angles[i] for i in present], given.count)
    placed = or_none(lambda: _place(own, part, options, progress))
    if placed is None:
        # The other components can still be mapped; mapping reports the defect of these.
        return CompletedCones(given.cones, given.angles, None)
    return _completed(given, options, replace(placed, warnings=_renumbered(placed.warnings, triangles)))


@dataclass(frozen=True, slots=True)
class ConeChoices:
    """Cones among which `best_map` chooses, each as of `complete_cones`.

    usual: symmetric ones if all components are symmetric. symmetric: those that differ from the usual ones, or have
    other cuts; None without. for_features: those with which creases can run along the lattice; None without.
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
    if not (given.is_free and follows_features(solver.surface, options)):
        return _symmetric_cones(solver, given, options, symmetric, progress)
    found = _symmetric_cones(solver, given, options, symmetric, share_of(progress, 0.0, _BEFORE_FEATURES))
    return replace(found, for_features=feature_cones(solver, options, share_of(progress, _BEFORE_FEATURES, 1.0)))


def follows_features(surface: Surface, options: Options) -> bool:
    """Whether marked features or creases of hard surfaces are to run along the lattice."""
    is_square = options.seamless is not None and options.seamless.lattice == "square"
    has_features = options.straighten or len(surface.features) > 0
    return is_square and has_features and options.prescription is None and not len(surface.seams)


def feature_cones(solver: Solver, options: Options, progress: Progress | None = None) -> CompletedCones | None:
    """Cones with which marked features and, with `Options.straighten`, creases of hard surfaces can run along the
    lattice, and those of `complete_cones` on other components; None without features, or if there are no such cones."""
    arrays = surface_arrays(solver.surface)
    chosen = or_none(lambda: _lsgp.feature_cones(arrays, options.straighten, share_of(progress, 0.0, TRYING)))
    if chosen is None or not len(chosen[0]):
        return None
    return or_none(lambda: complete_cones(solver, GivenCones.of(*chosen), options, share_of(progress, TRYING, 1.0)))


def _symmetric_cones(
    solver: Solver, given: GivenCones, options: Options, symmetric: bool, progress: Progress | None
) -> ConeChoices:
    """Those of `complete_cones` and, where a component is symmetric, symmetric ones; if these are the same, their cuts
    may still be others."""
    if not symmetric or len(given.cones):
        return ConeChoices(complete_cones(solver, given, options, progress))
    alike = or_none(lambda: complete_cones(solver, given, options, share_of(progress, 0.0, TRYING), symmetric=True))
    if alike is not None:
        odd = [finding for finding in alike.placement.warnings if finding.code == _ODD]
        others = [finding for finding in alike.placement.warnings if finding.code != _ODD]
        alike = replace(alike, placement=replace(alike.placement, warnings=others))
        if sum(len(finding.elements.indices) for finding in odd) == len(solver.surface.triangles):
            return ConeChoices(alike)
        alike = replace(alike, is_symmetric=True)
    usual = complete_cones(solver, given, options, share_of(progress, TRYING, 1.0))
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
) -> tuple[CompletedCones, Result]:
    """The map through the cones of `possible_cones`: the symmetric ones, or those for creases, if that costs little.

    Where symmetric cuts cost islands, the symmetric cones are tried with other cuts as well.
    pins, progress, errors: as for `parameterize`.
    """
    usual, symmetric, for_features = choices.usual, choices.symmetric, choices.for_features
    share = 1.0 / (1 + (symmetric is not None) + 2 * (for_features is not None))
    stages = iter([share_of(progress, i * share, (i + 1) * share) for i in range(round(1 / share))])
    along = None
    if for_features is not None:
        along = or_none(partial(_map_through, solver, for_features, options, pins, next(stages)))
        if along is not None and not runs_along_features(along):
            along = None
    # Creases along the lattice take time: they are tried with the cones that are chosen.
    # Those that are released run along it through other cones, perhaps.
    is_chosen = for_features is None or (along is None and symmetric is None) or releases_features(along)
    tried = options if is_chosen else replace(options, straighten=False)
    plain = _map_through(solver, usual, tried, pins, next(stages))
    best = usual, plain
    if symmetric is not None:
        # Comparing, and the map with other cuts, which few models need, have no time of their own.
        end = (2 + (for_features is not None)) * share
        mapping, still = next(stages), share_of(progress, end, end)
        may_replace = partial(may_replace_map, square_share=options.square_share, progress=still)
        map_through = partial(_map_through, solver, options=tried, pins=pins)
        for candidate in _symmetric_maps(
            map_through, symmetric, (usual, plain), not options.mirrored_cuts, (mapping, still)
        ):
            result = candidate[1]
            if may_replace(result, plain) and (best[1] is plain or may_replace(result, best[1])):
                best = candidate
    if along is not None and may_replace_for_features(along, best[1]):
        best = for_features, along
    elif not is_chosen:
        best = best[0], _map_through(solver, best[0], options, pins, next(stages))
        # Along creases the usual one is stretched as well.
        if along is not None and may_replace_for_features(along, best[1]):
            best = for_features, along
    return best[0], best[0].told(best[1], options)


def _symmetric_maps(
    map_through: Callable[..., Result],
    symmetric: CompletedCones,
    usual: tuple[CompletedCones, Result],
    frees_cuts: bool,
    progress: tuple[Progress | None, Progress | None],
) -> Iterator[tuple[CompletedCones, Result]]:
    """The map through symmetric cones, and where its symmetric cuts cost islands, one with other cuts that save them.

    map_through: the map of CompletedCones, with `progress`. usual: the cones and the map that may be replaced.
    frees_cuts: whether cuts need not be symmetric. progress: of both maps.
    """
    usual_cones, plain = usual
    mirrored = or_none(lambda: map_through(symmetric, progress=progress[0]))
    if mirrored is None:
        return
    yield symmetric, mirrored
    has_other_cones = set(symmetric.cones.tolist()) != set(usual_cones.cones.tolist())
    if not (frees_cuts and has_other_cones and mirrored_cuts_cost_islands(mirrored, plain)):
        return
    freed = replace(symmetric, is_symmetric=False)
    free = or_none(lambda: map_through(freed, progress=progress[1]))
    if free is not None and saves_islands(free, mirrored, plain):
        yield freed, free


def _map_through(
    solver: Solver, completed: CompletedCones, options: Options, pins: Pins | None, progress: Progress | None
) -> Result:
    chosen = completed.options_of_map(options)
    return solver.parameterize(completed.cones, completed.angles, chosen, pins, progress)


def _true_of_map(finding: Finding, result: Result) -> Finding:
    """A finding of placement, which leaves components out that have a map without cones."""
    if finding.code != "COMPONENT_SKIPPED" or (result.island[finding.elements.indices] < 0).any():
        return finding
    reason = finding.message.partition(": ")[2]
    return replace(
        finding, code="PLACEMENT_NOT_REACHED", message=f"A component was unwrapped without placed cones: {reason}"
    )


def joined_warnings(of_placement: Sequence[Finding], of_map: Sequence[Finding]) -> list[Finding]:
    """Merges the findings of placement and mapping, without duplicates."""
    said = {(finding.code, finding.message) for finding in of_map}
    return [finding for finding in of_placement if (finding.code, finding.message) not in said] + list(of_map)


def or_none(attempt: Callable[[], T]) -> T | None:
    """The value of an attempt; None if the library refuses it. Cancellation propagates."""
    try:
        return attempt()
    except Cancelled:
        raise
    except LsgpError:
        return None


def _place(
    solver: Solver, given: GivenCones, options: Options, progress: Progress | None, symmetric: bool = False
) -> Placement:
    lattice = None if options.seamless is None else options.seamless.lattice
    return solver.place_cones(
        given.cones,
        given.angles,
        count=given.count,
        target=TARGET,
        lattice=lattice,
        symmetric=symmetric,
        seams=options.seams,
        threads=options.threads,
        progress=progress,
    )


def _completed(given: GivenCones, options: Options, placed: Placement) -> CompletedCones:
    # The angles are for free borders, and for rules that keep them.
    as_placed = options.prescription is None and options.border == "free"
    angle_at = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True)) if as_placed else {}
    new = placed.cones[~np.isin(placed.cones, given.cones)]
    angles = [angle_at.get(cone, angle) for cone, angle in zip(given.cones.tolist(), given.angles, strict=True)]
    angles += [angle_at.get(cone) for cone in new.tolist()]
    return CompletedCones(np.concatenate([given.cones, new]), angles, placed, by_target=given.count is None)


def _renumbered(findings: Sequence[Finding], triangles: NDArray[np.integer]) -> list[Finding]:
    """Findings on these triangles of a surface as findings on the surface, of which the others are a part as well."""
    of_surface = []
    for finding in findings:
        elements = finding.elements
        if elements.kind == "triangles":
            elements = replace(elements, indices=triangles[elements.indices].astype(np.int32))
        if finding.code != "ISOLATED_VERTICES":
            of_surface.append(replace(finding, elements=elements))
    return of_surface


def _lacks(component: LedgerPart) -> bool:
    return not len(component.cones) or not component.closes
