# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight packing of islands, by turns and translations, with the packer of xatlas."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress, share_of, tell
from ..base.unit_size import unit_exponent
from ..errors import Elements, Finding, InputError
from ..results import Result
from ..surface import Surface
from .chart_packer import Square, find_xatlas
from .layout_search import LayoutSearch, Turned, islands_of
from .stacking import find_stacks
from .texels import TexelLayout, at_texel_density, outside_findings, tile_count
from .udim_packing import spread_over_tiles

Pack = Literal["tight", "shelves"]
Stack = Literal["same", "mirrored"]
SHELVES = "shelves"

INSTALL = "pip install 'lsgp[pack]'"
DEFAULT_MARGIN = 4 / 1024
"""Around each island, of the square's side."""

# Of the time of packing, and of finding stacks and packing those that stay.
_PREPARING = 0.2
_STACKING = 0.3


@dataclass(frozen=True, slots=True)
class _Kept:
    """What was found, by digests of what was packed, and how."""

    layouts: dict[tuple[object, ...], FloatArray] = field(default_factory=dict)
    searches: dict[tuple[object, ...], LayoutSearch] = field(default_factory=dict)


# None: nothing is kept.
_kept: ContextVar[_Kept | None] = ContextVar("kept", default=None)


@dataclass(frozen=True, slots=True)
class LaidOut:
    """A result with its islands laid out, who packed them, and (m,) bool, the triangles that lie on those of others."""

    result: Result
    packer: str
    stacked: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Packing:
    """How the islands of a finished map are laid out.

    pack: "tight": as by `pack_islands`; "shelves": side by side, as they come from `parameterize`; None: tight if that
        is installed and the margins leave room, otherwise on shelves. margin: of tight layouts, of the square's side;
        None: `DEFAULT_MARGIN` before the layout gets a texel density, which scales it too. udim: over how many UDIM
        tiles a tight layout is spread, as by `pack_islands`. stack: islands of one shape are stacked, as by
        `find_stacks`; "mirrored": reflected ones as well; None: none do.
    """

    pack: Pack | None = None
    margin: float | None = None
    udim: int | None = None
    stack: Stack | None = None

    def __post_init__(self) -> None:
        """Raises InputError: WRONG_PARAMETER, PACKER_NOT_INSTALLED."""
        if self.pack is not None:
            arguments.require_choice("pack", self.pack, get_args(Pack))
        if self.margin is not None:
            _square(self.margin, fill=True)
            if self.pack != "tight" and self.udim is None:
                arguments.refuse("margin", self.margin, 'pass it with pack="tight", or leave it out')
        if self.udim is not None:
            tile_count(self.udim)
            if self.pack == SHELVES:
                arguments.refuse("udim", self.udim, 'pass it with pack="tight", or leave it out')
        if self.stack is not None:
            arguments.require_choice("stack", self.stack, get_args(Stack))
            if self.pack == SHELVES:
                arguments.refuse("stack", self.stack, 'pass it with pack="tight", or leave it out')
        if self.pack == "tight" or self.udim is not None or self.stack is not None:
            require_packer()

    @property
    def is_tight(self) -> bool:
        """Whether a tight layout is attempted."""
        return self.pack != SHELVES and packer_name() is not None


def packer_name() -> str | None:
    """Name and version of the packer of tight layouts, which depend on both; None if it is not installed."""
    return None if find_xatlas() is None else f"xatlas {version('xatlas')}"


def require_packer() -> None:
    """Raises InputError: PACKER_NOT_INSTALLED."""
    if find_xatlas() is None:
        raise InputError("PACKER_NOT_INSTALLED", f"Packing islands takes the package xatlas: {INSTALL}, and try again.")


@contextmanager
def packing_once() -> Iterator[None]:
    """Within it, islands that were packed in the same way before are not packed again, and those that were turned by
    quarters not turned so again: maps are packed to be compared, and the chosen one once more as the result."""
    token = _kept.set(_Kept())
    try:
        yield
    finally:
        _kept.reset(token)


def pack_islands(
    corner_uv: ArrayLike,
    island: ArrayLike,
    margin: float = DEFAULT_MARGIN,
    *,
    fill: bool = True,
    turned: Turned = True,
    udim: int | None = None,
    progress: Progress | None = None,
) -> FloatArray:
    """Pack islands tightly, into the smallest square found, and return their coordinates, (m, 3, 2).

    Every island is moved as a whole: by a turn, a translation, and a common scale, so that texel density is preserved,
    and both sides of a cut stay related by one rotation and one translation.  Requires the package xatlas: pip install
    'lsgp[pack]'.

    corner_uv: (m, 3, 2). island: (m,), -1 for none; such triangles do not move.
    margin: around each island, so that the gap between two is twice as wide; at least 0, less than 0.5.
    fill: the square is the unit square, and the margin is a fraction of its side. Otherwise islands keep their size,
        the square starts at the origin, and the margin is in the unit of the coordinates.
    turned: whether islands may be rotated; "quarters": only by quarter turns. True: those with most of their border
        along the axes by quarter turns as well, unless seven tenths of the square stay empty and other turns make its
        side a tenth shorter: long strips lie along the diagonal.
    udim: the most UDIM tiles that islands are spread over, from 1001 on, so that they become as large as possible;
        fewer are used if the largest island alone fills one. Each island lies inside one tile, with its margin. Only
        with `fill`.
    progress: called at intervals with the fraction done, 0 to 1; if it returns False, Cancelled is raised.
    The result depends only on the arguments and the version of the package.
    Raises InputError: PACKER_NOT_INSTALLED; WRONG_PARAMETER, also if the margins leave no room for the islands.
    """
    island = arguments.islands("island", island)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    square = _square(margin, arguments.flag("fill", fill))
    if not isinstance(turned, bool | np.bool_) and not (isinstance(turned, str) and turned == "quarters"):
        arguments.refuse("turned", turned, 'pass True, False or "quarters"')
    may_turn: Turned = "quarters" if isinstance(turned, str) else bool(turned)
    tiles = 1 if udim is None else tile_count(udim)
    if tiles > 1 and not square.fill:
        arguments.refuse("udim", udim, "leave fill out, or use at_texel_density")
    arguments.require_callable(progress)
    require_packer()
    solved = np.flatnonzero(island >= 0)
    lost = solved[~np.isfinite(uv[solved]).all(axis=(1, 2))]
    if len(lost):
        raise InputError(
            "WRONG_PARAMETER",
            f"corner_uv is not finite at triangle {lost[0]}, which lies in an island; give such triangles island -1.",
        )
    out = uv.copy()
    if not len(solved):
        return out
    kept = _kept.get() or _Kept()
    given = _digest(uv, island)
    asked = given, square, may_turn, tiles
    if asked in kept.layouts:
        tell(progress, 1.0)
        return kept.layouts[asked].copy()
    exponent = unit_exponent(uv[solved], 0.0 if square.fill else square.margin)
    unit_uv = np.ldexp(uv[solved], -exponent)
    if tiles > 1:
        out[solved] = spread_over_tiles(unit_uv, island[solved], square.margin, tiles, may_turn, progress)
    else:
        searched = given, square, bool(may_turn)
        # One that is stopped is not kept.
        unit_square = square if square.fill else replace(square, margin=math.ldexp(square.margin, -exponent))
        search = kept.searches.pop(searched, None)
        if search is None:
            tell(progress, 0.0)
            islands = islands_of(unit_uv, island[solved])
            search = LayoutSearch(islands, unit_square, share_of(progress, 0.0, _PREPARING))
            progress = share_of(progress, _PREPARING, 1.0)
        found = search.best(may_turn, progress)
        kept.searches[searched] = search
        place = (found.place - found.low) / (found.side if square.fill else 1.0)
        packed = np.stack([place.real, place.imag], axis=-1)[search.islands.triangles] + unit_square.margin
        with np.errstate(over="ignore"):
            out[solved] = packed if square.fill else np.ldexp(packed, exponent)
        if not np.isfinite(out[solved]).all():
            raise InputError(
                "WRONG_PARAMETER",
                "The square around the packed islands is larger than numbers can hold. Scale corner_uv and the margin "
                "down.",
            )
    kept.layouts[asked] = out.copy()
    return out


def _digest(uv: FloatArray, island: IndexArray) -> bytes:
    digest = hashlib.blake2b(repr(uv.shape).encode())
    digest.update(np.ascontiguousarray(uv))
    digest.update(np.ascontiguousarray(island))
    return digest.digest()


def _square(margin: float, fill: bool) -> Square:
    remedy = "pass a margin from 0, less than 0.5"
    found = arguments.number("margin", margin, remedy)
    if not 0 <= found < (0.5 if fill else math.inf):
        arguments.refuse("margin", margin, remedy if fill else "pass a margin, 0 or more")
    return Square(found, fill)


def turns_of(result: Result) -> Turned:
    """How the islands of a map may be turned, as of `pack_islands`."""
    if result.features is not None and result.features.share > 0:
        return result.direction_error is None and "quarters"
    return result.direction_error is None


def laid_out(
    surface: Surface, result: Result, packing: Packing, texels: TexelLayout | None, progress: Progress | None = None
) -> LaidOut:
    """The result with its islands packed and at a texel density, as they are wanted.

    result: of a map that is neither pinned nor seamless. Islands are not turned where a direction was asked for, and
        only by quarters where features run straight.
    texels: without UDIM tiles.  Raises InputError, Cancelled.
    """
    none = np.zeros(len(result.island), bool)
    if not packing.is_tight:
        return LaidOut(result if texels is None else at_texel_density(surface, result, texels), SHELVES, none)
    name, turned = packer_name(), turns_of(result)
    if texels is not None and packing.margin is not None:
        # What is asked for is to be left at this density.
        scaled = at_texel_density(surface, result, texels)
        packed, stacked = _packed(scaled, packing.stack, packing.margin, fill=False, turned=turned, progress=progress)
        outside = outside_findings(packed.corner_uv, result.island)
        said = [finding for finding in packed.warnings if finding.code == "ISLANDS_STACKED"]
        return LaidOut(replace(packed, warnings=[*result.warnings, *said, *outside]), name, stacked)
    margin = DEFAULT_MARGIN if packing.margin is None else packing.margin
    try:
        packed, stacked = _packed(result, packing.stack, margin, turned=turned, udim=packing.udim, progress=progress)
    except InputError:
        if packing.pack == "tight" or packing.udim is not None or packing.stack is not None:
            raise
        name, packed, stacked = SHELVES, result, none
        tell(progress, 1.0)
    return LaidOut(packed if texels is None else at_texel_density(surface, packed, texels), name, stacked)


def _packed(
    result: Result, stack: Stack | None, margin: float, *, progress: Progress | None, **how: Any
) -> tuple[Result, NDArray[np.bool_]]:
    """The result packed, and the triangles, (m,) bool, that overlap others.  progress, how: as for `pack_islands`."""
    uv, island = result.corner_uv, result.island
    if stack is None:
        packed = pack_islands(uv, island, margin, **how, progress=progress)
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
