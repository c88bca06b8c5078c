# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges as numbers, by which arrays of them are compared."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .arguments import IndexArray


def edge_keys(a: IndexArray, b: IndexArray, vertex_count: int) -> NDArray[np.int64]:
    """A number for each pair of vertices, one of `a` and one of `b`, whatever their order."""
    return np.minimum(a, b).astype(np.int64) * vertex_count + np.maximum(a, b)
