# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of a single polygon of any size, in linear memory and, but for polygons that cross themselves all over, in
nearly linear time.

`polygons` cuts many small polygons at once by the same rule; this is for those that are large, and for
those whose diagonals have to avoid what other polygons have.
"""

from __future__ import annotations

import heapq
import itertools
import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

# In the frame of `polygons`, where a polygon has the size of 1, these are lengths, areas or sines.
ROUNDING = 1e-14
NEARLY_TOUCHING = 1e-6
TINY = 1e-300
NEARLY_STRAIGHT = 1e-4

# As a fraction of an ear's height: otherwise all ears of round polygons with many corners would be close to corners.
TOUCHING_SHARE = 0.5

# Penalties on the squared length of a diagonal, which is at most 8 there.
NEEDLE_PENALTY = 16.0
TAKEN_PENALTY = 64.0

# The cost of an ear of which two corners coincide, above that of all others: without it no ear is left at such corners.
FLAT_EAR_COST = 128.0

# Levels of strictness, in turn: no corner close to the diagonal, no corner inside, anything.
STRICT, ALLOWS_TOUCHING, ALLOWS_ANY = range(3)

# Limit on the corners tested, per corner of the polygon; beyond it ears are no longer tested.
MOST_LOOKS = 1000


def clip_ears_of_one(
    points: NDArray[np.float64], is_taken: Callable[[int, int], bool] | None = None
) -> NDArray[np.int64]:
    """Triangles (n - 2, 3), local corners, of a counter-clockwise polygon (n, 2) of the size of 1.

    is_taken: whether a diagonal between two corners is to be avoided.
    The cheapest ear is tried first, those of which two corners coincide last, and put aside if another corner lies in
    it. Where ears run out, corners close to the diagonal are allowed, then corners inside, then the rest becomes a fan.
    After an ear the test is strict again.
    """
    n = len(points)
    if not np.isfinite(points).all():
        return np.array(_fan(list(range(n))), np.int64)
    ring = _Ring(points, is_taken)
    triangles: list[tuple[int, int, int]] = []
    strictest = leniency = STRICT
    while len(triangles) < n - 2:
        if strictest == STRICT and ring.looks > MOST_LOOKS * n:
            strictest = leniency = ALLOWS_ANY
            ring.find_ears()
        tip = ring.pop_cheapest()
        if tip is None:
            leniency += 1
            if leniency > ALLOWS_ANY:
                triangles += _fan(ring.corners())
                break
            ring.find_ears()
        elif leniency == ALLOWS_ANY or not ring.is_occupied(tip, allows_touching=leniency == ALLOWS_TOUCHING):
            triangles.append(ring.cut_off(tip))
            leniency = strictest
    return np.array(triangles, np.int64)


def _fan(corners: list[int]) -> list[tuple[int, int, int]]:
    return [(corners[0], a, b) for a, b in itertools.pairwise(corners[1:])]


class _Ring:
    """The remaining polygon, and its ears by cost.  looks: number of corners tested so far."""

    def __init__(self, points: NDArray[np.float64], is_taken: Callable[[int, int], bool] | None) -> None:
        n = len(points)
        self.looks = 0
        self._points = points
        self._x, self._y = points[:, 0].tolist(), points[:, 1].tolist()
        self._before, self._after = [n - 1, *range(n - 1)], [*range(1, n), 0]
        self._is_taken = is_taken
        self._version = [0] * n  # of the cost of an ear; those of a lower one in the queue are out of date
        self._queue: list[tuple[float, int, int]] = []
        self._count = self._indexed = n
        self._first = 0
        self._places = _Places(points, range(n))
        self.find_ears()

    def corners(self) -> list[int]:
        """In their order, from the lowest."""
        found = [self._first]
        while self._after[found[-1]] != self._first:
            found.append(self._after[found[-1]])
        lowest = found.index(min(found))
        return found[lowest:] + found[:lowest]

    def find_ears(self) -> None:
        """Anew, those put aside included."""
        corners = self.corners()
        self.looks += len(corners)
        for corner in corners:
            self._add(corner)

    def pop_cheapest(self) -> int | None:
        while self._queue:
            _, tip, version = heapq.heappop(self._queue)
            if version == self._version[tip]:
                return tip
        return None

    def cut_off(self, tip: int) -> tuple[int, int, int]:
        p, q = self._before[tip], self._after[tip]
        self._after[p], self._before[q] = q, p
        self._version[tip] += 1
        self._count -= 1
        self._first = q
        self._places.remove(tip)
        if 2 * self._count < self._indexed:
            self._places, self._indexed = _Places(self._points, self.corners()), self._count
        self._add(p)
        self._add(q)
        return p, tip, q

    def is_occupied(self, tip: int, *, allows_touching: bool) -> bool:
        """Whether another corner lies in the ear, or close to its diagonal unless that is allowed."""
        x, y = self._x, self._y
        p, q = self._before[tip], self._after[tip]
        ax, ay, bx, by, cx, cy = x[p], y[p], x[tip], y[tip], x[q], y[q]
        abx, aby, bcx, bcy, cax, cay = bx - ax, by - ay, cx - bx, cy - by, ax - cx, ay - cy
        diagonal = math.sqrt(cax * cax + cay * cay)
        area = abx * bcy - aby * bcx
        if not area > ROUNDING:
            return False
        height = area / max(diagonal, TINY)
        margin = ROUNDING if allows_touching else max(min(NEARLY_TOUCHING, TOUCHING_SHARE * height), ROUNDING)
        beyond = -margin * diagonal
        # A corner at the same place as one of the ear's own touches it only: the two sides of a keyhole.
        own = ((ax, ay), (bx, by), (cx, cy))
        around = (
            min(ax, bx, cx) - margin,
            max(ax, bx, cx) + margin,
            min(ay, by, cy) - margin,
            max(ay, by, cy) + margin,
        )
        for corners in self._places.near(*around):
            self.looks += 1 + len(corners)
            for other in corners:
                ox, oy = x[other], y[other]
                if (
                    abx * (oy - ay) - aby * (ox - ax) >= -ROUNDING
                    and bcx * (oy - by) - bcy * (ox - bx) >= -ROUNDING
                    and cax * (oy - cy) - cay * (ox - cx) >= beyond
                    and (ox, oy) not in own
                ):
                    return True
        return False

    def _add(self, tip: int) -> None:
        """Queue the ear at a corner, if there is one, by the squared length of its diagonal and penalties."""
        self._version[tip] += 1
        x, y = self._x, self._y
        p, q = self._before[tip], self._after[tip]
        back_x, back_y, ahead_x, ahead_y = x[tip] - x[p], y[tip] - y[p], x[q] - x[tip], y[q] - y[tip]
        across_x, across_y = x[q] - x[p], y[q] - y[p]
        area = back_x * ahead_y - back_y * ahead_x
        cost = across_x * across_x + across_y * across_y  # the same to the last bit from both sides of the diagonal
        back, ahead = back_x * back_x + back_y * back_y, ahead_x * ahead_x + ahead_y * ahead_y
        if min(cost, back, ahead) <= ROUNDING**2:
            heapq.heappush(self._queue, (FLAT_EAR_COST, tip, self._version[tip]))
            return
        if not area > ROUNDING:
            return
        if area <= NEARLY_STRAIGHT * math.sqrt(back * ahead):
            cost += NEEDLE_PENALTY
        if self._is_taken is not None and self._is_taken(p, q):
            cost += TAKEN_PENALTY
        heapq.heappush(self._queue, (cost, tip, self._version[tip]))


class _Places:
    """A grid over corners whose columns and rows hold equally many, so that clusters are spread over cells."""

    def __init__(self, points: NDArray[np.float64], corners: range | list[int]) -> None:
        own = points[np.asarray(corners)]
        bins = 2 * math.isqrt(len(own)) + 1
        self._columns, self._rows = (_dividers(own[:, axis], bins) for axis in (0, 1))
        column, row = (
            np.searchsorted(dividers, own[:, axis], side="right")
            for axis, dividers in enumerate((self._columns, self._rows))
        )
        self._width = len(self._columns) + 1
        self._cell_of = dict(zip(corners, (row * self._width + column).tolist(), strict=True))
        self._in_cell: dict[int, list[int]] = {}
        for corner, cell in self._cell_of.items():
            self._in_cell.setdefault(cell, []).append(corner)

    def remove(self, corner: int) -> None:
        cell = self._cell_of.pop(corner)
        self._in_cell[cell].remove(corner)
        if not self._in_cell[cell]:
            del self._in_cell[cell]

    def near(self, x_min: float, x_max: float, y_min: float, y_max: float) -> Iterator[list[int]]:
        """The corners in cells that touch a box."""
        left, right = bisect_left(self._columns, x_min), bisect_right(self._columns, x_max)
        low, high = bisect_left(self._rows, y_min), bisect_right(self._rows, y_max)
        if (right - left + 1) * (high - low + 1) > len(self._in_cell):
            yield from self._in_cell.values()
            return
        for row in range(low, high + 1):
            for cell in range(row * self._width + left, row * self._width + right + 1):
                corners = self._in_cell.get(cell)
                if corners is not None:
                    yield corners


def _dividers(values: NDArray[np.float64], count: int) -> list[float]:
    """Ascending and distinct, with about as many of the values between any two."""
    ordered = np.sort(values)
    return np.unique(ordered[np.linspace(0, len(ordered) - 1, count).astype(np.int64)]).tolist()
