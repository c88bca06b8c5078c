# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons of any number of corners: covered exactly where they do not cross themselves, in nearly linear time."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp.base.ear_clipping import clip_ears
from lsgp.io.polygons import PolygonMesh, triangulate
from polygon_meshes import polygon_areas, polygon_mesh, require_triangulation, triangle_areas


def space(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.column_stack([x, y, np.zeros(len(x))])


def circle(n: int) -> np.ndarray:
    angles = np.arange(n) / n * 2 * np.pi
    return space(np.cos(angles), np.sin(angles))


def star(n: int, seed: int = 0) -> np.ndarray:
    """Seen whole from its middle, every other corner concave or not by chance."""
    return circle(n) * np.random.default_rng(seed).uniform(0.5, 1, n)[:, None]


def comb(n: int) -> np.ndarray:
    teeth = (n - 3) // 2
    x = np.arange(2 * teeth + 1)[::-1]
    return space(np.append([0, 2 * teeth], x), np.append([0, 0], np.where(x % 2, 5.0, 1.0)))


def spiral(n: int) -> np.ndarray:
    t = np.linspace(1, 12, n // 2)
    x, y = t * np.cos(2 * np.pi * t), t * np.sin(2 * np.pi * t)
    return space(np.append(x, 0.95 * x[::-1]), np.append(y, 0.95 * y[::-1]))


def with_an_outlier(n: int) -> np.ndarray:
    """Nearly all corners in a millionth of the polygon's area."""
    points = 1e-3 * star(n)
    points[0] = (1, 0, 0)
    return points


PLANAR = {"circle": circle, "star": star, "comb": comb, "spiral": spiral, "outlier": with_an_outlier}

# Polygons that have no triangulation without turned triangles.
OTHERS = {
    "twisted": lambda n, rng: circle(n) + [0, 0, 1] * np.sin(np.arange(n) / n * 8 * np.pi)[:, None],
    "any points": lambda n, rng: rng.normal(size=(n, 3)),
    "one point": lambda n, rng: np.zeros((n, 3)),
    "one line": lambda n, rng: np.arange(n)[:, None] * np.ones(3),
    "there and back": lambda n, rng: space(np.abs(np.arange(n) - n / 2), np.zeros(n)),
    "repeated places": lambda n, rng: np.repeat(circle(n // 4 + 1), 4, axis=0)[:n],
    "not finite": lambda n, rng: np.where(np.arange(n)[:, None] == n // 2, np.nan, circle(n)),
    "loop in a loop": lambda n, rng: circle(n) * (0.5 + circle(n)[:, :1]),
}


def back_to_back(n: int) -> PolygonMesh:
    """Two polygons with all edges in common: their diagonals would be the same."""
    points = circle(n)
    points[:, 2] = 0.1 * np.sin(7 * np.arange(n))
    return polygon_mesh(points, [list(range(n)), list(range(n))[::-1]])


def keyholes(holes: int, corners: int, seed: int) -> np.ndarray:
    """A rectangle with star-shaped holes, to each of which its lower side runs and back along the same edge."""
    random = np.random.default_rng(seed)
    angles = -np.pi / 2 - np.arange(corners) / corners * 2 * np.pi
    parts = [[[0, 0]]]
    for hole in range(holes):
        radii = random.uniform(0.2, 0.45, corners)
        around = np.column_stack([hole + 0.5 + radii * np.cos(angles), 0.5 + radii * np.sin(angles)])
        foot = [[hole + 0.5, 0]]
        parts += [foot, around, around[:1], foot]
    return np.concatenate([*parts, [[holes, 0], [holes, 1], [0, 1]]]) / holes


def require_exact_cover(points: np.ndarray) -> None:
    """Of a counter-clockwise polygon (n, 2)."""
    (triangles,) = clip_ears(points[None])
    areas = signed_areas(points[triangles])
    whole = float(signed_areas(points[None])[0])
    assert areas.min() > -1e-12 * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


def signed_areas(polygons: np.ndarray) -> np.ndarray:
    x, y = polygons[..., 0], polygons[..., 1]
    return (x * np.roll(y, -1, axis=-1) - y * np.roll(x, -1, axis=-1)).sum(axis=-1) / 2


@settings(max_examples=100, deadline=None)
@given(st.integers(5, 200), st.integers(0, 10**6))
def test_stars_are_covered_exactly(n: int, seed: int) -> None:
    require_exact_cover(star(n, seed)[:, :2])


@settings(max_examples=50, deadline=None)
@given(st.integers(1, 8), st.integers(3, 20), st.integers(0, 10**6))
def test_polygons_that_run_to_holes_and_back_are_covered_exactly(holes: int, corners: int, seed: int) -> None:
    require_exact_cover(keyholes(holes, corners, seed))


def test_the_shortest_diagonal_that_is_not_taken_comes_first() -> None:
    """Of a polygon whose corners have different angles: a fifth one off a square."""
    points = np.array([[0, 0], [1, 0], [1, 1], [0.4, 1.1], [0, 1]])
    ((first, *_),) = clip_ears(points[None])
    assert first.tolist() == [2, 3, 4]
    ((first, *_),) = clip_ears(points[None], lambda a, b: {a, b} == {2, 4})
    assert first.tolist() == [3, 4, 0]


@pytest.mark.parametrize("name", PLANAR)
@pytest.mark.parametrize("n", [1025, 4001])
def test_large_polygons_are_covered_exactly(name: str, n: int) -> None:
    points = PLANAR[name](n)
    mesh = polygon_mesh(points, [list(range(len(points)))])
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    areas, (whole,) = triangle_areas(mesh, triangulation), polygon_areas(mesh)
    assert areas.min() > -1e-12 * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(sorted(OTHERS)), st.integers(1024, 2048), st.integers(0, 999))
def test_other_large_polygons_lose_no_corner(name: str, n: int, seed: int) -> None:
    points = OTHERS[name](n, np.random.default_rng(seed))
    mesh = polygon_mesh(points, [list(range(n))])
    require_triangulation(mesh, triangulate(mesh))


@pytest.mark.parametrize("size", [60, 1029])
def test_polygons_back_to_back_share_no_diagonal(size: int) -> None:
    mesh = back_to_back(size)
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    triangles = triangulation.triangles
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, count = np.unique(pairs, axis=0, return_counts=True)
    assert count.max() == 2


@pytest.mark.slow
@pytest.mark.parametrize("name", PLANAR)
def test_time_grows_little_faster_than_the_corners(name: str) -> None:
    points = PLANAR[name](60_001)
    begin = time.process_time()
    triangulate(polygon_mesh(points, [list(range(len(points)))]))
    assert time.process_time() - begin < 20


def test_a_polygon_that_crosses_itself_everywhere_has_a_bound() -> None:
    n = 20_000
    points = np.random.default_rng(0).normal(size=(n, 2)) / 4
    begin = time.process_time()
    assert clip_ears(points[None]).shape == (1, n - 2, 3)
    assert time.process_time() - begin < 20
