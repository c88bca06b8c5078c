# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of one shape, which may be stacked and share their texels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray
from ..base.equality import EqualByContent
from ..base.progress import Progress, tell
from ..base.short_repr import ShortRepr
from ..base.unique_rows import unique_rows
from ..base.unit_size import unit_exponent
from ..triangles import uv_area

Indices = NDArray[np.int64]

# Of an island's size, how far vertices of islands of one shape may be apart.
TOLERANCE = 1e-4


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Stacks(EqualByContent, ShortRepr):
    """Which islands may lie on which.

    source: (m, 3), the corner, 3 * triangle + place, whose coordinates each takes; in islands that stay, its own.
    kept: (m,), triangles of islands that stay and those in none. count: islands that are stacked on others.
    """

    source: Indices
    kept: NDArray[np.bool_]
    count: int

    def stacked(self, corner_uv: ArrayLike) -> FloatArray:
        """The coordinates, (m, 3, 2), with each island on the first one of its shape, exactly.  Raises InputError."""
        return arguments.corner_coordinates("corner_uv", corner_uv, len(self.source)).reshape(-1, 2)[self.source]


def find_stacks(
    corner_uv: ArrayLike, island: ArrayLike, *, mirrored: bool = False, progress: Progress | None = None
) -> Stacks:
    """The islands with the shape and the triangles of another one, up to a rotation and a translation.

    corner_uv: (m, 3, 2), of one scale. island: (m,), -1 for none. mirrored: whether reflected islands count as well;
    what is written on one stands mirrored on the other. progress: as for `pack_islands`.

    Each is stacked on the first island of its shape. Vertices may differ by 1e-4 of the square root of the island's
    area; triangles must be joined alike, whatever their order. Of several ways to lay a symmetric island on another,
    that which keeps the order of triangles is taken if there is one.
    Raises InputError: WRONG_SHAPE, WRONG_DTYPE, WRONG_PARAMETER; Cancelled.
    """
    arguments.require_callable(progress)
    island = arguments.islands("island", island)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    may_mirror = arguments.flag("mirrored", mirrored)
    uv = np.ldexp(uv, -unit_exponent(uv[island >= 0]))
    source = np.arange(3 * len(island)).reshape(-1, 3)
    kept = np.ones(len(island), bool)
    found: dict[tuple[int, int], list[_Shape]] = {}
    count = 0
    mapped = np.flatnonzero((island >= 0) & np.isfinite(uv).all(axis=(1, 2)))
    order = mapped[np.argsort(island[mapped], kind="stable")]
    looked_at = 0
    for triangles in np.split(order, np.flatnonzero(np.diff(island[order])) + 1) if len(order) else []:
        heard = partial(tell, progress, looked_at / len(order))
        heard()
        looked_at += len(triangles)
        shape = _Shape.of(triangles, uv)
        alike = found.setdefault(shape.key, [])
        corners = next(filter(None, (shape.corners_on(other, may_mirror, heard) for other in alike)), None)
        if corners is None:
            alike.append(shape)
            continue
        count += 1
        kept[triangles] = False
        source[triangles] = np.array(corners).reshape(-1, 3)
    return Stacks(source, kept, count)


@dataclass(frozen=True, slots=True)
class _Shape:
    """An island by itself.

    triangles: (k,) of the surface. corners: (k, 3) vertices as lists. place: (n,) of vertices. size: the square root of
    its area. lengths: (3 k,) of edges, sorted. across: of the half-edge from one vertex to another, the corner 3 k + c
    that it begins at; empty where one is twice.
    """

    triangles: Indices
    corners: list[list[int]]
    place: list[complex]
    size: float
    lengths: FloatArray
    across: dict[tuple[int, int], int]

    @classmethod
    def of(cls, triangles: Indices, uv: FloatArray) -> _Shape:
        corner = uv[triangles].reshape(-1, 2) + 0.0  # -0.0 is 0.0
        vertex, _, of_corner, _ = unique_rows(corner)
        corners = of_corner.reshape(-1, 3)
        place = vertex @ np.array([1, 1j])
        edges = place[corners] - place[corners[:, [1, 2, 0]]]
        across = {
            (a, b): 3 * k + c
            for c, ends in enumerate((corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]))
            for k, (a, b) in enumerate(ends.tolist())
        }
        return cls(
            triangles=triangles,
            corners=corners.tolist(),
            place=place.tolist(),
            size=float(np.sqrt(uv_area(uv[triangles]))),
            lengths=np.sort(np.abs(edges).ravel()),
            across=across if len(across) == corners.size else {},
        )

    @property
    def key(self) -> tuple[int, int]:
        return len(self.corners), len(self.place)

    def corners_on(self, other: _Shape, may_mirror: bool, heard: Callable[[], None]) -> list[int] | None:
        """The corner of the surface in the other island that each of this one's lies on, (3 k,); None: it does not fit.

        both: of one key. heard: called before each way to lay it there is tried.
        """
        near = TOLERANCE * other.size
        if not self.across or not other.across or np.abs(self.lengths - other.lengths).max() > 2 * near:
            return None
        for first, turned in self._starts(other, near, may_mirror):
            heard()
            on = self._laid_on(other, first, turned, near)
            if on is not None:
                return [int(3 * other.triangles[corner // 3] + corner % 3) for corner in on]
        return None

    def _starts(self, other: _Shape, near: float, may_mirror: bool) -> Iterator[tuple[int, bool]]:
        """The corners of the other island that begin an edge on which this one's first may lie, and whether it is
        reflected; those that keep the order first."""
        length = abs(self._edge(0))
        for turned in (False, True) if may_mirror else (False,):
            for corner in range(3 * len(other.corners)):
                if abs(abs(other._edge(corner)) - length) <= 2 * near:
                    yield corner, turned

    def _edge(self, corner: int) -> complex:
        a, b = self._ends(corner)
        return self.place[b] - self.place[a]

    def _ends(self, corner: int) -> tuple[int, int]:
        of_triangle, c = self.corners[corner // 3], corner % 3
        return of_triangle[c], of_triangle[(c + 1) % 3]

    def _laid_on(self, other: _Shape, first: int, turned: bool, near: float) -> list[int] | None:
        """The other's corner on which each of this one's lies, (3 k,), if corner 0 lies on `first`, or, reflected, on
        the corner after it.  Followed from triangle to triangle; None where one misses."""
        on = [-1] * (3 * len(self.corners))
        begin = _next(first) if turned else first
        on[0] = begin
        motion = _Motion.between(self, other, begin, turned)
        waiting = [(0, begin)]
        step = _previous if turned else _next
        while waiting:
            corner, there = waiting.pop()
            for _ in range(3):
                a, _unused = self._ends(corner)
                if abs(motion(self.place[a]) - other.place[other._ends(there)[0]]) > near:
                    return None
                on[corner] = there
                here = self.across.get(self._ends(corner)[::-1])
                # The edge from this corner to the next lies, reflected, between the other's corner and the one before.
                ends = (there, step(there))
                vertices = other._ends(ends[0])[0], other._ends(ends[1])[0]
                beyond = other.across.get(vertices if turned else vertices[::-1])
                if (here is None) != (beyond is None):
                    return None
                if here is not None and on[here] < 0:
                    on[here] = _next(beyond) if turned else beyond
                    waiting.append((here, on[here]))
                corner, there = _next(corner), step(there)
        return None if min(on) < 0 else on


@dataclass(frozen=True, slots=True)
class _Motion:
    """A rotation, after a reflection where `turned`, and a translation."""

    turn: complex
    shift: complex
    turned: bool

    @classmethod
    def between(cls, one: _Shape, other: _Shape, begin: int, turned: bool) -> _Motion:
        """That which lays the corners 0 and 1 of one island on the corner `begin` of the other and the one that
        follows it, in the other direction where it is reflected."""
        start, end = one.place[one._ends(0)[0]], one.place[one._ends(0)[1]]
        after = _previous(begin) if turned else _next(begin)
        target, target_end = (other.place[other._ends(corner)[0]] for corner in (begin, after))
        if turned:
            start, end = start.conjugate(), end.conjugate()
        turn = (target_end - target) / (end - start) if end != start else 1.0
        turn /= abs(turn) or 1.0
        return cls(turn, target - turn * start, turned)

    def __call__(self, place: complex) -> complex:
        return self.turn * (place.conjugate() if self.turned else place) + self.shift


def _next(corner: int) -> int:
    return corner - 2 if corner % 3 == 2 else corner + 1


def _previous(corner: int) -> int:
    return corner + 2 if corner % 3 == 0 else corner - 1
