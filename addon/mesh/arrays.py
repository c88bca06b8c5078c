# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's collections as arrays."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray


def read_array(collection: bpy.types.bpy_prop_collection, name: str, dtype: type, columns: int = 1) -> NDArray:
    """One property of all elements: (n,), or (n, columns) where it has several components."""
    values = np.empty(len(collection) * columns, dtype)
    collection.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)


def rows(values: list, columns: int, dtype: type = np.float32) -> NDArray:
    """(n, columns) of a list of tuples, which may be empty."""
    return np.array(values, dtype).reshape(-1, columns)
