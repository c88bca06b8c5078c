# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gauss-Bonnet ledger: how much curvature the cones of every connected part have been given, and what is missing.

A flat metric with cones has its curvature at the cones: 2 pi less the cone's angle, on a border pi less it. On a closed
part they add up to 2 pi (2 - 2 genus), whatever its shape. A border that turns freely takes up what the cones leave.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .api import FloatArray, IndexArray, Options, Surface
from .errors import InputError

# Of a mismatch, radians: what the library itself overlooks.
CLOSED_WITHIN = 1e-6
# Of an angle in single precision, radians.
_STORED_WITHIN = 5e-7
# A cone keeps more than nothing of its angle.
_SMALLEST_ANGLE = 0.02 * math.pi


@dataclass(frozen=True, slots=True)
class LedgerPart:
    """The account of one connected part; angles and curvatures in radians.

    triangles: (m,) int32. cones: (k,) int32, places in the list of cones that was given; a vertex at which several
        parts touch is a cone of each. A cone on a free border is one of its corners where it has an angle, none
        otherwise.
    curvature: (k,) float64, what each cone takes up; NaN where its angle is automatic.
    euler: vertices - edges + triangles. borders: how many.
    assigned: the sum of the curvatures given. required: what all have to add up to.
    border_takes_up: a free border takes up what the cones leave, so that all sets of angles close.
    room: least and most that the automatic cones can take up together.
    """

    triangles: IndexArray
    cones: IndexArray
    curvature: FloatArray
    euler: int
    borders: int
    assigned: float
    required: float
    border_takes_up: bool
    room: tuple[float, float]

    @property
    def missing(self) -> float:
        """What automatic cones or the border take up; without them it has to be 0."""
        return self.required - self.assigned

    @property
    def automatic(self) -> IndexArray:
        """Places in the list of cones of those without an angle."""
        return self.cones[np.isnan(self.curvature)]

    @property
    def closes(self) -> bool:
        """Whether angles of the automatic cones exist with which the ledger closes."""
        low, high = self.room
        return self.border_takes_up or low - CLOSED_WITHIN <= self.missing <= high + CLOSED_WITHIN

    @property
    def complete(self) -> bool:
        """Whether it closes with no angle left automatic."""
        return self.closes and not len(self.automatic)


def build_ledger(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | None = None,
    options: Options | None = None,
) -> list[LedgerPart]:
    """The account of every connected part that has triangles, in the order of their first ones.

    cones, angles: as in `parameterize`; with a rule that chooses all angles, given ones do not count. Parts are those
    that `parameterize` solves one by one, as the options' meaning of seams has them. Whether a map has given angles is
    for `prescribe_curvature` and `parameterize` to say; the ledger says whether they add up.
    Raises InputError where the cones are no vertices or the angles not as many.
    """
    options = options or Options()
    vertices = np.asarray(cones, np.int64).reshape(-1)
    if ((vertices < 0) | (vertices >= len(surface.positions))).any():
        raise InputError("CONE_INDEX", "A cone is no vertex of the surface. Use vertices counted from 0.")
    given = np.full(len(vertices), np.nan)
    if angles is not None and options.prescription in (None, "manual"):
        given = np.array([np.nan if angle is None else angle for angle in angles], np.float64)
    if len(given) != len(vertices):
        raise InputError("ANGLE_COUNT", f"There are {len(vertices)} cones but {len(given)} angles. Give one for each.")

    triangles, kept = surface.triangles, np.arange(len(surface.triangles))
    edges = _Edges(triangles, surface)
    doubles = edges.doubles()
    if len(doubles):
        kept = np.delete(kept, doubles)
        triangles = triangles[kept]
        edges = _Edges(triangles, surface)
    borders = edges.seam if options.seams == "boundary" else np.zeros_like(edges.seam)
    parts = _Parts(triangles, edges, ~borders)
    if options.seams == "follow" and edges.seam.any():
        stuck = (parts.borders == 0) & (parts.euler != 0) & ~parts.has(vertices)
        opened = edges.seam & stuck[parts.of_triangle[edges.pairs[:, 0] // 3]]
        if opened.any():
            parts = _Parts(triangles, edges, ~opened)
    own = np.split(kept[np.argsort(parts.of_triangle, kind="stable")], np.cumsum(parts.sizes)[:-1])
    return parts.accounts(own, vertices, given, options.border == "straight") if len(kept) else []


def hold_complete(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None],
    tentative: ArrayLike,
    options: Options | None = None,
) -> list[float | None]:
    """The angles, those marked tentative, (k,) bool, only in parts whose ledger is complete with them.

    Angles found for one set of cones mean nothing for another: once a cone is added, taken away or given another
    angle, the others are automatic again. What storing angles in single precision has cost is shared out among those
    that hold.  Errors as in `build_ledger`.
    """
    held = list(angles)
    tentative = np.asarray(tentative, bool)
    if not tentative.any():
        return held
    for part in build_ledger(surface, cones, angles, options):
        places = part.cones[tentative[part.cones]]
        missing = 0.0 if part.border_takes_up else part.missing
        complete = not len(part.automatic) and abs(missing) <= CLOSED_WITHIN + _STORED_WITHIN * len(part.cones)
        for place in places:
            held[place] = float(angles[place]) - missing / len(places) if complete else None
    return held


def part_surface(surface: Surface, part: LedgerPart) -> Surface:
    """One part by itself, its vertices numbered as before; cuts may follow all of its edges."""
    triangles = surface.triangles[part.triangles]
    count = len(surface.positions)
    ends = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    seams = np.sort(surface.seams, axis=1).astype(np.int64)
    own = np.isin(seams[:, 0] * count + seams[:, 1], ends[:, 0].astype(np.int64) * count + ends[:, 1])
    return replace(surface, triangles=triangles, edges=None, seams=surface.seams[own])


class _Edges:
    """Which triangles lie side by side. A halfedge is 3 * triangle + corner and runs to the next corner.

    end_corners: (h, 2), the corners at a halfedge's lower and higher vertex. pairs: (p, 2), the halfedges of the edges
    of exactly two triangles. seam: (p,) bool, those marked.
    """

    def __init__(self, triangles: IndexArray, surface: Surface) -> None:
        corner = np.arange(triangles.size).reshape(-1, 3)
        ends = np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2)
        vertices = triangles.ravel()[ends]
        turned = vertices[:, 0] > vertices[:, 1]
        ends[turned] = ends[turned, ::-1]
        self.end_corners = ends
        count = len(surface.positions)
        keys = vertices.min(axis=1).astype(np.int64) * count + vertices.max(axis=1)
        order = np.argsort(keys)
        starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
        sizes = np.diff(starts, append=len(keys))
        of_two = starts[sizes == 2]
        self.pairs = np.stack([order[of_two], order[of_two + 1]], axis=1)
        self._crowded = order[np.repeat(sizes > 2, sizes)]
        self._triangles = triangles
        seams = np.sort(surface.seams.astype(np.int64), axis=1)
        self.seam = np.isin(keys[self.pairs[:, 0]], seams[:, 0] * count + seams[:, 1])

    def doubles(self) -> NDArray[np.int64]:
        """Triangles with the same vertices as an earlier one, ascending."""
        # They share their edges, with each other alone or in a crowd.
        opposite = self._triangles.ravel()[3 * (self.pairs // 3) + (self.pairs + 2) % 3]
        suspects = np.unique(np.append(self.pairs[opposite[:, 0] == opposite[:, 1]], self._crowded) // 3)
        _, first = np.unique(np.sort(self._triangles[suspects], axis=1), axis=0, return_index=True)
        return np.delete(suspects, first)


class _Parts:
    """The parts in which triangles hang together across joined edges.  joined: (p,) bool, of the pairs of halfedges.

    A vertex of a part is a fan of triangles about a vertex of the surface: what touches in a vertex only does not hang
    together there.
    """

    def __init__(self, triangles: IndexArray, edges: _Edges, joined: NDArray[np.bool_]) -> None:
        pairs = edges.pairs[joined]
        self.of_triangle = _labels(len(triangles), pairs // 3)
        count = int(self.of_triangle.max(initial=-1)) + 1
        self.sizes = np.bincount(self.of_triangle, minlength=count)
        fan = _labels(triangles.size, edges.end_corners[pairs].transpose(0, 2, 1).reshape(-1, 2))
        first = np.empty(int(fan.max(initial=-1)) + 1, np.int64)
        first[fan] = np.arange(triangles.size)
        self._vertex, self._part = triangles.ravel()[first], self.of_triangle[first // 3]
        self._valence = np.bincount(fan)

        single = np.ones(triangles.size, bool)
        single[pairs] = False
        rim = fan[edges.end_corners[single]]
        self._on_border = np.zeros(len(first), bool)
        self._on_border[rim] = True
        loop = _labels(len(first), rim)
        one_of_each = np.unique(loop[self._on_border], return_index=True)[1]
        self.borders = np.bincount(self._part[self._on_border][one_of_each], minlength=count)
        edge_count = np.bincount(self.of_triangle[pairs[:, 0] // 3], minlength=count) + np.bincount(
            self.of_triangle[np.flatnonzero(single) // 3], minlength=count
        )
        self.euler = np.bincount(self._part, minlength=count) - edge_count + self.sizes

    def has(self, vertices: IndexArray) -> NDArray[np.bool_]:
        """Of each part, whether it has one of these vertices."""
        out = np.zeros(len(self.sizes), bool)
        out[self._part[np.isin(self._vertex, vertices)]] = True
        return out

    def accounts(
        self, triangles: list[NDArray[np.int64]], cones: NDArray[np.int64], angles: FloatArray, straight: bool
    ) -> list[LedgerPart]:
        """triangles: of each part, as the surface numbers them. The others as in `build_ledger`."""
        own = np.flatnonzero(np.isin(self._vertex, cones))
        by_vertex = np.argsort(cones, kind="stable")
        place = by_vertex[np.searchsorted(cones, self._vertex[own], sorter=by_vertex)]
        counts = ~self._on_border[own] | straight | ~np.isnan(angles[place])
        own, place = own[counts], place[counts]
        order = np.lexsort([place, self._part[own]])
        own, place = own[order], place[order]
        flat = np.where(self._on_border[own], np.pi, 2 * np.pi)
        curvature = flat - angles[place]
        automatic = np.isnan(curvature)
        count = len(triangles)
        of_part = self._part[own]
        on_border = np.bincount(self._part, self._on_border, count) - np.bincount(of_part, self._on_border[own], count)
        assigned = np.bincount(of_part, np.where(automatic, 0.0, curvature), count)
        least = np.bincount(of_part, np.where(automatic, flat - np.pi * self._valence[own], 0.0), count)
        most = np.bincount(of_part, np.where(automatic, flat - _SMALLEST_ANGLE, 0.0), count)
        starts = np.searchsorted(of_part, np.arange(count + 1))
        return [
            LedgerPart(
                triangles=triangles[i].astype(np.int32),
                cones=place[starts[i] : starts[i + 1]].astype(np.int32),
                curvature=curvature[starts[i] : starts[i + 1]],
                euler=int(self.euler[i]),
                borders=int(self.borders[i]),
                assigned=float(assigned[i]),
                required=2 * np.pi * int(self.euler[i]),
                border_takes_up=bool(on_border[i] > 0 and not straight),
                room=(float(least[i]), float(most[i])),
            )
            for i in range(count)
        ]


def _labels(count: int, pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """Numbers things, 0 to count, alike where pairs join them: consecutive numbers in the order of their first."""
    label = np.arange(count)
    while True:
        pairs = label[pairs]
        pairs = pairs[pairs[:, 0] != pairs[:, 1]]
        if not len(pairs):
            break
        # To a lower one it is joined to, whichever comes last: the first of all stays its own.
        label[pairs.max(axis=1)] = pairs.min(axis=1)
        while True:
            shorter = label[label]
            if (shorter == label).all():
                break
            label = shorter
    return (np.cumsum(label == np.arange(count)) - 1)[label]
