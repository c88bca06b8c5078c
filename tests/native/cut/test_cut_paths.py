# SPDX-License-Identifier: GPL-3.0-or-later
"""Cut edges as paths: every edge once, from node to node, in any order of the edges; those of results by kind."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface, unwrap


def edges_along(paths: list[np.ndarray]) -> list[tuple[int, int]]:
    return sorted(tuple(sorted(edge)) for path in paths for edge in pairwise(path.tolist()))


@pytest.mark.parametrize("mesh", [meshes.flower(2), meshes.hill(), meshes.torus()])
def test_every_cut_edge_is_on_one_path_and_nodes_are_only_at_ends(mesh):
    result = unwrap(mesh)
    paths = lsgp.split_into_paths(result.cut_edges, result.cones)
    assert edges_along(paths) == sorted(tuple(sorted(edge)) for edge in result.cut_edges.tolist())
    degree = np.bincount(result.cut_edges.ravel(), minlength=len(mesh.positions))
    for path in paths:
        assert (degree[path[1:-1]] == 2).all()
        assert not np.isin(path[1:-1], result.cones).any()
        assert path[0] == path[-1] or all(degree[v] != 2 or v in result.cones for v in (path[0], path[-1]))


def test_paths_are_those_of_the_cut_graph():
    mesh = meshes.flower(2)
    graph = lsgp.find_cuts(surface(mesh), mesh.cones)
    ends = np.concatenate([path[[0, -1]] for path in graph.paths])
    found = {min(tuple(path), tuple(path[::-1])) for path in lsgp.split_into_paths(graph.edges, ends)}
    assert found == {min(tuple(path), tuple(path[::-1])) for path in graph.paths}


def test_the_order_of_the_edges_does_not_matter():
    result = unwrap(meshes.flower(2))
    shuffled = np.random.default_rng(5).permutation(result.cut_edges)[:, ::-1]
    first = lsgp.split_into_paths(result.cut_edges, result.cones)
    second = lsgp.split_into_paths(shuffled, result.cones[::-1])
    assert [path.tolist() for path in first] == [path.tolist() for path in second]


def test_loops_without_nodes_close_and_no_edges_are_no_paths():
    assert [path.tolist() for path in lsgp.split_into_paths([[3, 5], [4, 3], [5, 4]], [])] == [[3, 4, 5, 3]]
    assert [path.tolist() for path in lsgp.split_into_paths([[3, 5], [4, 3], [5, 4]], [4])] == [[4, 3, 5, 4]]
    assert lsgp.split_into_paths(np.empty((0, 2), np.int32), [7]) == []


def test_edges_given_twice_count_once():
    assert [path.tolist() for path in lsgp.split_into_paths([[3, 5], [5, 3], [5, 4]], [])] == [[3, 5, 4]]
    assert [path.tolist() for path in lsgp.split_into_paths([[7, 7]], [])] == [[7, 7]]


def as_edges(pairs: np.ndarray) -> set[tuple[int, int]]:
    return set(map(tuple, np.sort(pairs, axis=1).tolist()))


def seamed() -> tuple[lsgp.Surface, lsgp.Options, np.ndarray]:
    """One seam of a ball goes part of the way between cones."""
    mesh = meshes.flower(2)
    marked = lsgp.find_cuts(surface(mesh), mesh.cones).edges[::3]
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=marked), lsgp.Options(), mesh.cones


def with_borders() -> tuple[lsgp.Surface, lsgp.Options, tuple[()]]:
    """A box that ends along some edges of its ridges, and is cut along others."""
    mesh = meshes.cube(4)
    box = surface(mesh)
    ridges = lsgp.crease_borders(box, angle=1.0)
    return lsgp.Surface(box.positions, box.triangles, borders=ridges), lsgp.Options(overlaps="split"), ()


@pytest.mark.parametrize("case", [seamed, with_borders])
@pytest.mark.parametrize("overlaps", ["keep", "split"])
def test_paths_of_results_end_at_cones_junctions_and_changes_of_kind(case, overlaps):
    whole, options, cones = case()
    result = lsgp.parameterize(whole, cones, None, replace(options, overlaps=overlaps))
    seams, required = as_edges(whole.seams), as_edges(result.required_cuts)
    kind_of = {
        edge: "seam" if edge in seams else "required" if edge in required else "added"
        for edge in as_edges(np.concatenate([result.cut_edges, whole.borders]))
    }
    assert len(kind_of) > 0
    assert edges_along(result.cut_paths) == sorted(kind_of)
    kinds_at: dict[int, list[str]] = {}
    for edge, kind in kind_of.items():
        for vertex in edge:
            kinds_at.setdefault(vertex, []).append(kind)
    nodes = {v for v, kinds in kinds_at.items() if len(kinds) != 2 or len(set(kinds)) > 1 or v in result.cones}
    for path, kind in zip(result.cut_paths, result.cut_kinds, strict=True):
        assert {kind_of[edge] for edge in edges_along([path])} == {kind}
        assert nodes.isdisjoint(path[1:-1].tolist())
        assert {path[0], path[-1]} <= nodes or path[0] == path[-1] == path.min()


def test_the_kinds_of_a_result_are_those_that_occur():
    whole, options, cones = seamed()
    assert set(lsgp.parameterize(whole, cones, None, options).cut_kinds) == {"seam", "required"}
    whole, options, cones = with_borders()
    assert set(lsgp.parameterize(whole, cones, None, options).cut_kinds) == {"added"}
