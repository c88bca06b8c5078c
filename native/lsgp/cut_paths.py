# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges that a layout is cut along, as paths from node to node."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .base import arguments


def split_into_paths(edges: ArrayLike, nodes: ArrayLike) -> list[NDArray[np.int32]]:
    """Vertex chains between nodes: the given ones and every vertex where not exactly two of the edges meet.

    edges: (c, 2) vertex pairs, each counted once. nodes: (k,) vertices. A loop without a node begins and ends at its
    lowest vertex. The same edges in any order give the same paths.  Raises InputError.
    """
    return _lsgp.split_into_paths(arguments.index_rows("edges", edges, 2), arguments.index_vector("nodes", nodes))
