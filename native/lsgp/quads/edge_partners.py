# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies beyond the edges of triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import IndexArray


def edge_ends(triangles: IndexArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(3m,) the vertices at which edges start and end. Edge 3 t + c of triangle t is from its corner c to the next."""
    return triangles.ravel().astype(np.int64), np.roll(triangles, -1, axis=1).ravel().astype(np.int64)


def edge_partners(triangles: IndexArray) -> NDArray[np.int64]:
    """(3m,) the same edge in the triangle beyond, where it runs the other way; -1 where there is none, and for
    triangles that name a vertex twice."""
    start, end = edge_ends(triangles)
    count = int(start.max(initial=0)) + 1
    is_triangle = np.repeat((triangles != np.roll(triangles, -1, axis=1)).all(axis=1), 3)
    edges = np.flatnonzero(is_triangle)
    keys = (start * count + end)[edges]
    order = np.argsort(keys, kind="stable")
    wanted = end * count + start
    found = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    return np.where(is_triangle & (keys[order][found] == wanted), edges[order][found], -1)
