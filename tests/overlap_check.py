# SPDX-License-Identifier: GPL-3.0-or-later
"""Which triangles of a layout lie on others, from their corners alone.

Nothing here is shared with the library or the oracle.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

CHUNK = 1 << 17  # pairs of boxes looked at at once


def overlaps(z: NDArray[np.complex128]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Pairs (k, 2) of triangles (m, 3) whose insides meet as far as rounding lets that be seen, and the areas (k,)
    they share."""
    area = _cross(z[:, 1] - z[:, 0], z[:, 2] - z[:, 0])
    z = np.where(area[:, None] < 0, z[:, ::-1], z)
    has_inside = area != 0
    pairs, areas = [np.empty((0, 2), np.int64)], [np.empty(0)]
    for i, j in meeting_boxes(z):
        shared = _shared_area(z[i] - z[i, :1], z[j] - z[i, :1])
        found = (shared > 0) & has_inside[i] & has_inside[j]
        pairs.append(np.stack([i, j], axis=1)[found])
        areas.append(shared[found])
    return np.concatenate(pairs), np.concatenate(areas)


def _cross(a: NDArray[np.complex128], b: NDArray[np.complex128]) -> NDArray[np.float64]:
    return a.real * b.imag - a.imag * b.real


def meeting_boxes(z: NDArray[np.complex128]) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Pairs of triangles whose boxes meet, each once.

    The layout is cut into rows, and the boxes in a row are swept from left to right; a pair belongs to the row in which
    the upper one of its boxes begins.
    """
    left, right, low, high = z.real.min(1), z.real.max(1), z.imag.min(1), z.imag.max(1)
    rows = max(1, int(np.sqrt(len(z)) / 2))
    height = np.ptp(z.imag) / rows or 1.0
    first, last = (np.clip(((y - z.imag.min()) / height).astype(np.int64), 0, rows - 1) for y in (low, high))
    count = last - first + 1
    triangle = np.repeat(np.arange(len(z)), count)
    row = np.arange(len(triangle)) - np.repeat(np.cumsum(count) - count, count) + first[triangle]
    order = np.lexsort([left[triangle], row])
    triangle, row = triangle[order], row[order]
    # Rows one after the other on one axis, wide enough apart.
    shift = 2 * (np.ptp(z.real) or 1.0) * row
    begin, end = left[triangle] - z.real.min() + shift, right[triangle] - z.real.min() + shift
    reach = np.searchsorted(begin, end, side="right") - np.arange(len(begin)) - 1  # boxes that begin before it ends
    for chunk in np.split(np.arange(len(begin)), np.flatnonzero(np.diff(np.cumsum(reach) // CHUNK)) + 1):
        one = np.repeat(chunk, reach[chunk])
        other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(reach[chunk]) - reach[chunk], reach[chunk])
        i, j = triangle[one], triangle[other]
        meet = (low[i] < high[j]) & (low[j] < high[i]) & (row[one] == np.maximum(first[i], first[j]))
        yield np.minimum(i, j)[meet], np.maximum(i, j)[meet]


def _shared_area(a: NDArray[np.complex128], b: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Areas of the intersections of counter-clockwise triangles (k, 3): `b` cut off along the sides of `a`."""
    for side in range(3):
        b = _cut_off(b, a[:, side, None], a[:, (side + 1) % 3, None])
    spokes = b[:, 1:] - b[:, :1]
    return _cross(spokes[:, :-1], spokes[:, 1:]).sum(axis=1) / 2


def _cut_off(
    polygon: NDArray[np.complex128], start: NDArray[np.complex128], end: NDArray[np.complex128]
) -> NDArray[np.complex128]:
    """What of polygons (k, n) lies left of a line, (k, 2n): corners may stand in it more than once."""
    following = np.roll(polygon, -1, axis=1)
    height = _cross(end - start, polygon - start)
    next_height = np.roll(height, -1, axis=1)
    crosses = (height > 0) & (next_height < 0) | (height < 0) & (next_height > 0)
    share = height / np.where(crosses, height - next_height, 1)
    shape = len(polygon), 2 * polygon.shape[1]
    corners = np.stack([polygon, polygon + share * (following - polygon)], axis=2).reshape(shape)
    kept = np.stack([height >= 0, crosses], axis=2).reshape(shape)
    # What is not kept becomes the corner before it.
    last = np.maximum.accumulate(np.where(kept, np.arange(shape[1]), -1), axis=1)
    last = np.where(last < 0, np.maximum(last[:, -1:], 0), last)
    return np.take_along_axis(corners, last, axis=1)
