# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise at the scale of triangles makes neither creases nor cones; the shape below it has those of the clean one."""

from __future__ import annotations

import itertools

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface
from meshes import Mesh
from zoo import closed


def noisy(mesh: Mesh, amount: float, seed: int = 0) -> Mesh:
    """Vertices moved along their normals, by a normal distribution whose deviation is a share of the mean edge."""
    corners = mesh.positions[mesh.triangles]
    normal = np.zeros_like(mesh.positions)
    for c in range(3):
        np.add.at(normal, mesh.triangles[:, c], np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    edge = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1).mean()
    moves = np.random.default_rng(seed).normal(0, amount * edge, (len(normal), 1))
    return mesh._replace(positions=mesh.positions + moves * normal)


@pytest.mark.parametrize("amount", [0.1, 0.2, 0.3])
def test_creases_of_a_noisy_cube_are_those_of_the_cube(amount: float) -> None:
    mesh = meshes.cube(16)
    edges = lsgp.crease_borders(surface(noisy(mesh, amount)))
    least, most = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    to_sides = np.minimum(most - mesh.positions, mesh.positions - least) / (most - least)
    from_edge = np.sort(to_sides, axis=1)[:, 1]  # 0 on the cube's edges, where two sides meet
    assert len(edges) > 0
    assert (from_edge[edges] < 1.5 / 16).mean() > 0.9


@pytest.mark.parametrize("amount", [0.2, 0.3, 0.5])
def test_a_noisy_ball_takes_as_many_cones_as_a_smooth_one(amount: float) -> None:
    ball = meshes.icosphere(4)
    clean = lsgp.auto_unwrap(surface(ball), preset="paint")
    found = lsgp.auto_unwrap(surface(noisy(ball, amount)), preset="paint")
    assert abs(len(found.cones) - len(clean.cones)) <= 2


@pytest.mark.parametrize("amount", [0.2, 0.5, 1.0])
def test_noisy_terrain_takes_no_cones(amount: float) -> None:
    terrain = noisy(meshes.grid(40, 40), amount)
    found = lsgp.auto_unwrap(surface(terrain), preset="paint")
    assert len(found.cones) == 0
    assert len(np.unique(found.island)) == 1
    assert len(found.flipped) == len(found.overlapping) == 0


def test_hard_shapes_whose_corners_cancel_are_no_noise() -> None:
    gear = closed.gear(60, 0.3, 4)
    assert len(gear.triangles) > 500
    edges = lsgp.crease_borders(surface(gear))
    corners = gear.positions[gear.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    beside = {tuple(sorted(edge)): [] for edge in edges.tolist()}
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    for triangle, direction in zip(gear.triangles.tolist(), normal, strict=True):
        for edge in itertools.combinations(sorted(triangle), 2):
            beside.get(edge, []).append(direction)
    assert len(edges) > 0
    assert all(first @ second < 0.9 for first, second in beside.values())
