# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the islands of a selection were, and at which density; what is told of where they got."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.islands import Islands, Place, Surroundings
from ..tasks.areas import size_in_texels, total_area
from ..tasks.unwrapped import Unwrapped

FloatArray = NDArray[np.float64]

NO_EXTENT = 1e-5
"""Of a tile; coordinates have single precision."""
# What is told: of the density that was asked for, and of where others leave no room.
_NOTICEABLE = 0.995
_FARTHER = "beside the tile, in which the other islands leave no room"


def place_of(solved: Sequence[Unwrapped], surroundings: Surroundings) -> Place:
    """That of the faces of some maps; faces that are not mapped stay."""
    earlier = [_finite(unwrapped.region.corner_uv[unwrapped.result.solved]) for unwrapped in solved]
    unmapped = [_finite(unwrapped.region.corner_uv[~unwrapped.result.solved]) for unwrapped in solved]
    corners = np.concatenate(earlier).reshape(-1, 2)
    box = None
    if len(corners) and (np.ptp(corners, axis=0) > NO_EXTENT).all():
        box = np.stack([corners.min(axis=0), corners.max(axis=0)])
    return Place(np.concatenate([surroundings.corner_uv, *unmapped]), box, keeps_density=True)


def at_density(
    solved: Sequence[Unwrapped],
    parts: Sequence[Islands],
    surroundings: Surroundings,
    hidden: Sequence[NDArray[np.bool_]] | None = None,
) -> tuple[Place, list[Islands]]:
    """The place of maps, and their islands, which have one density, at that which their faces had; that of the others,
    if they had none.  hidden: (m,) of each map, triangles whose density has no say, as it may be less."""
    place = place_of(solved, surroundings)
    wanted = 0.0
    if place.box is not None:
        kept = [np.isfinite(u.region.corner_uv).all(axis=(1, 2)) & u.result.solved for u in solved]
        if hidden is not None:
            kept = [of & ~is_hidden for of, is_hidden in zip(kept, hidden, strict=True)]
        covered = sum(total_area(u.region.corner_uv[of]) for u, of in zip(solved, kept, strict=True))
        size = np.linalg.norm([size_in_texels(u.region, of) for u, of in zip(solved, kept, strict=True)])
        wanted = np.sqrt(covered) / size if size > 0 else 0.0
    elif surroundings.size > 0:
        wanted = np.sqrt(total_area(surroundings.corner_uv)) / surroundings.size
    now = [
        (total_area(part.corner_uv[~part.stays]), size_in_texels(u.region, _moves(u, part)))
        for u, part in zip(solved, parts, strict=True)
    ]
    area, size = sum(one for one, _ in now), np.linalg.norm([one for _, one in now])
    if not (wanted > 0 and area > 0 and size > 0):
        return replace(place, keeps_density=False), list(parts)
    factor = wanted * size / np.sqrt(area)
    scaled = [
        replace(part, corner_uv=np.where(part.stays[:, None, None], part.corner_uv, factor * part.corner_uv))
        for part in parts
    ]
    return place, scaled


def told(place: Place, wanted: Sequence[FloatArray], packed: Sequence[FloatArray]) -> list[str]:
    """What is to be said of islands, by their coordinates at the density they were to have and as they are packed."""
    found = []
    covered, asked = sum(map(total_area, packed)), sum(map(total_area, wanted))
    if place.keeps_density and covered < _NOTICEABLE**2 * asked:
        found.append(f"at {100 * np.sqrt(covered / asked):.0f} % of the density, for which there is no room")
    right = 1.0 if place.box is None else np.ceil(place.box[1, 0])
    if min(uv[..., 0].min() for uv in packed) >= right:
        found.append(_FARTHER)
    return found


def _moves(unwrapped: Unwrapped, part: Islands) -> NDArray[np.bool_]:
    """(m,), the triangles of the map that the part has and that do not stay."""
    moves = unwrapped.result.solved.copy()
    moves[moves] = ~part.stays
    return moves


def _finite(triangles: FloatArray) -> FloatArray:
    return triangles[np.isfinite(triangles).all(axis=(1, 2))]
