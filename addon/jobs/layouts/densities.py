# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps at a texel density, per unit of length in the world."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.islands import Place
from ..tasks.unwrapped import Unwrapped
from .packing import pack_at_scale, pack_in_place

if TYPE_CHECKING:
    import lsgp

FloatArray = NDArray[np.float64]

# Of a layout that fits exactly, in tiles.
ROUNDING = 1e-9


def packed_at_density(
    solved: Sequence[Unwrapped],
    layouts: Sequence[FloatArray],
    layout: lsgp.TexelLayout,
    *,
    unit: float,
    place: Place | None = None,
    **how: Any,
) -> list[FloatArray]:
    """The coordinates of each map, (m, 3, 2), at the density, each island inside one tile with the margin around it.

    The density is that of objects with the density weight 1; others get as many times as much as their weight says.

    They lie close together in one tile where they fit, and otherwise in rows in `layout.udim` tiles.

    layouts: of one scale. layout: with udim. place: of a selection, into which they go. how: as of `packing.pack`.
    unit, errors: as of `at_density`.
    """
    if any(unwrapped.aspect != 1.0 for unwrapped in solved):
        raise Refused("the image is not square, so its texels have two densities; use a square one")
    scaled, _ = at_density(solved, layouts, replace(layout, udim=None), share=True, unit=unit)
    parts = [
        replace(unwrapped.islands(), corner_uv=uv[unwrapped.result.solved])
        for unwrapped, uv in zip(solved, scaled, strict=True)
    ]
    margin = layout.margin / layout.texture_size
    if place is not None:
        packed = pack_in_place(parts, margin, place, **how)
    else:
        packed = pack_at_scale(parts, margin, **how)
        if packed is None or max(uv.max() for uv in packed) + margin > 1 + ROUNDING:
            return at_density(solved, layouts, layout, share=True, unit=unit)[0]
    for unwrapped, uv, at in zip(solved, scaled, packed, strict=True):
        uv[unwrapped.result.solved] = at
    return scaled


def at_density(
    solved: Sequence[Unwrapped],
    layouts: Sequence[FloatArray],
    layout: lsgp.TexelLayout,
    *,
    share: bool,
    unit: float = 1.0,
) -> tuple[list[FloatArray], list[lsgp.Finding]]:
    """The coordinates of each map, (m, 3, 2), at the density, and what is to be said of them.

    unit: that of the density, in Blender's own. share: whether the maps share one texture, in which they have one scale
    already; otherwise each is in one of its own.  Raises InputError; Refused where an object has no size.
    """
    scaled: list[FloatArray] = []
    findings: list[lsgp.Finding] = []
    groups = [range(len(solved))] if share else [[i] for i in range(len(solved))]
    for group in groups:
        maps, found = _together([solved[i] for i in group], [layouts[i] for i in group], layout, unit)
        scaled += maps
        findings += found
    return scaled, findings


def _together(
    solved: Sequence[Unwrapped], layouts: Sequence[FloatArray], layout: lsgp.TexelLayout, unit: float
) -> tuple[list[FloatArray], list[lsgp.Finding]]:
    """As above, of maps in one texture."""
    lsgp = native.lsgp
    if not all(unwrapped.region.object_scale for unwrapped in solved):
        raise Refused("an object is scaled to zero, so texels have no size on it; scale it up")
    # One surface in the world, with triangles, islands and coordinates of all; more texels are those of longer edges.
    positions = [unwrapped.region.surface.positions * (unwrapped.region.texel_scale / unit) for unwrapped in solved]
    triangles = [unwrapped.region.surface.triangles for unwrapped in solved]
    islands = [unwrapped.result.island for unwrapped in solved]
    first_vertex = _begins(map(len, positions))
    first_island = _begins(int(island.max(initial=-1)) + 1 for island in islands)
    surface = lsgp.Surface(
        np.concatenate(positions),
        np.concatenate([own + first for own, first in zip(triangles, first_vertex, strict=True)]).astype(np.int32),
    )
    island = np.concatenate(
        [np.where(own < 0, own, own + first) for own, first in zip(islands, first_island, strict=True)]
    )
    whole = replace(
        solved[0].result,
        corner_uv=np.concatenate(layouts),
        island=island.astype(np.int32),
        solved=island >= 0,
        warnings=[],
    )
    try:
        placed = lsgp.at_texel_density(surface, whole, layout)
    except lsgp.InputError as error:
        # It names triangles of the joint surface, which nobody knows.
        raise lsgp.InputError(error.code, error.message) from error
    ends = np.cumsum([len(own) for own in triangles])[:-1]
    return np.split(placed.corner_uv, ends), placed.warnings


def _begins(counts: Iterable[int]) -> NDArray[np.int64]:
    """Where each begins of what is counted one after the other."""
    counts = np.array(list(counts), np.int64)
    return np.cumsum(counts) - counts
