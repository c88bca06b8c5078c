# SPDX-License-Identifier: GPL-3.0-or-later
"""The distances between islands of a layout.

Places are complex numbers, u + iv.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from lsgp.base.arguments import FloatArray
from lsgp.base.progress import UNTOLD, Steps
from numpy.typing import NDArray

ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]

# Pieces are looked at in pairs, so many at a time: bounds the memory.
_PAIRS_AT_ONCE = 1 << 20
# Of the layout's size: no cell is made smaller, so that there are not too many pieces.
_SMALLEST_CELL = 1 / 512
_CELLS_IN_REACH = 2


def border_edges(vertices: Indices) -> tuple[Indices, Indices]:
    """The triangle and the corner at which each edge begins that one triangle alone has, or that is a point, (b,) each.

    vertices: (m, 3), of triangles that share them within an island alone.
    """
    tails, heads = vertices.ravel(), vertices[:, [1, 2, 0]].ravel()
    count = int(vertices.max(initial=0)) + 1
    edges = np.minimum(tails, heads) * count + np.maximum(tails, heads)
    _, edge_of, uses = np.unique(edges, return_inverse=True, return_counts=True)
    corners = np.flatnonzero((uses[edge_of.ravel()] == 1) | (tails == heads))
    return corners // 3, corners % 3


def least_gap(segments: ComplexArray, island: Indices, reach: float, steps: Steps = UNTOLD) -> float:
    """The least distance between segments of different islands; infinite where it is more than `reach`.

    segments: (s, 2), their ends. island: (s,) of each. reach: 0 or more. Segments that cross are at distance 0. steps:
    told of. Raises Cancelled.
    """
    if not len(segments):
        return np.inf
    low, high = (of(segments.real) + 1j * of(segments.imag) for of in (np.min, np.max))
    # A piece is no longer than a cell, and cells are small beside the reach: what is in two that are farther apart
    # need not be looked at, nor what is of one island.
    cell = max(reach / _CELLS_IN_REACH, _SMALLEST_CELL * abs(high - low))
    if not cell > 0:
        return 0.0 if len(np.unique(island)) > 1 else np.inf  # all of them are at one place
    pieces, of_segment = _pieces(segments, cell)
    least = np.inf
    for first, second in _near_pairs((pieces.mean(axis=1) - low) / cell, island[of_segment], reach / cell):
        steps.tell()
        least = min(least, float(_distances(pieces[first], pieces[second]).min()))
    return least if least <= reach else np.inf


def _pieces(segments: ComplexArray, longest: float) -> tuple[ComplexArray, Indices]:
    """The segments cut so that none is longer, (p, 2), and the segment of each piece."""
    along = segments[:, 1] - segments[:, 0]
    parts = (
        np.maximum(np.ceil(np.abs(along) / longest), 1).astype(np.int64) if longest > 0 else np.ones(len(along), int)
    )
    of_segment = np.repeat(np.arange(len(segments)), parts)
    number = np.arange(len(of_segment)) - np.repeat(np.cumsum(parts) - parts, parts)
    ends = np.stack([number, number + 1], axis=1) / parts[of_segment, None]
    return segments[of_segment, :1] + ends * along[of_segment, None], of_segment


def _near_pairs(middles: ComplexArray, owner: Indices, reach: float) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of pieces of different owners that may be within reach, chunk by chunk; in units of the cells of a grid.

    middles: (p,) of pieces that are no longer than a cell, none below 0.
    """
    column, row = np.floor(middles.real).astype(np.int64), np.floor(middles.imag).astype(np.int64)
    # Steps to cells within reach stay on their row.
    most = math.ceil(reach) + 2
    width = int(column.max()) + 1 + 2 * most
    key = row * width + column
    order = np.lexsort([owner, key])
    # What is of one owner in one cell is a group.
    begins = np.ones(len(order), bool)
    begins[1:] = (np.diff(key[order]) != 0) | (np.diff(owner[order]) != 0)
    start = np.flatnonzero(begins)
    size = np.diff(np.append(start, len(order)))
    group_key, group_owner = key[order[start]], owner[order[start]]
    for step in _steps(most, reach):
        found = [np.searchsorted(group_key, group_key + step[0] + step[1] * width, side) for side in ("left", "right")]
        first, second = _expanded(np.arange(len(start)), found[0], found[1] - found[0])
        apart = group_owner[first] != group_owner[second]
        first, second = first[apart], second[apart]
        pairs = size[first] * size[second]
        for chunk in np.array_split(np.arange(len(first)), 1 + int(pairs.sum()) // _PAIRS_AT_ONCE):
            if not len(chunk):
                continue
            group, number = _expanded(chunk, np.zeros(len(chunk), np.int64), pairs[chunk])
            one, other = first[group], second[group]
            yield order[start[one] + number // size[other]], order[start[other] + number % size[other]]


def _steps(most: int, reach: float) -> Iterator[tuple[int, int]]:
    """(columns, rows) from a cell to those in which something may be within reach of what is in it; each pair once."""
    for rows in range(most + 1):
        for columns in range(-most if rows else 0, most + 1):
            # A piece reaches half a cell beyond the one that its middle is in.
            if math.hypot(max(abs(columns) - 1, 0), max(rows - 1, 0)) - 1 <= reach:
                yield columns, rows


def _expanded(values: Indices, begin: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """Each value so often, and beside it the numbers from its begin on."""
    skipped = np.repeat(np.cumsum(counts) - counts, counts)
    return np.repeat(values, counts), np.repeat(begin, counts) + np.arange(len(skipped)) - skipped


def _distances(first: ComplexArray, second: ComplexArray) -> FloatArray:
    """(p,) between pairs of segments, (p, 2) each."""
    nearest = np.minimum.reduce(
        [_to_segment(first[:, end], second) for end in (0, 1)] + [_to_segment(second[:, end], first) for end in (0, 1)]
    )
    crossing = _parted(first, second) & _parted(second, first)
    return np.where(crossing, 0.0, nearest)


def _to_segment(place: ComplexArray, segment: ComplexArray) -> FloatArray:
    along, away = segment[:, 1] - segment[:, 0], place - segment[:, 0]
    squared = (along * along.conj()).real
    share = np.clip((away * along.conj()).real / np.where(squared > 0, squared, 1.0), 0.0, 1.0)
    return np.abs(away - share * along)


def _parted(segment: ComplexArray, line: ComplexArray) -> NDArray[np.bool_]:
    """Whether the ends of a segment lie on different sides of a line."""
    along = (line[:, 1] - line[:, 0]).conj()
    sides = [(along * (segment[:, end] - line[:, 0])).imag for end in (0, 1)]
    return sides[0] * sides[1] < 0
