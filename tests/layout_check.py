# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of packed layouts from their corners alone: distances between islands, and how each was moved.

Nothing here is shared with the library.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from overlap_check import overlaps


@dataclass(frozen=True)
class Room:
    """Around islands: the least distance between two of them, and from the unit square's border, below 0 outside."""

    between: float
    border: float


def room(triangles: NDArray[np.integer], corner_uv: NDArray[np.float64], island: NDArray[np.integer]) -> Room:
    """Of islands of which none overlaps another; triangles of island -1 are left out."""
    of_island = {i: _borders(triangles[island == i], corner_uv[island == i]) for i in np.unique(island[island >= 0])}
    between = np.inf
    names = list(of_island)
    for position, one in enumerate(names):
        for other in names[position + 1 :]:
            between = min(
                between, _distance(of_island[one], of_island[other]), _distance(of_island[other], of_island[one])
            )
    uv = corner_uv[island >= 0]
    return Room(float(between), float(min(uv.min(), 1 - uv.max())))


def _borders(triangles: NDArray[np.integer], uv: NDArray[np.float64]) -> NDArray[np.complex128]:
    """(s, 2), the edges that are of one triangle alone, told by their vertices and coordinates."""
    z = uv @ np.array([1, 1j])
    edges = []
    for corners, places in zip(triangles.tolist(), z.tolist(), strict=True):
        ends = list(zip(corners, places, strict=True))
        edges += [frozenset([ends[i], ends[i - 1]]) for i in range(3)]
    alone = [[place for _, place in edge] for edge, uses in Counter(edges).items() if uses == 1]
    return np.array(alone)


def _distance(ends: NDArray[np.complex128], segments: NDArray[np.complex128]) -> float:
    """From the ends of some segments to others."""
    least = np.inf
    for begin, end in segments:
        along = end - begin
        share = np.clip(((ends - begin) / along).real, 0, 1) if along else 0.0
        least = min(least, float(np.abs(ends - begin - share * along).min()))
    return least


def moves(old: NDArray[np.float64], new: NDArray[np.float64], island: NDArray[np.integer]) -> NDArray[np.complex128]:
    """(m, 2), by what complex number the sides of each triangle in an island were multiplied: its turn and scale."""
    one, two = (uv[island >= 0] @ np.array([1, 1j]) for uv in (old, new))
    return (two[:, 1:] - two[:, :1]) / (one[:, 1:] - one[:, :1])


def share_along_axes(triangles: NDArray[np.integer], corner_uv: NDArray[np.float64]) -> float:
    """Of the length of an island's border: what runs along u or v."""
    ends = _borders(triangles, corner_uv)
    edges = ends[:, 1] - ends[:, 0]
    along = np.minimum(np.abs(edges.real), np.abs(edges.imag)) < 1e-4 * np.abs(edges)
    return float(np.abs(edges[along]).sum() / np.abs(edges).sum())


def overlapping_islands(corner_uv: NDArray[np.float64], island: NDArray[np.integer]) -> int:
    """How many pairs of triangles of different islands overlap."""
    pairs, _ = overlaps(corner_uv[island >= 0] @ np.array([1, 1j]))
    first, second = island[island >= 0][pairs].T
    return int((first != second).sum())


def coverage(corner_uv: NDArray[np.float64], island: NDArray[np.integer]) -> float:
    """Sum of the areas of triangles in islands."""
    a, b, c = np.moveaxis(corner_uv[island >= 0], 1, 0)
    return float(np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1))).sum() / 2)
