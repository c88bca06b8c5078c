# SPDX-License-Identifier: GPL-3.0-or-later
"""Texels beside the end of a surface: the nearest covered texel, and its slope where the image is smooth.

The slope is that of the plane which fits the covered texels around best. It counts as far as the plane explains how
they vary, since to carry on the slope of noise or of an edge is worse than to repeat the nearest texel.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray
from ..base.progress import Steps
from .texel_raster import Indices, Shape, as_rows, centers

# In texels: where the weights of the fit fall to 0, and how far a plane is carried on.
_RADIUS = 3.2
_FARTHEST = 8.0
# Share of the variance at which the slope begins to count; it counts wholly where the plane explains all.
_LEAST_EXPLAINED = 0.85
# Texels nearly in one line have no slope across it: least determinant of their moments, over the square of the trace.
_FLATTEST = 1e-3


def extrapolate(
    pixels: NDArray[Any], covered: NDArray[np.bool_], texels: Indices, nearest: Indices, steps: Steps
) -> FloatArray:
    """(k, channels), values beside the end of a surface, in the range of all covered texels.

    covered: (height * width,). texels: (k,). nearest: (k,), the covered texel nearest to each.
    steps: told of.  Raises Cancelled.
    """
    rows, width = as_rows(pixels), pixels.shape[1]
    values = rows[nearest].astype(np.float64)
    if not len(texels):
        return values
    sources, of_source = np.unique(nearest, return_inverse=True)
    right, down = _slopes(rows, covered, sources, (pixels.shape[0], width), steps)[:, of_source.reshape(-1)]
    way = centers(texels, width) - centers(nearest, width)
    way *= np.minimum(1.0, _FARTHEST / np.abs(way))
    change = right * way.real[:, None] + down * way.imag[:, None]
    # Unlike minimum and maximum, these pass over what is no number.
    least, most = (bound.reduce(rows[covered], axis=0) for bound in (np.fmin, np.fmax))
    return np.where(change == 0, values, np.clip(values + change, least, most))


def _slopes(rows: NDArray[Any], covered: NDArray[np.bool_], sources: Indices, shape: Shape, steps: Steps) -> FloatArray:
    """(2, k, channels), how values change to the right and down at covered texels, (k,); 0 where that is unclear."""
    row, column = sources // shape[1], sources % shape[1]
    own = rows[sources].astype(np.float64)
    place, place_square = np.zeros((2, len(sources))), np.zeros((2, 2, len(sources)))
    value, value_square = np.zeros(own.shape), np.zeros(own.shape)
    total, product = np.zeros(len(sources)), np.zeros((2, *own.shape))
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        for step, weight in _NEIGHBORS:
            steps.tell()
            x, y = column + step[0], row + step[1]
            there = np.clip(y, 0, shape[0] - 1) * shape[1] + np.clip(x, 0, shape[1] - 1)
            counts = covered[there] & (x >= 0) & (x < shape[1]) & (y >= 0) & (y < shape[0])
            weights = np.where(counts, weight, 0.0)
            difference = np.where(counts[:, None], rows[there] - own, 0.0)
            weighted = weights[:, None] * difference
            total += weights
            place += weights * step[:, None]
            place_square += weights * (step[:, None] * step)[..., None]
            value += weighted
            value_square += weighted * difference
            product += weighted * step[:, None, None]
        # Moments about the mean.
        place_square -= place[:, None] * place / total
        product -= place[..., None] * value / total[:, None]
        value_square -= value**2 / total[:, None]
        (xx, xy), (_, yy) = place_square
        determinant = xx * yy - xy**2
        slopes = np.stack([yy[:, None] * product[0] - xy[:, None] * product[1], xx[:, None] * product[1]])
        slopes[1] -= xy[:, None] * product[0]
        slopes /= determinant[:, None]
        explained = (slopes * product).sum(axis=0) / value_square
        trust = np.clip((explained - _LEAST_EXPLAINED) / (1 - _LEAST_EXPLAINED), 0, 1)
        clear = (determinant > _FLATTEST * (xx + yy) ** 2)[:, None] & (trust > 0)
        return np.where(clear, trust * slopes, 0.0)


def _neighbors() -> list[tuple[NDArray[np.int64], float]]:
    """Steps to the texels around one and their weights, which do not sum to 1."""
    reach = range(-int(_RADIUS), int(_RADIUS) + 1)
    steps = [np.array((x, y)) for x in reach for y in reach]
    weighted = [(step, 1 - float(step @ step) / _RADIUS**2) for step in steps]
    return [(step, weight) for step, weight in weighted if weight > 0]


_NEIGHBORS = _neighbors()
