# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons of thousands of corners: cut by the rule of small ones, in memory and time that grow with their corners."""

from __future__ import annotations

import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lsgp.base import ear_clipping
from lsgp.base.ear_clipping import clip_ears_of_one
from lsgp.io import polygons
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


@settings(max_examples=150, deadline=None)
@given(st.integers(5, 60), st.integers(0, 10**6), st.booleans())
@example(5, 8155, True)  # two ears with one diagonal, whose length is rounded from either side
def test_alone_and_among_others_a_polygon_is_cut_the_same(n: int, seed: int, simple: bool) -> None:
    rng = np.random.default_rng(seed)
    points = star(n, seed)[:, :2] if simple else rng.normal(size=(n, 2)) / 4
    (expected,) = polygons._clip_ears(points[None])
    assert np.array_equal(clip_ears_of_one(points), expected)


@pytest.mark.parametrize("name", PLANAR)
@pytest.mark.parametrize("n", [polygons.LARGE + 1, 4001])
def test_large_polygons_are_covered_exactly(name: str, n: int) -> None:
    points = PLANAR[name](n)
    mesh = polygon_mesh(points, [list(range(len(points)))])
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    areas, (whole,) = triangle_areas(mesh, triangulation), polygon_areas(mesh)
    assert areas.min() > -1e-12 * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(sorted(OTHERS)), st.integers(polygons.LARGE, 2 * polygons.LARGE), st.integers(0, 999))
def test_other_large_polygons_lose_no_corner(name: str, n: int, seed: int) -> None:
    points = OTHERS[name](n, np.random.default_rng(seed))
    mesh = polygon_mesh(points, [list(range(n))])
    require_triangulation(mesh, triangulate(mesh))


@pytest.mark.parametrize("size", [60, polygons.LARGE + 5])
def test_polygons_back_to_back_share_no_diagonal(size: int) -> None:
    mesh = back_to_back(size)
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    triangles = triangulation.triangles
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, count = np.unique(pairs, axis=0, return_counts=True)
    assert count.max() == 2


def test_memory_grows_with_the_corners() -> None:
    peaks = []
    for n in (1200, 2400):
        mesh = back_to_back(n)
        tracemalloc.start()
        triangulate(mesh)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 10e6
    assert peaks[1] / peaks[0] < 2.5


@pytest.mark.parametrize("name", PLANAR)
def test_time_grows_little_faster_than_the_corners(name: str) -> None:
    points = PLANAR[name](20_001)
    begin = time.process_time()
    triangulate(polygon_mesh(points, [list(range(len(points)))]))
    assert time.process_time() - begin < 20


def test_a_polygon_that_crosses_itself_everywhere_has_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = 0
    near = ear_clipping._Places.near

    def counted(self: object, *box: float):
        nonlocal looks
        for corners in near(self, *box):
            looks += 1 + len(corners)
            yield corners

    monkeypatch.setattr(ear_clipping._Places, "near", counted)
    n = 1500
    points = np.random.default_rng(0).normal(size=(n, 2)) / 4
    assert clip_ears_of_one(points).shape == (n - 2, 3)
    # The test of one ear may go over it.
    assert looks <= ear_clipping.MOST_LOOKS * n + 3 * n
