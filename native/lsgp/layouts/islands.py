# SPDX-License-Identifier: GPL-3.0-or-later
"""Placement of finished islands: restoring their positions, and fitting them to images that are not square.

Only whole islands are moved, each by one similarity, so that the relation of both sides of every cut is preserved.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.unit_size import unit_exponent
from ..errors import InputError

# Texture coordinates come in single precision; an island below this share of its distance to the origin is a point.
_POINT = 1e-6
# Relative to the sizes; below this, the best rotation is undefined.
_NO_TURN = 1e-9


def fit_placement(corner_uv: FloatArray, old_uv: FloatArray, island: IndexArray) -> FloatArray:
    """Move every island to the former position of its corners, by one rotation, uniform scale and translation each.

    corner_uv: (m, 3, 2) float64, the new coordinates. old_uv: (m, 3, 2), the old ones. island: (m,), -1 for none.
    Rotation and position are the best fit in least squares over the island's corners, never a reflection. The scale
    preserves the root mean square distance of the corners from their centroid: the least-squares scale would shrink an
    island with every change of its shape.
    Triangles without an island do not move, nor do islands whose old coordinates are not finite or coincide.
    Returns a new array; raises InputError for arrays that do not match.
    """
    island = arguments.islands("island", island)
    corner_uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    old_uv = arguments.corner_coordinates("old_uv", old_uv, len(island))
    out = corner_uv.copy()
    count = int(island.max(initial=-1)) + 1
    finite = np.isfinite(old_uv).all(axis=(1, 2)) & np.isfinite(corner_uv).all(axis=(1, 2))
    broken = np.zeros(count, bool)
    broken[island[(island >= 0) & ~finite]] = True
    taken = np.flatnonzero((island >= 0) & ~np.append(broken, True)[island])
    of_triangle = island[taken]
    exponents = tuple(unit_exponent(uv[taken]) for uv in (corner_uv, old_uv))
    new, old = (_as_complex(np.ldexp(uv[taken], -e)) for uv, e in zip((corner_uv, old_uv), exponents, strict=True))

    corners = np.maximum(3 * np.bincount(of_triangle, minlength=count), 1)
    new_middle, old_middle = _sums(of_triangle, new, count) / corners, _sums(of_triangle, old, count) / corners
    new, old = new - new_middle[of_triangle, None], old - old_middle[of_triangle, None]
    new_size = np.sqrt(_sums(of_triangle, new.conj() * new, count).real / corners)
    old_size = np.sqrt(_sums(of_triangle, old.conj() * old, count).real / corners)
    along = _sums(of_triangle, new.conj() * old, count) / corners

    movable = (old_size > _POINT * abs(old_middle)) & (new_size > 0)
    sizes = np.where(movable, new_size * old_size, 1.0)
    turned = abs(along) > _NO_TURN * sizes
    turn = np.where(turned, along, 1.0) / np.where(turned, abs(along), 1.0)
    factor = np.where(movable, turn * old_size / np.where(movable, new_size, 1.0), 1.0)
    moved = factor[of_triangle, None] * new + old_middle[of_triangle, None]
    moves = movable[of_triangle]
    with np.errstate(over="ignore"):  # where the old places were next to the largest number
        out[taken[moves]] = np.ldexp(moved[moves].view(np.float64).reshape(-1, 3, 2), exponents[1])
    return out


def correct_aspect(corner_uv: ArrayLike, aspect: float) -> FloatArray:
    """Squeeze coordinates so that they are undistorted on an image of this aspect.

    corner_uv: (..., 2). aspect: width of the image over its height, above 0. Coordinates in the unit square stay in it.
    Raises InputError for other values of aspect.
    """
    aspect = arguments.positive("aspect", aspect, "pass width over height of the image, above 0")
    uv = arguments.floats("corner_uv", corner_uv)
    if uv.ndim == 0 or uv.shape[-1] != 2:
        raise InputError("WRONG_SHAPE", f"corner_uv has shape {uv.shape}; pass (..., 2).")
    return uv * np.array([1 / max(aspect, 1.0), min(aspect, 1.0)])


def _as_complex(corner_uv: FloatArray) -> np.ndarray:
    """(m, 3) of (m, 3, 2)."""
    return np.ascontiguousarray(corner_uv).view(np.complex128)[..., 0]


def _sums(of_triangle: IndexArray, values: np.ndarray, count: int) -> np.ndarray:
    """Sum of the (m, 3) complex values of each island's triangles."""
    values = values[:, 0] + values[:, 1] + values[:, 2]
    real = np.bincount(of_triangle, values.real, minlength=count)
    return real + 1j * np.bincount(of_triangle, values.imag, minlength=count)
