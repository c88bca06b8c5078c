# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of packed islands from their corners alone, fast enough for thousands: gaps, overlaps, how each was moved.

Nothing here is shared with the library.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from overlap_check import meeting_boxes, overlaps

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.integer]


def border(corner_uv: FloatArray, island: Indices) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The triangle and the corner at which each edge begins that one triangle alone has, by the places of its ends in
    its island, or that is a point.  corner_uv: as given, where edges that are shared have the same ends."""
    triangle = np.flatnonzero(island >= 0)
    z = corner_uv[triangle] @ [1, 1j]
    owner = np.repeat(island[triangle], 3)
    places, place = np.unique(z.ravel() + 0.0, return_inverse=True)
    tail, head = place.reshape(-1, 3), np.roll(place.reshape(-1, 3), -1, axis=1)
    low, high = np.minimum(tail, head).ravel(), np.maximum(tail, head).ravel()
    edges = np.stack([owner.astype(np.int64), low * len(places) + high], axis=1)
    _, edge, uses = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    alone = np.flatnonzero((uses[edge.ravel()] == 1) | (low == high))
    return triangle[alone // 3], alone % 3


def least_gap(segments: ComplexArray, owner: Indices, reach: float) -> float:
    """The least distance between segments, (s, 2), of different owners; infinite where it is more than `reach`."""
    low = segments.real.min(axis=1) + 1j * segments.imag.min(axis=1) - (0.51 + 0.51j) * reach
    high = segments.real.max(axis=1) + 1j * segments.imag.max(axis=1) + (0.51 + 0.51j) * reach
    least = np.inf
    for i, j in meeting_boxes(np.stack([low, high, low], axis=1)):
        apart = owner[i] != owner[j]
        if apart.any():
            least = min(least, float(segment_distances(segments[i[apart]], segments[j[apart]]).min()))
    return least if least <= reach else np.inf


def segment_distances(one: ComplexArray, other: ComplexArray) -> FloatArray:
    """(p,) between pairs of segments, (p, 2) each; 0 where they cross."""
    ends = [to_segment(one[:, end], other) for end in (0, 1)] + [to_segment(other[:, end], one) for end in (0, 1)]
    # On one line, rounding may part their ends, wherever they are.
    beside = [of(one).max(axis=1) < of(other).min(axis=1) for of in (np.real, np.imag)]
    beside += [of(other).max(axis=1) < of(one).min(axis=1) for of in (np.real, np.imag)]
    crossing = parted(one, other) & parted(other, one) & ~np.any(beside, axis=0)
    return np.where(crossing, 0.0, np.minimum.reduce(ends))


def to_segment(place: ComplexArray, segment: ComplexArray) -> FloatArray:
    along, away = segment[:, 1] - segment[:, 0], place - segment[:, 0]
    squared = np.abs(along) ** 2
    share = np.clip((away * along.conj()).real / np.where(squared > 0, squared, 1), 0, 1)
    return np.abs(away - share * along)


def parted(line: ComplexArray, segment: ComplexArray) -> NDArray[np.bool_]:
    """Whether a line has the ends of a segment on different sides."""
    along = (line[:, 1] - line[:, 0]).conj()
    sides = [(along * (segment[:, end] - line[:, 0])).imag for end in (0, 1)]
    return np.sign(sides[0]) * np.sign(sides[1]) < 0


@dataclass(frozen=True)
class Packed:
    """What a layout is.

    side: of the smallest square around it that leaves the margin at its sides. coverage: the area of its islands, of
    that square. kept: the least gap between two islands, of that asked for; infinite where none is within twice of it.
    overlapping: pairs of islands that overlap.
    """

    side: float
    coverage: float
    kept: float
    overlapping: int


def measured(given: FloatArray, packed: FloatArray, island: Indices, margin: float) -> Packed:
    """margin: around each island, of the square's side."""
    uv, of = packed[island >= 0], island[island >= 0]
    side = float(np.ptp(uv.reshape(-1, 2), axis=0).max()) / (1 - 2 * margin)
    triangle, corner = border(given, island)
    z = packed @ [1, 1j]
    segments = np.stack([z[triangle, corner], z[triangle, (corner + 1) % 3]], axis=1)
    gap = 2 * margin * side
    kept = least_gap(segments, island[triangle], 2 * gap) / gap if gap > 0 else np.inf
    return Packed(side, float(areas(uv).sum()) / side**2, kept, len(overlapping(uv, of)))


def areas(uv: FloatArray) -> FloatArray:
    """(m,), of triangles."""
    one, other = np.moveaxis(uv[:, 1:] - uv[:, :1], 1, 0)
    return np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]) / 2


def overlapping(uv: FloatArray, island: Indices, least: float = 1e-9) -> NDArray[np.int64]:
    """Pairs of islands, (k, 2), whose triangles share more than that part of the layout's box."""
    pairs, shared = overlaps(uv @ [1, 1j])
    found = island[pairs[(shared > least * float(np.ptp(uv.reshape(-1, 2), axis=0).prod()))]]
    return np.unique(np.sort(found[found[:, 0] != found[:, 1]], axis=1), axis=0)


@dataclass(frozen=True)
class Similarities:
    """factor: (islands,) by what complex number each was multiplied, its turn and scale. worst: how far it is from
    where that and a shift would have put it, of the extent of all."""

    factor: ComplexArray
    worst: FloatArray


def similarities(given: FloatArray, packed: FloatArray, island: Indices) -> Similarities:
    """The best ones by least squares; of a mirrored island `worst` is large, unless it is symmetric."""
    inside = island >= 0
    owner = np.repeat(island[inside], 3)
    count = int(owner.max()) + 1
    # A corner of each island as its origin, which loses no digit, and a power of two as the unit.
    first = np.unique(owner, return_index=True)[1]
    number = np.unique(owner, return_inverse=True)[1].ravel()
    old, new = ((uv[inside] @ [1, 1j]).ravel() for uv in (given, packed))
    old, new = (z - z[first[number]] for z in (old, new))
    exponent = np.frexp(max(np.abs(old.real).max(), np.abs(old.imag).max()))[1]
    old = np.ldexp(old.real, -exponent) + 1j * np.ldexp(old.imag, -exponent)
    old, new = (z - middles(z, owner, count)[owner] for z in (old, new))
    squared = np.bincount(owner, np.abs(old) ** 2, count)
    product = new * old.conj()
    factor = np.bincount(owner, product.real, count) + 1j * np.bincount(owner, product.imag, count)
    factor = factor / np.where(squared > 0, squared, 1)
    worst = np.zeros(count)
    np.maximum.at(worst, owner, np.abs(new - factor[owner] * old))
    return Similarities(factor * 2.0**-exponent, worst / np.ptp(packed[inside].reshape(-1, 2), axis=0).max())


def middles(z: ComplexArray, owner: Indices, count: int) -> ComplexArray:
    number = np.maximum(np.bincount(owner, minlength=count), 1)
    return (np.bincount(owner, z.real, count) + 1j * np.bincount(owner, z.imag, count)) / number
