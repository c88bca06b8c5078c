# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of all objects that are stacked on others of their shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.islands import Islands

FloatArray = NDArray[np.float64]
Pack = Callable[[Sequence[Islands]], list[FloatArray]]


def packed_in_stacks(parts: Sequence[Islands], pack: Pack, *, mirrored: bool) -> tuple[list[FloatArray], int]:
    """The new corner_uv of each part, with one island of each shape packed and the others on it; how many these are.

    parts: of one scale. pack: for those that are packed. mirrored: whether reflected islands have one shape.
    Islands with pins stay out of stacks.
    """
    ends = np.cumsum([len(part.island) for part in parts])
    first = np.cumsum([0, *(int(part.island.max(initial=-1)) + 1 for part in parts)])
    # Shapes are compared where both axes have the same unit of length.
    squeezes = [native.lsgp.correct_aspect((1.0, 1.0), part.aspect) for part in parts]
    places = np.concatenate([part.corner_uv / squeeze for part, squeeze in zip(parts, squeezes, strict=True)])
    island = np.concatenate([_unpinned(part, at) for part, at in zip(parts, first, strict=False)])
    stacks = native.lsgp.find_stacks(places, island.astype(np.int32), mirrored=mirrored)
    kept = np.split(stacks.kept, ends[:-1])
    there = [i for i, of_part in enumerate(kept) if of_part.any()]
    corner_uv = [part.corner_uv.copy() for part in parts]
    for i, uv in zip(there, pack([_only(parts[i], kept[i]) for i in there]), strict=True):
        corner_uv[i][kept[i]] = uv
    return np.split(stacks.stacked(np.concatenate(corner_uv)), ends[:-1]), stacks.count


def _unpinned(part: Islands, first: int) -> NDArray[np.int32]:
    """The islands numbered from `first`, -1 for those with pins."""
    return np.where(part.stays, -1, part.island + first)


def _only(part: Islands, kept: NDArray[np.bool_]) -> Islands:
    island = np.unique(part.island[kept], return_inverse=True)[1].ravel().astype(np.int32)
    return replace(
        part,
        triangles=part.triangles[kept],
        corner_uv=part.corner_uv[kept],
        island=island,
        pinned=part.pinned[kept],
    )
