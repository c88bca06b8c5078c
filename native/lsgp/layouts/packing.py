# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight packing of islands, by turns, translations and one scale."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _lsgp
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress, share_of, tell
from ..errors import Elements, Finding, InputError
from ..results import Result
from ..surface import Surface
from .arranging import require_up, upright_turns
from .inside import LEAST_SHARE, with_less_inside
from .stacking import find_stacks
from .texels import TexelLayout, at_texel_density, outside_findings, tile_count
from .upright import stand_upright

Pack = Literal["tight", "shelves"]
Stack = Literal["same", "mirrored"]
Turned = bool | Literal["quarters"]
"""Whether islands may be turned, or by quarters alone."""
Effort = Literal["quick", "good", "best"]
Kept = Literal["place", "rotation", "scale"]
SHELVES = "shelves"

DEFAULT_MARGIN = 4 / 1024
"""Around each island, of the square's side."""

# Of the time of laying out, where islands are looked for that nothing outside can see.
_LOOKING_INSIDE = 0.3
# Of the time of finding stacks and packing those that stay.
_STACKING = 0.3


@dataclass(frozen=True, slots=True)
class LaidOut:
    """A result with its islands laid out, how they are packed, and (m,) bool, the triangles that lie on those of
    others."""

    result: Result
    pack: Pack
    stacked: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Packing:
    """How the islands of a finished map are laid out.

    pack: "tight": as by `pack_islands`; "shelves": side by side, as they come from `parameterize`; None: tight if the
        margins leave room, otherwise on shelves. margin: of tight layouts, of the square's side; None: `DEFAULT_MARGIN`
        or, of so many islands that gaps would take more than a quarter of their room, less, before the layout gets a
        texel density, which scales it too. udim: over how many UDIM tiles a tight layout is spread, as by
        `pack_islands`. stack: islands of one shape are stacked, as by `find_stacks`; "mirrored":
        reflected ones as well; None: none do. effort: of tight layouts, as of `pack_islands`; None: "good".
        up: (3,), what is to point up in a square of islands that may be turned, as by `stand_upright`; None: nothing.
        inside: of tight layouts, the texel density of islands that nothing outside can see relative to that of the
        others, 0.01 to 1; None: the same.
    """

    pack: Pack | None = None
    margin: float | None = None
    udim: int | None = None
    stack: Stack | None = None
    effort: Effort | None = None
    up: Sequence[float] | None = None
    inside: float | None = None

    def __post_init__(self) -> None:
        """Raises InputError: WRONG_PARAMETER."""
        if self.up is not None:
            require_up(self.up)
        if self.pack is not None:
            arguments.require_choice("pack", self.pack, get_args(Pack))
        if self.margin is not None:
            _margin(self.margin, fill=True)
            if self.pack != "tight" and self.udim is None:
                arguments.refuse("margin", self.margin, 'pass it with pack="tight", or leave it out')
        if self.udim is not None:
            tile_count(self.udim)
        if self.stack is not None:
            arguments.require_choice("stack", self.stack, get_args(Stack))
        if self.effort is not None:
            arguments.require_choice("effort", self.effort, get_args(Effort))
        if self.inside is not None:
            remedy = f"pass a share of the texel density, {LEAST_SHARE} to 1"
            if not LEAST_SHARE <= arguments.number("inside", self.inside, remedy) <= 1:
                arguments.refuse("inside", self.inside, remedy)
        for name in ("udim", "stack", "effort", "inside"):
            value = getattr(self, name)
            if value is not None and self.pack == SHELVES:
                arguments.refuse(name, value, 'pass it with pack="tight", or leave it out')

    @property
    def is_tight(self) -> bool:
        """Whether a tight layout is attempted."""
        return self.pack != SHELVES


def pack_islands(
    corner_uv: ArrayLike,
    island: ArrayLike,
    margin: float = DEFAULT_MARGIN,
    *,
    fill: bool = True,
    turned: Turned = True,
    udim: int | None = None,
    effort: Effort = "good",
    seconds: float | None = None,
    area: Sequence[float] | None = None,
    groups: ArrayLike | None = None,
    locks: Mapping[Kept, Sequence[int]] | None = None,
    snap: float | None = None,
    progress: Progress | None = None,
) -> FloatArray:
    """Pack islands tightly and return their coordinates, (m, 3, 2).

    Every island is moved as a whole: by a turn, a translation, and a common scale, so that texel density is preserved,
    and both sides of a cut stay related by one rotation and one translation. Islands are put into bays and holes of
    others, and never mirrored. The layout as it is given is one of those that are compared, so that packing again never
    makes islands smaller; numbers of islands, triangles and corners do not matter.

    corner_uv: (m, 3, 2). island: (m,), -1 for none; such triangles do not move.
    margin: around each island and inside the border, in texture coordinates, so that the gap between two is twice as
        wide; at least 0. Outlines are measured exactly: it is never less.
    fill: islands get the common scale with which they fill the area. Otherwise they keep their size.
    turned: whether islands may be rotated; "quarters": only by quarter turns. True: those with most of their border
        along the axes by quarter turns as well, unless seven tenths of the area stay empty and other turns make its
        side a tenth shorter: long strips lie along the diagonal.
    udim: the most UDIM tiles that islands are spread over, from 1001 on, so that they become as large as possible;
        fewer are used if more do not make islands larger. Each island lies inside one tile, with its margin. Only with
        `fill` and without an area.
    effort: "quick": the first layout, in a hundredth of a second for a hundred islands; "good": the best of some
        hundreds; "best": of many more, for minutes. The same effort gives the same layout on every machine, more effort
        none that is worse.
    seconds: of "best": how long it goes on, but at least until there is the layout of "good", with which it begins.
        What it finds then hangs on the machine.
    area: (left, bottom, right, top), the rectangle that islands are packed into. None: the unit square; without `fill`
        and islands that keep their place, the smallest square that begins at the origin.
    groups: (islands,) numbers of groups, whose islands keep their places relative to each other; -1: alone.
    locks: the islands that keep their "place", in which others leave them their margin, their "rotation" or their
        "scale", for instance {"place": [3, 5]}.
    snap: the side of square blocks in texture coordinates, such as 4 / 1024 for blocks of 4 texels in an image of 1024:
        each island's box begins at the corner of a block, and no two islands share one. At most 8192 fit side by side.
    progress: called at intervals with the fraction done, 0 to 1; if it returns False, Cancelled is raised.
    Raises InputError: WRONG_PARAMETER, also where margins leave no room, islands do not fit, or locked ones lie outside
    the area or overlap; it names them. Where margins or the area's place leave numbers no digits for the shapes of
    islands, it says up to which they would.
    """
    arguments.require_callable(progress)
    island = arguments.islands("island", island)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    count = int(island.max(initial=-1)) + 1
    options = _options(margin, fill, turned, udim, effort, seconds, area, snap)
    if groups is not None:
        options["groups"] = _group_numbers(groups, count)
    options["locks"] = _lock_flags(locks, count)
    return _lsgp.pack_islands(uv, island, options, progress, None)


def _options(
    margin: float,
    fill: bool,
    turned: Turned,
    udim: int | None,
    effort: Effort,
    seconds: float | None,
    area: Sequence[float] | None,
    snap: float | None,
) -> dict[str, Any]:
    """Those of the native function, without groups and locks.  Raises InputError."""
    fills = arguments.flag("fill", fill)
    if not isinstance(turned, bool | np.bool_) and not (isinstance(turned, str) and turned == "quarters"):
        arguments.refuse("turned", turned, 'pass True, False or "quarters"')
    tiles = 1 if udim is None else tile_count(udim)
    if tiles > 1 and not fills:
        arguments.refuse("udim", udim, "leave fill out, or use at_texel_density")
    if tiles > 1 and area is not None:
        arguments.refuse("udim", udim, "leave it or the area out")
    arguments.require_choice("effort", effort, get_args(Effort))
    if seconds is not None:
        arguments.positive("seconds", seconds)
        if effort != "best":
            arguments.refuse("seconds", seconds, 'pass it with effort="best", or leave it out')
    rectangle = None if area is None else _rectangle(area)
    width = 1.0 if rectangle is None else min(rectangle[2] - rectangle[0], rectangle[3] - rectangle[1])
    return {
        "margin": _margin(margin, fills, width),
        "fill": fills,
        "turns": turned if isinstance(turned, str) else "any" if turned else "none",
        "effort": effort,
        "seconds": None if seconds is None else float(seconds),
        "area": rectangle,
        "tiles": tiles,
        "snap": 0.0 if snap is None else arguments.positive("snap", snap, "pass the side of a block, above 0"),
        "groups": np.zeros(0, np.int32),
        "locks": np.zeros((0, 3), bool),
    }


def _rectangle(area: Sequence[float]) -> tuple[float, float, float, float]:
    remedy = "pass (left, bottom, right, top), with some room between them"
    found = arguments.floats("area", area)
    if found.shape != (4,) or not np.isfinite(found).all() or not (found[:2] < found[2:]).all():
        arguments.refuse("area", area, remedy)
    return tuple(found.tolist())


def _group_numbers(groups: ArrayLike, count: int) -> IndexArray:
    found = arguments.islands("groups", groups)
    if len(found) < count:
        raise InputError("WRONG_SHAPE", f"groups has {len(found)} numbers; pass one for each of the {count} islands.")
    return found


def _lock_flags(locks: Mapping[Kept, Sequence[int]] | None, count: int) -> NDArray[np.bool_]:
    """(islands, 3): whether each keeps place, rotation and scale."""
    flags = np.zeros((count, 3), bool)
    if locks is None:
        return flags
    names = get_args(Kept)
    if not isinstance(locks, Mapping):
        arguments.refuse("locks", locks, 'pass the islands that keep their "place", "rotation" or "scale"')
    for name, islands in locks.items():
        arguments.require_choice("locks", name, names)
        numbers = arguments.index_vector("locks", islands)
        arguments.require_indices("locks", numbers, count)
        flags[numbers, names.index(name)] = True
    return flags


def _margin(margin: float, fill: bool, width: float = 1.0) -> float:
    remedy = "pass a margin from 0, less than half of the area's width"
    found = arguments.number("margin", margin, remedy)
    if not 0 <= found < (width / 2 if fill else math.inf):
        arguments.refuse("margin", margin, remedy if fill else "pass a margin, 0 or more")
    return found


def turns_of(result: Result) -> Turned:
    """How the islands of a map may be turned, as of `pack_islands`."""
    if result.features is not None and result.features.share > 0:
        return result.direction_error is None and "quarters"
    return result.direction_error is None


def laid_out(
    surface: Surface,
    result: Result,
    packing: Packing,
    texels: TexelLayout | None,
    progress: Progress | None = None,
    *,
    packed_quickly: FloatArray | None = None,
) -> LaidOut:
    """The result with its islands packed and at a texel density, as they are wanted.

    result: of a map that is neither pinned nor seamless. Islands are not turned where a direction was asked for, and
        only by quarters where features run straight.
    texels: without UDIM tiles, and without `Packing.inside`. packed_quickly: (m, 3, 2), the islands in the square with
        the effort "quick" and the usual margin, so that they need not be packed again; None: not known.
    Raises InputError, Cancelled.
    """
    if packing.inside is not None:
        result = with_less_inside(surface, result, packing.inside, share_of(progress, 0.0, _LOOKING_INSIDE))
        progress = share_of(progress, _LOOKING_INSIDE, 1.0)
    none = np.zeros(len(result.island), bool)
    if not packing.is_tight:
        return LaidOut(result if texels is None else at_texel_density(surface, result, texels), SHELVES, none)
    how: dict[str, Any] = {"turned": turns_of(result), "effort": packing.effort or "good"}
    if texels is not None and packing.margin is not None:
        # What is asked for is to be left at this density.
        scaled = at_texel_density(surface, result, texels)
        packed, stacked = _packed(
            scaled, packing.stack, packing.margin, fill=False, udim=None, **how, progress=progress
        )
        outside = outside_findings(packed.corner_uv, result.island)
        said = [finding for finding in packed.warnings if finding.code == "ISLANDS_STACKED"]
        return LaidOut(replace(packed, warnings=[*result.warnings, *said, *outside]), "tight", stacked)
    if (packing.margin, packing.udim, packing.stack, packing.inside) != (None, None, None, None):
        packed_quickly = None
    margin = packing.margin
    if margin is None:
        margin = _lsgp.usual_margin(result.corner_uv, result.island, packing.udim or 1)
    pack: Pack = "tight"
    try:
        packed, stacked = _packed(
            result,
            packing.stack,
            margin,
            fill=True,
            udim=packing.udim,
            **how,
            packed_quickly=packed_quickly,
            progress=progress,
        )
        if packing.up is not None and how["turned"] and packing.udim in (None, 1) and packing.stack is None:
            turns = upright_turns(surface, packed.corner_uv, packed.island, packing.up)
            packed = replace(packed, corner_uv=stand_upright(packed.corner_uv, packed.island, turns, margin=margin))
    except InputError:
        if packing.pack == "tight" or packing.udim is not None or packing.stack is not None:
            raise
        pack, packed, stacked = SHELVES, result, none
        tell(progress, 1.0)
    return LaidOut(packed if texels is None else at_texel_density(surface, packed, texels), pack, stacked)


def _packed(
    result: Result,
    stack: Stack | None,
    margin: float,
    *,
    progress: Progress | None,
    packed_quickly: FloatArray | None = None,
    **how: Any,
) -> tuple[Result, NDArray[np.bool_]]:
    """The result packed, and the triangles, (m,) bool, that overlap others.  how: fill, turned, udim and effort, these
    and progress as for `pack_islands`.  packed_quickly: as of `laid_out`, without stacks."""
    uv, island = result.corner_uv, result.island
    if stack is None:
        options = _options(margin, **how, seconds=None, area=None, snap=None)
        packed = _lsgp.pack_islands(uv, island, options, progress, packed_quickly)
        return replace(result, corner_uv=packed), np.zeros(len(island), bool)
    stacks = find_stacks(uv, island, mirrored=stack == "mirrored", progress=share_of(progress, 0.0, _STACKING))
    left = np.where(stacks.kept, island, -1).astype(np.int32)
    packed = stacks.stacked(pack_islands(uv, left, margin, **how, progress=share_of(progress, _STACKING, 1.0)))
    warnings = list(result.warnings)
    if stacks.count:
        message = (
            f"{stacks.count} of {int(island.max()) + 1} islands are stacked on others of their shape and share their "
            "texels."
        )
        warnings.append(
            Finding("ISLANDS_STACKED", message, Elements("triangles", np.flatnonzero(~stacks.kept).astype(np.int32)))
        )
    return replace(result, corner_uv=packed, warnings=warnings), ~stacks.kept
