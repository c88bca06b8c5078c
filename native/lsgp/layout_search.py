# SPDX-License-Identifier: GPL-3.0-or-later
"""The smallest layout of islands among those with different quarter turns."""

from __future__ import annotations

import numpy as np

from .api import Progress
from .arguments import FloatArray, IndexArray
from .chart_packer import Islands, Layout, Packer, Square
from .errors import Cancelled
from .island_gaps import border_edges
from .triangles import uv_area

# Ways to turn islands by quarter turns that are tried; of many islands fewer, since each takes longer.
_TRIES = 24
_ISLANDS_OF_ALL_TRIES = 64
# Of the islands of the best layout, so many keep their turn when some are turned.
_KEPT = 0.7


def islands_of(uv: FloatArray, island: IndexArray) -> Islands:
    """uv: (m, 3, 2), finite. island: (m,), of any number each."""
    _, of_triangle = np.unique(island, return_inverse=True)
    corners, owner = uv.reshape(-1, 2) + 0.0, np.repeat(of_triangle.ravel(), 3)  # -0.0 is 0.0
    order = np.lexsort((corners[:, 1], corners[:, 0], owner))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(owner[order]) != 0) | (np.diff(corners[order], axis=0) != 0).any(axis=1)
    vertices = np.empty(len(order), np.int64)
    vertices[order] = np.cumsum(new) - 1
    place = corners[order[new]] @ np.array([1, 1j])
    triangles = vertices.reshape(-1, 3)
    triangle, corner = border_edges(triangles)
    return Islands(
        place=place,
        triangles=triangles,
        island=owner[order[new]],
        borders=np.stack([triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]], axis=1),
        area=uv_area(uv),
    )


def best_layout(islands: Islands, square: Square, may_turn: bool, progress: Progress | None) -> Layout:
    """The smallest of the layouts tried.  Raises InputError, Cancelled."""
    tries = max(1, _TRIES * _ISLANDS_OF_ALL_TRIES // max(islands.count, _ISLANDS_OF_ALL_TRIES)) if may_turn else 1
    packer = Packer(islands, square)
    # The generator whose numbers never change with the version of numpy.
    random = np.random.RandomState(0)
    best: Layout | None = None
    turns = best_turns = np.zeros(islands.count, np.int64)
    for number in range(tries):
        if progress is not None and progress(number / tries) is False:
            raise Cancelled("CANCELLED", "Stopped as asked; nothing was changed.")
        if number == 1:
            turns = np.ones(islands.count, np.int64)
        elif number > 1:
            # Half of them from the best so far, of which some islands are turned.
            kept = random.random_sample(islands.count) < _KEPT if number % 2 else np.zeros(islands.count, bool)
            turns = np.where(kept, best_turns, random.randint(0, 4, islands.count))
        found = packer.improved(turns, best)
        if found is not None:
            best, best_turns = found, turns
    if progress is not None:
        progress(1.0)
    return best
