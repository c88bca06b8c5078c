# SPDX-License-Identifier: GPL-3.0-or-later
"""How near islands of a layout come to each other.

Places are complex numbers, u + iv.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .arguments import FloatArray

ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]

# Pieces are looked at in pairs, so many at a time: bounds the memory.
_PAIRS_AT_ONCE = 1 << 20
# Of the layout's size: no piece is made shorter, so that there are not too many of them.
_SHORTEST_PIECE = 1 / 512


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


def least_gap(segments: ComplexArray, island: Indices, reach: float) -> float:
    """The least distance between segments of different islands; infinite where it is more than `reach`.

    segments: (s, 2), their ends. island: (s,) of each. reach: 0 or more. Segments that cross are at distance 0.
    """
    if not len(segments):
        return np.inf
    low = segments.real.min() + 1j * segments.imag.min()
    high = segments.real.max() + 1j * segments.imag.max()
    longest = max(reach, _SHORTEST_PIECE * abs(high - low))
    pieces, of_segment = _pieces(segments, longest)
    owner = island[of_segment]
    cell = longest + reach
    if not cell > 0:
        return np.inf
    least = np.inf
    for first, second in _neighbours(pieces.mean(axis=1) - low, owner, cell):
        least = min(least, float(_distances(pieces[first], pieces[second]).min(initial=np.inf)))
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


def _neighbours(middles: ComplexArray, owner: Indices, cell: float) -> Iterator[tuple[Indices, Indices]]:
    """Pairs of different owners in the same or in adjacent cells of a grid, each pair once, chunk by chunk."""
    column, row = np.floor(middles.real / cell).astype(np.int64), np.floor(middles.imag / cell).astype(np.int64)
    width = int(column.max()) + 3
    key = (row + 1) * width + column + 1
    order = np.argsort(key, kind="stable")
    sorted_keys = key[order]
    # Half of the neighbourhood: the other half has the same pairs the other way round.
    for step in (0, 1, width - 1, width, width + 1):
        begin, end = (np.searchsorted(sorted_keys, key + step, side) for side in ("left", "right"))
        counts = end - begin
        for chunk in np.array_split(np.arange(len(key)), 1 + int(counts.sum()) // _PAIRS_AT_ONCE):
            first = np.repeat(chunk, counts[chunk])
            skipped = np.repeat(np.cumsum(counts[chunk]) - counts[chunk], counts[chunk])
            second = order[np.repeat(begin[chunk], counts[chunk]) + np.arange(len(first)) - skipped]
            apart = owner[first] != owner[second]
            yield first[apart], second[apart]


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
