# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates as files and other libraries hold them: a list without duplicates, and indices into it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .base import arguments


def index_uv(triangles: ArrayLike, corner_uv: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The list of texture coordinates and the indices of the triangles into it, as OBJ, libigl and others have them.

    triangles: (m, 3) vertices. corner_uv: (m, 3, 2), as of a result.

    Returns vt, (k, 2) float64, every (u, v) of a vertex once, in the order of their first corner; and ft, (m, 3) int32,
    so that vt[ft] is corner_uv; -1 at the corners of a triangle without coordinates (NaN at one of them).
    Raises InputError: WRONG_SHAPE, WRONG_DTYPE, INDEX_OUT_OF_RANGE.
    """
    vertices = arguments.index_rows("triangles", triangles, 3)
    arguments.require_indices("triangles", vertices, np.iinfo(np.int32).max)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(vertices))
    mapped = ~np.isnan(uv).any(axis=(1, 2))
    vt, found = index_corners(vertices[mapped].ravel(), uv[mapped].reshape(-1, 2))
    ft = np.full(vertices.shape, -1, np.int32)
    ft[mapped] = found.reshape(-1, 3)
    return vt, ft


def index_corners(
    vertices: NDArray[np.integer], uv: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """vt (k, 2), every (u, v) of a vertex once, in the order of their first corner, and its index at each corner, (c,).

    vertices: (c,), 0 or more. uv: (c, 2), without NaN.
    """
    first, index = _lsgp.distinct_corners(vertices, uv)
    return uv[first], index
