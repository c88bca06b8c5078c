# SPDX-License-Identifier: GPL-3.0-or-later
"""Cut edges as paths: every edge once, from node to node, in any order of the edges."""

from __future__ import annotations

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
