# SPDX-License-Identifier: GPL-3.0-or-later
"""Few triangles around many handles: maps of their own flat metrics, where repairs of positions leave vertices around
which a map winds once too often."""

from __future__ import annotations

import lsgp
import numpy as np
import pytest
from map_checks import surface
from meshes import Mesh
from result_check import undeclared_faults
from zoo.tunnels import ball_with_handles, tunneled_plate

SEEDS = range(5)
FAMILY = {
    "ball of genus 8": ball_with_handles(2, 8, 1),
    "ball of genus 10": ball_with_handles(2, 10, 1),
    "plate of genus 9": tunneled_plate(3, 3, 1),
}


def drawn_cones(mesh: Mesh, seed: int) -> list[int]:
    rng = np.random.default_rng(seed)
    return rng.choice(len(mesh.positions), rng.integers(8, 36), replace=False).tolist()


def angle_sums(mesh: Mesh, result: lsgp.Result) -> np.ndarray:
    """Around every vertex, of upright triangles."""
    z = result.corner_uv @ [1, 1j]
    angles = np.angle((np.roll(z, 1, axis=1) - z) * (np.roll(z, -1, axis=1) - z).conj())
    return np.bincount(mesh.triangles.ravel(), angles.ravel())


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.many_solves] if name == "ball of genus 8" else []) for name in FAMILY],
)
def test_random_cones_on_coarse_surfaces_with_many_handles_have_a_map(name: str) -> None:
    mesh = FAMILY[name]
    for seed in SEEDS:
        cones = drawn_cones(mesh, seed)
        result = lsgp.parameterize(surface(mesh), cones)
        assert len(result.flipped) == len(result.wrong_angle_sums) == 0
        others = np.setdiff1d(np.arange(len(mesh.positions)), cones)
        assert np.abs(angle_sums(mesh, result)[others] - 2 * np.pi).max() < 1e-6
        assert undeclared_faults(surface(mesh), result) == []


def test_given_angles_on_such_a_surface_are_imposed() -> None:
    """Those of a map with automatic angles, a tenth of the way to angles that are all alike."""
    mesh = FAMILY["ball of genus 8"]
    for seed in SEEDS:
        cones = drawn_cones(mesh, seed)
        automatic = angle_sums(mesh, lsgp.parameterize(surface(mesh), cones))[cones]
        given = 0.9 * automatic + 0.1 * automatic.mean()
        result = lsgp.parameterize(surface(mesh), cones, given.tolist())
        assert len(result.flipped) == len(result.wrong_angle_sums) == 0
        assert np.abs(angle_sums(mesh, result)[cones] - given).max() < 1e-6
