# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing of finished islands, those of all objects together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.islands import Islands, Place
from ..tasks.areas import total_area

if TYPE_CHECKING:
    from ..tasks.solving import Progress

FloatArray = NDArray[np.float64]

NO_MARGIN = 1e-4
"""Where not even so narrow a margin leaves room, islands have none."""
SLACK = 5e-4
"""Of a rectangle's side, so that what fits exactly is found to do so; the packer simplifies outlines by a fifth."""
LEAST_KEPT = 0.5
"""Of the density that islands are to keep: with less, what is painted on them is seen to be blurred."""
UNIT_SQUARE = np.array([[0.0, 0.0], [1.0, 1.0]])


def pack(
    parts: Sequence[Islands],
    margin: float,
    *,
    turned: bool = True,
    udim: int = 1,
    effort: str = "good",
    progress: Progress | None = None,
) -> list[FloatArray]:
    """Pack the islands of all parts together into the unit square; returns the new corner_uv of each part.

    margin: around each island, of the longer side of the image; halved until it leaves room. turned: whether islands
    may be, as of `lsgp.pack_islands`; not where images have different aspects. udim: over how many UDIM tiles they are
    spread at most. effort, progress: as of that.
    Every island is moved by a single similarity; those with pins stay, and others leave them their margin.  Raises
    Refused where several tiles are asked for that cannot be filled.
    """
    how = {"effort": effort, "progress": progress}
    if udim > 1:
        return _spread(parts, margin, udim, turned=turned, **how)
    squeeze = _common_squeeze(parts)
    if squeeze is None:
        return _packed(parts, np.ones(2), margin, turned=False, **how)
    return _packed(parts, squeeze, margin, turned=turned, **how)


def pack_at_scale(parts: Sequence[Islands], margin: float, **how: Any) -> list[FloatArray] | None:
    """Put the islands of all parts close together in a square that begins at the origin, and leave their size.

    Returns, margin, how: as of `pack`; None where islands are pinned or an image is not square.
    """
    if _obstacle(parts) is not None:
        return None
    return _pack_islands(parts, margin, fill=False, **how)


def pack_in_place(
    parts: Sequence[Islands],
    margin: float,
    place: Place,
    *,
    turned: bool = True,
    progress: Progress | None = None,
    **how: Any,
) -> list[FloatArray]:
    """Pack the islands of a selection into its place: the rectangle that they had; where that has no room, into its
    UDIM tile; or, if they had none, into the first tile.

    If they are to keep their density, they do so where the rectangle or the tile has room, and get somewhat smaller
    otherwise; if not, they fill the rectangle. If others leave hardly any room, they go into the next free tile.
    margin, turned, how, returns: as of `pack`.
    """
    share_of = native.part("base.progress").share_of
    squeeze = _common_squeeze(parts)
    if squeeze is None:
        squeeze, turned = np.ones(2), False
    how |= {"turned": turned}
    around, tried = _tiles_around(place), 0
    wanted = _area([part.corner_uv for part in parts])

    def attempt(margin: float) -> list[FloatArray] | None:
        boxes = [around] if place.box is None else [_grown(place.box, margin, squeeze), around]

        def into(box: FloatArray, others: FloatArray, fill: bool) -> list[FloatArray] | None:
            nonlocal tried
            # How many attempts there will be is not known: each takes half of what is left.
            part, tried = share_of(progress, 1 - 0.5**tried, 1 - 0.5 ** (tried + 1)), tried + 1
            try:
                return _pack_islands(parts, margin, squeeze, box=box, others=others, fill=fill, progress=part, **how)
            except native.lsgp.InputError:
                return None

        for box in boxes if place.keeps_density else ():
            packed = into(box, place.others, False)
            if packed is not None:
                return packed
        wide = boxes if place.keeps_density else boxes[:1]
        found = [packed for box in wide if (packed := into(box, place.others, True)) is not None]
        best = max(found, key=_area, default=None)
        if best is not None and (not place.keeps_density or _area(best) > LEAST_KEPT**2 * wanted):
            return best
        stays = [part.corner_uv[part.stays] for part in parts]
        free = _next_tile(around, np.concatenate([place.others, *stays]))
        none = place.others[:0]
        return (into(free, none, False) if place.keeps_density else None) or into(free, none, True)

    return _with_margin(attempt, margin * float((1 / squeeze).max()))


def _spread(parts: Sequence[Islands], margin: float, udim: int, **how: Any) -> list[FloatArray]:
    obstacle = _obstacle(parts)
    if obstacle is None:
        try:
            return _pack_islands(parts, margin, udim=udim, **how)
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


def _packed(parts: Sequence[Islands], squeeze: FloatArray, margin: float, **how: Any) -> list[FloatArray]:
    """With the widest margin that leaves room, not wider than this one.  squeeze: by which coordinates are divided so
    that both axes have the same unit of length."""

    def attempt(margin: float) -> list[FloatArray] | None:
        try:
            return _pack_islands(parts, margin, squeeze, box=UNIT_SQUARE, **how)
        except native.lsgp.InputError:
            if margin == 0:
                raise
            return None

    return _with_margin(attempt, margin * float((1 / squeeze).max()))


def _with_margin(attempt: Callable[[float], list[FloatArray] | None], margin: float) -> list[FloatArray]:
    """What is found with the widest margin, halved until something is.  Raises Refused."""
    while True:
        packed = attempt(margin)
        if packed is not None:
            return packed
        if margin == 0:
            raise Refused("there is no room for the islands; unpin some, or unwrap all faces")
        margin = margin / 2 if margin > NO_MARGIN else 0.0


def _pack_islands(
    parts: Sequence[Islands],
    margin: float,
    squeeze: FloatArray | None = None,
    *,
    box: FloatArray | None = None,
    others: FloatArray | None = None,
    **how: Any,
) -> list[FloatArray]:
    """As of `lsgp.pack_islands`; what is pinned, and others, (k, 3, 2), are one body, and what of it sticks out of the
    box, (2, 2), is left out."""
    scale = np.ones(2) if squeeze is None else squeeze
    first = np.cumsum([0, *(int(part.island.max(initial=-1)) + 1 for part in parts)])
    corner_uv = np.concatenate([part.corner_uv for part in parts])
    island = np.concatenate([part.island + at for part, at in zip(parts, first[:-1], strict=True)])
    stays = np.concatenate([part.stays for part in parts])
    count = len(island)
    left = corner_uv[stays] if others is None else np.concatenate([corner_uv[stays], others])
    left = clipped(left, UNIT_SQUARE if box is None else box)
    if len(left):
        # Pinned islands themselves do not take part: this is their part inside.
        island = np.concatenate([np.where(stays, -1, island), np.full(len(left), first[-1])])
        how["locks"] = {"place": np.flatnonzero(np.unique(island[island >= 0]) == first[-1])}
    else:
        island = np.where(stays, -1, island)
    moved = np.concatenate([corner_uv, left])
    island[island >= 0] = np.unique(island[island >= 0], return_inverse=True)[1]
    if box is not None:
        how["area"] = (box / scale).ravel().tolist()
    packed = native.lsgp.pack_islands(moved / scale, island.astype(np.int32), margin, **how)
    found = np.where(stays[:, None, None], corner_uv, (packed * scale)[:count])
    return np.split(found, np.cumsum([len(part.island) for part in parts])[:-1])


def _tiles_around(place: Place) -> FloatArray:
    """The whole tiles around the rectangle that islands had; the first one, if they had none."""
    return UNIT_SQUARE if place.box is None else np.stack([np.floor(place.box[0]), np.ceil(place.box[1])])


def _grown(box: FloatArray, margin: float, squeeze: FloatArray) -> FloatArray:
    """With room for the margin of islands that fill the box."""
    grown = margin + SLACK * float((np.ptp(box, axis=0) / squeeze).max())
    return box + grown * np.stack([-squeeze, squeeze])


def _next_tile(tiles: FloatArray, others: FloatArray) -> FloatArray:
    """As many tiles, moved to the right beyond all others."""
    right = np.ceil(others[..., 0].max(initial=tiles[1, 0]))
    return tiles + np.array([right - tiles[0, 0], 0.0])


def _area(parts: Sequence[FloatArray]) -> float:
    return sum(total_area(part) for part in parts)


def clipped(triangles: FloatArray, box: FloatArray) -> FloatArray:
    """Triangles, (k, 3, 2), with the parts that others, (m, 3, 2), have inside a box, (2, 2) from low to high."""
    inside = ((triangles >= box[0]) & (triangles <= box[1])).all(axis=(1, 2))
    beside = (triangles.max(axis=1) <= box[0]).any(axis=1) | (triangles.min(axis=1) >= box[1]).any(axis=1)
    found = [triangles[inside]]
    for polygon in triangles[~inside & ~beside]:
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
