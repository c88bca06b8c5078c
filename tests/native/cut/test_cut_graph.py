# SPDX-License-Identifier: GPL-3.0-or-later
"""The cuts (the paper's 4.1): a short tree over cones and borders, leaving disks behind."""

from __future__ import annotations

import itertools

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import scipy.sparse as sp
from map_checks import components, pairs, surface
from scipy.sparse import csgraph

GENERIC = {
    "bumpy sphere": meshes.bumpy_sphere(3),
    "many cones, turned": meshes.transform(
        meshes.bumpy_sphere(3)._replace(cones=np.arange(0, 640, 5, dtype=np.int32)), seed=3
    ),
    "forked": meshes.forked(),
    "flower": meshes.flower(3),
    "hill": meshes.hill(12),
    "two holes": meshes.disk_with_holes(14, 2),
    "three holes and cones": meshes.disk_with_holes(18, 3)._replace(cones=np.array([43, 92, 152, 201], np.int32)),
    "tube": meshes.cylinder(),
}
WITH_TIES = {"cube": meshes.cube(4), "box": meshes.cube(5, (1, 2, 0.5)), "icosphere": meshes.icosphere(2)}
WITH_HANDLES = {"torus": meshes.torus(), "double torus": meshes.subdivide(meshes.double_torus())}


def length(mesh: meshes.Mesh, edges: object) -> float:
    ends = mesh.positions[np.asarray(edges).reshape(-1, 2)]
    return float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum())


def nodes_of(mesh: meshes.Mesh) -> set[int]:
    return {int(v) for v in np.concatenate([mesh.cones, *oracle.boundary_loops(mesh.triangles)])}


def assert_tree_of_paths(mesh: meshes.Mesh, cuts: lsgp.CutPaths) -> None:
    """Paths tile the edges, end at nodes only, and no cut ends anywhere but at a cone or a boundary."""
    inner_edges = pairs(meshes.edges_of(mesh.triangles))
    tail, head, twin = oracle.halfedges(mesh.triangles)
    rim = pairs(np.stack([tail[twin < 0], head[twin < 0]], 1)) if (twin < 0).any() else set()
    assert pairs(cuts.edges) <= inner_edges - rim
    steps = [(int(a), int(b)) for path in cuts.paths for a, b in itertools.pairwise(path)]
    assert len(steps) == len(cuts.edges) and pairs(steps) == pairs(cuts.edges)
    degree = np.bincount(np.asarray(cuts.edges).ravel(), minlength=len(mesh.positions))
    nodes = nodes_of(mesh)
    for path in cuts.paths:
        for end in (path[0], path[-1]):
            assert int(end) in nodes or degree[end] >= 3
        assert all(degree[v] == 2 and int(v) not in nodes for v in path[1:-1])
    assert all(int(v) in nodes for v in np.flatnonzero(degree == 1))
    assert all(degree[c] > 0 for c in mesh.cones)


@pytest.mark.parametrize("name", [*GENERIC, *WITH_TIES, *WITH_HANDLES])
def test_opened_surface_is_a_disk_and_the_cuts_are_clean_paths(name: str) -> None:
    mesh = {**GENERIC, **WITH_TIES, **WITH_HANDLES}[name]
    cuts = lsgp.find_cuts(surface(mesh), mesh.cones)
    opened = oracle.cut_open(mesh.triangles, cuts.edges)
    assert len(np.unique(oracle.face_components(opened.corner))) == 1
    assert oracle.euler_of(opened.corner) == 1
    assert_tree_of_paths(mesh, cuts)


@pytest.mark.parametrize("name", GENERIC)
def test_cuts_are_no_longer_than_the_paths_of_the_minimum_spanning_tree(name: str) -> None:
    mesh = GENERIC[name]
    _, paths = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones)
    cuts = lsgp.find_cuts(surface(mesh), mesh.cones)
    assert length(mesh, cuts.edges) <= length(mesh, sorted(paths)) * (1 + 1e-12)


def test_no_path_of_a_tree_can_be_exchanged_for_a_shorter_one() -> None:
    """Of every path between two nodes: none joins what is left without it in less length."""
    for name in ("bumpy sphere", "many cones, turned", "flower"):
        mesh = GENERIC[name]
        edges = meshes.edges_of(mesh.triangles)
        costs = np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
        graph = sp.coo_matrix((costs, edges.T), (len(mesh.positions),) * 2).tocsr()
        cuts = lsgp.find_cuts(surface(mesh), mesh.cones)
        gains = []
        for path in cuts.paths:
            steps = pairs(itertools.pairwise(path.tolist()))
            rest = np.array(sorted(pairs(cuts.edges) - steps)).reshape(-1, 2)
            joined = sp.coo_matrix((np.ones(len(rest)), rest.T), graph.shape).tocsr()
            part = csgraph.connected_components(joined, directed=False)[1]
            held = np.zeros(len(mesh.positions), bool)
            held[[*rest.ravel(), path[0], path[-1]]] = True
            one = np.flatnonzero(held & (part == part[path[0]]))
            other = np.flatnonzero(held & (part == part[path[-1]]))
            shortest = csgraph.dijkstra(graph, False, one, min_only=True)[other].min()
            gains.append(1 - shortest / length(mesh, sorted(steps)))
        assert max(gains) < 2e-3, name


def test_trees_are_near_the_shortest_there_are() -> None:
    """Against the exact Steiner tree (Dreyfus and Wagner 1971), with costs that differ from place to place as well."""
    rng = np.random.default_rng(5)
    excess = []
    for trial in range(24):
        mesh = (meshes.bumpy_sphere(2), meshes.flower(2), meshes.icosphere(2), meshes.cube(4))[trial % 4]
        edges = meshes.edges_of(mesh.triangles)
        cones = np.sort(rng.choice(len(mesh.positions), rng.integers(3, 8), replace=False)).astype(np.int32)
        factor = np.exp(rng.normal(size=len(mesh.positions)))[edges].mean(axis=1) if trial % 2 else np.ones(len(edges))
        costs = factor * np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
        cuts = lsgp.find_cuts(surface(mesh, edges=edges, cut_costs=factor), cones)
        row = {edge: i for i, edge in enumerate(map(tuple, np.sort(edges, axis=1).tolist()))}
        found = sum(costs[row[edge]] for edge in pairs(cuts.edges))
        excess.append(found / oracle.steiner_cost(len(mesh.positions), edges, costs, cones) - 1)
    assert min(excess) > -1e-12
    assert np.mean(excess) < 0.003 and max(excess) < 0.03


def test_tree_is_as_long_as_the_minimum_spanning_tree_where_no_paths_merge() -> None:
    for name in ("cube", "box"):
        mesh = WITH_TIES[name]
        expected, _ = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones)
        assert length(mesh, lsgp.find_cuts(surface(mesh), mesh.cones).edges) == pytest.approx(expected, rel=1e-12)


def test_paths_that_merge_make_the_tree_shorter_and_a_junction() -> None:
    mesh = meshes.forked()
    expected, _ = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones)
    cuts = lsgp.find_cuts(surface(mesh), mesh.cones)
    degree = np.bincount(cuts.edges.ravel(), minlength=len(mesh.positions))
    junctions = np.setdiff1d(np.flatnonzero(degree >= 3), mesh.cones)
    assert len(junctions) >= 1
    assert length(mesh, cuts.edges) < expected * (1 - 1e-6)


def test_no_cut_without_need() -> None:
    for mesh in (meshes.saddle(6), meshes.grid(1, 1)):
        cuts = lsgp.find_cuts(surface(mesh), [])
        assert cuts.edges.shape == (0, 2) and cuts.paths == []


def test_diagonals_are_left_alone_when_only_mesh_edges_may_be_cut() -> None:
    mesh = meshes.cube(3)
    every = meshes.edges_of(mesh.triangles)
    axis = np.isclose(mesh.positions[every[:, 0]], mesh.positions[every[:, 1]]).sum(axis=1) == 2
    # Cones in the middle of faces and at corners, so that the shortest ways over all edges use diagonals.
    middle = [
        int(np.argmin(np.linalg.norm(mesh.positions - q, axis=1)))
        for q in ([1 / 3, 1 / 3, 0], [2 / 3, 0, 2 / 3], [1, 1, 1])
    ]
    free = pairs(lsgp.find_cuts(surface(mesh), middle).edges)
    kept = pairs(lsgp.find_cuts(surface(mesh, edges=every[axis]), middle).edges)
    assert not free <= pairs(every[axis])
    assert kept <= pairs(every[axis])
    expected, _ = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, middle, every[axis])
    assert length(mesh, sorted(kept)) == pytest.approx(expected, rel=1e-12)


TORUS, DOUBLE_TORUS = meshes.torus(8, 6), meshes.double_torus()


@pytest.mark.parametrize(
    "mesh, quads",
    [(TORUS, np.stack(np.split(TORUS.triangles, 2), axis=1)), (DOUBLE_TORUS, DOUBLE_TORUS.triangles.reshape(-1, 2, 3))],
    ids=["genus 1", "genus 2"],
)
def test_handles_are_opened_along_mesh_edges_too(mesh: meshes.Mesh, quads: np.ndarray) -> None:
    every = meshes.edges_of(mesh.triangles)
    diagonal = np.zeros(len(every), bool)
    lookup = {tuple(edge): i for i, edge in enumerate(every.tolist())}
    for one, other in quads:
        diagonal[lookup[tuple(sorted(set(one.tolist()) & set(other.tolist())))]] = True
    cuts = lsgp.find_cuts(surface(mesh, edges=every[~diagonal]), mesh.cones)
    assert not pairs(cuts.edges) & pairs(every[diagonal])
    assert oracle.euler_of(oracle.cut_open(mesh.triangles, cuts.edges).corner) == 1


def test_cuts_follow_seams_on_detours() -> None:
    mesh = meshes.flower(3)
    plain = lsgp.find_cuts(surface(mesh), mesh.cones)
    # A detour: the shortest way from cone 0 to cone 1 that has at most its ends in common with the plain cuts.
    banned = {edge for edge in pairs(plain.edges) if not set(edge) & {0, 1}}
    every = np.array(sorted(pairs(meshes.edges_of(mesh.triangles)) - banned))
    _, detour = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones[:2], every)
    assert len(detour - pairs(plain.edges)) >= 4
    seamed = lsgp.find_cuts(surface(mesh, seams=sorted(detour)), mesh.cones)
    assert detour <= pairs(seamed.edges)


def test_components_are_cut_each_by_itself() -> None:
    mesh = meshes.merge([meshes.cube(2), meshes.hill(8), meshes.flower(2)])
    together = pairs(lsgp.find_cuts(surface(mesh), mesh.cones).edges)
    assert len(components(mesh)) == 3
    alone = set()
    for part, faces in components(mesh):
        vertex = np.unique(mesh.triangles[faces])
        alone |= pairs(vertex[lsgp.find_cuts(surface(part), part.cones).edges])
    assert together == alone
