# SPDX-License-Identifier: GPL-3.0-or-later
"""Costs of cuts: what makes an edge a good place for one, and that the map does not depend on it."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import pairs, surface
from scipy import sparse as sp
from scipy.sparse import csgraph
from shared_meshes import shared_mesh


def with_edges(mesh: meshes.Mesh, **fields: object) -> lsgp.Surface:
    return surface(mesh, edges=meshes.edges_of(mesh.triangles), **fields)


def middles(of: lsgp.Surface) -> np.ndarray:
    return of.positions[of.edges].mean(axis=1)


@pytest.mark.parametrize("front", [(0, 0, 1), (0, -1, 0), (3, 1, 2)])
def test_a_sphere_hides_its_back(front: tuple[float, ...]) -> None:
    """Of views spread like the cosine, a point at an angle to the front is seen by (1 + cosine) / 2."""
    sphere = with_edges(meshes.icosphere(4))
    costs = lsgp.cut_costs(sphere, front, creases=False)
    normal = middles(sphere) / np.linalg.norm(middles(sphere), axis=1)[:, None]
    cosine = normal @ np.array(front) / np.linalg.norm(front)
    assert costs.shape == (len(sphere.edges),) and costs.min() >= 0.1 and costs.max() <= 30.1
    share = np.cbrt((costs - 0.1) / 30)
    assert share == pytest.approx((1 + cosine) / 2, abs=0.25)
    assert np.abs(share - (1 + cosine) / 2).mean() < 0.07


def test_what_stands_in_front_hides_what_is_behind() -> None:
    wall = meshes.grid(8, 8)
    near = wall.positions * [2, 2, 1] - [0.5, 0.5, -0.5]
    both = lsgp.Surface(
        np.concatenate([wall.positions, near]),
        np.concatenate([wall.triangles, wall.triangles + len(wall.positions)]),
        np.concatenate([meshes.edges_of(wall.triangles), meshes.edges_of(wall.triangles) + len(wall.positions)]),
    )
    behind, before = np.split(lsgp.cut_costs(both, (0, 0, 1)), 2)
    assert before.mean() > 0.95
    assert behind.mean() < 0.5 * before.mean()


def test_edges_of_a_cube_are_creases_and_those_on_its_faces_are_not() -> None:
    cube = with_edges(meshes.cube(4))
    costs = lsgp.cut_costs(cube)
    ends = cube.positions[cube.edges]
    on_side = [np.isclose(ends[:, :, axis], side).all(axis=1) for axis in range(3) for side in (0, 1)]
    is_crease = np.sum(on_side, axis=0) == 2
    assert is_crease.sum() == 48
    assert costs[is_crease] == pytest.approx(0.12) and costs[~is_crease] == pytest.approx(1)


def test_sharp_edges_count_as_creases_whatever_their_angle() -> None:
    flat = with_edges(meshes.grid(4, 4))
    sharp = flat.edges[[3, 7]]
    for creases in (True, False):
        costs = lsgp.cut_costs(flat, creases=creases, sharp=sharp[:, ::-1])
        assert np.flatnonzero(costs < 1).tolist() == [3, 7] and costs[[3, 7]] == pytest.approx(0.12)


def test_paint_multiplies_by_a_tenth_to_ten() -> None:
    flat = with_edges(meshes.grid(3, 3))
    x = flat.positions[:, 0] / flat.positions[:, 0].max()
    costs = lsgp.cut_costs(flat, creases=False, paint=x)
    assert costs == pytest.approx(10 ** (2 * x[flat.edges].mean(axis=1) - 1))


@pytest.mark.parametrize(
    "cause, fields, arguments",
    [
        ("front", {}, {"front": (0, 0, 0)}),
        ("front", {}, {"front": (0, np.nan, 1)}),
        ("painted", {}, {"paint": np.full(16, 1.5)}),
        ("edges", {"edges": None}, {}),
    ],
)
def test_preferences_that_are_none_are_refused(cause: str, fields: dict, arguments: dict) -> None:
    flat = meshes.grid(3, 3)
    of = surface(flat, **{"edges": meshes.edges_of(flat.triangles)} | fields)
    with pytest.raises(lsgp.InputError, match=cause) as refused:
        lsgp.cut_costs(of, **arguments)
    assert refused.value.code == "WRONG_PARAMETER"


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf, 1e7])
def test_a_cost_outside_its_range_is_refused_by_its_edge(bad: float) -> None:
    flat = with_edges(meshes.grid(3, 3))
    costs = np.ones(len(flat.edges))
    costs[5] = bad
    of = lsgp.Surface(flat.positions, flat.triangles, flat.edges, cut_costs=costs)
    with pytest.raises(lsgp.InputError, match="1 edge") as refused:
        lsgp.parameterize(of, [])
    assert refused.value.code == "WRONG_PARAMETER"
    assert refused.value.elements.indices.ravel().tolist() == flat.edges[5].tolist()


def test_cuts_keep_to_where_they_are_cheap() -> None:
    """From pole to pole the back of a sphere is as long as its front."""
    sphere = with_edges(meshes.icosphere(4))
    poles = [int(sphere.positions[:, 2].argmin()), int(sphere.positions[:, 2].argmax())]
    for front in ((1, 0, 0), (-1, 0, 0), (0, 1, 0)):
        costs = lsgp.cut_costs(sphere, front)
        cuts = lsgp.find_cuts(lsgp.Surface(sphere.positions, sphere.triangles, sphere.edges, cut_costs=costs), poles)
        on_cut = np.unique(cuts.edges)
        away = sphere.positions[on_cut] @ np.array(front)
        assert set(poles) <= set(on_cut.tolist()) and away.max() < 0.2


def turning(places: np.ndarray) -> float:
    """By length, of a polyline."""
    steps = np.diff(places, axis=0)
    length = np.linalg.norm(steps, axis=1)
    along = steps / length[:, None]
    return float(np.arccos(np.clip((along[1:] * along[:-1]).sum(axis=1), -1, 1)).sum() / length.sum())


def beside_shortest(of: lsgp.Surface, paths: list[np.ndarray]) -> float:
    """How much paths turn by length, relative to the shortest ways between their ends within two edges of them."""
    count, lengths = len(of.positions), np.linalg.norm(np.diff(of.positions[of.edges], axis=1), axis=2).ravel()
    graph = sp.coo_matrix((lengths, of.edges.T), (count, count)).tocsr()
    graph += graph.T
    turned, shortest = [], []
    for path in (path for path in paths if len(path) > 3 and path[0] != path[-1]):
        corridor = path
        for _ in range(2):
            corridor = np.union1d(corridor, graph[corridor].indices)
        first, last = np.searchsorted(corridor, path[[0, -1]])
        _, before = csgraph.dijkstra(graph[corridor][:, corridor], indices=first, return_predecessors=True)
        way = [last]
        while way[-1] != first:
            way.append(before[way[-1]])
        turned.append(turning(of.positions[path]))
        shortest.append(turning(of.positions[corridor[way]]))
    return float(np.mean(turned) / np.mean(shortest))


@pytest.mark.slow
def test_hidden_cuts_hardly_zigzag() -> None:
    """Costs that differ by chance from edge to edge make cuts turn twice as much."""
    hidden, by_chance = [], []
    for name in ("igea-16k", "bird", "hand-5k", "kitten-genus1"):
        mesh = shared_mesh(name)
        plain = with_edges(mesh)
        fronts = [lsgp.cut_costs(plain, front) for front in ((0, 0, 1), (1, 0, 0), (0, -1, 0))]
        noise = np.exp(np.random.default_rng(1).normal(size=len(plain.edges)))
        *along, across = (
            beside_shortest(plain, lsgp.find_cuts(replace(plain, cut_costs=costs), mesh.cones).paths)
            for costs in (*fronts, noise)
        )
        hidden += along
        by_chance.append(across)
    assert np.median(hidden) <= 1.3 and max(hidden) <= 1.6 < min(by_chance)


MAPPED = {
    "bumpy sphere": meshes.bumpy_sphere(3),
    "flower": meshes.flower(3),
    "hill": meshes.hill(12),
    "holes and cones": meshes.disk_with_holes(18, 3)._replace(cones=np.array([43, 92, 152, 201], np.int32)),
    "torus": meshes.torus(24, 16)._replace(cones=np.array([10, 200], np.int32)),
}


@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
@pytest.mark.parametrize("name", MAPPED)
def test_costs_move_the_cuts_and_leave_the_map(name: str, mode: str) -> None:
    mesh = MAPPED[name]
    plain = with_edges(mesh)
    options = lsgp.Options(mode=mode)
    before = lsgp.parameterize(plain, mesh.cones, options=options)
    rng = np.random.default_rng(2)
    moved = 0
    for _ in range(3):
        costs = np.exp(1.5 * rng.normal(size=len(mesh.positions)))[plain.edges].mean(axis=1)
        of = lsgp.Surface(plain.positions, plain.triangles, plain.edges, cut_costs=costs)
        after = lsgp.parameterize(of, mesh.cones, options=options)
        moved += pairs(after.cut_edges) != pairs(before.cut_edges)
        assert after.distortion.l2_stretch == pytest.approx(before.distortion.l2_stretch, rel=1e-9)
        assert oracle.metric_gap(before.corner_uv, after.corner_uv) <= 1e-7
    assert moved


def cut_choices(of: lsgp.Surface) -> dict[str, np.ndarray]:
    """The costs of the choices that the interfaces offer, and a user's own."""
    painted = np.random.default_rng(4).uniform(size=len(of.positions))
    return {
        "hidden": lsgp.cut_costs(of, (0, 0, 1)),
        "hidden from elsewhere": lsgp.cut_costs(of, (1, -2, 0)),
        "shortest": np.ones(len(of.edges)),
        "sharp": lsgp.cut_costs(of),
        "own": lsgp.cut_costs(of, creases=False, paint=painted),
    }


def rigid_gap(triangles: np.ndarray, one: lsgp.Result, other: lsgp.Result) -> float:
    """Largest distance, in parts of the layout's extent, between two maps cut open along the cuts of both, after the
    best rigid motion of each piece and one common scale."""
    both = np.concatenate([one.cut_edges, other.cut_edges])
    piece = oracle.face_components(oracle.cut_open(triangles, both).corner)
    first, second = (
        oracle.as_complex(result.corner_uv) / np.sqrt(np.abs(oracle.signed_areas(result.corner_uv)).sum())
        for result in (one, other)
    )
    gaps = []
    for i in np.unique(piece):
        a, b = first[piece == i].ravel(), second[piece == i].ravel()
        a, b = a - a.mean(), b - b.mean()
        turn = b.conj() @ a
        gaps.append(np.abs(a - turn / abs(turn) * b).max())
    return float(max(gaps) / np.abs(first.ravel() - first.mean()).max())


@pytest.mark.parametrize("name", MAPPED)
def test_every_choice_of_cuts_gives_the_same_coordinates_up_to_a_motion(name: str) -> None:
    """To nine digits: pieces between the cuts move rigidly, and nothing else changes."""
    mesh = MAPPED[name]
    of = with_edges(mesh)
    cones = lsgp.parameterize(of, mesh.cones)
    plain = lsgp.Options(repair=False)
    maps = [
        lsgp.parameterize(replace(of, cut_costs=costs), cones.cones, cones.cone_angles, plain)
        for costs in cut_choices(of).values()
    ]
    assert len({frozenset(pairs(one.cut_edges)) for one in maps}) >= 2
    assert max(rigid_gap(mesh.triangles, maps[0], other) for other in maps[1:]) <= 1e-9
