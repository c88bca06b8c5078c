# SPDX-License-Identifier: GPL-3.0-or-later
"""Greedy placement: the next cone at the extremum of the log scale factor with y = 0 at the cones so far."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_curvature_adds_up, inner_vertices, surface, unwrap


def candidates(mesh: meshes.Mesh, cones: np.ndarray) -> np.ndarray:
    """Inner vertices more than two edges away from every cone: cones side by side would cancel each other."""
    near = np.isin(np.arange(len(mesh.positions)), cones)
    for _ in range(2):
        near[mesh.triangles[near[mesh.triangles].any(axis=1)]] = True
    return np.setdiff1d(inner_vertices(mesh), np.flatnonzero(near))


def log_scale_between(mesh: meshes.Mesh, cones: np.ndarray) -> np.ndarray:
    """y = 0 at the cones and the boundary, L y = -K elsewhere."""
    kappa = np.zeros(len(mesh.positions))
    loops = oracle.boundary_loops(mesh.triangles)
    if len(cones) == 0 and not loops:
        return oracle.solve_scale(mesh.positions, mesh.triangles, kappa)
    angles = oracle.harmonic_angles(mesh.positions, mesh.triangles, cones)
    kappa[cones] = oracle.TURN - angles
    y = oracle.solve_scale(mesh.positions, mesh.triangles, kappa)
    return y - y[cones[0] if len(cones) else loops[0][0]]


@pytest.mark.parametrize(
    "mesh", [meshes.bumpy_sphere(3), meshes.flower(3), meshes.hill(12)], ids=["bumpy", "flower", "hill"]
)
def test_each_cone_is_at_the_extremum_left_by_those_before(mesh: meshes.Mesh) -> None:
    cones = lsgp.place_cones(surface(mesh), count=9).cones
    assert cones.dtype == np.int32 and len(set(cones.tolist())) == 9
    start = 0 if oracle.boundary_loops(mesh.triangles) else 2  # a closed surface has to begin somewhere
    for k in range(start, 9):
        y = np.abs(log_scale_between(mesh, cones[:k]))
        assert cones[k] in candidates(mesh, cones[:k])
        assert y[cones[k]] >= y[candidates(mesh, cones[:k])].max() * (1 - 1e-9)


def test_existing_cones_come_first_and_are_kept() -> None:
    mesh = meshes.bumpy_sphere(3)
    existing = np.array([500, 7, 33], np.int32)
    cones = lsgp.place_cones(surface(mesh), existing, count=6).cones
    assert cones[:3].tolist() == existing.tolist()
    assert len(cones) == 6 and len(set(cones.tolist())) == 6
    y = np.abs(log_scale_between(mesh, cones[:5]))
    assert y[cones[5]] >= y[candidates(mesh, cones[:5])].max() * (1 - 1e-9)


def test_more_cones_distort_less() -> None:
    mesh = meshes.bumpy_sphere(3)
    predicted = [
        lsgp.prescribe_curvature(surface(mesh), lsgp.place_cones(surface(mesh), count=n).cones).predicted_l2
        for n in (4, 8, 16, 32)
    ]
    assert predicted[0] > predicted[1] > predicted[2] > predicted[3]


@pytest.mark.parametrize("mesh", [meshes.bumpy_sphere(4), meshes.flower(4)], ids=["bumpy", "flower"])
def test_automatic_number_brings_the_stretch_near_one(mesh: meshes.Mesh) -> None:
    cones = lsgp.place_cones(surface(mesh)).cones
    assert 3 <= len(cones) <= 60
    found = lsgp.prescribe_curvature(surface(mesh), cones)
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.predicted_l2 <= 1.06


def test_a_nearly_flat_disk_needs_none() -> None:
    assert len(lsgp.place_cones(surface(meshes.saddle(8, 0.01))).cones) == 0


def test_every_component_gets_its_own() -> None:
    mesh = meshes.merge([meshes.bumpy_sphere(2), meshes.flower(2)])
    cones = lsgp.place_cones(surface(mesh), count=5).cones
    first = len(meshes.bumpy_sphere(2).positions)
    assert (cones < first).sum() == 5 and (cones >= first).sum() == 5


def test_placed_cones_unwrap() -> None:
    mesh = meshes.bumpy_sphere(4)
    mesh = mesh._replace(cones=lsgp.place_cones(surface(mesh), count=12).cones)
    result = unwrap(mesh)
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0


def test_the_corners_of_a_cube_are_found() -> None:
    mesh = meshes.cube(6)
    assert set(mesh.cones.tolist()) <= set(lsgp.place_cones(surface(mesh), count=14).cones.tolist())


def test_twice_the_same() -> None:
    mesh = meshes.icosphere(3)
    assert (
        lsgp.place_cones(surface(mesh), count=7).cones.tolist()
        == lsgp.place_cones(surface(mesh), count=7).cones.tolist()
    )
