# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic cones on real meshes: as few as promised, as little stretch as predicted, without any settings."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from extremities import body_with_limbs, distances_to_cones, extremities, largest_component, with_cones_at
from map_checks import surface
from meshes import Mesh
from nightly import nightly, some_nightly
from placement_checks import place
from sanitized_run import many_solves
from shared_meshes import shared_mesh

FEWEST = {
    "fandisk": 8,
    "octa-flower": 6,
    "igea-16k": 8,
    "max-planck-25k": 9,
    "bird": 15,
    "hand-5k": 28,
    "kitten-genus1": 14,
    "camel-head-disk": 12,
    "julius": 4,
}
AT_COUNT = {
    "fandisk": (25, 1.006),
    "igea-16k": (14, 1.012),
    "max-planck-25k": (14, 1.022),
    "bird": (25, 1.008),
    "hand-5k": (25, 1.02),
}
CLOSED = [
    "cube-768",
    "octa-flower",
    "igea-16k",
    "max-planck-25k",
    "fandisk",
    "bird",
    "hand-5k",
    "kitten-genus1",
    "eight-genus2",
    "elephant-genus3",
]


def unwrapped(mesh: Mesh, placed: lsgp.Placement, **options: object) -> lsgp.Result:
    result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles, lsgp.Options(**options))
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    return result


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", some_nightly(FEWEST, "julius", "igea-16k"))
def test_few_cones_reach_the_target_and_the_map_keeps_it(name: str) -> None:
    mesh = shared_mesh(name)
    placed = place(mesh)
    assert placed.reached and placed.predicted_l2 <= 1.05
    assert len(placed.cones) <= FEWEST[name]
    assert unwrapped(mesh, placed).distortion.l2_stretch == pytest.approx(placed.predicted_l2, rel=0.03)
    assert placed.factorizations == 1


@pytest.mark.many_solves
@pytest.mark.parametrize("name", some_nightly(AT_COUNT, "igea-16k", "max-planck-25k"))
def test_stretch_at_a_count(name: str) -> None:
    mesh = shared_mesh(name)
    count, most = AT_COUNT[name]
    placed = place(mesh, count=count)
    assert len(placed.cones) == count and placed.back_substitutions <= 800
    assert unwrapped(mesh, placed).distortion.l2_stretch <= most


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", some_nightly(CLOSED, "igea-16k", "max-planck-25k", "elephant-genus3"))
def test_as_good_as_other_cones_of_the_same_number(name: str) -> None:
    mesh = shared_mesh(name)
    other = lsgp.parameterize(surface(mesh), mesh.cones).distortion.l2_stretch
    assert unwrapped(mesh, place(mesh, count=len(mesh.cones))).distortion.l2_stretch <= other + 1e-3


@pytest.mark.parametrize(("length", "sharpness"), [(1, 10), (1.5, 20)])
@pytest.mark.parametrize("count", [3, *many_solves(5, 7)])
def test_limbs_get_cones_at_their_tips(count: int, length: float, sharpness: float) -> None:
    for seed in range(3):
        mesh, tips = body_with_limbs(count, length, sharpness, seed)
        cones = place(mesh).cones
        edges = meshes.edges_of(mesh.triangles)
        for tip in tips.tolist():
            near = np.append(edges[(edges == tip).any(axis=1)], tip)  # and its neighbors
            assert np.isin(near, cones).any()


@pytest.mark.many_solves
@pytest.mark.parametrize("name", ["hand-5k", "bird", *nightly("igea-16k"), "suzanne-messy"])
def test_cones_are_as_near_to_extremities_as_serves(name: str) -> None:
    """Within two or three edges of each; at the extremities themselves they would stretch no less."""
    mesh = largest_component(shared_mesh(name))
    placed, tips = place(mesh, count=14), extremities(mesh)
    assert (distances_to_cones(mesh, tips, placed).min(axis=1) <= 3).all()
    assert with_cones_at(mesh, tips, placed).mapped_l2 >= placed.mapped_l2


@pytest.mark.many_solves
def test_rounded_angles_and_places_are_chosen_together() -> None:
    mesh = shared_mesh("fandisk")
    placed = place(mesh, count=25, lattice="square")
    turns = placed.cone_angles / (np.pi / 2)
    assert turns == pytest.approx(turns.round(), abs=1e-9)
    assert placed.predicted_l2 <= 1.03
    result = unwrapped(mesh, placed, seamless=lsgp.Seamless("square", tiles=64))
    assert result.distortion.l2_stretch <= 1.03 and result.seamless.error == 0
    assert result.cone_angles == pytest.approx(placed.cone_angles, abs=1e-9)


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", ["suzanne-messy", "camel-head-disk", "teapot-messy", "rabbit", *nightly("julius")])
def test_an_artist_gets_a_usable_map_without_any_choice(name: str) -> None:
    """From the file to the map: automatic cones, default options."""
    mesh = shared_mesh(name)
    result = unwrapped(mesh, place(mesh))
    assert result.solved.all() and result.distortion.l2_stretch <= 1.15


def bent_torus(around: int, along: int) -> Mesh:
    mesh = meshes.torus(around, along)
    x, y, z = mesh.positions.T
    bump = np.sin(1.3 * x + 0.7) * np.cos(1.1 * y - 0.3) + 0.5 * np.sin(2.1 * z + 0.6 * x)
    return mesh._replace(positions=mesh.positions * (1 + 0.25 * bump)[:, None])


def test_cones_chosen_on_a_coarse_triangulation_are_as_good() -> None:
    """Cones of so large a surface are: those of a coarse mesh of the same shape are chosen on the surface itself."""
    few, many = bent_torus(60, 32), bent_torus(290, 140)
    exact, placed = place(few, count=8), place(many, count=8)
    assert placed.mapped_l2 - 1 <= 1.05 * (exact.mapped_l2 - 1)
    assert placed.mapped_l2 == pytest.approx(placed.predicted_l2, rel=1e-3)
