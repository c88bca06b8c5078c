# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric cones on surfaces that are their own mirror image."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
import zoo
from map_checks import assert_curvature_adds_up, codes, only, surface
from meshes import Mesh, make
from placement_checks import place


def images_in_x(mesh: Mesh) -> np.ndarray:
    """The vertex at each vertex's mirror image in x = 0."""
    keys = {tuple(row): v for v, row in enumerate(np.round(mesh.positions, 9) + 0.0)}
    return np.array([keys[tuple(row)] for row in np.round(mesh.positions * [-1, 1, 1], 9) + 0.0])


MESH = meshes.two_horned()
IMAGE = images_in_x(MESH)


def is_its_image(cones: np.ndarray) -> bool:
    return {int(IMAGE[v]) for v in cones} == set(cones.tolist())


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


def assert_nearly_symmetric(positions: np.ndarray, placed: lsgp.Placement, within: float) -> None:
    """Each cone has one of the same angle near its image in x = 0."""
    assert "NOT_SYMMETRIC" not in codes(placed.warnings)
    cones = positions[placed.cones]
    apart = np.linalg.norm(cones[:, None] * [-1, 1, 1] - cones[None], axis=2)
    image = apart.argmin(axis=1)
    assert apart.min(axis=1).max() <= within
    assert image[image].tolist() == list(range(len(cones)))
    assert placed.cone_angles[image] == pytest.approx(placed.cone_angles, abs=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_noise_and_other_triangles_on_either_side_leave_it_symmetric(tilt: float) -> None:
    mesh = meshes.two_horned(turn=0.7)
    extent = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    noise = np.random.default_rng(3).uniform(-0.005, 0.005, mesh.positions.shape) * extent
    tilted = meshes.rotation([3, 1, -2], tilt)
    placed = place(make((mesh.positions + noise) @ tilted.T, mesh.triangles), count=12, symmetric=True)
    edge = np.linalg.norm(mesh.positions[mesh.triangles] - mesh.positions[mesh.triangles[:, [1, 2, 0]]], axis=2).mean()
    assert len(placed.cones) >= 11
    assert_nearly_symmetric(mesh.positions, placed, 0.75 * edge)


def mirrored(mesh: Mesh) -> Mesh:
    return make(mesh.positions * [-1, 1, 1], mesh.triangles[:, ::-1])


@pytest.mark.parametrize("count", [None, 7])
def test_parts_that_mirror_each_other_get_mirrored_cones(count: int | None) -> None:
    odd = meshes.bumpy_sphere(2)
    both = meshes.merge([odd, meshes.renumber(mirrored(odd), 5)[0]])
    placed = place(both, count=count, symmetric=True)
    assert len(placed.cones) == 2 * np.sum(placed.cones < len(odd.positions)) > 0
    middle = (both.positions.min(axis=0) + both.positions.max(axis=0)) / 2
    assert_nearly_symmetric(both.positions - middle * [1, 0, 0], placed, 1e-9)


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


def test_the_first_press_is_symmetric_unless_that_is_turned_off_or_cones_are_given() -> None:
    given = surface(MESH)
    usual = lsgp.auto_unwrap(given, symmetric=False).cones
    symmetric = lsgp.auto_unwrap(given).cones
    assert is_its_image(symmetric) and not is_its_image(usual)
    counted = lsgp.auto_unwrap(given, count=len(usual)).cones
    assert len(counted) == len(usual)
    v = int(usual[0])
    assert lsgp.auto_unwrap(given, [v]) == lsgp.auto_unwrap(given, [v], symmetric=False)


@pytest.mark.slow
def test_of_several_components_each_has_the_cones_that_cost_least() -> None:
    """Alone the box with handles takes many symmetric cones."""
    box, horned = zoo.member("box-with-handles-cells=5-handles=1-seed=0").mesh(), meshes.two_horned(3)
    result = lsgp.auto_unwrap(surface(meshes.merge([box, horned])), creases=False)
    made = [choice for choice in result.choices if choice.cost is not None and "cones" in choice.name]
    assert [choice for choice in made if choice.is_best][-1].cost == min(choice.cost for choice in made)
    first = len(box.positions)
    of_horned = {int(cone) - first for cone in result.cones if cone >= first}
    image = images_in_x(horned)
    assert {int(image[cone]) for cone in of_horned} == of_horned


def test_where_nothing_is_symmetric_the_first_press_says_nothing_of_it() -> None:
    given = surface(meshes.bumpy_sphere(2))
    assert lsgp.auto_unwrap(given) == lsgp.auto_unwrap(given, symmetric=False)


def test_symmetry_is_obeyed_as_it_is_weighed() -> None:
    """Without weight the stretch, islands, cuts and square alone decide; with much of it nothing else does."""
    given = surface(MESH)
    costs = {}
    for weight in (0.0, 100.0):
        result = lsgp.auto_unwrap(given, weights=lsgp.Weights(symmetry=weight))
        made = [choice for choice in result.choices if choice.cost is not None and "cones" in choice.name]
        costs[weight] = {choice.name: choice.cost for choice in made}
        best = [choice for choice in made if choice.is_best][-1]
        assert best.cost == min(choice.cost for choice in made)
    assert list(costs[100.0]) == ["symmetric cones and cuts"]
    assert len(costs[0.0]) > 1
