# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangulation of polygons: the triangles cover the polygon exactly and turn its way."""

from __future__ import annotations

import itertools
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp import _lsgp
from lsgp.errors import InputError
from lsgp.io.polygons import require_polygons, triangulate
from polygon_meshes import cube, patch, polygon_areas, polygon_mesh, require_triangulation, triangle_areas


def loop(xy: object) -> np.ndarray:
    """Points of the plane as points of space."""
    xy = np.array(xy, float)
    return np.column_stack([xy, np.zeros(len(xy))])


def one_polygon(points: np.ndarray):
    mesh = polygon_mesh(points, [list(range(len(points)))])
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    return mesh, triangulation


def rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def require_exact_cover(points: np.ndarray, share: float = 0.0) -> None:
    """No triangle is turned (or smaller than this share of the polygon), and together they have the polygon's area."""
    mesh, triangulation = one_polygon(points)
    areas = triangle_areas(mesh, triangulation)
    (whole,) = polygon_areas(mesh)
    assert areas.min() > share * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


@st.composite
def star_shaped(draw: st.DrawFn) -> np.ndarray:
    """A polygon seen whole from one point, mostly concave, some corners in the middle of edges, anywhere in space."""
    n = draw(st.integers(4, 24))
    # No step reaches half a turn, or the polygon would cross itself.
    steps = np.array(draw(st.lists(st.floats(0.4, 1), min_size=n, max_size=n)))
    radii = np.array(draw(st.lists(st.floats(0.1, 1), min_size=n, max_size=n)))
    angles = 2 * np.pi * np.cumsum(steps) / steps.sum()
    corners = radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    halved = draw(st.sets(st.integers(0, n - 1), max_size=3))
    points = []
    for i, corner in enumerate(corners):
        points.append(corner)
        if i in halved:
            points.append((corner + corners[(i + 1) % n]) / 2)
    scale = draw(st.sampled_from([1e-18, 1e-3, 1.0, 1e6, 1e18]))
    shift = draw(st.sampled_from([0.0, 10.0]))
    return scale * (loop(points) @ rotation(draw(st.integers(0, 99))).T + shift)


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(star_shaped())
def test_concave_polygons_are_covered_exactly(points: np.ndarray) -> None:
    mesh, triangulation = one_polygon(points)
    areas = triangle_areas(mesh, triangulation)
    (whole,) = polygon_areas(mesh)
    # A corner in the middle of an edge lies beside it by rounding: its triangle is not turned by more than that.
    assert areas.min() > -1e-12 * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


@settings(max_examples=150, deadline=None)
@given(star_shaped(), st.lists(st.integers(1, 3), min_size=28, max_size=28))
def test_concave_polygons_with_repeated_corners_are_covered(points: np.ndarray, times: list[int]) -> None:
    mesh, triangulation = one_polygon(np.repeat(points, times[: len(points)], axis=0))
    areas = triangle_areas(mesh, triangulation)
    (whole,) = polygon_areas(mesh)
    assert areas.min() > -1e-12 * whole
    assert areas.sum() == pytest.approx(whole, rel=1e-9)


def spiral(turns: float, n: int) -> np.ndarray:
    """A corridor that winds round itself."""
    t = np.linspace(0.5, turns, n)
    outer = np.column_stack([t * np.cos(2 * np.pi * t), t * np.sin(2 * np.pi * t)])
    return loop(np.concatenate([outer, 0.8 * outer[::-1]]))


def comb(teeth: int) -> np.ndarray:
    top = [(i, 5.0 if i % 2 else 1.0) for i in range(2 * teeth + 1)]
    return loop([(0, 0), (2 * teeth, 0), *top[::-1]])


CONCAVE = {
    "arrow": loop([(0, 0), (2, 0), (2, 2), (1, 0.2), (0, 2)]),
    "L": loop([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]),
    "comb": comb(20),
    "spiral": spiral(4.0, 120),
    # A keyhole: a square with a square hole, the bridge between them walked twice.
    "keyhole": loop([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)]),
}


@pytest.mark.parametrize("name", CONCAVE)
def test_hard_polygons_are_covered_exactly(name: str) -> None:
    for seed in range(3):
        require_exact_cover(CONCAVE[name] @ rotation(seed).T)


def test_concave_polygon_from_every_first_corner() -> None:
    for shift in range(5):
        require_exact_cover(np.roll(CONCAVE["arrow"], shift, axis=0))


def test_corners_on_straight_edges_keep_a_triangle_with_area() -> None:
    side = np.linspace(0, 1, 5)[:-1]
    square = np.concatenate([np.column_stack(p) for p in ((side, 0 * side), (1 + 0 * side, side))])
    require_exact_cover(loop(np.concatenate([square, 1 - square])), share=1e-3)
    # In single precision the corners lie beside the edges by 1e-7; needles of that width are as bad as turned ones.
    turned = (loop(np.concatenate([square, 1 - square])) @ rotation(5).T).astype(np.float32)
    require_exact_cover(turned.astype(float), share=1e-3)


def test_no_diagonal_runs_along_a_straight_side() -> None:
    # The ear at the top has the shortest diagonal by far, but corners lie on it, beside it in single precision.
    tower = loop([(0, 0), (1 / 3, 0), (2 / 3, 0), (1, 0), (0.5, 5)])
    for seed in range(20):
        require_exact_cover((tower @ rotation(seed).T).astype(np.float32).astype(float), share=1e-3)


def test_large_polygon_in_reasonable_time() -> None:
    rng = np.random.default_rng(1)
    angles = np.linspace(0, 2 * np.pi, 1500, endpoint=False)
    radii = rng.uniform(0.5, 1, 1500)
    begin = time.process_time()
    require_exact_cover(loop(radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])))
    assert time.process_time() - begin < 10


@pytest.mark.parametrize(
    ("points", "diagonal"),
    [
        (loop([(0, 0), (4, 0), (5, 1), (1, 1)]), {1, 3}),  # the shorter one
        (loop([(0, 0), (1, 0), (1, 1), (0, 1)]), {0, 2}),  # equally long: the one with the lowest vertex
        (loop([(0, 0), (2, 0.9), (4, 0), (2, 3)]), {1, 3}),  # concave at 1, though 0-2 would be outside
        (loop([(0, 0), (2, 0), (4, 0), (2, 9)]), {1, 3}),  # 1 in the middle of an edge, though 1-3 is longer
    ],
)
def test_diagonal_of_quads(points: np.ndarray, diagonal: set[int]) -> None:
    for shift, seed in itertools.product(range(4), range(5)):
        quad = np.roll(np.arange(4), shift)
        turn = rotation(seed) if seed else np.eye(3)
        mesh = polygon_mesh(points @ turn.T, [quad.tolist()])
        triangulation = triangulate(mesh)
        require_triangulation(mesh, triangulation)
        shared = set(triangulation.triangles[0].tolist()) & set(triangulation.triangles[1].tolist())
        assert shared == diagonal
        assert triangle_areas(mesh, triangulation).min() > 0


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.0, 0.5))
def test_bent_quads_are_not_turned(seed: int, bend: float) -> None:
    rng = np.random.default_rng(seed)
    points = loop([(0, 0), (1, 0), (1, 1), (0, 1)]) + rng.uniform(-0.45, 0.45, (4, 3)) * [1, 1, bend]
    mesh, triangulation = one_polygon(points)
    areas = triangle_areas(mesh, triangulation)
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(polygon_areas(mesh)[0], rel=1e-12)


def test_triangles_pass_as_they_are() -> None:
    faces = [[2, 0, 1], [3, 2, 1]]
    triangulation = triangulate(polygon_mesh(np.random.default_rng(0).normal(size=(4, 3)), faces))
    assert triangulation.triangles.tolist() == faces
    assert triangulation.corner.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert triangulation.polygon.tolist() == [0, 1]


def test_triangles_of_mixed_polygons_follow_their_order() -> None:
    positions, faces = patch()
    mesh = polygon_mesh(positions, faces)
    triangulation = triangulate(mesh)
    require_triangulation(mesh, triangulation)
    assert np.bincount(triangulation.polygon).tolist() == [len(face) - 2 for face in faces]
    assert triangle_areas(mesh, triangulation).min() > 0


def test_edges_are_those_of_the_polygons() -> None:
    positions, faces = patch()
    triangulation = triangulate(polygon_mesh(positions, faces))
    expected = {tuple(sorted(pair)) for face in faces for pair in zip(face, face[1:] + face[:1], strict=True)}
    assert triangulation.edges.tolist() == sorted(map(list, expected))


@pytest.mark.parametrize(
    "faces",
    [
        [[0, 1, 2, 3], [3, 2, 1, 0]],  # two quads back to back
        [[0, 1, 2, 3, 4], [4, 3, 2, 1, 0]],  # two pentagons
        [[0, 1, 2, 4], [2, 1, 0, 3], [0, 4, 3], [4, 2, 3]],  # two quads with two edges in common
    ],
)
def test_diagonals_join_only_two_triangles(faces: list[list[int]]) -> None:
    angles = np.arange(5) * 2 * np.pi / 5
    positions = loop(np.column_stack([np.cos(angles), np.sin(angles)])) + np.array([[0, 0, 0.1 * i] for i in range(5)])
    triangulation = triangulate(polygon_mesh(positions, faces))
    triangles = triangulation.triangles
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, count = np.unique(pairs, axis=0, return_counts=True)
    assert count.max() == 2


@pytest.mark.parametrize("size", [4, 5, 9])
@pytest.mark.parametrize(
    "points",
    [
        lambda n: np.zeros((n, 3)),
        lambda n: np.arange(n)[:, None] * np.ones(3),
        lambda n: np.full((n, 3), np.nan),
        lambda n: np.where(np.arange(n)[:, None] == 1, np.inf, np.eye(n, 3)),
        lambda n: np.random.default_rng(n).normal(size=(n, 3)),
        lambda n: 1e300 * np.random.default_rng(n).normal(size=(n, 3)),
        lambda n: loop([(i % 2, i // 2 % 2) for i in range(n)]),
    ],
    ids=["one point", "one line", "NaN", "infinite", "any points", "huge", "crossing"],
)
def test_degenerate_polygons_still_become_triangles(points, size: int) -> None:
    one_polygon(points(size))


@pytest.mark.parametrize("seed", range(20))
def test_polygons_with_doubled_diagonals_are_those_of_a_count(seed: int) -> None:
    """Faces of few vertices, cut into fans: by a count of all pairs that edges and diagonals join."""
    random = np.random.default_rng(seed)
    sizes = random.integers(3, 8, 12)
    corners = np.concatenate([random.permutation(14)[:size] for size in sizes]).astype(np.int32)
    starts = np.cumsum(sizes) - sizes
    fans = [
        [start, start + i, start + i + 1] for start, size in zip(starts, sizes, strict=True) for i in range(1, size - 1)
    ]
    edges, diagonals = set(), []
    for polygon, (start, size) in enumerate(zip(starts.tolist(), sizes.tolist(), strict=True)):
        ring = corners[start : start + size].tolist()
        edges |= {frozenset(pair) for pair in zip(ring, ring[1:] + ring[:1], strict=True)}
        diagonals += [(frozenset((ring[0], vertex)), polygon) for vertex in ring[2:-1]]
    joined = [*edges, *(pair for pair, _ in diagonals)]
    expected = sorted({polygon for pair, polygon in diagonals if joined.count(pair) > 1})
    drawn = np.array([random.permutation(sorted(pair)) for pair in edges], np.int32)
    found = _lsgp.doubled_diagonals(np.array(fans), corners, sizes, drawn, 14)
    assert found.tolist() == expected
    assert 0 < len(expected) < len(sizes)


def test_values_of_triangle_corners_return_to_polygon_corners() -> None:
    positions, faces = cube(2)
    mesh = polygon_mesh(positions, [*faces, [0, 1, 2, 3, 4]])
    triangulation = triangulate(mesh)
    given_values = np.random.default_rng(0).normal(size=(len(mesh.corners), 2))
    values = given_values[triangulation.corner]
    assert (triangulation.to_polygon_corners(values, len(mesh.corners)) == given_values).all()
    values[triangulation.polygon == 3] = np.nan
    values[np.flatnonzero(triangulation.polygon == 24)[1]] = np.nan
    returned = triangulation.to_polygon_corners(values, len(mesh.corners))
    missing = np.zeros(len(mesh.corners), bool)
    missing[12:16] = missing[96:101] = True
    assert (np.isnan(returned).all(axis=1) == missing).all()
    assert (returned[~missing] == given_values[~missing]).all()


@given(st.integers(0, 2**32 - 1))
def test_polygons_given_again_have_the_same_triangles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(4, 9))
    turns = 2 * np.pi * (np.arange(n) + rng.uniform(0, 0.5, n)) / n
    positions = np.stack([np.cos(turns), np.sin(turns), np.zeros(n)], axis=1)
    copies = [np.roll(np.arange(n), int(rng.integers(n))).tolist() for _ in range(3)]
    mesh = polygon_mesh(positions, [*copies, [0, 2, 1]])
    found = triangulate(mesh)
    assert (mesh.corners[found.corner] == found.triangles).all()
    alike = [{frozenset(t) for t in found.triangles[found.polygon == i].tolist()} for i in range(3)]
    assert alike[0] == alike[1] == alike[2]


@pytest.mark.parametrize(
    ("faces", "code", "named"),
    [
        ([[0, 1, 2], [0, 1, 4]], "INDEX_OUT_OF_RANGE", [1]),
        ([[0, -1, 2], [0, 1, 2], [5, 6, 7]], "INDEX_OUT_OF_RANGE", [0, 2]),
        ([[0, 1], [2]], "BAD_FACE", [0, 1]),
        ([[], [0, 1, 2], [3]], "BAD_FACE", [0]),
    ],
)
def test_polygons_that_cannot_be_are_refused_by_number(faces: list[list[int]], code: str, named: list[int]) -> None:
    corners = np.array([vertex for face in faces for vertex in face], np.int64)
    with pytest.raises(InputError) as caught:
        require_polygons(4, corners, np.array(list(map(len, faces)), np.int64))
    assert caught.value.code == code
    assert caught.value.elements.kind == "faces"
    assert caught.value.elements.indices.tolist() == named
