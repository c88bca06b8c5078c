# SPDX-License-Identifier: GPL-3.0-or-later
"""Gutters of a texture: texels beside islands hold the content beyond the cut, not copies of the boundary."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray
from ..base.progress import Progress, Steps, share_of, tell
from ..errors import Elements, InputError
from ..surface import Surface, require_vertices
from .extrapolation import extrapolate
from .texel_raster import (
    ComplexArray,
    Indices,
    Shape,
    as_rows,
    centers,
    covering_triangles,
    nearest_covered,
    nearest_points,
    nearest_segments,
    to_pixels,
)
from .unfolded_walk import Walked, find_seams, walk

KINDS = ("uint8", "uint16", "float32", "float64")
MOST_CHANNELS = 4
# Coordinates come in single precision from files.
_ROUNDING = 1e-6
# Covered texels of less weight than this have no say in a bilinear sample.
_LEAST_WEIGHT = 1e-3
# Of filling gutters: each takes a weighted mean of covered texels and other gutters, so errors shrink with every pass.
_PASSES = 4
# Of the time of padding: which texels are covered, what lies beyond borders, and filling gutters from there.
_COVERED, _WALKED, _FILLED = 0.2, 0.5, 0.8


def pad_image(
    image: ArrayLike,
    surface: Surface,
    corner_uv: ArrayLike,
    margin: float,
    *,
    normal_map: bool = False,
    progress: Progress | None = None,
) -> NDArray[Any]:
    """A texture whose gutters hold the content beyond the cuts, so that filtered lookups match on both sides of a cut.

    image: (height, width) or (height, width, channels), 1 to 4 channels, uint8, uint16, float32 or float64; the first
    row is the top, v = 1.
    corner_uv: (m, 3, 2), in the unit square; NaN where there is none.
    margin: how far gutters reach from islands, in pixels.
    normal_map: the first two channels are a direction in the tangent plane, to the right and up, with 0 at half the
            range of integers, at 1/2 in floating point; it is rotated with the map.
    progress: as for `pack_islands`.

    A texel whose center is in no triangle gets the value of the surface beyond the nearest boundary of the island,
    found by unfolding triangles across all edges on the way; the sample is bilinear, from covered texels and from
    gutters that are known. Across
    cuts of this library's maps its position is exact; in other maps, sides of different length are matched by a
    similarity. At the boundary of the surface, or where it is mirrored in the map, it is the value of the nearest
    covered texel; where those around it are close to a plane, their slope is followed, for at most 8 pixels and within
    the range of the covered texels. Covered texels and those beyond the margin do not change. If coordinates are
    squeezed for an image that is not square, as by `correct_aspect`, transitions are those on the image. The argument
    is not modified; returns an image of its shape and dtype.
    Raises InputError: WRONG_SHAPE, WRONG_DTYPE, WRONG_PARAMETER, INDEX_OUT_OF_RANGE; ISLANDS_OUTSIDE the unit square,
    as in seamless layouts, in which a texel is at several places of the surface; NO_UV if nothing is mapped. Cancelled.

    >>> image = np.zeros((64, 64, 3), np.uint8)
    >>> padded = lsgp.pad_image(image, surface, lsgp.auto_unwrap(surface).corner_uv, margin=4)
    >>> padded.shape, padded.dtype
    ((64, 64, 3), dtype('uint8'))
    """
    arguments.require_callable(progress)
    turns_normals = arguments.flag("normal_map", normal_map)
    pixels = _image(image, turns_normals)
    uv = _coordinates(surface, corner_uv)
    shape: Shape = (pixels.shape[0], pixels.shape[1])
    reach = min(_margin(margin), math.hypot(*shape))
    corners = to_pixels(uv, shape)
    covered = covering_triangles(corners, shape, Steps(share_of(progress, 0.0, _COVERED))) >= 0
    texels, beyond = _beyond_borders(
        surface, corners, covered, reach, shape, Steps(share_of(progress, _COVERED, _WALKED))
    )

    gutters, known = _filled(
        pixels, covered, texels, beyond, turns_normals, Steps(share_of(progress, _WALKED, _FILLED))
    )
    steps = Steps(share_of(progress, _FILLED, 1.0))
    out = pixels.copy()
    rows = as_rows(out)
    rows[texels[known]] = convert_texels(gutters[known], pixels.dtype)
    rest = texels[~known]
    source = nearest_covered(rest, covered.reshape(shape), math.ceil(reach) + 1, steps)
    rest, source = rest[source >= 0], source[source >= 0]
    values = extrapolate(out, covered, rest, source, steps)
    if turns_normals:
        _keep_lengths(values, rows[source], pixels.dtype)
    rows[rest] = convert_texels(values, pixels.dtype)
    tell(progress, 1.0)
    return out


def _beyond_borders(
    surface: Surface, corners: ComplexArray, covered: NDArray[np.bool_], margin: float, shape: Shape, steps: Steps
) -> tuple[Indices, Walked]:
    """The texels of gutters, and where the centers of each lie beyond the nearest border."""
    seams = find_seams(surface.triangles, corners)
    borders = np.flatnonzero(seams.is_border)
    segments = np.stack([corners.ravel(), corners[:, [1, 2, 0]].ravel()], axis=1)[borders]
    nearest = nearest_segments(segments, margin, ~covered, shape, steps)
    texels = np.flatnonzero(nearest >= 0)
    places, chosen = centers(texels, shape[1]), nearest[texels]
    return texels, walk(seams, borders[chosen], nearest_points(segments[chosen], places), places, steps)


def _filled(
    pixels: NDArray[Any],
    covered: NDArray[np.bool_],
    texels: Indices,
    beyond: Walked,
    turns_normals: bool,
    steps: Steps,
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """(k, channels) what is beyond each of these texels, and where that is known.

    Beside a cut, samples also take gutters, which are filled again until they agree.
    """
    # Single precision holds 16 bits, in half the memory.
    work = pixels.astype(np.float64 if pixels.dtype == np.float64 else np.float32)
    rows, filled = as_rows(work), covered.copy()
    for _ in range(_PASSES):
        values, known = _sampled(work, filled, beyond.place, steps)
        known &= beyond.arrived
        if turns_normals:
            _turn_normals(values, beyond.turn, pixels.dtype)
        rows[texels[known]] = values[known]
        filled[texels[known]] = True
    return values, known


def _sampled(
    pixels: NDArray[Any], covered: NDArray[np.bool_], places: ComplexArray, steps: Steps
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """(k, channels) bilinear samples of the texels that are covered, and where there are any."""
    height, width = pixels.shape[:2]
    rows = as_rows(pixels)
    left, top = np.floor(places.real - 0.5), np.floor(places.imag - 0.5)
    across, down = places.real - 0.5 - left, places.imag - 0.5 - top
    values, total = np.zeros((len(places), rows.shape[1])), np.zeros(len(places))
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        steps.tell()
        x = np.clip(left + j, 0, width - 1).astype(np.int64)
        y = np.clip(top + i, 0, height - 1).astype(np.int64)
        texels = y * width + x
        weights = np.where(covered[texels], np.abs(1 - j - across) * np.abs(1 - i - down), 0.0)
        counted = weights > 0
        values[counted] += weights[counted, None] * rows[texels[counted]]
        total += weights
    known = total > _LEAST_WEIGHT
    values[known] /= total[known, None]
    return values, known


def _keep_lengths(values: FloatArray, others: NDArray[Any], dtype: np.dtype[Any]) -> None:
    """Make normals as long as others, in place; with two components, at most as long as a unit."""
    middle = _middle(dtype)
    normals, lengths = (np.linalg.norm(rows[:, :3] - middle, axis=1) for rows in (values, others.astype(np.float64)))
    if values.shape[1] == 2:
        lengths = np.minimum(normals, np.maximum(lengths, middle))
    changed = (normals != lengths) & (normals > 0)
    values[changed, :3] = middle + (values[changed, :3] - middle) * (lengths[changed] / normals[changed])[:, None]


def _middle(dtype: np.dtype[Any]) -> float:
    """What stands for 0 in the components of normals."""
    return float(np.iinfo(dtype).max if dtype.kind == "u" else 1) / 2


def _turn_normals(values: FloatArray, turn: ComplexArray, dtype: np.dtype[Any]) -> None:
    """Turn the directions of normals from where they were sampled back to the gutter, in place."""
    middle = _middle(dtype)
    # The inverse of the turn in an image, whose y is down, is the turn itself where y is up.
    direction = ((values[:, 0] - middle) + 1j * (values[:, 1] - middle)) * turn
    values[:, 0], values[:, 1] = direction.real + middle, direction.imag + middle


def convert_texels(values: FloatArray, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Values as the type of an image holds them: integers are rounded and clipped to their range."""
    if dtype.kind == "u":
        values = np.clip(np.floor(values + 0.5), 0, np.iinfo(dtype).max)
    return values.astype(dtype)


def _image(image: ArrayLike, normal_map: bool) -> NDArray[Any]:
    pixels = arguments.as_array("image", image)
    if pixels.dtype.name not in KINDS:
        raise InputError("WRONG_DTYPE", f"image holds {pixels.dtype}; pass {', '.join(KINDS[:-1])} or {KINDS[-1]}.")
    channels = pixels.shape[2] if pixels.ndim == 3 else 1
    if pixels.ndim not in (2, 3) or not pixels.size or not 1 <= channels <= MOST_CHANNELS:
        raise InputError(
            "WRONG_SHAPE",
            f"image has shape {pixels.shape}; pass (height, width) or (height, width, channels), of 1 to "
            f"{MOST_CHANNELS} channels and at least one texel.",
        )
    if normal_map and channels < 2:
        raise InputError("WRONG_SHAPE", "A normal map has two channels or more, the image 1. Leave out normal_map.")
    return arguments.contiguous("image", pixels, pixels.dtype)


def _coordinates(surface: Surface, corner_uv: ArrayLike) -> FloatArray:
    """(m, 3, 2), in the unit square or NaN."""
    require_vertices(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    mapped = ~np.isnan(uv).any(axis=(1, 2))
    if not mapped.any():
        raise InputError("NO_UV", "No triangle has texture coordinates. Unwrap the surface first.")
    outside = mapped & ((uv < -_ROUNDING) | (uv > 1 + _ROUNDING)).any(axis=(1, 2))
    if outside.any():
        far = uv[outside].ravel()
        raise InputError(
            "ISLANDS_OUTSIDE",
            f"{int(outside.sum())} of {len(uv)} triangles are outside the unit square, from {far.min():.4g} to "
            f"{far.max():.4g}: the texture repeats there, and a gutter cannot be beside all of its copies. Pass a "
            "layout in the unit square; seamless ones need no gutters.",
            Elements("triangles", np.flatnonzero(outside).astype(np.int32)),
        )
    return np.where(mapped[:, None, None], uv, np.nan)


def _margin(margin: float) -> float:
    remedy = "pass how many pixels gutters are wide, 0 or more"
    found = arguments.number("margin", margin, remedy)
    if not (math.isfinite(found) and found >= 0):
        arguments.refuse("margin", margin, remedy)
    return found
