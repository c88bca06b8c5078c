# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands by formula, to be packed: kits of any number of one kind, (m, 3, 2) coordinates and (m,) islands.

The same kind, count and seed give the same islands. They lie on a grid, each turned at random, none on another.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Random = np.random.RandomState


class Kit(NamedTuple):
    corner_uv: FloatArray
    island: NDArray[np.int32]


def kit(kind: str, count: int, seed: int = 0) -> Kit:
    random = Random([seed, count, list(KINDS).index(kind)])
    return gathered([turned(KINDS[kind](random, number), random) for number in range(count)])


def gathered(islands: list[FloatArray]) -> Kit:
    """Islands, (k, 3, 2) each, on a grid."""
    columns = math.ceil(math.sqrt(len(islands)))
    pitch = 1.1 * max(float(np.ptp(one.reshape(-1, 2), axis=0).max()) for one in islands)
    placed = [
        one - one.reshape(-1, 2).min(axis=0) + [number % columns * pitch, number // columns * pitch]
        for number, one in enumerate(islands)
    ]
    island = np.repeat(np.arange(len(islands), dtype=np.int32), [len(one) for one in islands])
    return Kit(np.concatenate(placed), island)


def turned(one: FloatArray, random: Random) -> FloatArray:
    angle = random.uniform(0, 2 * math.pi)
    x, y = np.moveaxis(one, -1, 0)
    # Not by a product of matrices, which may round corners that are the same differently.
    return np.stack([math.cos(angle) * x - math.sin(angle) * y, math.sin(angle) * x + math.cos(angle) * y], axis=-1)


def convex(random: Random, _: int) -> FloatArray:
    """A polygon of 3 to 12 corners on an ellipse."""
    count = random.randint(3, 13)
    angle = (np.arange(count) + random.uniform(-0.3, 0.3, count)) * (2 * math.pi / count)
    return size(random) * fan(np.stack([np.cos(angle), random.uniform(0.4, 1) * np.sin(angle)], axis=1))


def concave(random: Random, number: int) -> FloatArray:
    """An L, a U or a star."""
    width, height = random.uniform(0.2, 0.6, 2)
    if number % 3 == 0:
        return size(random) * blocks([0, width, 1], [0, height, 1], [(0, 0), (1, 0), (0, 1)])
    if number % 3 == 1:
        whole = [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1)]
        return size(random) * blocks([0, 0.5 * width, 1 - 0.5 * width, 1], [0, 0.5 * height, 1], whole)
    count = random.randint(4, 9)
    angle = np.arange(2 * count) * (math.pi / count)
    radius = np.where(np.arange(2 * count) % 2, random.uniform(0.25, 0.6), 0.8)
    return size(random) * fan(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def strip(random: Random, number: int) -> FloatArray:
    """Long and thin, straight or bent."""
    length, width = random.uniform(1.5, 4), random.uniform(0.08, 0.25)
    bend = random.uniform(0.5, 4) if number % 2 else 0.0
    along = np.linspace(-0.5, 0.5, 2 if bend == 0 else 25)
    return size(random) * band(*arc(along, length, bend), np.full(len(along), width / 2))


def ring(random: Random, number: int) -> FloatArray:
    """A ring, one that fits into its hole, or a disk for the hole of that."""
    outer = (1.2, 0.8, 0.5)[number % 3] * random.uniform(0.9, 1.05)
    angle = np.arange(33) * (2 * math.pi / 32)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    circle[-1] = circle[0]
    if number % 3 == 2:
        return outer * fan(circle[:-1])
    inner = random.uniform(0.75, 0.8)
    return outer * quads(circle[:-1], circle[1:], inner * circle[1:], inner * circle[:-1])


def leaf(random: Random, _: int) -> FloatArray:
    """Pointed at both ends, bent, with a toothed border."""
    along = np.linspace(-0.5, 0.5, 31)
    width = random.uniform(0.2, 0.45) * np.cos(math.pi * along) ** random.uniform(0.6, 1.5)
    width *= 1 - 0.25 * (np.arange(31) % 2)
    width[[0, -1]] = 0
    return size(random) * band(*arc(along, random.uniform(1.2, 2), random.uniform(-1.5, 1.5)), width)


def scrap(random: Random, _: int) -> FloatArray:
    """One to four triangles in a row."""
    count = random.randint(1, 5)
    corners = np.stack([0.5 * np.arange(count + 2), np.arange(count + 2) % 2], axis=1)
    corners = corners + random.uniform(-0.2, 0.2, corners.shape)
    return size(random) * np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)


def mixed(random: Random, number: int) -> FloatArray:
    """Any of the others; few are large, most small: of lengths above x there are as many as 1/x."""
    kinds = (convex, concave, strip, ring, leaf, scrap)
    return min(1 / random.uniform(0.02, 1), 20.0) * kinds[random.randint(len(kinds))](random, number)


KINDS: dict[str, Callable[[Random, int], FloatArray]] = {
    "convex": convex,
    "concave": concave,
    "strips": strip,
    "rings": ring,
    "leaves": leaf,
    "scraps": scrap,
    "mixed": mixed,
}


def size(random: Random) -> float:
    return float(np.exp(random.uniform(-0.7, 0.7)))


def fan(corners: FloatArray) -> FloatArray:
    """A polygon that is seen as a whole from its middle, counter-clockwise, with triangles around that."""
    middle = np.broadcast_to(corners.mean(axis=0), corners.shape)
    return np.stack([middle, corners, np.roll(corners, -1, axis=0)], axis=1)


def quads(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Two triangles for each of four corners, clockwise ones turned around; those without an area are left out."""
    both = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    one, other = both[:, 1] - both[:, 0], both[:, 2] - both[:, 0]
    area = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.where(area[:, None, None] < 0, both[:, ::-1], both)[np.abs(area) > 1e-12]


def blocks(x: list[float], y: list[float], cells: list[tuple[int, int]]) -> FloatArray:
    """Cells of a grid with these lines."""
    i, j = np.array(cells).T
    left, right, low, high = np.array(x)[i], np.array(x)[i + 1], np.array(y)[j], np.array(y)[j + 1]
    return quads(*(np.stack(corner, axis=1) for corner in ((left, low), (right, low), (right, high), (left, high))))


def arc(along: FloatArray, length: float, bend: float) -> tuple[FloatArray, FloatArray]:
    """Points (n, 2) of an arc of this length, which turns by `bend`, and its directions."""
    angle = bend * along
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if bend == 0:
        return np.stack([length * along, 0 * along], axis=1), direction
    return length / bend * np.stack([np.sin(angle), 1 - np.cos(angle)], axis=1), direction


def band(middle: FloatArray, direction: FloatArray, half: FloatArray) -> FloatArray:
    """What lies within `half`, (n,), beside a line."""
    beside = half[:, None] * np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    left, right = middle + beside, middle - beside
    return quads(right[:-1], right[1:], left[1:], left[:-1])
