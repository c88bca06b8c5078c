# SPDX-License-Identifier: GPL-3.0-or-later
"""Long edges of a surface divided in the middle, and the way back to the surface's own elements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys
from ..base.progress import UNTOLD, Steps
from ..base.unique_rows import unique_rows
from ..errors import Elements
from ..surface import Surface
from ..triangles import side_lengths

# Needles are divided along their length into as many triangles as that takes; no more than this in all, or as many
# times the surface's own.
_MOST_TRIANGLES, _MOST_TIMES = 20_000, 4
_COARSER = 1.25


@dataclass(frozen=True, slots=True, eq=False)
class DividedSurface:
    """A surface with long edges divided. Its own vertices keep their numbers, and new ones follow.

    surface: the divided one, without seams, borders and cut costs. source: the given one.
    triangles: (t,) int32, the source's triangle that contains each triangle. corners: (t, 3, 3) float64, barycentric
        coordinates of the corners there.
    ends: (v, 2) int32, the ends of the source's edge that each vertex is on, a vertex of the source twice, and -1 for a
        vertex inside a triangle.
    """

    surface: Surface
    source: Surface
    triangles: IndexArray
    corners: FloatArray
    ends: IndexArray

    def elements(self, elements: Elements) -> Elements:
        """The source's elements that these are parts of; vertices and edges inside its triangles are left out."""
        indices = np.asarray(elements.indices)
        if elements.kind == "triangles":
            return Elements("triangles", np.unique(self.triangles[indices]).astype(np.int32))
        if elements.kind == "vertices":
            return Elements("vertices", indices[indices < len(self.source.positions)].astype(np.int32))
        if elements.kind == "edges":
            edges = _edges_of(self.ends, indices.reshape(-1, 2))
            return Elements("edges", unique_rows(edges[edges[:, 0] >= 0]).rows.astype(np.int32))
        return elements


def divide_long_edges(source: Surface, longest: float, steps: Steps = UNTOLD) -> DividedSurface:
    """Divide edges longer than this in the surface's metric, and others where triangles would get smaller angles
    otherwise: the longest edge of every triangle that is divided is (Rivara 1984). On surfaces of many needles longer
    edges may stay.  steps: told of.  Raises Cancelled."""
    count = len(source.triangles)
    most = max(_MOST_TRIANGLES, _MOST_TIMES * count)
    sizes = side_lengths(source).max(axis=1)
    longest = max(longest, float(sizes.sum()) / most)
    while (found := _divided(source, longest, most, steps)) is None:
        longest *= _COARSER
    return found


def _divided(source: Surface, longest: float, most: int, steps: Steps) -> DividedSurface | None:
    """None where that would be more than so many triangles."""
    positions, triangles = source.positions, source.triangles.astype(np.int64)
    scale = np.ones(len(positions)) if source.scale is None else source.scale
    within = np.arange(len(triangles))
    corners = np.tile(np.eye(3), (len(triangles), 1, 1))
    ends = np.repeat(np.arange(len(positions)), 2).reshape(-1, 2)
    while True:
        steps.tell()
        ahead = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
        edges, _, edge, _ = unique_rows(np.sort(ahead, axis=2).reshape(-1, 2))
        edge = edge.reshape(-1, 3)
        lengths = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1) * scale[edges].mean(axis=1)
        # Of edges that are equally long the first is divided, so that both triangles there choose the same one.
        rank = np.empty(len(edges), np.int64)
        rank[np.lexsort((-np.arange(len(edges)), lengths))] = np.arange(len(edges))
        first = np.argmax(rank[edge], axis=1)
        rows = np.arange(len(triangles))
        is_divided = np.zeros(len(edges), bool)
        is_divided[edge[rows, first][lengths[edge[rows, first]] > longest]] = True
        if not is_divided.any():
            break
        while True:
            lacking = is_divided[edge].any(axis=1) & ~is_divided[edge[rows, first]]
            if not lacking.any():
                break
            steps.tell()
            is_divided[edge[rows, first][lacking]] = True
        if len(triangles) + is_divided[edge].sum() > most:
            return None
        middle = np.where(is_divided, len(positions) + np.cumsum(is_divided) - 1, -1)
        positions = np.concatenate([positions, (positions[edges[is_divided, 0]] + positions[edges[is_divided, 1]]) / 2])
        scale = np.concatenate([scale, scale[edges[is_divided]].mean(axis=1)])
        ends = np.concatenate([ends, _edges_of(ends, edges[is_divided])])
        parts = _Parts(triangles, middle[edge], within, corners, first)
        triangles, within, corners = parts.halves()
    importance = None
    if source.importance is not None:
        weights = np.zeros(len(positions))
        weights[triangles.ravel()] = np.einsum(
            "tck,tk->tc", corners, source.importance[source.triangles[within]]
        ).ravel()
        importance = weights
    surface = replace(
        source,
        positions=positions,
        triangles=triangles.astype(np.int32),
        edges=None,
        seams=None,
        importance=importance,
        cut_costs=None,
        borders=None,
        directions=None if source.directions is None else source.directions[within],
        features=_divided_pairs(source.features, ends, edges),
        scale=None if source.scale is None else scale,
    )
    return DividedSurface(surface, source, within.astype(np.int32), corners, ends.astype(np.int32))


@dataclass(frozen=True, slots=True, eq=False)
class _Parts:
    """Triangles to be divided.

    middle: (t, 3), the new vertex on the edge from each corner to the next, -1 for none. within, corners: as of
    `DividedSurface`. first: (t,) the edge that is divided if any is.
    """

    triangles: NDArray[np.int64]
    middle: NDArray[np.int64]
    within: NDArray[np.int64]
    corners: FloatArray
    first: NDArray[np.int64]

    def halves(self) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """The triangles without new vertices, and the parts of the others: two to four each."""
        rows = np.arange(len(self.triangles))[:, None]
        turned = (self.first[:, None] + np.arange(3)) % 3
        a, b, c = self.triangles[rows, turned].T
        ab, bc, ca = self.middle[rows, turned].T
        at_a, at_b, at_c = self.corners[rows, turned].transpose(1, 0, 2)
        at_ab, at_bc, at_ca = (at_a + at_b) / 2, (at_b + at_c) / 2, (at_c + at_a) / 2
        is_left, is_right = (ab >= 0) & (ca >= 0), (ab >= 0) & (bc >= 0)
        pieces = [
            (ab < 0, (a, b, c), (at_a, at_b, at_c)),
            ((ab >= 0) & ~is_left, (a, ab, c), (at_a, at_ab, at_c)),
            (is_left, (a, ab, ca), (at_a, at_ab, at_ca)),
            (is_left, (ca, ab, c), (at_ca, at_ab, at_c)),
            ((ab >= 0) & ~is_right, (ab, b, c), (at_ab, at_b, at_c)),
            (is_right, (ab, b, bc), (at_ab, at_b, at_bc)),
            (is_right, (ab, bc, c), (at_ab, at_bc, at_c)),
        ]
        chosen = np.concatenate([np.flatnonzero(which) for which, _, _ in pieces])
        triangles = np.concatenate([np.stack(vertices, axis=1)[which] for which, vertices, _ in pieces])
        corners = np.concatenate([np.stack(places, axis=1)[which] for which, _, places in pieces])
        order = np.argsort(chosen, kind="stable")
        return triangles[order], self.within[chosen[order]], corners[order]


def _edges_of(ends: NDArray[np.integer], pairs: NDArray[np.integer]) -> NDArray[np.int64]:
    """(p, 2) the source's edge that contains both vertices of each pair; -1 where there is none."""
    four = np.sort(np.concatenate([ends[pairs[:, 0]], ends[pairs[:, 1]]], axis=1), axis=1)
    is_other = four[:, 1:] != four[:, :-1]
    is_on_edge = (is_other.sum(axis=1) == 1) & (four[:, 0] >= 0)
    return np.where(is_on_edge[:, None], four[:, [0, 3]], -1)


def _divided_pairs(pairs: IndexArray, ends: NDArray[np.int64], edges: NDArray[np.int64]) -> IndexArray:
    """The parts of these edges of the source among all edges."""
    if not len(pairs):
        return pairs
    whole = _edges_of(ends, edges)
    count = int(ends.max()) + 1
    keys, wanted = (edge_keys(of[:, 0], of[:, 1], count) for of in (whole, pairs))
    return edges[(whole[:, 0] >= 0) & np.isin(keys, wanted)].astype(np.int32)
