# SPDX-License-Identifier: GPL-3.0-or-later
"""Unfolding (the paper's 4.2 and 6): exact transitions, the same map as the oracle's, whatever way the cuts run."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_angles_met, assert_exact_transitions, codes, only, pairs, solve_again, surface, unwrap

PI = np.pi
BOTH = pytest.mark.parametrize("unfold", ["poisson", "spectral"])


CLOSED = {
    "cube": meshes.cube(3),
    "bumpy sphere": meshes.bumpy_sphere(2),
    "flower": meshes.flower(3),
    "ellipsoid": meshes.ellipsoid(2),
    "with a junction": meshes.forked(),
}
OPEN = {
    "saddle, no cut": meshes.saddle(8),
    "hill": meshes.hill(),
    "tube, no cones": meshes.cylinder(),
    "two holes": meshes.disk_with_holes(12, 2),
    "three holes and cones": meshes.disk_with_holes(18, 3)._replace(cones=np.array([43, 152], np.int32)),
}
DEVELOPABLE = {
    "tetrahedron": meshes.tetrahedron(),
    "octahedron": meshes.subdivide(meshes.octahedron()),
    "icosahedron": meshes.subdivide(meshes.icosahedron()),
    "cube of 12 triangles": meshes.cube(1),
    "cube": meshes.cube(5),
    "box": meshes.cube(4, (1, 3, 0.4)),
}


def spread(mesh: meshes.Mesh, result: lsgp.Result) -> float:
    """Largest over smallest stretch in any triangle and any direction, less 1."""
    stretch = oracle.stretches(mesh.positions, mesh.triangles, result.corner_uv)
    return float(stretch.max() / stretch.min() - 1)


@BOTH
@pytest.mark.parametrize("name", DEVELOPABLE)
def test_developable_surfaces_are_unfolded_isometrically(name: str, unfold: str) -> None:
    mesh = DEVELOPABLE[name]
    result = unwrap(mesh, unfold=unfold)
    assert spread(mesh, result) <= 1e-9
    assert_angles_met(mesh, result)
    assert_exact_transitions(mesh, result)


@BOTH
@pytest.mark.parametrize("name", CLOSED)
def test_map_is_the_oracles(name: str, unfold: str) -> None:
    mesh = CLOSED[name]
    result = unwrap(mesh, unfold=unfold)
    again = solve_again(mesh, result, unfold)
    assert again.closure <= 1e-9
    assert oracle.similarity_gap(again.corner_uv, result.corner_uv) <= 1e-7
    assert_exact_transitions(mesh, result)
    assert_angles_met(mesh, result)


@pytest.mark.parametrize("name", OPEN)
def test_map_of_a_surface_with_boundary_is_the_oracles(name: str) -> None:
    mesh = OPEN[name]
    result = unwrap(mesh)
    again = solve_again(mesh, result)
    assert again.closure <= 1e-9
    assert oracle.similarity_gap(again.corner_uv, result.corner_uv) <= 1e-7
    assert_exact_transitions(mesh, result)
    assert_angles_met(mesh, result)


def other_cuts(mesh: meshes.Mesh, result: lsgp.Result) -> lsgp.Surface:
    """The surface with seams along another tree, that shares no edges with the first but some at cones."""
    ends = set(mesh.cones.tolist())
    rest = pairs(meshes.edges_of(mesh.triangles)) - {e for e in pairs(result.cut_edges) if not set(e) & ends}
    _, tree = oracle.shortest_cut_tree(mesh.positions, mesh.triangles, mesh.cones, np.array(sorted(rest)))
    return surface(mesh, seams=sorted(tree))


@BOTH
@pytest.mark.parametrize("name", ["cube", "bumpy sphere", "flower", "ellipsoid"])
def test_map_does_not_depend_on_where_the_cuts_run(name: str, unfold: str) -> None:
    mesh = CLOSED[name]
    one = unwrap(mesh, unfold=unfold)
    two = lsgp.parameterize(other_cuts(mesh, one), mesh.cones, one.cone_angles.tolist(), lsgp.Options(unfold=unfold))
    assert len(pairs(one.cut_edges) & pairs(two.cut_edges)) < len(one.cut_edges) / 2
    assert two.cone_angles == pytest.approx(one.cone_angles, abs=1e-12)
    assert oracle.metric_gap(one.corner_uv, two.corner_uv) <= 1e-7


@pytest.mark.parametrize("name", ["hill", "three holes and cones"])
def test_map_with_boundary_does_not_depend_on_where_the_cuts_run(name: str) -> None:
    mesh = OPEN[name]
    one = unwrap(mesh)
    two = lsgp.parameterize(other_cuts(mesh, one), mesh.cones, one.cone_angles.tolist())
    assert pairs(one.cut_edges) != pairs(two.cut_edges)
    assert oracle.metric_gap(one.corner_uv, two.corner_uv) <= 1e-7


def test_poisson_and_spectral_agree_as_far_as_the_surface_is_fine() -> None:
    """Both discretise the same conformal map: their difference shrinks with the triangles."""
    gaps = []
    for levels in (2, 3, 4):
        mesh = meshes.ellipsoid(levels)
        maps = [unwrap(mesh, prescription="harmonic", unfold=unfold).corner_uv for unfold in ("poisson", "spectral")]
        lengths = [
            np.linalg.norm(uv - uv[:, [1, 2, 0]], axis=2) / np.sqrt(oracle.signed_areas(uv).sum()) for uv in maps
        ]
        gaps.append(np.abs(np.log(lengths[0] / lengths[1])).mean())
    assert gaps[1] < 0.6 * gaps[0] and gaps[2] < 0.6 * gaps[1]


def test_flat_patches_stay_as_they_are() -> None:
    for mesh in (meshes.grid(5, 3), meshes.grid(1, 1), meshes.make([[0, 0, 0], [3, 0, 1], [1, 2, 0]], [[0, 1, 2]])):
        result = unwrap(mesh)
        assert spread(mesh, result) <= 1e-9
        assert result.cut_edges.shape == (0, 2)


# --- the node rule in its special cases -------------------------------------------------------------------------------


@BOTH
def test_a_flat_cone_is_no_cone(unfold: str) -> None:
    """Once round a cone of 2 pi the rotations cancel: its translation is bound instead of its position."""
    mesh = meshes.cube(4)
    middle = int(np.argmin(np.linalg.norm(mesh.positions - [0.5, 0.5, 0], axis=1)))
    with_flat = mesh._replace(cones=np.append(mesh.cones, middle).astype(np.int32))
    result = unwrap(with_flat, [1.5 * PI] * 8 + [2 * PI], unfold=unfold)
    assert middle in set(result.cut_edges.ravel().tolist())
    assert spread(mesh, result) <= 1e-9
    assert_exact_transitions(with_flat, result)
    assert_angles_met(with_flat, result)


def test_a_flat_cone_between_two_cuts() -> None:
    mesh = meshes.cube(4)
    middle = int(np.argmin(np.linalg.norm(mesh.positions - [0.5, 0, 0], axis=1)))  # on an edge of the cube
    with_flat = mesh._replace(cones=np.append(mesh.cones, middle).astype(np.int32))
    result = unwrap(with_flat, [1.5 * PI] * 8 + [2 * PI])
    assert spread(mesh, result) <= 1e-9
    assert_exact_transitions(with_flat, result)


@pytest.mark.parametrize("degrees", [0.5, 0.1, 0.01])
def test_weak_cones_on_a_torus(degrees: float) -> None:
    """Where no rotation is clear, about cones or handles, the transitions are no less exact."""
    for count in (2, 4, 8):
        cones = np.linspace(0, 180, count, endpoint=False).astype(np.int32)
        mesh = meshes.torus()._replace(cones=cones)
        result = unwrap(mesh, [2 * PI + (-1) ** i * np.radians(degrees) for i in range(count)])
        assert_exact_transitions(mesh, result)
        assert_angles_met(mesh, result)


def test_a_cone_of_two_turns() -> None:
    """4 pi, the same rotation as a flat vertex: only the metric tells them apart, so the Poisson map must."""
    mesh = meshes.icosphere(3)
    center = mesh.positions[mesh.triangles[mesh.triangles.min(axis=1) > 100][0]].mean(axis=0)
    saddle = int(np.argmin(np.linalg.norm(mesh.positions - center, axis=1)))
    mesh = mesh._replace(cones=np.append(mesh.cones, saddle).astype(np.int32))
    result = unwrap(mesh, [1.5 * PI] * 12 + [4 * PI])
    assert_exact_transitions(mesh, result)
    assert oracle.similarity_gap(solve_again(mesh, result).corner_uv, result.corner_uv) <= 1e-7


def test_a_cone_of_negative_curvature() -> None:
    mesh = meshes.cube(6)
    middle = int(np.argmin(np.linalg.norm(mesh.positions - [0.5, 0.5, 0], axis=1)))
    mesh = mesh._replace(cones=np.append(mesh.cones, middle).astype(np.int32))
    near = np.linalg.norm(mesh.positions[mesh.cones[:8]] - mesh.positions[middle], axis=1)
    angles = [*np.where(near < 1, 1.375 * PI, 1.5 * PI).tolist(), 2.5 * PI]
    result = unwrap(mesh, angles)
    assert result.cone_angles == pytest.approx(angles, abs=1e-12)
    assert_exact_transitions(mesh, result)
    assert_angles_met(mesh, result)


def test_every_vertex_a_cone() -> None:
    mesh = meshes.icosphere(1)
    mesh = mesh._replace(cones=np.arange(len(mesh.positions), dtype=np.int32))
    result = unwrap(mesh)
    assert len(result.cut_edges) == len(mesh.positions) - 1
    assert_exact_transitions(mesh, result)
    assert_angles_met(mesh, result)


def test_cones_one_edge_apart() -> None:
    mesh = meshes.bumpy_sphere(2)
    neighbors = np.unique(mesh.triangles[(mesh.triangles == 0).any(axis=1)])[:2]
    mesh = mesh._replace(cones=np.unique(np.append(mesh.cones, neighbors)).astype(np.int32))
    result = unwrap(mesh)
    assert_exact_transitions(mesh, result)


# --- where the spectral way ends --------------------------------------------------------------------------------------


def test_spectral_on_a_boundary_says_that_it_is_not_and_solves() -> None:
    mesh = meshes.hill()
    result = unwrap(mesh, unfold="spectral")
    only(result.warnings, "SPECTRAL_NEEDS_CLOSED")
    assert oracle.metric_gap(result.corner_uv, unwrap(mesh).corner_uv) <= 1e-9


def test_dirichlet_normalized_lambdas_are_shares_of_non_conformality() -> None:
    """The oracle's own two eigensolvers agree, and the library's map has the smallest share there is."""
    mesh = meshes.bumpy_sphere(2)
    result = unwrap(mesh, unfold="spectral")
    cut = result.cut_edges
    sparse = oracle.unfold(mesh.positions, mesh.triangles, result.cones, result.cone_angles, cut, "spectral")
    dense = oracle.unfold(mesh.positions, mesh.triangles, result.cones, result.cone_angles, cut, "dense")
    assert sparse.lambdas[0] == pytest.approx(dense.lambdas[0], rel=1e-9)
    opened = oracle.cut_open(mesh.triangles, cut)
    conformal, dirichlet = oracle.energies(mesh.positions, mesh.triangles, opened)
    z = np.empty(opened.count, complex)
    z[opened.corner.ravel()] = oracle.as_complex(result.corner_uv).ravel()
    share = (z.conj() @ (conformal @ z)).real / (z.conj() @ (dirichlet @ z)).real
    assert share == pytest.approx(dense.lambdas[0], rel=1e-7)


# --- the paper's comparison -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["bumpy sphere", "flower", "hill", "saddle, no cut"])
def test_lscm_is_the_least_squares_conformal_map_of_the_same_cuts(name: str) -> None:
    mesh = {**CLOSED, **OPEN}[name]
    result = unwrap(mesh, method="lscm")
    assert pairs(result.cut_edges) == pairs(lsgp.find_cuts(surface(mesh), mesh.cones).edges)
    opened = oracle.cut_open(mesh.triangles, result.cut_edges)
    z = np.empty(opened.count, complex)
    z[opened.corner.ravel()] = oracle.as_complex(result.corner_uv).ravel()
    conformal, dirichlet = oracle.energies(mesh.positions, mesh.triangles, opened)
    # The gradient of the energy vanishes everywhere but at the two pins, whichever they are.
    force = np.abs(conformal @ z) / np.abs(dirichlet @ z - conformal @ z).max()
    pins = np.argsort(force)[-2:]
    assert np.sort(force)[-3] <= 1e-9 < force[pins].min()
    solved = oracle.lscm_unfold(mesh.positions, mesh.triangles, opened, pins, z[pins])
    assert np.abs(oracle.as_uv(solved) - result.corner_uv).max() <= 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_rounding_does_not_decide_whether_lscm_unfolds_a_large_surface_exactly(seed: int) -> None:
    """Its system is singular but for rounding, which grows with the surface."""
    mesh = meshes.cube(58)
    units = np.random.default_rng(seed).integers(-1, 2, mesh.positions.shape)
    found = unwrap(mesh._replace(positions=mesh.positions + units * np.spacing(np.abs(mesh.positions))), method="lscm")
    assert found.distortion.l2_stretch == pytest.approx(1, abs=1e-6)


def test_lscm_leaves_sisters_of_different_length() -> None:
    """What the transitions are for: without them the two sides of a cut do not fit."""
    mesh = meshes.bumpy_sphere(2)
    assert unwrap(mesh, method="lscm").seams.sister_ratio_max > 1.01
    assert codes(unwrap(mesh).warnings) == []
