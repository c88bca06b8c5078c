# SPDX-License-Identifier: GPL-3.0-or-later
"""Random seams that part a surface into disks and planar pieces, told by their topology alone.

Nothing here is shared with the library or the oracle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from opened_surface import edge_keys, labels, next_corner
from scipy.sparse import csgraph

Ints = NDArray[np.int64]


@dataclass
class Gluing:
    """Triangles glued along every edge at which exactly two of them meet, turned alike or not.

    vertex: (3m) of corners.  one, other: (e,) the two halfedges of each such edge.
    """

    vertex: Ints
    one: Ints
    other: Ints

    @property
    def edges(self) -> Ints:
        """Vertex pairs, (e, 2)."""
        return np.stack([self.vertex[self.one], self.vertex[next_corner(self.one)]], axis=1)

    def among(self, edges: object) -> NDArray[np.bool_]:
        """Which of the edges are among some vertex pairs, (e,)."""
        return np.isin(edge_keys(*self.edges.T), edge_keys(*np.asarray(edges).reshape(-1, 2).T))

    def opened(self, corner_uv: NDArray[np.float64]) -> Ints:
        """The edges whose two sides lie apart in a layout, (k, 2)."""
        z = (corner_uv[..., 0] + 1j * corner_uv[..., 1]).ravel()
        a, b = self.one, self.other
        alike = self.vertex[a] == self.vertex[next_corner(b)]
        at_a, after_a = np.where(alike, next_corner(b), b), np.where(alike, b, next_corner(b))
        return self.edges[(z[a] != z[at_a]) | (z[next_corner(a)] != z[after_a])]


@dataclass
class Pieces:
    """of_triangle: (m,) the piece of each.  euler, borders: (pieces,) V - E + F and the number of border loops."""

    of_triangle: Ints
    euler: Ints
    borders: Ints

    @property
    def planar(self) -> NDArray[np.bool_]:
        """Disks, with or without holes."""
        return (self.borders > 0) & (self.euler == 2 - self.borders)


def glue(triangles: NDArray[np.integer]) -> Gluing:
    vertex = np.asarray(triangles, np.int64).ravel()
    h = np.arange(len(vertex))
    key = edge_keys(vertex, vertex[next_corner(h)])
    order = np.argsort(key, kind="stable")
    first, count = np.unique(key[order], return_index=True, return_counts=True)[1:]
    first = first[count == 2]
    return Gluing(vertex, order[first], order[first + 1])


def pieces_of(gluing: Gluing, is_open: NDArray[np.bool_]) -> Pieces:
    """The pieces into which open edges, (e,), part the triangles."""
    vertex, glued = gluing.vertex, ~is_open
    a, b = gluing.one[glued], gluing.other[glued]
    after_a, after_b = next_corner(a), next_corner(b)
    alike = vertex[a] == vertex[after_b]  # which run along their edge in opposite directions
    meets_a, meets_after_a = np.where(alike, after_b, b), np.where(alike, b, after_b)
    fan = labels(np.concatenate([a, after_a]), np.concatenate([meets_a, meets_after_a]), len(vertex))
    piece = labels(a // 3, b // 3, len(vertex) // 3)
    count = int(piece.max()) + 1
    border = np.ones(len(vertex), bool)
    border[a] = border[b] = False
    rim = np.flatnonzero(border)
    fans = int(fan.max()) + 1
    of_fan = np.zeros(fans, np.int64)
    of_fan[fan] = np.repeat(piece, 3)
    loop = labels(fan[rim], fan[next_corner(rim)], fans)
    on_rim = np.unique(fan[np.concatenate([rim, next_corner(rim)])])
    loops, place = np.unique(loop[on_rim], return_index=True)
    edges = np.bincount(piece[rim // 3], minlength=count) + np.bincount(piece[a // 3], minlength=count)
    euler = np.bincount(of_fan, minlength=count) - edges + np.bincount(piece, minlength=count)
    return Pieces(piece, euler, np.bincount(of_fan[on_rim[place]], minlength=count) if len(loops) else euler * 0)


def random_segmentation(
    triangles: NDArray[np.integer], pieces: int, rng: np.random.Generator, *, holes: bool = True
) -> Ints:
    """Seams, (s, 2), that part the surface into about as many pieces, all of them planar: regions grown from random
    triangles at random speeds, some of them joined so that they surround others, and parted again until all are.

    holes: whether pieces may have holes; otherwise they are disks.
    """
    gluing = glue(triangles)
    count, ends = len(triangles), (gluing.one // 3, gluing.other // 3)

    def nearest(sources: Ints, among: NDArray[np.bool_]) -> Ints:
        """The source next to every triangle that is to be divided."""
        kept = among[ends[0]] & among[ends[1]]
        slowness = rng.uniform(0.5, 1.5, kept.sum())
        graph = sp.coo_matrix((slowness, (ends[0][kept], ends[1][kept])), (count, count)).tocsr()
        return csgraph.dijkstra(graph, directed=False, indices=sources, min_only=True, return_predecessors=True)[2]

    everyone = np.ones(count, bool)
    label = nearest(rng.choice(count, min(pieces + pieces // 2, count), replace=False), everyone)
    for inner in rng.choice(label, pieces // 4 + 1) if holes else []:  # join what surrounds a piece
        beside = np.concatenate([label[b][label[a] == inner] for a, b in (ends, ends[::-1])])
        label = np.where(np.isin(label, beside[beside != inner]), label.max() + 1, label)
    while True:
        is_open = label[ends[0]] != label[ends[1]]
        found = pieces_of(gluing, is_open)
        label = found.of_triangle.copy()
        wrong = np.flatnonzero(~(found.planar if holes else found.planar & (found.borders == 1)))
        if not len(wrong):
            return gluing.edges[is_open]
        for piece in wrong:
            among = found.of_triangle == piece
            sources = rng.choice(np.flatnonzero(among), 2, replace=False)
            label[among & (nearest(sources, among) == sources[1])] = len(label) + piece
