# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles of a result glued to each other again, on any surface however messy, for checks of its coordinates.

Nothing here is shared with the library or the oracle.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import combinations

import lsgp
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import csgraph

SAME_LENGTH = 1e-6  # relative: sides of a cut
SAME_TURN = 1e-5  # of lattices whose points single precision rounds
NO_HEIGHT = 1e-9  # over the length of a side: such a triangle bends no way
FOLDED = 3 * np.pi / 4  # radians of bending


def named_by(result: lsgp.Result, code: str) -> NDArray[np.int32]:
    """The elements of all warnings with this code."""
    found = [finding.elements.indices for finding in result.warnings if finding.code == code]
    return np.concatenate(found) if found else np.empty(0, np.int32)


def labels(a: NDArray[np.int64], b: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """A number for each of `count` elements, the same for those that pairs (a, b) connect."""
    graph = sp.coo_matrix((np.ones(len(a), bool), (a, b)), (count, count))
    return csgraph.connected_components(graph, directed=False)[1]


def next_corner(h: NDArray[np.int64]) -> NDArray[np.int64]:
    return h // 3 * 3 + (h + 1) % 3


def edge_keys(a: NDArray[np.integer], b: NDArray[np.integer]) -> NDArray[np.int64]:
    return (np.minimum(a, b).astype(np.int64) << 32) + np.maximum(a, b)


@dataclass
class Opened:
    """The solved triangles, turned alike, each double only once, glued where two of them meet along an edge and, where
    more do, those of them that are one sheet.

    triangle: (m,) their numbers.  z: (3m) u + iv.  vertex: (3m) of the surface.  twin: (3m) opposite halfedge or -1.
    fan: (3m) corners around one vertex share a number.  closed: (fans,) whether the triangles go all the way round.
    component: (m,) joined by edges.
    """

    triangle: NDArray[np.int64]
    z: NDArray[np.complex128]
    vertex: NDArray[np.int64]
    twin: NDArray[np.int64]
    fan: NDArray[np.int64]
    closed: NDArray[np.bool_]
    component: NDArray[np.int64]

    def straight_on(
        self, h: NDArray[np.int64], nodes: NDArray[np.integer], but_at: NDArray[np.bool_] | None = None
    ) -> tuple[NDArray[np.int64], ...]:
        """Of cut halfedges h, both directions of each: those that lead to a vertex which the cut passes straight
        through, neither branching nor ending nor a node, and those by which it goes on, as places in h.

        but_at: (3m) corners at which a node is none."""
        leaving = np.bincount(self.fan[h], minlength=len(self.closed))
        passes = self.closed & (leaving == 2)
        is_node = np.isin(self.vertex, nodes)
        passes[self.fan[is_node if but_at is None else is_node & ~but_at]] = False
        out = h[passes[self.fan[h]]]
        out = out[np.argsort(self.fan[out], kind="stable")].reshape(-1, 2)
        place = np.full(len(self.z), -1)
        place[h] = np.arange(len(h))
        before = place[np.concatenate([self.twin[out[:, 1]], self.twin[out[:, 0]]])]
        return before, place[np.concatenate([out[:, 0], out[:, 1]])]


def open_surface(surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> Opened:
    """options: what the map was made with; seams may be open borders."""
    single = np.ones(len(surface.triangles), bool)
    single[named_by(result, "DUPLICATE_FACE")] = False
    single &= (surface.triangles != np.roll(surface.triangles, 1, axis=1)).all(axis=1)  # the others are lines
    kept = result.solved & single
    turned = np.zeros(len(kept), bool)
    turned[named_by(result, "REORIENTED")] = True
    order = np.where(turned[:, None], [2, 1, 0], [0, 1, 2])[kept]
    triangle = np.flatnonzero(kept)
    vertex = np.take_along_axis(surface.triangles[kept].astype(np.int64), order, axis=1).ravel()
    uv = np.take_along_axis(result.corner_uv[kept], order[:, :, None], axis=1)

    h = np.arange(len(vertex))
    tail, head = vertex, vertex[next_corner(h)]
    key = edge_keys(tail, head)
    # Triangles without a map count: with them more than two may meet.
    everyone = surface.triangles[single]
    keys, meeting = np.unique(edge_keys(everyone.ravel(), everyone[:, [1, 2, 0]].ravel()), return_counts=True)
    parts = lsgp.build_ledger(surface, result.cones, result.cone_angles, options)
    crowded = keys[meeting > 2]
    ends = np.isin(key, edge_keys(*surface.borders.T))
    ends |= np.isin(key, edge_keys(*surface.seams.T)) & np.repeat(
        _is_opened(surface, result, options, parts)[triangle], 3
    )
    by_edge = np.argsort(key, kind="stable")
    first, count = np.unique(key[by_edge], return_index=True, return_counts=True)[1:]
    one, other = by_edge[first[count == 2]], by_edge[first[count == 2] + 1]
    glued = (tail[one] == head[other]) & ~np.isin(key[one], crowded) & ~ends[one] & ~ends[other]
    z = (uv[..., 0] + 1j * uv[..., 1]).ravel()
    inside = np.isin(key, crowded)
    part = np.full(len(surface.triangles), -1)  # of each triangle, as the library tells it; -1: in none
    for number, one_part in enumerate(parts):
        part[one_part.triangles] = number
    part = part[triangle]
    running_on = _running_on(surface, result, np.flatnonzero(inside & ~ends), key[inside & ends], vertex, z, part)
    one, other = np.concatenate([one[glued], running_on[:, 0]]), np.concatenate([other[glued], running_on[:, 1]])
    twin = np.full(len(h), -1)
    twin[one], twin[other] = other, one
    fan = labels(np.concatenate([one, next_corner(one)]), np.concatenate([next_corner(other), other]), len(h))
    closed = np.ones(int(fan.max()) + 1, bool)
    rim = twin < 0
    closed[fan[rim]] = closed[fan[next_corner(h)[rim]]] = False
    component = labels(one // 3, other // 3, len(triangle))
    return Opened(triangle, z, vertex, twin, fan, closed, component)


def _running_on(
    surface: lsgp.Surface,
    result: lsgp.Result,
    h: NDArray[np.int64],
    ended: NDArray[np.int64],
    vertex: NDArray[np.int64],
    z: NDArray[np.complex128],
    part: NDArray[np.int64],
) -> NDArray[np.int64]:
    """(p, 2) Which of the halfedges h, at edges of three or more triangles, are two sides of one sheet.

    ended: the keys of their edges, once for each further side, at which the surface ends.

    Seen from the map: two sides with the same coordinates.  What the map cuts there it lists, once for each sheet: of
    the sides left, two of one part and of the same length, as sides of a cut have, and of several such, those that bend
    least.  An edge that is marked is listed once more if two sides or more end there: it tells nothing of folds, but in
    a seamless layout of those whose sides are a turn of the lattice apart, and of no others."""
    cuts, ends = Counter(edge_keys(*result.cut_edges.T).tolist()), Counter(ended.tolist())
    by_edge: dict[int, list[int]] = {}
    for side, key in zip(h.tolist(), edge_keys(vertex[h], vertex[next_corner(h)]).tolist(), strict=True):
        by_edge.setdefault(key, []).append(side)
    ahead, place = next_corner(np.arange(len(z))), surface.positions[vertex]

    def joinable(a: int, b: int) -> bool:
        return bool(vertex[a] == vertex[ahead[b]] and part[a // 3] == part[b // 3])

    def differ(a: int, b: int) -> bool:
        one, other = abs(z[ahead[a]] - z[a]), abs(z[ahead[b]] - z[b])
        return bool(abs(one - other) > SAME_LENGTH * max(one, other))

    def bend(a: int, b: int) -> float:
        along = place[ahead[a]] - place[a]
        normals = [np.cross(along, place[ahead[ahead[side]]] - place[a]) for side in (a, b)]
        if min(np.linalg.norm(normal) for normal in normals) <= NO_HEIGHT * (along @ along):
            return np.pi / 2
        return float(np.arctan2(np.linalg.norm(np.cross(*normals)), -normals[0] @ normals[1]))

    def is_turn(a: int, b: int) -> bool:
        if result.seamless is None:
            return bend(a, b) < FOLDED
        ratio = (z[a] - z[ahead[a]]) / (z[ahead[b]] - z[b])
        return bool(abs(ratio**result.seamless.rotation_order - 1) < SAME_TURN)

    marked = set(edge_keys(*surface.seams.T).tolist())
    pairs: list[tuple[int, int]] = []
    for key, sides in by_edge.items():
        opposite = [(a, b) for a, b in combinations(sides, 2) if joinable(a, b)]
        together = [(a, b) for a, b in opposite if z[a] == z[ahead[b]] and z[ahead[a]] == z[b]]
        apart = sorted(set(opposite) - set(together), key=lambda pair: (differ(*pair), bend(*pair)))
        taken: set[int] = set()
        cut = cuts[key]
        if key in marked:
            apart = [pair for pair in apart if not differ(*pair) and is_turn(*pair)]
            cut -= ends[key] + len(sides) - 2 * (len(together) + cut) >= 2
        for candidates, most in ((together, len(together)), (apart, cut)):
            for pair in candidates:
                if most > 0 and taken.isdisjoint(pair):
                    pairs.append(pair)
                    taken.update(pair)
                    most -= 1
    return np.array(pairs, np.int64).reshape(-1, 2)


def _is_opened(
    surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options, parts: list[lsgp.LedgerPart]
) -> NDArray[np.bool_]:
    """(m,) the triangles whose seams are where their surface ends, and no cuts."""
    out = np.full(len(surface.triangles), options.seams == "boundary")
    out[named_by(result, "SEAMS_OPENED")] = True
    for part in parts if options.seams == "exact" else []:  # which opens components without cones, and says nothing
        out[part.triangles] = not len(part.cones)
    return out
