# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing of finished islands, those of all objects together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.islands import Islands

FloatArray = NDArray[np.float64]

NO_MARGIN = 1e-4
"""Where not even so narrow a margin leaves room, islands have none."""
UNIT_SQUARE = np.array([[0.0, 0.0], [1.0, 1.0]])


def pack(parts: Sequence[Islands], margin: float, *, turned: bool = True, udim: int = 1) -> list[FloatArray]:
    """Pack the islands of all parts together into the unit square; returns the new corner_uv of each part.

    margin: around each island, of the longer side of the image; halved until it leaves room. turned: whether islands
    may be, as of `lsgp.pack_islands`; not where images have different aspects. udim: over how many UDIM tiles they are
    spread at most.
    Every island is moved by a single similarity; those with pins stay, and others leave them their margin.  Raises
    Refused where several tiles are asked for that cannot be filled.
    """
    if udim > 1:
        return _spread(parts, margin, turned, udim)
    squeeze = _common_squeeze(parts)
    if squeeze is None:
        return _packed(parts, np.ones(2), margin, turned=False)
    return _packed(parts, squeeze, margin, turned=turned)


def pack_at_scale(parts: Sequence[Islands], margin: float, *, turned: bool) -> list[FloatArray] | None:
    """Put the islands of all parts close together in a square that begins at the origin, and leave their size.

    Returns, margin, turned: as of `pack`; None where islands are pinned or an image is not square.
    """
    if _obstacle(parts) is not None:
        return None
    return _pack_islands(parts, margin, turned=turned, fill=False)


def _spread(parts: Sequence[Islands], margin: float, turned: bool, udim: int) -> list[FloatArray]:
    obstacle = _obstacle(parts)
    if obstacle is None:
        try:
            return _pack_islands(parts, margin, turned=turned, udim=udim)
        except native.lsgp.InputError:
            obstacle = "the margin leaves no room for so many islands; lower it"
    raise Refused(f"Islands cannot be spread over UDIM tiles: {obstacle}, or set UDIM Tiles to 1")


def _obstacle(parts: Sequence[Islands]) -> str | None:
    """What keeps islands from UDIM tiles, and what to do; None where nothing does."""
    if any(part.pinned.any() for part in parts):
        return "some are pinned; unpin them"
    if any(part.aspect != 1.0 for part in parts):
        return "the image is not square; use a square one"
    return None


def _common_squeeze(parts: Sequence[Islands]) -> FloatArray | None:
    """That of the image of all parts, (2,), as of `lsgp.correct_aspect`; None where they have different ones."""
    aspects = {part.aspect for part in parts}
    return native.lsgp.correct_aspect((1.0, 1.0), aspects.pop()) if len(aspects) == 1 else None


def _packed(parts: Sequence[Islands], squeeze: FloatArray, margin: float, *, turned: bool) -> list[FloatArray]:
    """With the widest margin that leaves room, not wider than this one.  squeeze: by which coordinates are divided so
    that both axes have the same unit of length."""
    image = 1 / squeeze
    rest = margin * float(image.max())
    while True:
        try:
            packed = _pack_islands(parts, rest, squeeze, turned=turned, area=(0.0, 0.0, *image.tolist()))
            break
        except native.lsgp.InputError:
            if rest == 0:
                raise
            rest = rest / 2 if rest > NO_MARGIN else 0.0
    return [np.where(part.stays[:, None, None], part.corner_uv, uv) for part, uv in zip(parts, packed, strict=True)]


def _pack_islands(
    parts: Sequence[Islands], margin: float, squeeze: FloatArray | None = None, **how: Any
) -> list[FloatArray]:
    """As of `lsgp.pack_islands`; what is pinned is one body, and what of it sticks out of the square is left out."""
    scale = np.ones(2) if squeeze is None else squeeze
    first = np.cumsum([0, *(int(part.island.max(initial=-1)) + 1 for part in parts)])
    corner_uv = np.concatenate([part.corner_uv for part in parts])
    island = np.concatenate([part.island + at for part, at in zip(parts, first[:-1], strict=True)])
    stays = np.concatenate([part.stays for part in parts])
    count = len(island)
    if stays.any():
        pinned = clipped(corner_uv[stays], UNIT_SQUARE)
        corner_uv = np.concatenate([corner_uv, pinned])
        # The pinned islands themselves do not take part: this is their part inside.
        island = np.concatenate([np.where(stays, -1, island), np.full(len(pinned), first[-1])])
        how["locks"] = {"place": np.flatnonzero(np.unique(island[island >= 0]) == first[-1])}
    island[island >= 0] = np.unique(island[island >= 0], return_inverse=True)[1]
    packed = native.lsgp.pack_islands(corner_uv / scale, island.astype(np.int32), margin, **how)
    return np.split((packed * scale)[:count], np.cumsum([len(part.island) for part in parts])[:-1])


def clipped(triangles: FloatArray, box: FloatArray) -> FloatArray:
    """Triangles, (k, 3, 2), with the parts that others, (m, 3, 2), have inside a box, (2, 2) from low to high."""
    inside = ((triangles >= box[0]) & (triangles <= box[1])).all(axis=(1, 2))
    found = [triangles[inside]]
    for polygon in triangles[~inside]:
        for axis in range(2):
            for side, bound in ((1.0, box[0, axis]), (-1.0, box[1, axis])):
                polygon = _half(polygon, side * (polygon[:, axis] - bound))
        found += [polygon[None, [0, k, k + 1]] for k in range(1, len(polygon) - 1)]
    # Where a side is cut, rounding may leave it beyond the box, and a triangle beside the box leaves a line.
    parts = np.clip(np.concatenate(found), *box)
    (a, b), (c, d) = (parts[:, 1] - parts[:, 0]).T, (parts[:, 2] - parts[:, 0]).T
    return parts[a * d != b * c]


def _half(polygon: FloatArray, height: FloatArray) -> FloatArray:
    """The part of a convex polygon, (k, 2), where heights over a line, (k,), are not negative (Sutherland and Hodgman
    1974)."""
    corners = []
    for here, there, at, then in zip(polygon, np.roll(polygon, -1, axis=0), height, np.roll(height, -1), strict=True):
        if at >= 0:
            corners.append(here)
        if (at > 0 > then) or (at < 0 < then):
            corners.append(here + at / (at - then) * (there - here))
    return np.array(corners).reshape(-1, 2)
