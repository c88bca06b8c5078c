# SPDX-License-Identifier: GPL-3.0-or-later
"""Few triangles that cover the same part of the plane as the many of an island, for packers, which see no more of it.

Places are complex numbers, u + iv.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from ..base.arguments import FloatArray
from ..base.ear_clipping import clip_ears
from ..base.progress import Progress, Steps, share_of
from .island_gaps import ComplexArray, Indices

# Corners of a border that lie on a line so well, relative to the square root of the island's area, are left out.
_STRAIGHT = 1e-5
# By how much the area may change, relative to what leaving them out can change.
_ROUNDING = 2.0
# Islands of fewer triangles a border edge are not worth it.
_WORTHWHILE = 3
_MOST_HOLES = 50
# Packers compare all triangles of a vertex.
_MOST_AROUND = 100
# Of points, a tenth of a second or less.
_LOOKED_AT_BETWEEN_STEPS = 1_000_000


def coarse_triangles(
    place: ComplexArray,
    triangles: Indices,
    island: Indices,
    borders: Indices,
    progress: Progress | None = None,
) -> Indices:
    """(k, 3) vertices of triangles that cover each island as the given ones do, within rounding; those given of islands
    where there is no such cover, as they overlap themselves, or where it would not be much smaller.

    place: (n,) of vertices, which are joined within an island alone. triangles: (m, 3). island: (n,) of each vertex.
    borders: (s, 2) vertices, ends of edges that one triangle alone has, along it.
    Raises Cancelled.
    """
    of_triangle, of_border = island[triangles[:, 0]], island[borders[:, 0]]
    by_island = np.split(np.argsort(of_triangle, kind="stable"), np.cumsum(np.bincount(of_triangle))[:-1])
    border_count = np.bincount(of_border, minlength=len(by_island))
    borders_by_island = np.split(np.argsort(of_border, kind="stable"), np.cumsum(border_count)[:-1])
    covers = []
    done = 0
    for own, own_borders in zip(by_island, borders_by_island, strict=True):
        steps = Steps(share_of(progress, done / len(triangles), (done + len(own)) / len(triangles)))
        done += len(own)
        cover = None
        if len(own) > _WORTHWHILE * len(own_borders):
            steps.tell()
            cover = _cover(place, triangles[own], borders[own_borders], steps)
        covers.append(triangles[own] if cover is None else cover)
    return np.concatenate(covers)


def _cover(place: ComplexArray, triangles: Indices, borders: Indices, steps: Steps) -> Indices | None:
    following = dict(borders.tolist())
    if len(following) < len(borders):
        return None  # its border touches itself
    areas = doubled_areas(place, triangles)
    if not (areas > 0).all():
        return None
    loops = _loops(following)
    if not loops or len(loops) > _MOST_HOLES + 1:
        return None
    tolerance = _STRAIGHT * float(np.sqrt(areas.sum()))
    polygon = _bridged(place, loops, tolerance, triangles, steps)
    if polygon is None:
        return None
    low = place[polygon].real.min() + 1j * place[polygon].imag.min()
    size = np.abs(place[polygon] - low).max()
    points = (place[polygon] - low) / size
    steps.tell()
    (ears,) = clip_ears(np.stack([points.real, points.imag], axis=1)[None])
    cover = polygon[ears]
    around = np.abs(place[borders[:, 1]] - place[borders[:, 0]]).sum()
    missing = np.abs(doubled_areas(place, cover)).sum() - areas.sum()
    if abs(missing) > _ROUNDING * tolerance * around or np.bincount(cover.ravel()).max() > _MOST_AROUND:
        return None
    return cover


def doubled_areas(place: ComplexArray, triangles: Indices) -> FloatArray:
    """(m,) twice the signed area of each triangle."""
    along, across = (place[triangles[:, k]] - place[triangles[:, 0]] for k in (1, 2))
    return (along.conj() * across).imag


def _loops(following: dict[int, int]) -> list[list[int]] | None:
    """The vertices of each closed border, the longest first; None where one does not close.  Empties `following`."""
    loops = []
    while following:
        first, vertex = following.popitem()
        loop = [first]
        while vertex != first:
            loop.append(vertex)
            if vertex not in following:
                return None
            vertex = following.pop(vertex)
        loops.append(loop)
    return sorted(loops, key=len, reverse=True)


def _without_straight(place: ComplexArray, loop: list[int], tolerance: float, steps: Steps) -> list[int]:
    """The corners of a loop without those that are less than the tolerance off the line between their neighbors that
    stay (Ramer 1972, Douglas and Peucker 1973)."""
    points = place[[*loop, loop[0]]]
    kept = np.zeros(len(points), bool)
    far = int(np.abs(points - points[0]).argmax())
    kept[[0, far]] = True
    open_spans = [(0, far), (far, len(loop))]
    looked_at = 0
    while open_spans:
        begin, end = open_spans.pop()
        looked_at += end - begin
        if looked_at > _LOOKED_AT_BETWEEN_STEPS:
            looked_at = 0
            steps.tell()
        if end - begin < 2:
            continue
        chord = points[end] - points[begin]
        off = np.abs(((points[begin + 1 : end] - points[begin]) * chord.conjugate()).imag)
        middle = begin + 1 + int(off.argmax())
        if off[middle - begin - 1] > tolerance * abs(chord):
            kept[middle] = True
            open_spans += [(begin, middle), (middle, end)]
    return [vertex for vertex, stays in zip(loop, kept, strict=False) if stays]


def _bridged(
    place: ComplexArray, loops: list[list[int]], tolerance: float, triangles: Indices, steps: Steps
) -> Indices | None:
    """One polygon along all loops, which runs to each further one and back along edges inside; None where it cannot."""
    polygon, *holes = (_without_straight(place, loop, tolerance, steps) for loop in loops)
    if holes:
        edges = _Edges(triangles)
        taken = {vertex for loop in loops for vertex in loop}
        once = set(polygon)  # a bridge may end at those
        for hole in holes:
            steps.tell()
            path = edges.path(hole, once, taken)
            if path is None:
                return None
            start, end = hole.index(path[0]), polygon.index(path[-1])
            around = [*hole[start:], *hole[: start + 1]]
            polygon = [*polygon[: end + 1], *path[-2:0:-1], *around, *path[1:-1], *polygon[end:]]
            taken.update(path)
            once = (once | set(hole)) - set(path)
    return np.array(polygon, np.int64)


class _Edges:
    """The vertices beside each."""

    def __init__(self, triangles: Indices) -> None:
        tails, heads = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
        both = np.concatenate([tails, heads])
        order = np.argsort(both, kind="stable")
        self._heads = np.concatenate([heads, tails])[order]
        self._begin = np.searchsorted(both[order], np.arange(int(both.max()) + 2))

    def path(self, starts: list[int], ends: set[int], taken: set[int]) -> list[int] | None:
        """Vertices of a shortest path, all but the first and the last not taken; None where there is none."""
        before = dict.fromkeys(starts, -1)
        reached = deque(starts)
        while reached:
            vertex = reached.popleft()
            for other in self._heads[self._begin[vertex] : self._begin[vertex + 1]].tolist():
                if other in ends:
                    path = [other]
                    while vertex != -1:
                        path.append(vertex)
                        vertex = before[vertex]
                    return path[::-1]
                if other not in taken and other not in before:
                    before[other] = vertex
                    reached.append(other)
        return None
