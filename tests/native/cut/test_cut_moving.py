# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts moved by hand: the layout is cut where asked, every triangle keeps its shape and every seam its exactness."""

from __future__ import annotations

from itertools import pairwise

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import scipy.sparse as sp
from map_checks import RESIDUAL, pairs
from meshes import Mesh
from scipy.sparse.csgraph import dijkstra

SEAMLESS = lsgp.Options(seamless=lsgp.Seamless())


class Cuts:
    """A map of a mesh, and its cuts as paths between nodes."""

    def __init__(self, mesh: Mesh, options: lsgp.Options | None = None, costs: object = None) -> None:
        edges = meshes.edges_of(mesh.triangles)
        self.mesh = mesh
        self.surface = lsgp.Surface(mesh.positions, mesh.triangles, edges, cut_costs=costs)
        result = lsgp.parameterize(self.surface, mesh.cones, None, options or lsgp.Options())
        self.uv, self.cuts, self.cones = result.corner_uv, result.cut_edges, result.cones
        self.paths = lsgp.split_into_paths(self.cuts, self.cones)
        self.longest = max(self.paths, key=len)
        self.mover = lsgp.CutMover(self.surface)

    def grab(self, path: np.ndarray) -> lsgp.GrabbedCut:
        return self.mover.grab(self.uv, self.cuts, path, self.cones)

    def near(self, vertex: int, rings: int) -> list[int]:
        """The vertices within some rings about a vertex."""
        found = {vertex}
        for _ in range(rings):
            around = np.isin(self.mesh.triangles, list(found)).any(axis=1)
            found |= set(self.mesh.triangles[around].ravel().tolist())
        return sorted(found)

    def moved(self, path: np.ndarray, moved: lsgp.MovedCut) -> tuple[np.ndarray, set[tuple[int, int]]]:
        """The layout with a moved cut, and its cuts."""
        uv = self.uv.copy()
        uv[moved.triangles] = moved.corner_uv
        return uv, (pairs(self.cuts) - pairs(list(pairwise(path)))) | pairs(list(pairwise(moved.path)))


def ways(cuts: Cuts, path: np.ndarray, **how: bool) -> list[tuple[int, lsgp.MovedCut]]:
    """The path by way of every vertex within three rings of its middle, where it can go."""
    grabbed, found = cuts.grab(path), []
    for vertex in cuts.near(int(path[len(path) // 2]), 3):
        try:
            found.append((vertex, grabbed.through(vertex, **how)))
        except lsgp.TopologyError as error:
            assert error.code == "CUT_NOT_MOVABLE"
    assert len(found) > 5
    return found


def worst_seam(cuts: Cuts, uv: np.ndarray, edges: set[tuple[int, int]]) -> float:
    """The largest distance between one side of a cut and the other one moved by one rotation and translation."""
    z, corner_of = oracle.as_complex(uv), {}
    for f, triangle in enumerate(cuts.mesh.triangles.tolist()):
        for c in range(3):
            corner_of[triangle[c], triangle[(c + 1) % 3]] = z[f, c], z[f, (c + 1) % 3]
    worst = 0.0
    for path in lsgp.split_into_paths(sorted(edges), cuts.cones):
        steps = list(pairwise(path.tolist()))
        left = np.array([corner_of[step] for step in steps]).ravel()
        right = np.array([corner_of[step[::-1]][::-1] for step in steps]).ravel()
        turn = np.vdot(left - left.mean(), right - right.mean())
        turn /= abs(turn)
        worst = max(worst, np.abs(right - right.mean() - turn * (left - left.mean())).max())
    return worst


@pytest.fixture(scope="module", params=["sphere", "seamless", "torus", "hill"])
def cuts(request: pytest.FixtureRequest) -> Cuts:
    if request.param == "torus":
        return Cuts(meshes.torus())
    if request.param == "hill":
        return Cuts(meshes.hill())
    return Cuts(meshes.bumpy_sphere(3), SEAMLESS if request.param == "seamless" else None)


def test_the_layout_is_open_where_asked_and_every_triangle_keeps_its_shape(cuts):
    path = cuts.longest
    for vertex, moved in ways(cuts, path):
        uv, edges = cuts.moved(path, moved)
        assert vertex in moved.path
        assert (moved.path[0], moved.path[-1]) == (path[0], path[-1])
        assert oracle.open_edges(cuts.mesh.triangles, uv, 1e-9) == edges
        assert oracle.metric_gap(uv, cuts.uv) < RESIDUAL * np.abs(uv).max()


def test_seams_stay_exact(cuts):
    for _, moved in ways(cuts, cuts.longest)[::3]:
        uv, edges = cuts.moved(cuts.longest, moved)
        assert worst_seam(cuts, uv, edges) < RESIDUAL * np.abs(uv).max()


def test_where_the_cut_was_both_sides_meet_to_the_last_digit(cuts):
    _, moved = ways(cuts, cuts.longest)[0]
    uv, edges = cuts.moved(cuts.longest, moved)
    assert oracle.open_edges(cuts.mesh.triangles, uv) == edges


def test_the_way_back_gives_the_same_layout(cuts):
    path, back_again = cuts.longest, 0
    for _, moved in ways(cuts, path)[::3]:
        uv, edges = cuts.moved(path, moved)
        grabbed = cuts.mover.grab(uv, sorted(edges), moved.path, cuts.cones)
        for vertex in path[1:-1].tolist():
            try:
                back = grabbed.through(vertex)
            except lsgp.TopologyError:
                continue
            if not np.array_equal(back.path, path):
                continue
            uv[back.triangles] = back.corner_uv
            if grabbed.transition.exact:
                assert uv.tobytes() == cuts.uv.tobytes()
            else:
                np.testing.assert_allclose(uv, cuts.uv, rtol=0, atol=RESIDUAL)
            back_again += 1
            break
    assert back_again


def test_both_parts_of_the_way_are_the_cheapest():
    mesh = meshes.bumpy_sphere(2)
    edges = meshes.edges_of(mesh.triangles)
    costs = 1 + np.abs(np.sin(np.arange(len(edges))))
    cuts = Cuts(mesh, costs=costs)
    path = cuts.longest
    lengths = costs * np.linalg.norm(mesh.positions[edges[:, 0]] - mesh.positions[edges[:, 1]], axis=1)
    others = pairs(cuts.cuts) - pairs(list(pairwise(path)))
    closed = np.zeros(len(mesh.positions), bool)
    closed[[*cuts.cones, *(v for edge in others for v in edge)]] = True
    for vertex, moved in ways(cuts, path):
        at = moved.path.tolist().index(vertex)
        for end, way in ((path[0], moved.path[: at + 1]), (path[-1], moved.path[at:])):
            free = ~closed
            free[[end, vertex]] = True
            kept = free[edges].all(axis=1)
            graph = sp.coo_matrix((lengths[kept], edges[kept].T), (len(closed), len(closed))).tocsr()
            cost = {edge: length for edge, length in zip(map(tuple, edges.tolist()), lengths, strict=True)}
            spent = sum(cost[min(step), max(step)] for step in pairwise(way.tolist()))
            least = dijkstra(graph, directed=False, indices=vertex)[end]
            # The second part keeps off the first one.
            assert spent >= least - 1e-12
            if end == path[0]:
                assert spent == pytest.approx(least, rel=1e-12)


def test_a_seamless_layout_stays_exact_in_single_precision():
    cuts = Cuts(meshes.bumpy_sphere(3), SEAMLESS)
    for path in cuts.paths:
        transition = cuts.grab(path).transition
        assert transition.exact
        assert transition.translation == complex(np.round(transition.translation))
    for _, moved in ways(cuts, cuts.longest, single=True):
        uv, edges = cuts.moved(cuts.longest, moved)
        stored = uv.astype(np.float32).astype(np.float64)
        assert np.abs(stored - uv).max() <= np.spacing(np.float32(np.abs(uv).max()))
        for path in lsgp.split_into_paths(sorted(edges), cuts.cones):
            assert cuts.mover.grab(stored, sorted(edges), path, cuts.cones).transition.exact


def test_a_part_of_a_cut_moves_while_the_rest_stays():
    cuts = Cuts(meshes.bumpy_sphere(3))
    part = cuts.longest[1:-1]
    moved = ways(cuts, part)[-1][1]
    uv, edges = cuts.moved(part, moved)
    assert pairs([cuts.longest[:2], cuts.longest[-2:]]) <= edges
    assert oracle.open_edges(cuts.mesh.triangles, uv, 1e-9) == edges


def test_a_closed_cut_between_two_islands_moves():
    sphere = meshes.bumpy_sphere(3)
    upper = sphere.positions[sphere.triangles].mean(axis=1)[:, 2] > 0
    between = [pair for pair in meshes.edges_of(sphere.triangles).tolist() if _parts(sphere, pair, upper)]
    flat = sphere.positions[:, :2][sphere.triangles]
    flat[~upper, :, 0] += 10.0
    mover = lsgp.CutMover(lsgp.Surface(sphere.positions, sphere.triangles))
    (path,) = lsgp.split_into_paths(between, [])
    assert path[0] == path[-1]
    below = sphere.triangles[~upper]
    beside = below[np.isin(below, path[5:-5]).any(axis=1)]
    vertex = next(int(v) for v in beside.ravel() if v not in path)
    moved = mover.grab(flat, between, path).through(vertex)
    flat[moved.triangles] = moved.corner_uv
    wanted = pairs(list(pairwise(moved.path)))
    assert oracle.open_edges(sphere.triangles, flat, 1e-9) == wanted
    assert vertex in moved.path


def _parts(mesh: Mesh, pair: list[int], upper: np.ndarray) -> bool:
    at = np.isin(mesh.triangles, pair).sum(axis=1) == 2
    return len(set(upper[at].tolist())) == 2


def refusal(cuts: Cuts, path: np.ndarray, vertex: int) -> str:
    with pytest.raises(lsgp.TopologyError) as caught:
        cuts.grab(path).through(vertex)
    assert caught.value.code == "CUT_NOT_MOVABLE"
    return caught.value.message


def test_no_cut_moves_onto_a_cone_or_another_cut():
    cuts = Cuts(meshes.bumpy_sphere(2))
    path, other = cuts.paths[0], cuts.paths[-1]
    assert "cone" in refusal(cuts, path, int(path[0]))
    assert "another cut" in refusal(cuts, path, int(other[len(other) // 2]))


def test_no_cut_moves_across_a_cone():
    cuts = Cuts(meshes.bumpy_sphere(3))
    said = {}
    for path in cuts.paths:
        grabbed = cuts.grab(path)
        for vertex in range(0, len(cuts.mesh.positions), 7):
            try:
                moved = grabbed.through(vertex)
            except lsgp.TopologyError as error:
                said[error.message] = said.get(error.message, 0) + 1
            else:
                uv, edges = cuts.moved(path, moved)
                assert oracle.open_edges(cuts.mesh.triangles, uv, 1e-9) == edges
    assert any("lies between" in message for message in said)


def test_no_cut_moves_to_the_other_side_of_a_handle():
    cuts = Cuts(meshes.torus())
    refused = []
    for path in cuts.paths:
        grabbed = cuts.grab(path)
        for vertex in range(len(cuts.mesh.positions)):
            try:
                moved = grabbed.through(vertex)
            except lsgp.TopologyError as error:
                refused.append(error.message)
            else:
                uv, edges = cuts.moved(path, moved)
                assert oracle.open_edges(cuts.mesh.triangles, uv, 1e-9) == edges
    assert any("handle" in message or "in the way" in message for message in refused)


def test_sides_that_no_motion_relates_are_refused():
    cuts = Cuts(meshes.bumpy_sphere(2), lsgp.Options(method="lscm"))
    with pytest.raises(lsgp.TopologyError, match="not related by one rotation") as caught:
        cuts.grab(cuts.longest)
    assert pairs(caught.value.elements.indices) == pairs(list(pairwise(cuts.longest)))


def test_boundaries_stay():
    mesh = meshes.hill()
    cuts = Cuts(mesh)
    border = oracle.boundary_loops(mesh.triangles)[0]
    with pytest.raises(lsgp.TopologyError, match="boundary"):
        cuts.mover.grab(cuts.uv, cuts.cuts, border[:3])


@pytest.mark.parametrize(
    ("path", "cut", "code"),
    [([0], [], "WRONG_PARAMETER"), ([0, 10**6], [], "INDEX_OUT_OF_RANGE"), ([0, 1], [[0, 0]], "EDGE_NOT_IN_MESH")],
)
def test_paths_that_are_none(path, cut, code):
    mesh = meshes.tetrahedron()
    mover = lsgp.CutMover(lsgp.Surface(mesh.positions, mesh.triangles))
    with pytest.raises(lsgp.InputError) as caught:
        mover.grab(np.zeros((4, 3, 2)), cut, path)
    assert caught.value.code == code


@pytest.mark.parametrize("size", [1.0, 1e-300, 1e-170, 1e160, 1e300, 2e307])
def test_triangles_on_others_are_found(size):
    """Their areas need not be numbers, nor the width of all."""
    corner = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    layout = np.array([corner, corner + 5, corner + 0.25, corner + np.nan, corner[[1, 2, 0]] - [1, 0], corner - 8])
    assert lsgp.overlapping_triangles(size * layout).tolist() == [0, 2]
    assert lsgp.overlapping_triangles(np.empty((0, 3, 2))).tolist() == []
