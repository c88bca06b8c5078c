# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges of three or more triangles: the sheets that run on there, and those that end."""

from __future__ import annotations

from collections.abc import Callable

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from map_checks import codes
from meshes import FloatArray, IndexArray, Mesh
from opened_surface import open_surface
from outcome_check import cuts_faults, result_faults

Sheets = set[frozenset[frozenset[int]]]
Soup = Callable[[Mesh, float, int], Mesh]


def ledger(mesh: Mesh) -> list[lsgp.LedgerPart]:
    return lsgp.build_ledger(lsgp.Surface(mesh.positions, mesh.triangles), [])


def sheets(mesh: Mesh) -> Sheets:
    """Each sheet as the set of its triangles, each as the set of its vertices."""
    return {frozenset(frozenset(map(int, mesh.triangles[f])) for f in part.triangles) for part in ledger(mesh)}


def sizes(mesh: Mesh) -> list[int]:
    return sorted(len(part.triangles) for part in ledger(mesh))


def finned(mesh: Mesh, share: float, seed: int) -> Mesh:
    """A share of the triangles gets another triangle on one of its edges, at right angles."""
    random = np.random.default_rng(seed)
    positions, triangles = list(mesh.positions), list(mesh.triangles)
    for f in random.choice(len(mesh.triangles), round(share * len(mesh.triangles)), replace=False):
        a, b, c = np.roll(mesh.triangles[f], random.integers(3))
        pa, pb, pc = mesh.positions[[a, b, c]]
        normal = np.cross(pb - pa, pc - pa)
        height = np.linalg.norm(pb - pa) * random.uniform(0.3, 1.2)
        positions.append((pa + pb) / 2 + normal / np.linalg.norm(normal) * height)
        triangles.append(np.array([a, b, len(positions) - 1][:: random.choice([-1, 1])]))
    return meshes.make(np.array(positions), np.array(triangles, np.int32))


def rows(across: FloatArray, n: int, first: int) -> tuple[list[FloatArray], list[list[int]], int]:
    """Quads as triangles from the vertices 0..n along x, over further rows at these places of (y, z)."""
    positions: list[FloatArray] = []
    triangles: list[list[int]] = []
    before = list(range(n + 1))
    for y, z in across:
        row = [first + len(positions) + i for i in range(n + 1)]
        positions += [np.array([i, y, z], float) for i in range(n + 1)]
        for i in range(n):
            triangles += [[before[i], before[i + 1], row[i + 1]], [before[i], row[i + 1], row[i]]]
        before = row
    return positions, triangles, first + len(positions)


def book(angles: list[float], n: int = 4, length: int = 3) -> Mesh:
    """Pages about the x axis at these angles, each wound as it comes."""
    positions = [np.array([i, 0.0, 0.0]) for i in range(n + 1)]
    triangles: list[list[int]] = []
    count = n + 1
    for angle in angles:
        direction = np.array([np.cos(angle), np.sin(angle)])
        more, faces, count = rows(np.arange(1, length + 1)[:, None] * direction, n, count)
        positions += more
        triangles += faces
    return meshes.make(np.array(positions), np.array(triangles, np.int32))


def turned_pages(mesh: Mesh, pages: list[int], of: int) -> Mesh:
    """The book with some of its equal pages wound the other way."""
    each = len(mesh.triangles) // of
    triangles = mesh.triangles.copy()
    for page in pages:
        part = slice(page * each, (page + 1) * each)
        triangles[part] = triangles[part][:, ::-1]
    return mesh._replace(triangles=triangles)


def shuffled(mesh: Mesh, seed: int) -> Mesh:
    """Other orders of the triangles and of their corners."""
    random = np.random.default_rng(seed)
    triangles = mesh.triangles[random.permutation(len(mesh.triangles))]
    return mesh._replace(
        triangles=np.array([np.roll(t, random.integers(3)) for t in triangles], np.int32).reshape(-1, 3)
    )


@pytest.mark.parametrize("share", [0.02, 0.3, 1.0])
@pytest.mark.parametrize("body", [meshes.bumpy_sphere(3), meshes.cube(5), meshes.torus()], ids=["ball", "cube", "ring"])
def test_fins_do_not_open_the_body(body: Mesh, share: float) -> None:
    fins = round(share * len(body.triangles))
    for seed in range(3):
        mesh = finned(body, share, seed)
        parts = ledger(mesh)
        whole = [part for part in parts if part.triangles[0] == 0]
        assert whole[0].triangles.tolist() == list(range(len(body.triangles)))
        assert whole[0].borders == 0 and whole[0].euler == meshes.euler_characteristic(body.triangles)
        assert sum(len(part.triangles) for part in parts) == len(body.triangles) + fins


def test_a_body_with_fins_is_cut_as_without() -> None:
    body = meshes.bumpy_sphere(3)
    expected = lsgp.auto_unwrap(lsgp.Surface(body.positions, body.triangles), preset="paint")
    mesh = finned(body, 0.2, 1)
    result = lsgp.auto_unwrap(lsgp.Surface(mesh.positions, mesh.triangles), preset="paint")
    fins = len(mesh.triangles) - len(body.triangles)
    assert len(np.unique(result.island[: len(body.triangles)])) == len(np.unique(expected.island))
    assert len(np.unique(result.island[len(body.triangles) :])) <= fins

    def length(edges: IndexArray) -> float:
        return float(np.linalg.norm(mesh.positions[edges[:, 1]] - mesh.positions[edges[:, 0]], axis=1).sum())

    assert length(result.cut_edges) <= 1.1 * length(expected.cut_edges)


def test_a_flap_on_a_corner_does_not_open_it() -> None:
    """Though one side runs straight on into the flap, the corner stays closed."""
    cube = meshes.cube(2)
    edges = meshes.edges_of(cube.triangles)
    top = cube.positions[:, 2].max()
    end = cube.positions.max(axis=0)
    rim = [e for e in edges if (cube.positions[e, 2] == top).all() and (cube.positions[e, 0] == end[0]).all()]
    for direction in ([0.7, 0, 0], [0.7, 0, 0.7]):
        apex = cube.positions[rim[0]].mean(axis=0) + direction
        mesh = meshes.make(
            np.concatenate([cube.positions, [apex]]),
            np.concatenate([cube.triangles, [[*rim[0], len(cube.positions)]]]),
        )
        assert sizes(mesh) == [1, len(cube.triangles)], direction


def test_crossing_sheets_each_run_on() -> None:
    for turn in (0.4, 0.9, np.pi / 2):
        mesh = book([0, turn, np.pi, np.pi + turn])
        each = len(mesh.triangles) // 4
        assert sizes(turned_pages(mesh, [2, 3], 4)) == [2 * each] * 2
    six = turned_pages(book(list(np.arange(6) * np.pi / 3)), [3, 4, 5], 6)
    assert sizes(six) == [len(six.triangles) // 3] * 3


def test_a_fin_along_all_of_a_sheet_ends_there() -> None:
    each = len(book([0]).triangles)
    for angle in (0.6, 1.2, np.pi / 2, 2.5):
        mesh = turned_pages(book([0.1, np.pi - 0.1, angle]), [1], 3)
        assert sizes(mesh) == [each, 2 * each]
        parts = sheets(mesh)
        fin = frozenset(frozenset(map(int, t)) for t in mesh.triangles[2 * each :])
        assert fin in parts


def test_a_wall_inside_does_not_open_the_body() -> None:
    filled = np.ones((2, 3, 2), bool)
    body = meshes.voxels(filled)
    # Across the middle, from side to side.
    place = {tuple(p): v for v, p in enumerate(np.round(body.positions - body.positions.min(axis=0), 6))}
    scale = max(p[1] for p in place) / 3
    positions, wall, extra = list(body.positions), [], body.positions.min(axis=0)

    def vertex(x: int, z: int) -> int:
        at = tuple(np.round(np.array([x, 1, z]) * scale, 6))
        if at not in place:
            place[at] = len(positions)
            positions.append(np.array(at) + extra)
        return place[at]

    for x in range(2):
        for z in range(2):
            a, b, c, d = vertex(x, z), vertex(x + 1, z), vertex(x + 1, z + 1), vertex(x, z + 1)
            wall += [[a, b, c], [a, c, d]]
    mesh = meshes.make(np.array(positions), np.concatenate([body.triangles, wall]))
    assert sizes(mesh) == [len(wall), len(body.triangles)]
    assert all(part.borders == (len(part.triangles) == len(wall)) for part in ledger(mesh))


def test_solids_that_touch_at_an_edge_are_apart() -> None:
    filled = np.zeros((2, 2, 1), bool)
    filled[0, 0, 0] = filled[1, 1, 0] = True
    parts = ledger(meshes.voxels(filled))
    assert [len(part.triangles) for part in parts] == [12, 12]
    # Neither goes on better than the other, nor would both have cones at the vertices that they share.
    assert all(part.borders == 1 for part in parts)


@given(st.integers(0, 10_000))
def test_any_order_of_triangles_joins_the_same(seed: int) -> None:
    random = np.random.default_rng(seed)
    kind = seed % 3
    if kind == 0:
        mesh = finned(meshes.bumpy_sphere(1), random.uniform(0, 1), seed)
    elif kind == 1:
        mesh = meshes.voxels(random.random((4, 4, 4)) < 0.5)
    else:
        triangles = np.array([random.choice(9, 3, replace=False) for _ in range(24)], np.int32)
        mesh = meshes.make(random.normal(size=(9, 3)), triangles)
    assert sheets(shuffled(mesh, seed)) == sheets(mesh) or has_duplicates(mesh)


def has_duplicates(mesh: Mesh) -> bool:
    """Which of several equal triangles counts is a matter of their order."""
    return len({frozenset(map(int, t)) for t in mesh.triangles}) < len(mesh.triangles)


@given(st.integers(0, 10_000))
def test_joining_makes_nothing_one_sided(seed: int) -> None:
    random = np.random.default_rng(seed)
    triangles = {tuple(sorted(random.choice(10, 3, replace=False))) for _ in range(30)}
    mesh = meshes.make(
        random.normal(size=(10, 3)), np.array([random.permutation(t) for t in sorted(triangles)], np.int32)
    )
    edges = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    found, counts = np.unique(edges, axis=0, return_counts=True)
    # Joined at edges of two triangles alone, as far as these are two-sided.
    alone = lsgp.Surface(mesh.positions, mesh.triangles, borders=found[counts > 2])
    one_sided = sum(part.euler == 0 and not part.borders for part in lsgp.build_ledger(alone, []))
    assert sum(part.euler == 0 and not part.borders for part in ledger(mesh)) <= one_sided


def flapped(mesh: Mesh, share: float, seed: int) -> Mesh:
    """A share of the triangles gets a bent strip of four triangles on an edge, as of cloth or leaves."""
    random = np.random.default_rng(seed)
    positions, triangles = list(mesh.positions), list(mesh.triangles)
    for f in random.choice(len(mesh.triangles), round(share * len(mesh.triangles)), replace=False):
        a, b, c = mesh.triangles[f]
        pa, pb, pc = mesh.positions[[a, b, c]]
        normal = np.cross(pb - pa, pc - pa)
        out = normal / np.linalg.norm(normal) * np.linalg.norm(pb - pa)
        side = np.cross(out, pb - pa) / np.linalg.norm(pb - pa)
        for height, bend in ((0.5, 0.1), (1.0, 0.3)):
            first = len(positions)
            positions += [p + height * out + bend * side for p in (pa, pb)]
            triangles += [np.array([a, b, first + 1]), np.array([a, first + 1, first])]
            a, b = first, first + 1
    return meshes.make(np.array(positions), np.array(triangles, np.int32))


BODIES = {"ball": meshes.bumpy_sphere(2), "cube": meshes.cube(4), "ring": meshes.torus()}


@pytest.mark.parametrize("share", [0, 0.05, 0.15, 0.3])
@pytest.mark.parametrize("make", [finned, flapped])
@pytest.mark.parametrize("kind", BODIES)
def test_soups_are_unwrapped_with_no_more_islands_than_sheets(kind: str, make: Soup, share: float) -> None:
    """The body as without what hangs on it, and an island for each of these."""
    body = BODIES[kind]
    count = len(body.triangles)
    mesh = make(body, share, 5)
    # Nothing is divided to fill the square, which other islands fill as well.
    how = {"preset": "paint", "weights": lsgp.Weights(square=0.0)}
    alone = lsgp.auto_unwrap(lsgp.Surface(body.positions, body.triangles), **how)
    result = lsgp.auto_unwrap(lsgp.Surface(mesh.positions, mesh.triangles), **how)
    assert (result.island >= 0).all() and result.flipped.size == 0 and result.overlapping.size == 0
    assert ("NON_MANIFOLD_EDGE" in codes(result.warnings)) == (share > 0)
    # Where two fins stand on one edge they are one sheet, which may end at that crease.
    assert len(sheets(mesh)) - 1 <= len(np.unique(result.island[count:])) <= round(share * count)
    assert len(np.unique(result.island[:count])) == len(np.unique(alone.island))
    density = [np.abs(oracle.signed_areas(uv)).sum() for uv in (result.corner_uv[:count], result.corner_uv[count:])]
    spatial = oracle.triangle_areas(mesh.positions, mesh.triangles)
    if share > 0:
        assert density[0] / density[1] == pytest.approx(spatial[:count].sum() / spatial[count:].sum(), rel=0.1)


@pytest.mark.parametrize("share", [0.1, 1.0])
def test_maps_of_bodies_with_fins_have_the_sheets_of_the_ledger(share: float) -> None:
    """Also where cuts cross the fins: they are sides of one sheet there, of the same length."""
    mesh = finned(meshes.bumpy_sphere(3), share, 2)
    surface, options = lsgp.Surface(mesh.positions, mesh.triangles), lsgp.Options()
    result = lsgp.parameterize(surface, lsgp.place_cones(surface, count=6).cones, None, options)
    assert result_faults(surface, result, options) == []
    component = open_surface(surface, result, options).component
    assert sorted(np.bincount(component)) == sizes(mesh)


def test_an_edge_at_which_two_sheets_cross_is_a_cut_of_each() -> None:
    mesh = book([0, np.pi / 2, np.pi, 3 * np.pi / 2])
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    cone = 2  # in the middle of the back, on both sheets
    along = lsgp.Surface(mesh.positions, mesh.triangles, edges=[[0, 1], [1, cone]])
    cuts = lsgp.find_cuts(along, [cone])
    assert cuts_faults(surface, cuts) == []
    assert sorted(np.sort(cuts.edges, axis=1).tolist()) == [[0, 1], [0, 1], [1, cone], [1, cone]]
    result = lsgp.parameterize(along, [cone], [np.pi])
    assert sorted(np.sort(result.cut_edges, axis=1).tolist()) == [[0, 1], [0, 1], [1, cone], [1, cone]]
    assert result_faults(along, result, lsgp.Options()) == []
