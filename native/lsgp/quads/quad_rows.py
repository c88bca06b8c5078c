# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of quads that are joined in pairs: the line of edges between two rows is left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import IndexArray


class QuadLines:
    """The edges of a closed mesh of quads as lines, which run straight through vertices of four quads.

    A line can be left out if it closes without passing through a vertex that has to stay, as all irregular ones have
    to. The vertices on it vanish, all others keep their valences, and the surface its genus. A halfedge is 4 quad +
    corner; around a vertex they keep their order, while their other ends move along the lines they are on.
    """

    def __init__(self, quads: IndexArray, stays: NDArray[np.bool_]) -> None:
        """quads: (q, 4). stays: (v,), whether the lines through a vertex have to stay."""
        origin, target = quads.ravel().astype(np.int64), np.roll(quads, -1, axis=1).ravel()
        # Both orders list the sides of edges alike: one by their ends, the other one by those of their twins.
        self._twin = np.empty(quads.size, np.int64)
        self._twin[np.lexsort((target, origin))] = np.lexsort((origin, target))
        left = np.empty(quads.size, np.int64)  # the next halfedge at the same vertex, counterclockwise
        left[np.arange(quads.size).reshape(-1, 4)[:, [1, 2, 3, 0]].ravel()] = self._twin
        self._right = np.argsort(left)
        self._origin = origin
        self._by_origin = np.argsort(origin, kind="stable")
        self._first = np.searchsorted(origin[self._by_origin], np.arange(len(stays) + 1))
        self._is_left = np.ones(len(stays), bool)
        may_go = ~stays & (np.diff(self._first) == 4)
        self._opposite = np.where(may_go[origin], left[left], -1)
        self._line, self._halfedges = self._trace()

    def _trace(self) -> tuple[NDArray[np.int64], list[NDArray[np.int64]]]:
        """The line of each halfedge, -1 for those that stay, and those in one direction of every other line."""
        twin, opposite = self._twin.tolist(), self._opposite.tolist()
        line, lines = [-2] * len(twin), []
        # Lines that stay are traced from where they do; the others are closed.
        for first in [*np.flatnonzero(self._opposite < 0).tolist(), *range(len(twin))]:
            found, h = [], first
            while h >= 0 and line[h] == -2:
                found.append(h)
                line[h] = line[twin[h]] = -1
                h = opposite[twin[h]]
            if not found or h != first:
                continue
            for h in found:
                line[h] = line[twin[h]] = len(lines)
            lines.append(np.array(found))
        return np.array(line), lines

    def leave_out(self, most: int) -> None:
        """Leaves out lines, the longest before others, as long as there are more quads than that, and only those
        without which the others are a mesh."""
        count = len(self._twin) // 4
        for line in sorted(range(len(self._halfedges)), key=lambda line: -len(self._halfedges[line])):
            if count <= most:
                break
            count -= self._remove(line)

    def mesh(self) -> tuple[IndexArray, NDArray[np.int64]]:
        """The quads, (q, 4), and which vertices are left, (v,)."""
        corners = [np.flatnonzero(self._is_left[self._origin])]
        for _ in range(3):
            corners.append(self._right[self._twin[corners[-1]]])
        sides = np.stack(corners, axis=1)
        sides = sides[sides[:, 0] == sides.min(axis=1)]
        number = np.cumsum(self._is_left) - 1
        return number[self._origin[sides]].astype(np.int32), np.flatnonzero(self._is_left)

    def _remove(self, line: int) -> int:
        """How many quads that saves: none where the others would be no mesh, and everything stays as it is."""
        halfedges = self._halfedges[line]
        halfedges = halfedges[self._is_left[self._origin[halfedges]]]
        vertices = np.unique(self._origin[halfedges])
        across = self._right[halfedges]
        joined = []
        is_mesh = True
        for h in across[self._line[across] != line].tolist():
            g = int(self._opposite[h])
            a, b = int(self._twin[h]), int(self._twin[g])
            is_mesh = a != g  # otherwise no vertex of the other line is left
            if not is_mesh:
                break
            joined.append((a, h, b, g))
            self._twin[a], self._twin[b] = b, a
        self._is_left[vertices] = False
        if is_mesh:
            ends = np.unique(self._origin[[end for a, _, b, _ in joined for end in (a, b)]])
            is_mesh = self._is_mesh_around(ends[self._is_left[ends]])
        if is_mesh:
            return len(vertices)
        self._is_left[vertices] = True
        for a, h, b, g in reversed(joined):
            self._twin[a], self._twin[b] = h, g
        return 0

    def _is_mesh_around(self, vertices: NDArray[np.int64]) -> bool:
        """Whether the neighbors of each of these differ from it and from each other, and the vertices opposite in its
        quads from it."""
        first, end = self._first[vertices], self._first[vertices + 1]
        count = end - first
        halfedges = self._by_origin[np.repeat(end - np.cumsum(count), count) + np.arange(count.sum())]
        origin, ahead = self._origin[halfedges], self._twin[halfedges]
        neighbor, opposite = self._origin[ahead], self._origin[self._twin[self._right[ahead]]]
        pairs = np.unique(origin * len(self._is_left) + neighbor)
        return len(pairs) == len(halfedges) and bool(((origin != neighbor) & (origin != opposite)).all())
