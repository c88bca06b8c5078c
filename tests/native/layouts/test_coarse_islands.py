# SPDX-License-Identifier: GPL-3.0-or-later
"""Few triangles cover the same as many, for the packer."""

from __future__ import annotations

import meshes
import numpy as np
import pytest
from lsgp.layouts.coarse_islands import coarse_triangles
from lsgp.layouts.island_gaps import border_edges


def cut_to(shape, n: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Of a grid over [-1, 1]² the triangles whose middles are in a shape: places and triangles."""
    grid = meshes.grid(n, n)
    place = grid.positions[:, :2] @ np.array([1, 1j])
    place = 2 * (place - (place.real.min() + 1j * place.imag.min())) / np.ptp(place.real) - (1 + 1j)
    kept = grid.triangles[shape(place[grid.triangles].mean(axis=1))]
    used, triangles = np.unique(kept, return_inverse=True)
    return place[used], triangles.reshape(-1, 3)


def holes(z: np.ndarray) -> np.ndarray:
    return np.all([np.abs(z - (x + 1j * y)) > 0.13 for x in (-0.6, 0, 0.6) for y in (-0.5, 0.1, 0.6)], axis=0)


SHAPES = {
    "square": lambda z: np.abs(z) < 9,
    "disk": lambda z: np.abs(z) < 0.8,
    "ring": lambda z: np.abs(np.abs(z) - 0.6) < 0.3,
    "holes": holes,
    "cross": lambda z: np.minimum(np.abs(z.real), np.abs(z.imag)) < 0.3,
}


def covered(place: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(p,) how many of the triangles each point is in."""
    count = np.zeros(len(points), int)
    for a, b, c in place[triangles]:
        sides = [((q - p).conjugate() * (points - p)).imag for p, q in ((a, b), (b, c), (c, a))]
        count += np.all(np.greater(sides, 0), axis=0) | np.all(np.less(sides, 0), axis=0)
    return count


def coarse(place: np.ndarray, triangles: np.ndarray, island: np.ndarray | None = None) -> np.ndarray:
    triangle, corner = border_edges(triangles)
    borders = np.stack([triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]], axis=1)
    return coarse_triangles(place, triangles, np.zeros(len(place), int) if island is None else island, borders)


@pytest.mark.parametrize("name", SHAPES)
def test_the_same_is_covered_once_by_few(name: str) -> None:
    place, triangles = cut_to(SHAPES[name])
    place = place * np.exp(0.3j)
    few = coarse(place, triangles)
    assert len(few) < 0.25 * len(triangles)
    random = np.random.default_rng(1)
    points = np.exp(0.3j) * (random.uniform(-1.1, 1.1, 2000) + 1j * random.uniform(-1.1, 1.1, 2000))
    assert np.array_equal(covered(place, few, points), covered(place, triangles, points))


@pytest.mark.parametrize("name", SHAPES)
def test_the_few_are_in_one_piece(name: str) -> None:
    place, triangles = cut_to(SHAPES[name])
    few = coarse(place, triangles)
    a, b, c = place[few].T
    few = few[np.abs(((b - a).conjugate() * (c - a)).imag) > 1e-9]
    edges = [{tuple(sorted((t[i], t[i - 1]))) for i in range(3)} for t in few.tolist()]
    reached, front = {0}, [0]
    while front:
        here = front.pop()
        new = [i for i in range(len(few)) if i not in reached and edges[i] & edges[here]]
        reached.update(new)
        front += new
    assert len(reached) == len(few)


def test_an_island_that_lies_on_itself_covers_the_same() -> None:
    place, triangles = cut_to(SHAPES["ring"])
    opened = triangles[~((place[triangles].real < 0) & (np.abs(place[triangles].imag) < 0.1)).any(axis=1)]
    twice = np.abs(place) * np.exp(1.9j * np.angle(place))
    random = np.random.default_rng(1)
    points = random.uniform(-1, 1, 2000) + 1j * random.uniform(-1, 1, 2000)
    before, after = (covered(twice, of, points) for of in (opened, coarse(twice, opened)))
    assert before.max() > 1
    assert np.array_equal(before > 0, after > 0)


def test_islands_that_touch_themselves_or_are_partly_flipped_stay_as_they_are() -> None:
    bow_tie, _ = meshes.bow_tie(9)
    flat = bow_tie.positions[:, :2] @ np.array([1, 1j])
    assert np.array_equal(coarse(flat, bow_tie.triangles), bow_tie.triangles)
    place, triangles = cut_to(SHAPES["ring"])
    flipped = np.vstack([triangles[:-1], triangles[-1:, ::-1]])
    assert np.array_equal(coarse(place, flipped), flipped)
    without_border = np.vstack([triangles, triangles])
    assert np.array_equal(coarse(place, without_border), without_border)


def test_every_island_is_covered_by_its_own_vertices() -> None:
    parts = [cut_to(SHAPES[name], 30) for name in ("holes", "disk", "square")]
    offsets = np.cumsum([0, *(len(place) for place, _ in parts)])
    place = np.concatenate([places + 3 * i for i, (places, _) in enumerate(parts)])
    triangles = np.concatenate([own + offset for (_, own), offset in zip(parts, offsets, strict=False)])
    island = np.repeat(np.arange(3), np.diff(offsets))
    few = coarse(place, triangles, island)
    assert (island[few] == island[few][:, :1]).all()
    assert len(few) < 0.5 * len(triangles)
    random = np.random.default_rng(1)
    points = random.uniform(-1, 7, 4000) + 1j * random.uniform(-1, 1, 4000)
    assert np.array_equal(covered(place, few, points), covered(place, triangles, points))
