# SPDX-License-Identifier: GPL-3.0-or-later
"""From a surface to a finished map in one call: presets, and automatic cones if the given ones do not suffice."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..api import Solver, crease_borders
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress, share_of, tell
from ..errors import InputError, SolverError
from ..layouts.packing import Effort, Pack, Packing, Stack, laid_out
from ..layouts.texels import TexelLayout, at_texel_density, refuse_of_seamless, with_tiny_findings
from ..options import Options, Seamless
from ..results import Result
from ..surface import Pins, Surface, has_strokes
from .border_gains import AlongLattice, BorderGain, LowerCost
from .completed_cones import TARGET, CompletedCones, GivenCones, or_none
from .components import Components, keys_of
from .cone_choices import best_map, follows_features
from .divisions import best_division
from .map_comparison import LEAST_DIRECTION_ERROR, direction_error, follows_strokes_better
from .marked_seams import MEASURING, along_seams
from .objective import Objective, Weights

Preset = Literal["paint", "tile", "bake"]

Mapped = tuple[Surface, CompletedCones, Result]
MakeMap = Callable[[Surface, Progress | None], tuple[CompletedCones, Result]]

# And with making the map, where islands are packed afterward.
PACKING = 0.9
# Of the time of cones and maps: where those without further borders are made.
_TRYING = 0.5
# Hard surfaces end at their creases where their curvature sits at more corners than these, at which cones serve as
# well and the texture runs on; None: it runs on wherever creases run along the tiles.
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


_WEIGHTS: dict[Preset, Weights] = {
    "paint": Weights(),
    "tile": Weights(),
    "bake": Weights(islands=0.1, cuts=0.05, borders=0.0, cones=0.0),
}
# A longer search fills 1 % more with the few islands of "paint", 3 % with those of "bake".
_EFFORTS: dict[Preset, Effort] = {"paint": "quick", "tile": "good", "bake": "good"}


def preset_weights(preset: Preset) -> Weights:
    """What a preset of `auto_unwrap` chooses by; `dataclasses.replace` changes some of it.  Raises InputError."""
    arguments.require_choice("preset", preset, get_args(Preset))
    return _WEIGHTS[preset]


def preset_effort(preset: Preset) -> Effort:
    """How long a preset of `auto_unwrap` looks for a layout, as of `pack_islands`.  Raises InputError."""
    arguments.require_choice("preset", preset, get_args(Preset))
    return _EFFORTS[preset]


def objective_of(preset: Preset, options: Options, weights: Weights | None = None) -> Objective:
    """By which the maps of a preset with these options are compared; weights: None for those of the preset."""
    if weights is not None:
        arguments.require_type("weights", weights, Weights)
    return Objective(_WEIGHTS[preset] if weights is None else weights, options.square_share)


def preset_options(preset: Preset) -> Options:
    """The options of a preset of `auto_unwrap`; `dataclasses.replace` changes some of them.

    preset: "paint" preserves lengths, for texture painting, and cuts islands that would leave most of the square empty;
        "tile" makes seams invisible for a tileable texture of squares, except where hard parts end at creases that
        cannot run along the tiles; "bake" is for computed textures: it preserves lengths, cuts islands so that they
        fill the square, and hard surfaces at their creases.
    With every preset no island overlaps itself, unless `seams` is "exact".  Raises InputError.
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
    target: float = TARGET,
    symmetric: bool = True,
    creases: bool = True,
    sharp: ArrayLike | None = None,
    pins: Pins | None = None,
    pack: Pack | None = None,
    margin: float | None = None,
    udim: int | None = None,
    stack: Stack | None = None,
    effort: Effort | None = None,
    texels: TexelLayout | None = None,
    weights: Weights | None = None,
    progress: Progress | None = None,
) -> Result:
    """Unwrap a surface ready for use: place missing cones and apply a preset.

    Marked seams are cut. A chart that they bound gets further cuts only if it is no disk, its L2 stretch exceeds the
    target, or it overlaps itself, and cones only if cuts alone do not help. With `Options.seams` "exact" there are
    neither. With given cones, and in seamless layouts, the texture runs on across the seams of components that get
    cones.

    cones, angles: as for `parameterize`; they are kept. A component without cones gets the number that its stretch
        requires, which may be 0; one whose cones cannot take up its curvature gets more.
    options: instead of `preset_options(preset)`. count: cones on each component that gets some, as for `place_cones`;
        None: the fewest that bring the L2 stretch to `target`.
    symmetric: whether cones are placed alike on both sides of a mirror plane, and on components that mirror each other,
        as by `place_cones`, and cuts run alike on both sides, as with `Options.mirrored_cuts`, where other maps do not
        cost less by the weights. Only without cones and `count`.
    creases: whether hard surfaces may be cut at their creases, as by `crease_borders`, which takes `sharp`; and others
        where their maps gain by it: with half of the curvature on creases, where they are stretched visibly less or
        cost less by the weights. Without cones, `count` or pins. In seamless layouts on squares, without marked cones
        and seams: those of hard components whose creases cannot run along the lattice otherwise; all other cuts stay
        invisible.
    pack: "tight": as by `pack_islands`; "shelves": in rows; None: tight, unless the margins leave no room. Layouts that
        are seamless, pinned or in UDIM tiles at a texel density are never packed.
    margin: with "tight", around each island, as a fraction of the square's side; None: 4 / 1024, before the layout gets
        a texel density. udim: most UDIM tiles that a tight layout is spread over, as for `pack_islands`, and its
        `Options.square_share`; not with texels, which have their own.
    stack: in tight layouts, islands of one shape are stacked, as by `find_stacks`: "same", or "mirrored", which
        includes reflected ones. `ISLANDS_STACKED` among the warnings says how many; they do not count as overlaps.
    effort: how long a tight layout is looked for, as of `pack_islands`; None: "quick" with "paint", else "good".
    weights: by which maps are compared; None: `preset_weights(preset)`. `Result.choices` says what they chose from.
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
    given = GivenCones.of(cones, angles, count, target)
    seamed = along_seams(surface, given, chosen, share_of(progress, 0.0, MEASURING))
    if len(surface.seams):
        progress = share_of(progress, MEASURING, 1.0)
    surface, given, chosen = seamed.surface, seamed.given, seamed.options
    choices = CreaseChoices(surface)
    if arguments.flag("creases", creases):
        choices = crease_choices(surface, given, preset, chosen, sharp, share_of(progress, 0.0, 0.0))
    if pins is not None:
        choices = replace(choices, possible=None)
    if texels is not None:
        arguments.require_type("texels", texels, TexelLayout)
        if pins is not None:
            raise InputError("WRONG_PARAMETER", "pins and texels both say how large islands are; pass one of them.")
        if chosen.seamless is not None:
            refuse_of_seamless()
    packing = Packing(pack, margin, udim, stack, effort)
    if udim is not None:
        chosen = replace(chosen, square_share=float(udim))
    packs = _may_pack(packing, chosen, pins, texels)
    is_free = arguments.flag("symmetric", symmetric) and count is None
    solvers = Solvers()
    objective = objective_of(preset, chosen, weights)

    def mapped(options: Options, progress: Progress | None) -> Mapped:
        def make(opened: Surface, share: Progress | None) -> tuple[CompletedCones, Result]:
            return best_map(solvers.of(opened), given, options, objective, pins, share, symmetric=is_free)

        return best_at_creases(choices, options, objective, make, progress)

    mapping = share_of(progress, 0.0, PACKING if packs else 1.0)
    found = best_for_strokes(surface, chosen, mapped, mapping)
    surface, result = found[0], found[2]
    if pins is None:
        result = best_division(solvers.of(surface), found[1], result, chosen, objective, mapping)
    result = seamed.told(replace(result, choices=objective.choices))
    if packs:
        packing = replace(packing, effort=preset_effort(preset) if effort is None else effort)
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
        if is_so and packing.effort is not None:
            arguments.refuse("effort", packing.effort, f"leave it out, since this layout is {why}")
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
    progress: Progress | None = None,
) -> CreaseChoices:
    """The borders of `crease_borders` that a preset requires, and those with which it may become better.

    "bake" requires all; "paint" those of components with curvature at more than 24 vertices, since fewer can be cones,
    across which the texture continues. Both may gain by those of other components with half of their curvature on
    creases, unless the number of cones is given. Seamless layouts on squares, as with "tile", may gain by those of hard
    components where no cones or seams are marked. With straight borders or prescribed turning: none.
    sharp, errors: as for `crease_borders`. progress: without time of its own.
    """
    find_borders = partial(crease_borders, surface, sharp=sharp, progress=share_of(progress, 0.0, 0.0))
    most_corners = _MOST_CORNERS[preset]
    if options.border != "free" or options.loop_turning or options.seams == "exact":
        return CreaseChoices(surface)
    if options.seamless is not None:
        is_free = given.is_free and follows_features(surface, options)
        further = find_borders() if is_free else ()
        return CreaseChoices(surface, further if len(further) else None, preset)
    if most_corners is None:
        return CreaseChoices(surface)
    required = find_borders(given.cones, most_corners=most_corners)
    if given.count is not None:
        return CreaseChoices(_ending_at(surface, required))
    possible = find_borders(given.cones, least_share=_LEAST_SHARE_TO_TRY)
    further = possible[~np.isin(keys_of(possible, surface), keys_of(required, surface))]
    return CreaseChoices(_ending_at(surface, required), further if len(further) else None, preset)


class Solvers:
    """A solver for each surface: what one call computes serves the next ones."""

    def __init__(self) -> None:
        self._known: list[Solver] = []

    def of(self, surface: Surface) -> Solver:
        for solver in self._known:
            if solver.surface is surface:
                return solver
        self._known.append(Solver(surface, self._known[-1] if self._known else None))
        return self._known[-1]


def best_at_creases(
    choices: CreaseChoices,
    options: Options,
    objective: Objective,
    make: MakeMap,
    progress: Progress | None = None,
) -> Mapped:
    """The surface with the best borders among the possible ones, its cones and its map.

    Other borders are tried on components that may gain by them; and all of them where no map is found without.
    objective: by which maps that are not seamless are compared. make: the cones and the map of a surface, as of
    `best_map`. progress, errors: of `make`.
    """
    surface, is_possible = choices.surface, choices.possible is not None
    trying = share_of(progress, 0.0, _TRYING if is_possible else 1.0)
    try:
        best = surface, *make(surface, trying)
    except SolverError as error:
        if error.code != "SOLVER_FAILED" or choices.possible is None:
            raise
        # Ending at creases it takes fewer cones, or none.
        opened = _ending_at(surface, choices.possible)
        return opened, *make(opened, share_of(progress, _TRYING, 1.0))
    if is_possible:
        components = Components.of(surface)
        possible = _PossibleBorders(choices.possible, components.of_edges(choices.possible))
        rest = share_of(progress, _TRYING, 1.0)
        if options.seamless is not None:
            best = _gaining(AlongLattice(components, choices.possible), possible, best, make, rest)
        else:
            gain = LowerCost(components, choices.possible, objective)
            with objective.bounded(gain.cost(best[2], share_of(rest, 0.0, 0.0))):
                best = _gaining(gain, possible, best, make, rest)
    tell(progress, 1.0)  # maps that were not needed leave their time
    return best


def best_for_strokes(
    surface: Surface,
    options: Options,
    mapped: Callable[[Options, Progress | None], Mapped],
    progress: Progress | None = None,
) -> Mapped:
    """The map with angles of least distortion, or one that follows the surface's strokes where it gains by that.

    mapped: the map with some options. progress, errors: of `mapped`.
    """
    if not (options.follow_strokes and has_strokes(surface)):
        return mapped(options, progress)
    usual = mapped(replace(options, follow_strokes=False), share_of(progress, 0.0, _TRYING))
    if direction_error(usual[2]) > LEAST_DIRECTION_ERROR:
        toward = or_none(partial(mapped, options, share_of(progress, _TRYING, 1.0)))
        if toward is not None and follows_strokes_better(toward[2], usual[2]):
            return toward
    tell(progress, 1.0)
    return usual


@dataclass(frozen=True, slots=True)
class _PossibleBorders:
    """Borders at which components may end: edges, (b, 2), and the component of each, (b,)."""

    edges: IndexArray
    component: NDArray[np.intp]

    def not_in(self, surface: Surface) -> NDArray[np.intp]:
        """The components that do not end at all of theirs yet."""
        is_new = ~np.isin(keys_of(self.edges, surface), keys_of(surface.borders, surface))
        return np.unique(self.component[is_new])

    def of(self, components: NDArray[np.intp]) -> IndexArray:
        return self.edges[np.isin(self.component, components)]


def _gaining(
    gain: BorderGain,
    possible: _PossibleBorders,
    usual: Mapped,
    make: MakeMap,
    progress: Progress | None,
) -> Mapped:
    """The usual map, or a better one, in which components that gain by their borders end there."""
    # Comparing, and the map of those that gain, where others do not, have no time of their own.
    begin, end = (share_of(progress, done, done) for done in (0.0, 1.0))
    surface = usual[0]
    chosen = possible.not_in(surface)
    chosen = chosen[gain.may_gain(usual[2], chosen, begin)]
    for stage in (progress, end):
        if not len(chosen):
            break
        opened = _ending_at(surface, possible.of(chosen))
        found = or_none(partial(make, opened, stage))
        if found is None:
            break
        gains = gain.gains(found[1], usual[2], chosen)
        if gains.all():
            return (opened, *found) if gain.may_replace(found[1], usual[2], end) else usual
        chosen = chosen[gains]
    return usual


def _ending_at(surface: Surface, borders: IndexArray) -> Surface:
    return replace(surface, borders=np.concatenate([surface.borders, borders]))
