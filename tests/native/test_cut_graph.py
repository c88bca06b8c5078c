# SPDX-License-Identifier: GPL-3.0-or-later
"""The cuts (the paper's 4.1): the minimum spanning tree over all shortest paths, leaving disks behind."""

from __future__ import annotations

import itertools

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import components, pairs, surface

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


def assert_tree_of_paths(mesh: meshes.Mesh, cuts: lsgp.CutGraph) -> None:
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
def test_cuts_are_the_union_of_the_paths_of_the_minimum_spanning_tree(name: str) -> None:
    mesh = GENERIC[name]
    _, expected = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones)
    assert pairs(lsgp.find_cuts(surface(mesh), mesh.cones).edges) == expected


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
