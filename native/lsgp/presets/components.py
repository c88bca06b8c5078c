# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of maps on each connected component of their surface, by which maps are compared piece by piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys, side_keys
from ..base.unique_rows import unique_rows
from ..ledger import build_ledger
from ..results import Result
from ..surface import Surface
from ..triangles import singular_values, triangle_areas


@dataclass(frozen=True, slots=True)
class Components:
    """The connected components of a surface, c of them.

    of_triangle: (m,), -1 for triangles that are left out. of_vertex: (n,), one of those that a vertex belongs to; -1
    for none.
    """

    surface: Surface
    count: int
    of_triangle: NDArray[np.intp]
    of_vertex: NDArray[np.intp]

    @classmethod
    def of(cls, surface: Surface) -> Components:
        found = build_ledger(surface, ())
        of_triangle = np.full(len(surface.triangles), -1)
        for i, component in enumerate(found):
            of_triangle[component.triangles] = i
        of_vertex = np.full(len(surface.positions), -1)
        is_of_one = of_triangle >= 0
        of_vertex[surface.triangles[is_of_one]] = of_triangle[is_of_one, None]
        return cls(surface, len(found), of_triangle, of_vertex)

    def of_edges(self, edges: IndexArray) -> NDArray[np.intp]:
        """The component of each edge of the surface; edges: (e, 2)."""
        sides = side_keys(self.surface.triangles, len(self.surface.positions))
        order = np.argsort(sides, kind="stable")
        return self.of_triangle[order[np.searchsorted(sides, keys_of(edges, self.surface), sorter=order)] // 3]

    def lengths(self, edges: IndexArray) -> FloatArray:
        """The total length of those edges that each component has, (c,)."""
        ends = self.surface.positions[edges]
        return self._sums(self.of_edges(edges), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))

    def areas(self) -> FloatArray:
        """On the surface, (c,)."""
        return self._sums(self.of_triangle, triangle_areas(self.surface))

    def counts(self, vertices: IndexArray) -> NDArray[np.intp]:
        """How many of these vertices each component has, (c,)."""
        return self._counts(self.of_vertex[vertices])

    def islands(self, result: Result) -> NDArray[np.intp]:
        """The number of islands, (c,)."""
        pairs = np.stack([self.of_triangle, result.island], axis=1)[result.solved]
        return self._counts(unique_rows(pairs).rows[:, 0])

    def cuts(self, result: Result) -> NDArray[np.intp]:
        """The number of edges that are cut, (c,)."""
        return self._counts(self.of_edges(result.cut_edges))

    def solved(self, result: Result) -> NDArray[np.intp]:
        """The number of solved triangles, (c,)."""
        return self._counts(self.of_triangle[result.solved])

    def defects(self, result: Result) -> NDArray[np.intp]:
        """The number of defects, (c,), as of `defects`."""
        of_defects = [
            self.of_triangle[result.flipped],
            self.of_triangle[result.overlapping],
            self.of_vertex[result.wrong_angle_sums],
        ]
        return self._counts(np.concatenate(of_defects))

    def stretches(self, result: Result) -> FloatArray:
        """The L2 stretch, (c,), each at a common scale of its own; NaN where one is not solved."""
        areas = triangle_areas(self.surface)
        largest, smallest = singular_values(self.surface, result.corner_uv)
        with np.errstate(divide="ignore", invalid="ignore"):
            image, spread = areas * largest * smallest, areas * (1 / largest**2 + 1 / smallest**2) / 2
            image[areas == 0] = spread[areas == 0] = 0.0
            sums = [self._sums(self.of_triangle, values) for values in (areas, image, spread)]
            return np.sqrt(sums[2] * sums[1]) / sums[0]

    def excess(self, result: Result) -> FloatArray:
        """What each component adds to the excess of the L2 stretch over 1, (c,); infinite where one is not solved."""
        share = self.areas() / self.areas().sum()
        excess = np.nan_to_num(self.stretches(result), nan=np.inf) - 1
        return np.where(share > 0, share, 1.0) * np.where(share > 0, excess, 0.0)

    def _counts(self, component: NDArray[np.intp]) -> NDArray[np.intp]:
        return np.bincount(component[component >= 0], minlength=self.count)

    def _sums(self, component: NDArray[np.intp], values: FloatArray) -> FloatArray:
        is_of_one = component >= 0
        return np.bincount(component[is_of_one], values[is_of_one], minlength=self.count)


def keys_of(edges: IndexArray, surface: Surface) -> NDArray[np.int64]:
    """The `edge_keys` of edges of a surface, (e, 2)."""
    return edge_keys(edges[:, 0], edges[:, 1], len(surface.positions))
