# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of single triangles, for heat maps; `measure_distortion` measures whole maps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .base import arguments
from .base.arguments import FloatArray
from .base.equality import EqualByContent
from .base.short_repr import ShortRepr
from .base.unit_size import unit_exponent
from .surface import Surface, require_vertices


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TriangleDistortion(EqualByContent, ShortRepr):
    """Measures of each triangle, (m,) float64; NaN where it has no area on the surface or no coordinates.

    conformal: sigma_1 / sigma_2, 1 if angles are preserved. area: (share of the UV area) / (share of the 3D area), 1 if
    the triangle has its share of the texture. stretch: the L2 stretch of Sander et al. 2001 of the triangle, at the
    common scale of the whole map; 1 if lengths are preserved. All are infinite or 0 if the triangle's image has no
    area.
    """

    conformal: FloatArray
    area: FloatArray
    stretch: FloatArray


def singular_values(surface: Surface, corner_uv: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """(m,) sigma_1 >= sigma_2 >= 0 of each triangle's linear map from its plane to the texture, with lengths as of
    `Surface.scale`.

    corner_uv: (m, 3, 2). NaN as in `TriangleDistortion`.  Raises InputError.
    """
    largest, smallest, exponent = _scaled_singular_values(surface, corner_uv)
    with np.errstate(over="ignore"):
        return np.ldexp(largest, exponent), np.ldexp(smallest, exponent)


def _scaled_singular_values(surface: Surface, corner_uv: ArrayLike) -> tuple[FloatArray, FloatArray, int]:
    """The same with coordinates of about 1, and the power of two by which they were larger."""
    require_vertices(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    exponent = unit_exponent(uv)
    uv = np.ldexp(uv, -exponent)
    length, dot, doubled = _first_sides(surface)
    with np.errstate(divide="ignore", invalid="ignore"):
        # The triangle in its own plane: corners 0, length, x + i height.
        x, height = dot / length, doubled / length
        z = uv[..., 0] + 1j * uv[..., 1]
        along = (z[:, 1] - z[:, 0]) / length
        across = (z[:, 2] - z[:, 0] - along * x) / height
        largest = (np.abs(along - 1j * across) + np.abs(along + 1j * across)) / 2
        # By the area, not as a difference, which would lose the digits of thin images.
        smallest = np.abs((along.conj() * across).imag) / largest
    smallest[largest == 0] = 0.0
    flat = ~(doubled > 0)
    largest[flat] = smallest[flat] = np.nan
    return largest, smallest, exponent


def triangle_distortion(surface: Surface, corner_uv: ArrayLike) -> TriangleDistortion:
    """The measures of each triangle.  Arguments and errors as in `singular_values`."""
    largest, smallest, _ = _scaled_singular_values(surface, corner_uv)
    measured = ~np.isnan(largest)
    areas = np.where(measured, triangle_areas(surface), 0.0)
    scaled = largest * smallest
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # Texture area per unit of surface area, over the whole map.
        unit = (scaled[measured] * areas[measured]).sum() / areas.sum()
        stretch = np.sqrt((1 / largest**2 + 1 / smallest**2) / 2 * unit)
        return TriangleDistortion(
            conformal=np.where(smallest > 0, largest / smallest, np.where(measured, np.inf, np.nan)),
            area=scaled / unit,
            stretch=stretch,
        )


def triangle_areas(surface: Surface) -> FloatArray:
    """(m,) area of each triangle in the surface's metric."""
    return _first_sides(surface)[2] / 2


def _first_sides(surface: Surface) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(m,) of each triangle in the surface's metric: the length of its first side, the product of that with the side
    to the last corner, and the doubled area between them."""
    place = surface.positions[surface.triangles]
    if surface.scale is None:
        first, second = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
        return (
            np.linalg.norm(first, axis=1),
            (first * second).sum(axis=1),
            np.linalg.norm(np.cross(first, second), axis=1),
        )
    sides = side_lengths(surface)
    squares = sides * sides
    c, b, a = np.sort(sides, axis=1).T
    # Kahan's stable formula.
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return sides[:, 0], (squares[:, 0] + squares[:, 2] - squares[:, 1]) / 2, np.sqrt(np.maximum(product, 0.0)) / 2


def side_lengths(surface: Surface) -> FloatArray:
    """(m, 3) in the surface's metric, that from each corner to the next."""
    place = surface.positions[surface.triangles]
    lengths = np.linalg.norm(np.roll(place, -1, axis=1) - place, axis=2)
    if surface.scale is None:
        return lengths
    scale = surface.scale[surface.triangles]
    return lengths * (scale + np.roll(scale, -1, axis=1)) / 2


def uv_area(corner_uv: FloatArray) -> float:
    """Of all triangles in the plane, flipped ones too, (m, 3, 2)."""
    return float(uv_areas(corner_uv).sum())


def uv_areas(corner_uv: FloatArray) -> FloatArray:
    """(m,) of triangles in the plane, flipped ones too, (m, 3, 2)."""
    first, second = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2
