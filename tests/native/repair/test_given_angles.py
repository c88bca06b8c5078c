# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles far from those of least distortion are reached, where no direct map of them is valid."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes, only, surface
from meshes import Mesh
from result_check import undeclared_faults

QUARTER = np.pi / 2


def inner_vertices(mesh: Mesh) -> np.ndarray:
    border = {v for loop in oracle.boundary_loops(mesh.triangles) for v in loop}
    return np.array([v for v in range(len(mesh.positions)) if v not in border])


def drawn_angles(mesh: Mesh, count: int, seed: int) -> dict[int, float]:
    """Quarter to nine quarter turns at random vertices; the sum is that of Gauss-Bonnet on closed surfaces."""
    rng = np.random.default_rng(seed)
    inner = inner_vertices(mesh)
    cones = rng.choice(inner, count, replace=False)
    quarters = rng.integers(1, 10, count)
    while len(inner) == len(mesh.positions) and (4 - quarters).sum() != 4 * oracle.euler_of(mesh.triangles):
        i = rng.integers(count)
        quarters[i] = np.clip(quarters[i] + np.sign((4 - quarters).sum() - 4 * oracle.euler_of(mesh.triangles)), 1, 9)
    return dict(zip(cones.tolist(), (quarters * QUARTER).tolist(), strict=True))


def with_needles(mesh: Mesh, seed: int) -> Mesh:
    """Twenty edges, no two of which touch, are shortened to half a percent."""
    edges = meshes.edges_of(mesh.triangles)
    positions = mesh.positions.copy()
    moved: set[int] = set()
    for a, b in np.random.default_rng(seed).permutation(edges).tolist():
        if len(moved) < 40 and not moved & {a, b}:
            moved |= {a, b}
            positions[a] = positions[b] + 0.005 * (positions[a] - positions[b])
    return meshes.make(positions, mesh.triangles)


def assert_valid_with(mesh: Mesh, asked: dict[int, float]) -> None:
    result = lsgp.parameterize(surface(mesh), list(asked), list(asked.values()))
    assert len(result.flipped) == len(result.wrong_angle_sums) == 0
    assert "ANGLES_ADJUSTED" not in codes(result.warnings)
    assert undeclared_faults(surface(mesh), result, given=asked) == []


CLOSED = {"ball": meshes.bumpy_sphere(2), "ring": meshes.torus(12, 8), "flower": meshes.flower(2)}
HOLES = meshes.disk_with_holes(8, 2)
HILL = meshes.hill(8)


@pytest.mark.parametrize(("name", "count", "seed"), [("ring", 24, 13), ("flower", 24, 7), ("flower", 24, 13)])
def test_angles_are_reached_where_lengths_differ_by_thousands(name: str, count: int, seed: int) -> None:
    assert_valid_with(CLOSED[name], drawn_angles(CLOSED[name], count, seed))


@pytest.mark.parametrize("seed", [4, 11])
def test_angles_are_reached_on_open_surfaces(seed: int) -> None:
    assert_valid_with(HILL, drawn_angles(HILL, 12 if seed == 4 else 24, seed))


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 6, 7, 13, 14])
def test_angles_are_reached_beside_holes_that_close_without_a_cut(seed: int) -> None:
    assert_valid_with(HOLES, drawn_angles(HOLES, 24 if seed % 2 else 12, seed))


@pytest.mark.parametrize("seed", range(2, 9))
def test_angles_are_reached_with_corners_on_the_boundary(seed: int) -> None:
    rim = oracle.boundary_loops(HILL.triangles)[0]
    assert_valid_with(HILL, drawn_angles(HILL, 16, seed) | {int(rim[3]): QUARTER, int(rim[12]): 3 * QUARTER})


@pytest.mark.parametrize(("needles", "seed"), [(1, 0), (1, 3), (2, 5)])
def test_angles_are_reached_across_needles(needles: int, seed: int) -> None:
    mesh = with_needles(CLOSED["flower"], needles)
    assert_valid_with(mesh, drawn_angles(mesh, 16, seed))


def test_adjusted_angles_are_named_with_those_of_corners() -> None:
    rim = oracle.boundary_loops(HILL.triangles)[0]
    asked = drawn_angles(HILL, 16, 14) | {int(rim[3]): QUARTER, int(rim[12]): 3 * QUARTER}
    result = lsgp.parameterize(surface(HILL), list(asked), list(asked.values()))
    assert len(result.flipped) == len(result.wrong_angle_sums) == 0
    assert set(only(result.warnings, "ANGLES_ADJUSTED").elements.indices.tolist()) == set(asked)
