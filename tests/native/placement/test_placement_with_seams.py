# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones placed on a surface with seams: what placement assumes of the seams, all other verbs do with its cones."""

from __future__ import annotations

from itertools import pairwise

import lsgp
import meshes
import numpy as np
import pytest
import scipy.sparse
from lsgp import Options, build_ledger
from map_checks import codes, only, surface
from meshes import Mesh
from numpy.typing import NDArray
from scipy.sparse.csgraph import shortest_path
from shared_meshes import shared_mesh

MESHES = {
    "bumpy": meshes.bumpy_sphere(2),
    "cube": meshes.cube(3),
    "two holes": meshes.subdivide(meshes.double_torus()),
    "torus": meshes.torus(12, 8),
    "hill": meshes.hill(8),
    "cylinder": meshes.cylinder(10, 5),
    "closed and open": meshes.merge([meshes.ellipsoid(1), meshes.grid(4, 4), meshes.cube(2)]),
}
MODES = ("follow", "boundary", "ignore")
CUBE = meshes.cube(2)


def neighbors(mesh: Mesh) -> list[NDArray[np.integer]]:
    edges = meshes.edges_of(mesh.triangles)
    both = np.concatenate([edges, edges[:, ::-1]])
    return [both[both[:, 0] == v, 1] for v in range(len(mesh.positions))]


def path_of(mesh: Mesh, length: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """A walk along edges that meets no vertex twice."""
    around = neighbors(mesh)
    walk = [int(rng.integers(len(mesh.positions)))]
    while len(walk) <= length:
        onward = np.setdiff1d(around[walk[-1]], walk)
        if not len(onward):
            break
        walk.append(int(rng.choice(onward)))
    return list(pairwise(walk))


def loop_of(mesh: Mesh, rng: np.random.Generator) -> list[tuple[int, int]]:
    """The edges around a patch of triangles, which close it off."""
    center = mesh.positions[rng.integers(len(mesh.positions))]
    middles = mesh.positions[mesh.triangles].mean(axis=1)
    patch = np.argsort(np.linalg.norm(middles - center, axis=1), kind="stable")[: rng.integers(3, 20)]
    of_patch = np.sort(mesh.triangles[patch][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, counts = np.unique(of_patch, axis=0, return_counts=True)
    return [tuple(edge) for edge in edges[counts == 1].tolist()]


def random_seams(mesh: Mesh, rng: np.random.Generator) -> NDArray[np.integer]:
    """Some of: a path, a loop, single edges here and there."""
    seams: list[tuple[int, int]] = []
    for kind in rng.permutation(3)[: rng.integers(1, 4)]:
        if kind == 0:
            seams += path_of(mesh, int(rng.integers(1, 12)), rng)
        elif kind == 1:
            seams += loop_of(mesh, rng)
        else:
            seams += [tuple(edge) for edge in rng.choice(meshes.edges_of(mesh.triangles), rng.integers(1, 4)).tolist()]
    return np.array(seams)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", MESHES)
def test_maps_have_the_cones_and_angles_that_were_placed(name: str, seed: int) -> None:
    mesh, rng = MESHES[name], np.random.default_rng([seed, len(name)])
    marked = surface(mesh, seams=random_seams(mesh, rng))
    mode = MODES[seed % 3]
    how = [{}, {"count": 6}, {"lattice": "square"}, {"prefer_sharp": True}][seed // 3]
    kept = rng.choice(mesh.triangles.ravel(), 1) if rng.random() < 0.3 else ()
    placed = lsgp.place_cones(marked, kept, seams=mode, **how)
    options = Options(seams=mode, repair=False)
    assert all(part.closes for part in build_ledger(marked, placed.cones, placed.cone_angles, options))
    found = lsgp.prescribe_curvature(marked, placed.cones, placed.cone_angles, options)
    result = lsgp.parameterize(marked, placed.cones, placed.cone_angles, options)
    assert "COMPONENT_SKIPPED" not in codes(placed.warnings + result.warnings) and result.solved.all()
    for imposed in (found, result):
        assert imposed.cones.tolist() == placed.cones.tolist()
        assert np.abs(imposed.cone_angles - placed.cone_angles).max(initial=0) <= 1e-9
    if "lattice" not in how:  # which rounds the turning of borders as well
        assert found.predicted_l2 == pytest.approx(placed.predicted_l2, rel=1e-9)


def test_path_of_seams_on_a_closed_surface_leaves_it_closed() -> None:
    mesh = shared_mesh("bird")
    edges, count = meshes.edges_of(mesh.triangles), len(mesh.positions)
    joined = scipy.sparse.coo_array((np.ones(len(edges)), edges.T), (count, count))
    ends = mesh.positions[:, 0].argmin(), mesh.positions[:, 0].argmax()
    before = shortest_path(joined.tocsr(), directed=False, indices=ends[0], return_predecessors=True)[1]
    path = [int(ends[1])]
    while path[-1] != ends[0] and len(path) <= 55:
        path.append(int(before[path[-1]]))
    seams = list(pairwise(path))
    assert len(seams) > 20
    marked = surface(mesh, seams=seams)
    placed = lsgp.place_cones(marked)
    result = lsgp.parameterize(marked, placed.cones, placed.cone_angles)
    assert "SEAMS_OPENED" not in codes(placed.warnings + result.warnings)
    assert (2 * np.pi - result.cone_angles).sum() == pytest.approx(4 * np.pi, abs=1e-9)


def test_seams_that_are_followed_do_not_move_cones() -> None:
    edges = meshes.edges_of(CUBE.triangles)
    plain, marked = (lsgp.place_cones(surface(CUBE, seams=seams)) for seams in ([], edges[:2]))
    assert plain.cones.tolist() == marked.cones.tolist() and plain.cone_angles.tolist() == marked.cone_angles.tolist()
    plain, marked = (lsgp.cone_gains(surface(CUBE, seams=seams)) for seams in ([], edges[:2]))
    assert (plain.best, plain.present_l2) == (marked.best, marked.present_l2)
    assert np.array_equal(plain.predicted_l2, marked.predicted_l2, equal_nan=True)


def test_no_cones_asked_for_is_what_opens_a_closed_surface_along_its_seams() -> None:
    marked = surface(CUBE, seams=meshes.edges_of(CUBE.triangles))
    placed = lsgp.place_cones(marked, count=0)
    only(placed.warnings, "SEAMS_OPENED")
    result = lsgp.parameterize(marked, placed.cones, placed.cone_angles)
    assert len(placed.cones) == 0 and result.solved.all()
    assert result.distortion.l2_stretch == pytest.approx(placed.predicted_l2, abs=1e-9)


def test_open_surface_that_gets_no_cones_is_described_as_opened_along_its_seams() -> None:
    mesh = meshes.saddle(8)
    across = [(9 * i + 4, 9 * i + 13) for i in range(8)]
    marked = surface(mesh, seams=across)
    placed = lsgp.place_cones(marked)
    assert len(placed.cones) == 0
    result = lsgp.parameterize(marked, [])
    assert "SEAMS_OPENED" in codes(result.warnings)
    assert placed.mapped_l2 == pytest.approx(result.distortion.l2_stretch, rel=1e-9)
    assert placed.mapped_l2 != pytest.approx(lsgp.place_cones(surface(mesh)).mapped_l2, rel=1e-6)
    assert np.abs(placed.log_scale - result.log_scale).max() <= 1e-12


def test_parts_that_get_cones_are_those_of_placement() -> None:
    """A closed part that is to get cones is one account, however its seams divide it."""
    top = CUBE.positions[:, 2] == CUBE.positions[:, 2].max()
    edges = meshes.edges_of(CUBE.triangles)
    marked = surface(CUBE, seams=edges[top[edges].all(axis=1)])
    assert len(build_ledger(marked, [])) > 1
    (part,) = build_ledger(marked, [], gets_cones=True)
    assert (part.euler, part.borders, len(part.triangles)) == (2, 0, len(CUBE.triangles))
