# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures baked from a function of space, padded in several ways, and the lookups on both sides of cuts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import lsgp
import numpy as np
from map_checks import surface
from meshes import Mesh
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

FloatArray = NDArray[np.float64]


def unwrapped(mesh: Mesh) -> tuple[lsgp.Surface, FloatArray]:
    """The surface and its map, (m, 3, 2), in the unit square and nowhere on itself."""
    whole = surface(mesh)
    return whole, lsgp.auto_unwrap(whole, mesh.cones, options=lsgp.Options(overlaps="split")).corner_uv


def inset(corner_uv: FloatArray, room: float) -> FloatArray:
    """The map, smaller, with so much of the square free around it."""
    return corner_uv * (1 - 2 * room) + room


def smooth(places: FloatArray) -> FloatArray:
    """A function of space, (k, 3), from 0 to 1."""
    x, y, z = np.moveaxis(places, -1, 0)
    return 0.5 + 0.2 * np.sin(2.1 * x + 0.3) + 0.2 * np.cos(1.7 * y - z) + 0.1 * np.sin(2.9 * z + x)


def bake(whole: lsgp.Surface, corner_uv: FloatArray, size: int) -> tuple[FloatArray, NDArray[np.bool_]]:
    """The function at the texels with their center in a triangle, 0 elsewhere; and which these are. Both (size, size).

    One triangle after the other, by barycentric coordinates.
    """
    image, covered = np.zeros((size, size)), np.zeros((size, size), bool)
    for uv, corners in zip(corner_uv, whole.positions[whole.triangles], strict=True):
        x, y = uv[:, 0] * size, (1 - uv[:, 1]) * size
        columns = np.arange(max(int(x.min()) - 1, 0), min(int(x.max()) + 2, size))
        rows = np.arange(max(int(y.min()) - 1, 0), min(int(y.max()) + 2, size))
        j, i = (grid.ravel() for grid in np.meshgrid(columns, rows))
        weights = np.linalg.solve(np.stack([x, y, np.ones(3)]), np.stack([j + 0.5, i + 0.5, np.ones(len(i))])).T
        inside = (weights >= 0).all(axis=1) & ~covered[i, j]
        image[i[inside], j[inside]] = smooth(weights[inside] @ corners)
        covered[i[inside], j[inside]] = True
    return image, covered


def smeared(image: FloatArray, covered: NDArray[np.bool_], margin: float) -> FloatArray:
    """The image with the value of the nearest covered texel, as other tools pad."""
    distance, nearest = distance_transform_edt(~covered, return_indices=True)
    return np.where(distance <= margin + 1, image[tuple(nearest)], image)


def mips(image: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """The image and its box-filtered halves."""
    while True:
        yield image
        image = (image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]) / 4


def lookup(image: NDArray[Any], uv: FloatArray) -> NDArray[Any]:
    """Bilinear, as a graphics processor's; (k, 2) to (k, ...)."""
    height, width = image.shape[:2]
    x = np.clip(uv[:, 0] * width - 0.5, 0, width - 1)
    y = np.clip((1 - uv[:, 1]) * height - 0.5, 0, height - 1)
    j, i = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    s, t = ((part).reshape(-1, *[1] * (image.ndim - 2)) for part in (x - j, y - i))
    upper = image[i, j] * (1 - s) + image[i, j + 1] * s
    return upper * (1 - t) + (image[i + 1, j] * (1 - s) + image[i + 1, j + 1] * s) * t


def both_sides(whole: lsgp.Surface, corner_uv: FloatArray, step: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Texture coordinates at both sides of points along all cuts, a step apart, and the turn from one to the other.

    (k, 2), (k, 2), (k,) radians.
    """
    sides: dict[tuple[int, int], tuple[FloatArray, FloatArray]] = {}
    found: list[tuple[FloatArray, FloatArray, FloatArray]] = []
    for triangle, uv in zip(whole.triangles.tolist(), corner_uv, strict=True):
        for c in range(3):
            a, b = triangle[c], triangle[(c + 1) % 3]
            here = uv[c], uv[(c + 1) % 3]
            sides[a, b] = here
            if (b, a) not in sides:
                continue
            there = sides[b, a][::-1]
            if max(np.abs(here[0] - there[0]).max(), np.abs(here[1] - there[1]).max()) < 1e-9:
                continue
            count = int(np.linalg.norm(here[1] - here[0]) / step) + 1
            share = ((np.arange(count) + 0.5) / count)[:, None]
            along = [complex(*(side[1] - side[0])) for side in (here, there)]
            found.append(
                (
                    *((1 - share) * side[0] + share * side[1] for side in (here, there)),
                    np.full(count, np.angle(along[1] / along[0])),
                )
            )
    left, right, turn = (np.concatenate(part) for part in zip(*found, strict=True))
    return left, right, turn


def difference_across_cuts(whole: lsgp.Surface, corner_uv: FloatArray, image: FloatArray, levels: int) -> list[float]:
    """Mean difference of lookups at both sides of all cuts, at each mip level."""
    left, right, _ = both_sides(whole, corner_uv, 1 / image.shape[0])
    return [
        float(np.abs(lookup(mip, left) - lookup(mip, right)).mean())
        for mip, _ in zip(mips(image), range(levels), strict=False)
    ]


def difference_of_neighbors(image: FloatArray, covered: NDArray[np.bool_]) -> float:
    """Mean difference of covered texels beside and above each other."""
    pairs = [(image[:, 1:], image[:, :-1], covered[:, 1:] & covered[:, :-1])]
    pairs.append((image[1:], image[:-1], covered[1:] & covered[:-1]))
    return float(np.concatenate([np.abs(one - other)[both] for one, other, both in pairs]).mean())
