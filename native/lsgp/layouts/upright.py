# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed islands turned by quarters until as many as can be stand upright, without making any smaller."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..errors import InputError
from ..indexed_uv import index_corners
from ..lattice import island_boxes
from .arranging import numbered_islands, turn_islands

_QUARTER = math.pi / 2
# Of the cosine of what is left to upright: what a turn has to gain.
_LEAST_GAIN = 0.5
# Coordinates beyond are those of no layout.
_FAR = 1e9
# Segments of outlines, and pairs of them that are compared for one island: beyond, islands stay as they are packed.
_MOST_SEGMENTS, _MOST_PAIRS = 50_000, 2_000_000


def stand_upright(
    corner_uv: ArrayLike, island: ArrayLike, turns: ArrayLike, *, margin: float, whole: bool = True
) -> FloatArray:
    """Turn islands of a packed square by quarters, where that brings them nearer to upright and takes no room.

    corner_uv: (m, 3, 2). island: (m,), -1 for none. turns: (islands,) radians, those after which each is upright, as of
    `upright_turns`; 0 also for those that have no up. margin: around each island; none gets nearer to another, or to
    the border of the square, than twice or once that, unless it is so already. whole: whether all may be turned
    together first, about the middle of the square, by the quarter that most of their area gains by. Then each is turned
    about the middle of its own box, the largest first, if it does not come too near to another.
    Returns (m, 3, 2).  Raises InputError.
    """
    uv, numbers, count = numbered_islands(corner_uv, island)
    left = arguments.floats_of_shape("turns", turns, (count,)).copy()
    if not np.isfinite(left).all():
        arguments.refuse("turns", turns, "pass finite angles")
    gap = arguments.number("margin", margin, "pass a margin, 0 or more")
    if not 0 <= gap < math.inf:
        arguments.refuse("margin", margin, "pass a margin, 0 or more")
    inside = numbers >= 0
    if not inside.any():
        return uv.copy()
    if not (abs(uv[inside]) < _FAR).all():
        raise InputError(
            "WRONG_PARAMETER",
            "corner_uv is not finite in an island, or far from the square; give such triangles island -1.",
        )
    area = _areas(uv, numbers, count)
    if arguments.flag("whole", whole):
        gains = [float((area * _cosines(left - k * _QUARTER)).sum()) for k in range(4)]
        # What differs by rounding alone stays.
        best = next(k for k in range(4) if gains[k] >= max(gains) - 1e-9 * area.sum())
        uv = np.where(inside[:, None, None], _turned_square(uv, best), uv)
        left -= best * _QUARTER
    outlines = _outlines(uv, numbers, count)
    if sum(map(len, outlines)) > _MOST_SEGMENTS:
        return uv
    boxes, uv = island_boxes(uv, numbers), uv.copy()
    triangles = _members(numbers, count)
    for i in np.argsort(-area, kind="stable").tolist():
        quarters = round(left[i] / _QUARTER) % 4
        if not quarters or math.cos(left[i] - quarters * _QUARTER) - math.cos(left[i]) < _LEAST_GAIN:
            continue
        mine = triangles[i]
        turned = turn_islands(uv[mine], np.zeros(len(mine), np.int32), [quarters * _QUARTER])
        (outline,) = _outlines(turned, np.zeros(len(turned), np.int32), 1)
        (box,) = island_boxes(turned, np.zeros(len(turned), np.int32))
        others = [outlines[j] for j in _near(box, boxes, 2 * gap) if j != i]
        if not _fits(outlines[i], boxes[i], outline, box, others, gap):
            continue
        uv[mine], outlines[i], boxes[i] = turned, outline, box
    return uv


def _cosines(angles: FloatArray) -> FloatArray:
    return np.array([math.cos(angle) for angle in angles.tolist()])


def _areas(uv: FloatArray, island: IndexArray, count: int) -> FloatArray:
    first, second = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    doubled = abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    return np.bincount(island[island >= 0], doubled[island >= 0], minlength=count) / 2


def _turned_square(uv: FloatArray, quarters: int) -> FloatArray:
    u, v = uv[..., 0], uv[..., 1]
    return np.stack(((u, v), (1 - v, u), (1 - u, 1 - v), (v, 1 - u))[quarters], axis=-1)


def _outlines(uv: FloatArray, island: IndexArray, count: int) -> list[FloatArray]:
    """Of each island the sides of triangles, (s, 2, 2), counter-clockwise around them, beyond which it has no other:
    once for each triangle more on its left than on its right."""
    numbers = np.repeat(island, 3)
    first, second = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    is_flipped = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    corners = np.where(is_flipped[:, None, None], uv[:, [0, 2, 1]], uv)
    _, place = index_corners(
        np.maximum(numbers, 0), np.where(np.repeat(island >= 0, 3)[:, None], corners.reshape(-1, 2), 0.0)
    )
    tail, head = place.astype(np.int64), np.roll(place.reshape(-1, 3), -1, axis=1).ravel().astype(np.int64)
    key, opposite = tail * len(place) + head, head * len(place) + tail
    known, index, times = np.unique(key, return_inverse=True, return_counts=True)
    at = np.minimum(np.searchsorted(known, opposite), len(known) - 1)
    beyond = np.where(known[at] == opposite, times[at], 0)
    order = np.argsort(key, kind="stable")
    rank = np.empty(len(key), np.int64)
    rank[order] = np.arange(len(key)) - (np.cumsum(times) - times)[index.ravel()[order]]
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    kept = (rank >= beyond) & (numbers >= 0)
    return [sides[of] for of in _members(np.where(kept, numbers, -1), count)]


def _members(numbers: IndexArray, count: int) -> list[NDArray[np.int64]]:
    """Of each number from 0 to count - 1 the places that have it, in order."""
    order = np.argsort(numbers, kind="stable")
    ends = np.searchsorted(numbers[order], np.arange(count + 1))
    return [order[begin:end] for begin, end in pairwise(ends.tolist())]


def _fits(
    before: FloatArray,
    box_before: FloatArray,
    outline: FloatArray,
    box: FloatArray,
    others: list[FloatArray],
    margin: float,
) -> bool:
    """Whether an island, turned, is no nearer to the outlines of others whose boxes are near, or to the border of the
    square, than it may be, or was."""
    border = min(margin, _to_border(box_before))
    if not len(outline) or _to_border(box) < border - 1e-12:
        return False
    for other in others:
        if not len(other):
            continue
        gap = _gap(outline, other, 2 * margin)
        # It may have been as near before.
        if gap < 2 * margin and (gap <= 0 or gap < _gap(before, other, 2 * margin)):
            return False
        if _holds(other, outline[0, 0]) != _holds(other, before[0, 0]):
            return False
    return True


def _to_border(box: FloatArray) -> float:
    return float(min(box[0], box[1], 1 - box[2], 1 - box[3]))


def _near(box: FloatArray, others: FloatArray, gap: float) -> list[int]:
    """Which of the other boxes, (n, 4), are nearer to one than the gap."""
    is_near = (box[:2] - gap < others[:, 2:]).all(axis=1) & (others[:, :2] - gap < box[2:]).all(axis=1)
    return np.flatnonzero(is_near).tolist()


def _gap(one: FloatArray, other: FloatArray, most: float) -> float:
    """The least distance between segments, (s, 2, 2) and (t, 2, 2), at most as much as asked for; 0 where some cross,
    and where there are too many to compare."""
    one, other = _within(one, other, most), _within(other, one, most)
    if not (len(one) and len(other)):
        return most
    if len(one) * len(other) > _MOST_PAIRS:
        return 0.0
    a, b = one[:, None, 0], one[:, None, 1]
    c, d = other[None, :, 0], other[None, :, 1]
    crossing = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
    if crossing.any():
        return 0.0
    squares = (_to_segment(a, c, d), _to_segment(b, c, d), _to_segment(c, a, b), _to_segment(d, a, b))
    return min(math.sqrt(min(float(square.min()) for square in squares)), most)


def _within(segments: FloatArray, others: FloatArray, gap: float) -> FloatArray:
    """Those near the box around others."""
    low, high = others.min(axis=(0, 1)) - gap, others.max(axis=(0, 1)) + gap
    return segments[((segments.max(axis=1) >= low) & (segments.min(axis=1) <= high)).all(axis=1)]


def _side(a: FloatArray, b: FloatArray, point: FloatArray) -> FloatArray:
    along, away = b - a, point - a
    return along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]


def _to_segment(point: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    """Squared distances."""
    along, away = end - begin, point - begin
    length = (along**2).sum(axis=-1)
    share = np.clip((along * away).sum(axis=-1) / np.where(length > 0, length, 1.0), 0.0, 1.0)
    return ((away - share[..., None] * along) ** 2).sum(axis=-1)


def _holds(outline: FloatArray, point: NDArray[np.float64]) -> bool:
    """Whether an outline winds around a point."""
    a, b = outline[:, 0], outline[:, 1]
    upward = (b[:, 1] > point[1]).astype(np.int64) - (a[:, 1] > point[1])
    rise = np.where(upward != 0, b[:, 1] - a[:, 1], 1.0)
    right = a[:, 0] + (point[1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0]) > point[0]
    return bool(upward[right].sum())
