# SPDX-License-Identifier: GPL-3.0-or-later
"""From a surface to a finished map in one call: the library's choice among maps, and where their islands lie."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from .. import _lsgp
from ..api import given_cones, option_values, pin_arrays, to_result
from ..base import arguments
from ..base.arguments import FloatArray
from ..base.progress import Progress, share_of
from ..errors import InputError
from ..layouts.packing import Effort, Pack, Packing, Stack, laid_out
from ..layouts.texels import TexelLayout, at_texel_density, refuse_of_seamless, with_tiny_findings
from ..options import Options, Seamless
from ..results import Choice, Placement, Result
from ..surface import Pins, Surface, surface_arrays

Preset = Literal["paint", "tile", "bake"]

TIME_LIMIT = "TIME_LIMIT"
# The stretch of the map that automatic cones are to reach, as of `place_cones`.
TARGET = 1.05
# Of the time of a press: choosing the map, where islands are packed afterward.
PACKING = 0.9


@dataclass(frozen=True, slots=True)
class Weights:
    """What the parts of a map's quality are worth in a choice, in hundredths of L2 stretch.

    islands: each one; a tenth of them where there are more than ten. cuts: those as long as the square root of the
    surface's area. borders: the same at creases, across which the texture does not run on. cones: each one, around
    which it turns; of several components by the square root of their share of the area. square: as much of the texture
    as islands fill, left empty. strips: that tubes, by their share of the area, are laid out straight, as
    strips. symmetry: that cuts run alike on both sides of a mirror plane; half of it, that cones
    do.

    A larger weight is obeyed at the cost of the others, 0 is no wish at all.  Raises InputError.
    """

    islands: float = 0.4
    cuts: float = 0.3
    borders: float = 0.3
    cones: float = 0.1
    square: float = 1.2
    strips: float = 15.0
    symmetry: float = 1.0

    def __post_init__(self) -> None:
        for name in self.__slots__:
            remedy = "pass a finite number that is not negative"
            if not 0 <= arguments.number(f"weights.{name}", getattr(self, name), remedy) < math.inf:
                arguments.refuse(f"weights.{name}", getattr(self, name), remedy)


_ROWS = {preset: _lsgp.preset(preset) for preset in get_args(Preset)}
_EFFORTS: dict[Preset, Effort] = {preset: row["effort"] for preset, row in _ROWS.items()}


def preset_weights(preset: Preset) -> Weights:
    """What a preset of `auto_unwrap` chooses by; `dataclasses.replace` changes some of it.  Raises InputError."""
    arguments.require_choice("preset", preset, get_args(Preset))
    return Weights(**_ROWS[preset]["weights"])


def preset_effort(preset: Preset) -> Effort:
    """How long a preset of `auto_unwrap` looks for a layout, as of `pack_islands`.  Raises InputError."""
    arguments.require_choice("preset", preset, get_args(Preset))
    return _EFFORTS[preset]


def preset_options(preset: Preset) -> Options:
    """The options of a preset of `auto_unwrap`; `dataclasses.replace` changes some of them.

    preset: "paint" preserves lengths, for texture painting, and cuts islands that would leave most of the square empty;
        "tile" makes seams invisible for a tileable texture of squares, except where hard parts end at creases that
        cannot run along the tiles; "bake" is for computed textures: it preserves lengths, cuts islands so that they
        fill the square, and hard surfaces at their creases.
    With every preset no island overlaps itself, unless `seams` is "exact".  Raises InputError.
    """
    arguments.require_choice("preset", preset, get_args(Preset))
    row = _ROWS[preset]
    return Options(seamless=Seamless() if row["is_seamless"] else None, **row["options"])


@dataclass(frozen=True, slots=True)
class ChosenMap:
    """A map as it is chosen, with its islands side by side.

    surface: with the borders of the map. placement: of automatic cones; None without.
    packed_quickly: (m, 3, 2), its islands as they were packed for the choice, as for `laid_out`; None: they were not.
    """

    surface: Surface
    result: Result
    placement: Placement | None
    packed_quickly: FloatArray | None


def choose_map(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | FloatArray | None = None,
    *,
    preset: Preset = "paint",
    options: Options | None = None,
    count: int | None = None,
    target: float = TARGET,
    symmetric: bool = True,
    charts: bool = True,
    creases: bool = True,
    sharp: ArrayLike | None = None,
    pins: Pins | None = None,
    weights: Weights | None = None,
    seconds: float | None = None,
    progress: Progress | None = None,
) -> ChosenMap:
    """The map of `auto_unwrap`, which takes the same arguments and raises the same errors.

    charts: whether charts that marked seams bound get cones and cuts only where they need some, and one-sided
        components are cut open.
    """
    chosen, chosen_weights = preset_options(preset), preset_weights(preset)
    if options is not None:
        arguments.require_type("options", options, Options)
        chosen = options
    if weights is not None:
        arguments.require_type("weights", weights, Weights)
        chosen_weights = weights
    arguments.require_callable(progress)
    remedy = "pass an L2 stretch, a finite number above 1"
    if not 1 < arguments.number("target", target, remedy) < math.inf:
        arguments.refuse("target", target, remedy)
    if count is not None:
        count = arguments.whole_number("count", count, 0, "pass a number of cones, or None for automatic")
    if count is not None and chosen.seams == "exact":
        arguments.refuse("count", count, 'leave it out: with the seams "exact" no cones are placed')
    if seconds is not None:
        remedy = "pass a positive number of seconds, or None for no limit"
        if not arguments.number("seconds", seconds, remedy) > 0:
            arguments.refuse("seconds", seconds, remedy)
    values = {
        "preset": preset,
        "options": option_values(chosen),
        "weights": asdict(chosen_weights),
        "count": count,
        "target": float(target),
        "symmetric": arguments.flag("symmetric", symmetric),
        "charts": charts,
        "creases": arguments.flag("creases", creases),
        "seconds": None if seconds is None else float(seconds),
    }
    marked = np.empty((0, 2), np.int32) if sharp is None else arguments.index_rows("sharp", sharp, 2)
    given = given_cones(cones, angles)
    found = _lsgp.auto_unwrap(surface_arrays(surface), given, marked, values, pin_arrays(pins), progress)
    placement = None if found["placement"] is None else Placement(**found["placement"])
    result = replace(to_result(found["result"], found["borders"]), choices=[Choice(*one) for one in found["choices"]])
    return ChosenMap(replace(surface, borders=found["borders"]), result, placement, found["packed_quickly"])


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
    inside: float | None = None,
    effort: Effort | None = None,
    texels: TexelLayout | None = None,
    up: Sequence[float] | None = None,
    weights: Weights | None = None,
    seconds: float | None = None,
    progress: Progress | None = None,
) -> Result:
    """Unwrap a surface ready for use: place missing cones and apply a preset.

    Marked seams are cut. A chart that they bound gets further cuts only if it is no disk, its L2 stretch exceeds the
    target, or it overlaps itself, and cones only if cuts alone do not help. With `Options.seams` "exact" there are
    neither. With given cones, and in seamless layouts, the texture runs on across the seams of components that get
    cones.

    One-sided components are cut open, so that they get a map, where neither cones, `count` nor pins are given and
    `Options.seams` is not "exact"; otherwise they are refused, unless marked seams open them.

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
        invisible. And whether tubes, as of `find_tubes`, may end where they do, to become strips.
    pack: "tight": as by `pack_islands`; "shelves": in rows; None: tight, unless the margins leave no room. Layouts that
        are seamless, pinned or in UDIM tiles at a texel density are never packed.
    margin: with "tight", around each island, as a fraction of the square's side; None: 4 / 1024 or, of so many islands
        that the gaps would take more than a quarter of their room, less, down to 0.5 / 1024, before the layout gets a
        texel density. udim: most UDIM tiles that a tight layout is spread over, as for `pack_islands`, and its
        `Options.square_share`; not with texels, which have their own.
    stack: in tight layouts, islands of one shape are stacked, as by `find_stacks`: "same", or "mirrored", which
        includes reflected ones. `ISLANDS_STACKED` among the warnings says how many; they do not count as overlaps.
    inside: in tight layouts, the texel density of islands that nothing outside can see, relative to that of the
        others, 0.01 to 1, for instance 0.25: no ray from them leaves the surface, which hides what is behind it from
        both sides. ISLANDS_HIDDEN among the warnings says which. None: the same. Not with texels.
    effort: how long a tight layout is looked for, as of `pack_islands`; None: "quick" with "paint", else "good".
    seconds: after so many the best map made until then is packed quickly, and TIME_LIMIT among the warnings says so; it
        is raised where no map was made in time. None: no limit. Results depend on the machine then.
    weights: by which maps are compared; None: `preset_weights(preset)`. `Result.choices` says what they chose from.
    up: (3,), what is to point up in the image, as far as islands of a tight layout in one square can be turned by
        quarters at no loss, as by `stand_upright`; None: nothing.
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
    if texels is not None:
        arguments.require_type("texels", texels, TexelLayout)
        if pins is not None:
            raise InputError("WRONG_PARAMETER", "pins and texels both say how large islands are; pass one of them.")
        if chosen.seamless is not None:
            refuse_of_seamless()
        if inside is not None:
            raise InputError("WRONG_PARAMETER", "inside and texels both say how large islands are; pass one of them.")
    packing = Packing(pack, margin, udim, stack, effort, up, inside)
    if udim is not None:
        chosen = replace(chosen, square_share=float(udim))
    packs = _may_pack(packing, chosen, pins, texels)
    arguments.require_callable(progress)
    begin = time.monotonic()
    found = choose_map(
        *(surface, cones, angles),
        **{"preset": preset, "options": chosen, "count": count, "target": target, "symmetric": symmetric},
        **{"creases": creases, "sharp": sharp, "pins": pins, "weights": weights},
        seconds=seconds,
        progress=share_of(progress, 0.0, PACKING if packs else 1.0),
    )
    result = found.result
    if packs:
        packing = replace(packing, effort=preset_effort(preset) if effort is None else effort)
        packing = in_time(packing, is_late=seconds is not None and time.monotonic() - begin > seconds)
        placing = share_of(progress, PACKING, 1.0)
        result = laid_out(found.surface, result, packing, texels, placing, packed_quickly=found.packed_quickly).result
    elif texels is not None:
        result = at_texel_density(found.surface, result, texels)
    return with_tiny_findings(result)


def in_time(packing: Packing, *, is_late: bool) -> Packing:
    """How the islands of a map are packed: quickly when its time is over."""
    return replace(packing, effort="quick") if is_late and packing.is_tight else packing


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
        for name in ("udim", "stack", "inside", "effort"):
            value = getattr(packing, name)
            if is_so and value is not None:
                arguments.refuse(name, value, f"leave it out, since this layout is {why}")
    if texels is not None and packing.udim is not None:
        arguments.refuse("udim", packing.udim, "leave it out and pass that of texels, whose density says the size")
    return packing.is_tight and not any(fixed.values())
