# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric cones on surfaces that are their own mirror image."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import assert_curvature_adds_up, codes, only, surface
from meshes import Mesh, make
from placement_checks import place


def two_horned(levels: int = 3) -> Mesh:
    """A ball with two horns and a snout, its own mirror image in x = 0 and in no other plane."""
    ball = meshes.icosphere(levels)
    p = ball.positions
    horn = np.exp(-6 * ((np.abs(p[:, 0]) - 0.6) ** 2 + (p[:, 1] - 0.7) ** 2 + (p[:, 2] - 0.2) ** 2))
    snout = np.exp(-5 * (p[:, 0] ** 2 + (p[:, 1] + 0.3) ** 2 + (p[:, 2] - 0.9) ** 2))
    return make(p * (1 + 0.9 * horn + 0.7 * snout)[:, None], ball.triangles)


def images_in_x(mesh: Mesh) -> np.ndarray:
    """The vertex at each vertex's mirror image in x = 0."""
    keys = {tuple(row): v for v, row in enumerate(np.round(mesh.positions, 9) + 0.0)}
    return np.array([keys[tuple(row)] for row in np.round(mesh.positions * [-1, 1, 1], 9) + 0.0])


MESH = two_horned()
IMAGE = images_in_x(MESH)


def assert_symmetric(placed: lsgp.Placement) -> None:
    angle = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True))
    assert {int(IMAGE[v]) for v in angle} == set(angle)
    assert all(angle[int(IMAGE[v])] == pytest.approx(a, abs=1e-12) for v, a in angle.items())
    assert placed.log_scale == pytest.approx(placed.log_scale[IMAGE], abs=1e-9)
    assert_curvature_adds_up(MESH, placed.cones, placed.cone_angles)


@pytest.mark.parametrize("options", [{}, {"count": 8}, {"count": 11}, {"prefer_sharp": True}])
@pytest.mark.parametrize("mirror", [None, ([0, 3, 1], [-2, 0, 0])])
def test_cones_and_angles_mirror_each_other(options: dict[str, object], mirror: object) -> None:
    placed = place(MESH, symmetric=True, mirror=mirror, **options)
    assert_symmetric(placed)
    assert "NOT_SYMMETRIC" not in codes(placed.warnings)
    assert len(placed.cones) in (options.get("count", len(placed.cones)), options.get("count", 0) - 1)


def test_the_map_is_symmetric() -> None:
    placed = place(MESH, symmetric=True)
    uv = lsgp.parameterize(surface(MESH), placed.cones, placed.cone_angles).corner_uv
    lengths = np.linalg.norm(uv - uv[:, [1, 2, 0]], axis=2) / np.sqrt(np.ptp(uv.reshape(-1, 2), axis=0).prod())
    edges = {frozenset(e): length for e, length in zip(
        np.stack([MESH.triangles, MESH.triangles[:, [1, 2, 0]]], axis=2).reshape(-1, 2).tolist(),
        lengths.ravel(), strict=True)}  # fmt: skip
    gap = max(abs(edges[frozenset((int(IMAGE[a]), int(IMAGE[b])))] - length) for (a, b), length in edges.items())
    assert gap <= 1e-6


def test_little_is_lost() -> None:
    free, symmetric = place(MESH, count=10), place(MESH, count=10, symmetric=True)
    assert symmetric.predicted_l2 - 1 <= 2 * (free.predicted_l2 - 1)


def test_existing_cones_get_their_image() -> None:
    v = int(np.argmax(MESH.positions[:, 0]))
    placed = place(MESH, [v], [5.0], count=9, symmetric=True)
    assert placed.cones[0] == v and IMAGE[v] in placed.cones
    assert_symmetric(placed)
    assert placed.cone_angles[placed.cones.tolist().index(int(IMAGE[v]))] == 5.0


def test_without_symmetry_it_says_so_and_places_as_usual() -> None:
    mesh = meshes.bumpy_sphere(3)
    placed = place(mesh, count=9, symmetric=True)
    assert codes(placed.warnings) == ["NOT_SYMMETRIC"]
    assert placed.cones.tolist() == place(mesh, count=9).cones.tolist()
    wrong = place(MESH, count=9, symmetric=True, mirror=([0, 0, 0], [0, 1, 0]))
    assert codes(wrong.warnings) == ["NOT_SYMMETRIC"]


def test_one_finding_names_all_components_without_symmetry() -> None:
    odd, even = meshes.bumpy_sphere(2), meshes.icosphere(2)
    placed = place(meshes.merge([odd, even, odd]), count=4, symmetric=True)
    finding = only(placed.warnings, "NOT_SYMMETRIC")
    assert finding.message.startswith("2 components are not their own mirror images in any plane that was tried; their")
    count = len(odd.triangles)
    triangles = np.arange(3 * count)
    assert finding.elements.indices.tolist() == triangles[triangles // count != 1].tolist()
