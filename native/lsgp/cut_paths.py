# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges that a layout is cut along, as paths from node to node."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import arguments


def split_into_paths(edges: ArrayLike, nodes: ArrayLike) -> list[NDArray[np.int32]]:
    """Vertex chains between nodes: the given ones and every vertex where not exactly two of the edges meet.

    edges: (c, 2) vertex pairs, each once. nodes: (k,) vertices. A loop without a node begins and ends at its lowest
    vertex. The same edges in any order give the same paths.  Raises InputError.
    """
    pairs = np.sort(arguments.index_rows("edges", edges, 2), axis=1)
    neighbours: dict[int, list[int]] = {}
    for a, b in pairs[np.lexsort(pairs.T[::-1])].tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    ends = {vertex for vertex, around in neighbours.items() if len(around) != 2}
    ends |= neighbours.keys() & set(arguments.index_vector("nodes", nodes).tolist())
    left = {frozenset(pair) for pair in pairs.tolist()}
    paths = []
    # After the chains that start at nodes only loops without nodes are left.
    for start in sorted(ends) + sorted(neighbours.keys() - ends):
        for step in neighbours[start]:
            if frozenset((start, step)) not in left:
                continue
            path = [start, step]
            left.remove(frozenset(path))
            while path[-1] not in ends and path[-1] != start:
                path.append(next(v for v in neighbours[path[-1]] if frozenset((path[-1], v)) in left))
                left.remove(frozenset(path[-2:]))
            paths.append(np.array(path, np.int32))
    return paths
