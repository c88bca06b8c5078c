# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges as numbers, by which arrays of them are compared."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .arguments import IndexArray


def edge_keys(a: IndexArray, b: IndexArray, vertex_count: int) -> NDArray[np.int64]:
    """A number for each pair of vertices, one of `a` and one of `b`, whatever their order."""
    return np.minimum(a, b).astype(np.int64) * vertex_count + np.maximum(a, b)


def side_keys(triangles: IndexArray, vertex_count: int) -> NDArray[np.int64]:
    """(3 m,), the key of each side of triangles, (m, 3), from corner c to c + 1."""
    return edge_keys(triangles, triangles[:, [1, 2, 0]], vertex_count).ravel()
