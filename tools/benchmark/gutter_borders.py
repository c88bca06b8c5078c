# SPDX-License-Identifier: GPL-3.0-or-later
"""How far lookups at the end of a surface are off, for gutters of several kinds, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/gutter_borders.py

Images of known content are cut out along three outlines and padded again; the table has the mean difference of bilinear
lookups, on the outline and up to a texel inside, from those in the whole image, at the mip levels 0 to 3 of both, in
units of 1e-4. Needs the lsgp wheel and scipy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import lsgp
import numpy as np
from gutter_checks import lookup, mips, smeared
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

FloatArray = NDArray[np.float64]

SIZE, MARGIN, LEVELS = 256, 16, 4


@dataclass(frozen=True, eq=False)
class Outline:
    """An island around the middle of the image.

    corners: (k,), of the outline, complex, in pixels. covered: (SIZE, SIZE). texels: (m,), of the gutter. foot: (m,),
    the point of the outline nearest to each, and inwards, (m,), the unit vector from the texel to it.
    """

    corners: NDArray[np.complex128]
    surface: lsgp.Surface
    corner_uv: FloatArray
    covered: NDArray[np.bool_]
    texels: NDArray[np.int64]
    foot: NDArray[np.complex128]
    inwards: NDArray[np.complex128]
    distance: FloatArray


def outline(shape: NDArray[np.complex128]) -> Outline:
    """shape: (k,), corners about 0, in shares of the image, seen from 0."""
    middle = 0.5013 * SIZE * (1 + 1j)
    corners = middle + SIZE * shape
    rows, columns = np.mgrid[:SIZE, :SIZE]
    centers = (columns + 0.5 + 1j * (rows + 0.5)).ravel()
    ends = np.roll(corners, -1)
    foot, distance = centers.copy(), np.full(len(centers), np.inf)
    covered = np.zeros(len(centers), bool)
    for start, end in zip(corners, ends, strict=True):
        along = end - start
        share = np.clip(((centers - start) * np.conj(along)).real / abs(along) ** 2, 0, 1)
        point = start + share * along
        nearer = np.abs(centers - point) < distance
        foot[nearer], distance[nearer] = point[nearer], np.abs(centers - point)[nearer]
        sides = [((centers - a) * np.conj(b - a)).imag for a, b in ((start, end), (end, middle), (middle, start))]
        covered |= (np.array(sides) <= 0).all(axis=0) | (np.array(sides) >= 0).all(axis=0)
    texels = np.flatnonzero(~covered & (distance <= MARGIN))
    places = np.append(corners, middle)
    uv = np.stack([places.real / SIZE, 1 - places.imag / SIZE], axis=1)
    count = len(corners)
    triangles = np.stack([np.arange(count), (np.arange(count) + 1) % count, np.full(count, count)], axis=1)
    whole = lsgp.Surface(np.column_stack([uv, np.zeros(len(uv))]), triangles.astype(np.int32))
    foot, distance = foot[texels], distance[texels]
    inwards = (foot - centers[texels]) / np.maximum(distance, 1e-9)
    return Outline(corners, whole, uv[triangles], covered.reshape(SIZE, SIZE), texels, foot, inwards, distance)


def outlines() -> list[Outline]:
    turns = np.exp(2j * np.pi * np.arange(64) / 64)
    square = 0.27 * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]) * np.exp(0.2j)
    star = (0.28 + 0.09 * np.sin(7 * np.angle(turns))) * turns
    return [outline(shape) for shape in (0.37 * turns, square, star)]


def images() -> dict[str, FloatArray]:
    """From 0 to 1, (SIZE, SIZE)."""
    random = np.random.default_rng(0)
    rows, columns = np.mgrid[:SIZE, :SIZE]

    def waves(length: float) -> FloatArray:
        angles, phases = random.uniform(0, 2 * np.pi, (2, 4))
        ways = ((columns * np.cos(angle) + rows * np.sin(angle)) / length for angle in angles)
        return sum(np.sin(2 * np.pi * way + phase) for way, phase in zip(ways, phases, strict=True)) * 0.12 + 0.5

    def noise(radius: float) -> FloatArray:
        values = gaussian_filter(random.standard_normal((SIZE, SIZE)), radius, mode="wrap")
        return 0.5 + 0.15 * values / values.std()

    gradient = 0.1 + 0.8 * (columns * np.cos(0.5) + rows * np.sin(0.5)) / (SIZE * (np.cos(0.5) + np.sin(0.5)))
    found = {
        "gradient": gradient,
        **{f"waves, {length} texels long": waves(length) for length in (64, 32, 16, 8)},
        **{f"noise, smoothed by {radius}": noise(radius) for radius in (4, 2, 1)},
        "noise of single texels": noise(0),
        "gradient with grain": gradient + 0.02 * random.standard_normal((SIZE, SIZE)),
        "checkers of 16 texels": 0.2 + 0.6 * ((rows // 16 + columns // 16) % 2),
    }
    return {name: np.clip(image, 0, 1) for name, image in found.items()}


def at(part: Outline, image: FloatArray, inside: FloatArray) -> FloatArray:
    """Bilinear lookups so far inside the outline, of covered texels alone; the nearest texel where there are none."""
    places = part.foot + inside * part.inwards
    uv = np.stack([places.real / SIZE, 1 - places.imag / SIZE], axis=1)
    weight = lookup(part.covered.astype(float), uv)
    nearest = smeared(image, part.covered, MARGIN).ravel()[part.texels]
    return np.where(weight > 1e-3, lookup(image * part.covered, uv) / np.maximum(weight, 1e-3), nearest)


def reflected(part: Outline, image: FloatArray) -> FloatArray:
    """Twice the value on the outline, less that of the mirrored place."""
    return np.clip(2 * at(part, image, 0 * part.distance) - at(part, image, np.maximum(part.distance, 1)), 0, 1)


def clamped(part: Outline, image: FloatArray) -> FloatArray:
    """The same, in the range of lookups around the point on the outline."""
    beside = [at(part, image, np.full(len(part.foot), step)) for step in (0.0, 1.0, 2.0)]
    return np.clip(reflected(part, image), np.min(beside, axis=0), np.max(beside, axis=0))


def filled(fill: Callable[[Outline, FloatArray], FloatArray]) -> Callable[[Outline, FloatArray], FloatArray]:
    def pad(part: Outline, image: FloatArray) -> FloatArray:
        padded = np.where(part.covered, image, 0.0)
        padded.ravel()[part.texels] = fill(part, image)
        return padded

    return pad


KINDS: dict[str, Callable[[Outline, FloatArray], FloatArray]] = {
    "nearest": lambda part, image: smeared(image * part.covered, part.covered, MARGIN),
    "mirrored": filled(lambda part, image: at(part, image, part.distance)),
    "linear": filled(reflected),
    "clamped": filled(clamped),
    "ours": lambda part, image: lsgp.pad_image(image * part.covered, part.surface, part.corner_uv, MARGIN),
}


def difference(part: Outline, image: FloatArray, padded: FloatArray) -> FloatArray:
    """(LEVELS,)"""
    share = (np.arange(40) + 0.5) / 40
    along = np.roll(part.corners, -1) - part.corners
    points = (part.corners[:, None] + share * along[:, None]).ravel()
    across = np.repeat(1j * along / np.abs(along), len(share))
    points = np.concatenate([points + inside * across for inside in (0.0, 0.5, 1.0)])
    uv = np.stack([points.real / SIZE, 1 - points.imag / SIZE], axis=1)
    levels = zip(range(LEVELS), mips(padded), mips(image), strict=False)
    return np.array([np.abs(lookup(ours, uv) - lookup(true, uv)).mean() for _, ours, true in levels])


def main() -> None:
    parts = outlines()
    print(f"| image | {' | '.join(KINDS)} |")
    print(f"|---|{'--:|' * len(KINDS)}")
    for name, image in images().items():
        cells = []
        for pad in KINDS.values():
            found = np.mean([difference(part, image, pad(part, image)) for part in parts], axis=0)
            cells.append(", ".join(f"{1e4 * value:.0f}" if value >= 1e-3 else f"{1e4 * value:.1f}" for value in found))
        print(f"| {name} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
