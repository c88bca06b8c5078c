# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands packed close together, by quarter turns and shifts, with the packer of xatlas."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .api import Progress, Result, Surface
from .arguments import FloatArray, IndexArray
from .chart_packer import Islands, Layout, Packer, Square, find_xatlas
from .errors import Cancelled, InputError
from .island_gaps import border_edges
from .texels import TexelLayout, at_texel_density, outside_findings
from .triangles import uv_area

Pack = Literal["tight", "shelves"]
SHELVES = "shelves"

INSTALL = "pip install 'lsgp[pack]'"
DEFAULT_MARGIN = 4 / 1024
"""Around each island, of the square's side."""

# Ways to turn islands by quarter turns that are tried; of many islands fewer, since each takes longer.
_TRIES = 24
_ISLANDS_OF_ALL_TRIES = 64
# Of the islands of the best layout, so many keep their turn when some are turned.
_KEPT = 0.7


@dataclass(frozen=True, slots=True)
class Packing:
    """How the islands of a finished map are laid out.

    pack: "tight": as by `pack_islands`; "shelves": side by side, as they come from `parameterize`; None: tight if that
        is installed and the margins leave room, otherwise on shelves. margin: of tight layouts, of the square's side;
        None: `DEFAULT_MARGIN` before the layout gets a texel density, which scales it too.
    """

    pack: Pack | None = None
    margin: float | None = None

    def __post_init__(self) -> None:
        """Raises InputError: WRONG_PARAMETER, PACKER_NOT_INSTALLED."""
        if self.pack is not None:
            arguments.require_choice("pack", self.pack, get_args(Pack))
        if self.margin is not None:
            _square(self.margin, fill=True)
            if self.pack != "tight":
                arguments.refuse("margin", self.margin, 'pass it with pack="tight", or leave it out')
        if self.pack == "tight":
            require_packer()

    @property
    def is_tight(self) -> bool:
        """Whether a tight layout is looked for."""
        return self.pack != SHELVES and packer_name() is not None


def packer_name() -> str | None:
    """Name and version of the packer of tight layouts, on which they depend; None where it is not installed."""
    return None if find_xatlas() is None else f"xatlas {version('xatlas')}"


def require_packer() -> None:
    """Raises InputError: PACKER_NOT_INSTALLED."""
    if find_xatlas() is None:
        raise InputError("PACKER_NOT_INSTALLED", f"Packing islands takes the package xatlas: {INSTALL}, and try again.")


def pack_islands(
    corner_uv: ArrayLike,
    island: ArrayLike,
    margin: float = DEFAULT_MARGIN,
    *,
    fill: bool = True,
    turned: bool = True,
    progress: Progress | None = None,
) -> FloatArray:
    """Put islands close together, into as small a square as is found, and return their coordinates, (m, 3, 2).

    Every island is moved as a whole: by a quarter turn, a shift, and a scale that all of them share, so that texel
    density and the transitions across cuts stay as they are.  Takes the package xatlas: pip install 'lsgp[pack]'.

    corner_uv: (m, 3, 2). island: (m,), -1 for none; such triangles stay.
    margin: around each island, so that twice as much is between two; from 0, less than 0.5.
    fill: the square is the unit square, and the margin is of its side. Otherwise islands keep their size, the square
        begins at the origin, and the margin is in the same unit as they are.
    turned: whether islands may be.
    progress: called at intervals with the fraction done, 0 to 1; if it returns False, Cancelled is raised.
    The result depends on the arguments and the version of the package alone.
    Raises InputError: PACKER_NOT_INSTALLED; WRONG_PARAMETER, also where the margins leave no room for the islands.
    """
    island = arguments.islands("island", island)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    square = _square(margin, arguments.flag("fill", fill))
    may_turn = arguments.flag("turned", turned)
    arguments.require_callable(progress)
    require_packer()
    solved = island >= 0
    if not solved.any():
        return uv.copy()
    islands = _islands(uv, island)
    found = _best_layout(islands, square, may_turn, progress)
    place = (found.place - found.low) / (found.side if square.fill else 1.0)
    out = uv.copy()
    out[solved] = np.stack([place.real, place.imag], axis=-1)[islands.triangles] + square.margin
    return out


def _square(margin: float, fill: bool) -> Square:
    remedy = "pass a margin from 0, less than 0.5"
    found = arguments.number("margin", margin, remedy)
    if not 0 <= found < (0.5 if fill else math.inf):
        arguments.refuse("margin", margin, remedy if fill else "pass a margin, 0 or more")
    return Square(found, fill)


def _islands(uv: FloatArray, island: IndexArray) -> Islands:
    """Of the triangles that are in one.  Raises InputError: WRONG_PARAMETER."""
    solved = np.flatnonzero(island >= 0)
    lost = solved[~np.isfinite(uv[solved]).all(axis=(1, 2))]
    if len(lost):
        raise InputError(
            "WRONG_PARAMETER",
            f"corner_uv is not finite at triangle {lost[0]}, which lies in an island; give such triangles island -1.",
        )
    _, of_triangle = np.unique(island[solved], return_inverse=True)
    corners, owner = uv[solved].reshape(-1, 2) + 0.0, np.repeat(of_triangle.ravel(), 3)  # -0.0 is 0.0
    order = np.lexsort((corners[:, 1], corners[:, 0], owner))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(owner[order]) != 0) | (np.diff(corners[order], axis=0) != 0).any(axis=1)
    vertices = np.empty(len(order), np.int64)
    vertices[order] = np.cumsum(new) - 1
    place = corners[order[new]] @ np.array([1, 1j])
    triangles = vertices.reshape(-1, 3)
    triangle, corner = border_edges(triangles)
    return Islands(
        place=place,
        triangles=triangles,
        island=owner[order[new]],
        borders=np.stack([triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]], axis=1),
        area=uv_area(uv[solved]),
    )


def _best_layout(islands: Islands, square: Square, may_turn: bool, progress: Progress | None) -> Layout:
    """The smallest layout of those that are tried.  Raises InputError, Cancelled."""
    tries = max(1, _TRIES * _ISLANDS_OF_ALL_TRIES // max(islands.count, _ISLANDS_OF_ALL_TRIES)) if may_turn else 1
    packer = Packer(islands, square)
    # The generator whose numbers never change with the version of numpy.
    random = np.random.RandomState(0)
    best: Layout | None = None
    turns = best_turns = np.zeros(islands.count, np.int64)
    for number in range(tries):
        if progress is not None and progress(number / tries) is False:
            raise Cancelled("CANCELLED", "Stopped as asked; nothing was changed.")
        if number == 1:
            turns = np.ones(islands.count, np.int64)
        elif number > 1:
            # Half of them from the best so far, of which some islands are turned.
            kept = random.random_sample(islands.count) < _KEPT if number % 2 else np.zeros(islands.count, bool)
            turns = np.where(kept, best_turns, random.randint(0, 4, islands.count))
        found = packer.improved(turns, best)
        if found is not None:
            best, best_turns = found, turns
    if progress is not None:
        progress(1.0)
    return best


def laid_out(
    surface: Surface, result: Result, packing: Packing, texels: TexelLayout | None, progress: Progress | None = None
) -> tuple[Result, str]:
    """The result with its islands packed and at a texel density, as they are wanted, and who packed them.

    result: of a map that is neither pinned nor seamless. Islands are not turned where a direction was asked for.
    texels: without UDIM tiles.  Raises InputError, Cancelled.
    """
    if not packing.is_tight:
        return (result if texels is None else at_texel_density(surface, result, texels)), SHELVES
    name, turned = packer_name(), result.direction_error is None
    if texels is not None and packing.margin is not None:
        # What is asked for is to be left at this density.
        scaled = at_texel_density(surface, result, texels)
        uv = pack_islands(scaled.corner_uv, result.island, packing.margin, fill=False, turned=turned, progress=progress)
        return replace(scaled, corner_uv=uv, warnings=[*result.warnings, *outside_findings(uv, result.island)]), name
    margin = DEFAULT_MARGIN if packing.margin is None else packing.margin
    try:
        uv = pack_islands(result.corner_uv, result.island, margin, turned=turned, progress=progress)
    except InputError:
        if packing.pack == "tight":
            raise
        name, uv = SHELVES, result.corner_uv
        if progress is not None:
            progress(1.0)
    packed = replace(result, corner_uv=uv)
    return (packed if texels is None else at_texel_density(surface, packed, texels)), name
