# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of flipped triangles: none is left, what is far from them stays, and it costs no conformality."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_angles_met, assert_exact_transitions, codes, only, surface, unwrap
from meshes import Mesh
from nightly import some_nightly
from result_check import undeclared_faults
from sanitized_run import many_solves
from shared_meshes import shared_mesh


def uneven_angles(mesh: Mesh, seed: int) -> list[float]:
    """Of a sphere's cones: under Gauss-Bonnet, some sharp and some wide."""
    total = 2 * np.pi * (len(mesh.cones) - 2)
    return (total * np.random.default_rng(seed).dirichlet(np.full(len(mesh.cones), 3.0))).tolist()


# Spheres and seeds of angles whose first unfolding flips some triangles: few, and many.
FLIPPING = {
    "few": (meshes.bumpy_sphere(4), 16),
    "a dozen": (meshes.bumpy_sphere(4), 8),
    "many": (meshes.bumpy_sphere(3), 3),
    "petals": (meshes.flower(3), 6),
    "junctions": (meshes.forked(), 12),
}
every_case = pytest.mark.parametrize("name", FLIPPING)


@cache
def unwrapped(name: str, repair: bool) -> lsgp.Result:
    mesh, seed = FLIPPING[name]
    return unwrap(mesh, uneven_angles(mesh, seed), repair=repair)


def flipped(result: lsgp.Result) -> list[int]:
    return np.flatnonzero(oracle.signed_areas(result.corner_uv) <= 0).tolist()


def far_from(mesh: Mesh, triangles: list[int], rings: int) -> np.ndarray:
    """The triangles that no so many steps from vertex to vertex reach."""
    near = np.zeros(len(mesh.positions), bool)
    near[mesh.triangles[triangles]] = True
    for _ in range(rings):
        near[mesh.triangles[near[mesh.triangles].any(axis=1)]] = True
    return np.flatnonzero(~near[mesh.triangles].any(axis=1))


@every_case
def test_no_repair_returns_what_was_flipped_and_says_so(name: str) -> None:
    raw = unwrapped(name, repair=False)
    assert len(flipped(raw)) > 0 and raw.flipped.tolist() == flipped(raw)
    finding = only(raw.warnings, "FLIPPED_TRIANGLES")
    assert finding.elements.kind == "triangles" and finding.elements.indices.tolist() == flipped(raw)
    assert_exact_transitions(FLIPPING[name][0], raw)
    assert raw.repair.iterations == 0


def test_what_was_flipped_is_what_the_linear_solve_flips() -> None:
    mesh, seed = FLIPPING["few"]
    raw = unwrapped("few", repair=False)
    again = oracle.unfold(*mesh, uneven_angles(mesh, seed), raw.cut_edges)
    assert np.flatnonzero(oracle.signed_areas(again.corner_uv) <= 0).tolist() == flipped(raw)
    assert oracle.similarity_gap(again.corner_uv, raw.corner_uv) <= 1e-7


@every_case
def test_repair_leaves_no_flip_and_counts_those_there_were(name: str) -> None:
    mesh, _ = FLIPPING[name]
    raw, repaired = unwrapped(name, repair=False), unwrapped(name, repair=True)
    assert_angles_met(mesh, repaired)
    assert_exact_transitions(mesh, repaired)
    assert "FLIPPED_TRIANGLES" not in codes(repaired.warnings)
    for result in (raw, repaired):
        assert result.repair.flipped_before == len(flipped(raw))
        assert result.repair.wrong_angle_sums_before == len(raw.wrong_angle_sums)


def test_a_map_without_flips_is_not_touched() -> None:
    mesh = meshes.bumpy_sphere(3)
    one, two = unwrap(mesh), unwrap(mesh, repair=False)
    assert np.array_equal(one.corner_uv, two.corner_uv)
    assert one.repair == lsgp.RepairReport(flipped_before=0, wrong_angle_sums_before=0, iterations=0)


def test_far_from_few_flips_nothing_moves() -> None:
    mesh, _ = FLIPPING["few"]
    raw, repaired = unwrapped("few", repair=False), unwrapped("few", repair=True)
    assert repaired.repair.iterations > 0
    far = far_from(mesh, flipped(raw), 20)
    assert len(far) > 0.5 * len(mesh.triangles)
    assert oracle.similarity_gap(raw.corner_uv[far], repaired.corner_uv[far]) <= 1e-12
    near = np.setdiff1d(np.arange(len(mesh.triangles)), far)
    assert oracle.similarity_gap(raw.corner_uv[near], repaired.corner_uv[near]) > 1e-6


@pytest.mark.parametrize("name", ["hand-5k", *many_solves("igea-16k", "max-planck-25k")])
def test_far_from_flips_nothing_moves_on_real_meshes(name: str) -> None:
    mesh = shared_mesh(name)
    angles = unwrap(mesh).cone_angles.tolist()
    raw, repaired = unwrap(mesh, angles, repair=False), unwrap(mesh, angles)
    assert 0 < len(flipped(raw)) == repaired.repair.flipped_before
    assert flipped(repaired) == [] and repaired.wrong_angle_sums.size == 0
    far = far_from(mesh, flipped(raw), 20)
    assert len(far) > 0.1 * len(mesh.triangles)
    assert oracle.similarity_gap(raw.corner_uv[far], repaired.corner_uv[far]) <= 1e-12


# --- real meshes ------------------------------------------------------------------------------------------------------

CLOSED = (
    "cube-768",
    "octa-flower",
    "fandisk",
    "igea-16k",
    "max-planck-25k",
    "hand-5k",
    "bird",
    "kitten-genus1",
    "eight-genus2",
    "elephant-genus3",
)
OPEN = ("julius", "camel-head-disk")
WITHOUT_CONES = ("rabbit", "blobby-misoriented")


@cache
def own_cones(name: str) -> lsgp.Result:
    return unwrap(shared_mesh(name))


@pytest.mark.slow
@pytest.mark.many_solves
def test_conformality_is_that_of_spectral_maps() -> None:
    """On average over the closed meshes; a spectral map minimizes conformal energy and nothing else."""
    repaired = [own_cones(name).distortion.quasi_conformal for name in CLOSED]
    spectral = [
        unwrap(shared_mesh(name), unfold="spectral", repair=False).distortion.quasi_conformal for name in CLOSED
    ]
    assert np.mean(repaired) <= np.mean(spectral)


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_own_cones_give_a_valid_map(name: str) -> None:
    assert_valid(shared_mesh(name), own_cones(name))


@cache
def with_automatic_cones(name: str) -> Mesh:
    mesh = shared_mesh(name)
    return mesh._replace(cones=lsgp.place_cones(surface(mesh)).cones)


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
@pytest.mark.parametrize("name", some_nightly([*CLOSED, *OPEN, *WITHOUT_CONES], "elephant-genus3", "julius", "rabbit"))
def test_automatic_cones_give_a_valid_map(name: str, mode: str) -> None:
    mesh = with_automatic_cones(name)
    assert_valid(mesh, unwrap(mesh, mode=mode))


def assert_valid(mesh: Mesh, result: lsgp.Result) -> None:
    assert result.solved.all()
    assert undeclared_faults(surface(mesh), result) == []
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    assert result.seams.sister_ratio_max - 1 <= 1e-9
