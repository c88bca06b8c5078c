# SPDX-License-Identifier: GPL-3.0-or-later
"""Automatic cones: where they are, what angles they have, and that maps come out as predicted."""

from __future__ import annotations

import re

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_curvature_adds_up, codes, inner_vertices, only, surface
from meshes import Mesh
from nightly import nightly
from placement_checks import (
    SHARE,
    TURN,
    USUAL_REACH,
    curvature_of,
    dense_model,
    imposed_scale,
    middle_l2,
    open_vertices,
    place,
    strength,
)
from zoo.tunnels import tunneled_plate

PI = np.pi
MESHES = {
    "bumpy": meshes.bumpy_sphere(3),
    "flower": meshes.flower(3),
    "hill": meshes.hill(12),
    "torus": meshes.torus(24, 12),
    "two holes": meshes.subdivide(meshes.double_torus()),
    "holes": meshes.disk_with_holes(12, 2),
}
every_mesh = pytest.mark.parametrize("name", MESHES)


@every_mesh
def test_the_log_scale_is_that_of_the_angles(name: str) -> None:
    mesh = MESHES[name]
    placed = place(mesh, count=9)
    assert len(placed.cones) == len(set(placed.cones.tolist())) == 9
    assert placed.cones.dtype == np.int32 and np.isin(placed.cones, inner_vertices(mesh)).all()
    if name != "holes":  # whose borders are scaled so that the holes close without a cut
        assert placed.log_scale == pytest.approx(imposed_scale(mesh, placed), abs=1e-9)
    assert placed.predicted_l2 == pytest.approx(middle_l2(mesh, placed.log_scale), rel=1e-9)
    if not oracle.boundary_loops(mesh.triangles):
        assert_curvature_adds_up(mesh, placed.cones, placed.cone_angles)


@every_mesh
def test_curvatures_keep_their_bounds(name: str) -> None:
    mesh = MESHES[name]
    placed = place(mesh, target=1.02)
    assert placed.reached and placed.predicted_l2 <= 1.02
    assert strength(mesh, placed).max(initial=0) <= USUAL_REACH + 1e-9
    valence = np.bincount(mesh.triangles.ravel())[placed.cones]
    assert (placed.cone_angles <= SHARE * valence + 1e-9).all() and (placed.cone_angles >= 0.35 * TURN - 1e-9).all()


@every_mesh
def test_the_map_stretches_as_predicted(name: str) -> None:
    mesh = MESHES[name]
    placed = place(mesh)
    result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles)
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    assert result.distortion.l2_stretch == pytest.approx(placed.predicted_l2, rel=0.03)
    assert result.cone_angles == pytest.approx(placed.cone_angles, abs=1e-9)


@every_mesh
def test_the_prescription_predicts_the_same(name: str) -> None:
    mesh = MESHES[name]
    placed = place(mesh, count=8)
    found = lsgp.prescribe_curvature(surface(mesh), placed.cones, placed.cone_angles)
    assert found.predicted_l2 == pytest.approx(placed.predicted_l2, rel=1e-9)
    assert found.log_scale == pytest.approx(placed.log_scale, abs=1e-9)


@pytest.mark.parametrize("mesh", [meshes.bumpy_sphere(2), meshes.hill(14)], ids=["bumpy", "hill"])
def test_no_single_cone_has_a_much_better_place(mesh: Mesh) -> None:
    """Every cone taken out and put anywhere else, all curvatures chosen anew, by a dense model."""
    placed = place(mesh, count=12)
    model = dense_model(mesh)
    least, kappa = model.least(placed.cones)
    assert curvature_of(placed) == pytest.approx(kappa, abs=1e-6)  # no curvature is at a bound
    for cone in placed.cones:
        rest = np.setdiff1d(placed.cones, [cone])
        best = min(model.least(np.append(rest, v))[0] for v in open_vertices(mesh, rest))
        assert least <= 1.02 * best


def test_more_cones_distort_less() -> None:
    predicted = [place(MESHES["bumpy"], count=n).predicted_l2 for n in (4, 8, 16, 32)]
    assert predicted[0] > predicted[1] > predicted[2] > predicted[3]


@pytest.mark.parametrize("target", [1.02, 1.01])
def test_a_lower_target_takes_more_cones(target: float) -> None:
    mesh = MESHES["bumpy"]
    usual, better = place(mesh), place(mesh, target=target)
    assert better.reached and better.predicted_l2 <= target < usual.predicted_l2
    assert len(better.cones) > len(usual.cones)


@pytest.mark.parametrize("mesh", [meshes.saddle(8, 0.01), meshes.cylinder(), meshes.torus(30, 15, 5, 0.5)])
def test_zero_cones_where_none_is_needed(mesh: Mesh) -> None:
    placed = place(mesh)
    assert placed.reached and placed.cones.size == 0 and placed.cone_angles.size == 0


@pytest.mark.parametrize("count", [None, 8])
def test_a_cube_has_its_corners(count: int | None) -> None:
    mesh = meshes.cube(6)
    placed = place(mesh, count=count)
    assert sorted(placed.cones.tolist()) == sorted(mesh.cones.tolist())
    assert placed.cone_angles == pytest.approx(1.5 * PI, abs=1e-9)
    assert placed.predicted_l2 == pytest.approx(1, abs=1e-9)


def test_sharp_corners_are_preferred_on_request() -> None:
    mesh = meshes.subdivide(meshes.subdivide(meshes.icosahedron()))
    defects = np.abs(oracle.angle_defects(mesh.positions, mesh.triangles))
    smooth, sharp = place(mesh, count=6), place(mesh, count=6, prefer_sharp=True)
    assert (defects[sharp.cones] > 1).all() and not (defects[smooth.cones] > 1).all()
    assert smooth.predicted_l2 < sharp.predicted_l2 < smooth.predicted_l2 + 0.03


def test_existing_cones_come_first_and_given_angles_stay() -> None:
    mesh = MESHES["bumpy"]
    existing, angles = [500, 7, 33], [None, 5.0, None]
    placed = place(mesh, existing, angles, count=7)
    assert placed.cones[:3].tolist() == existing and placed.cone_angles[1] == 5.0
    assert len(placed.cones) == 7
    assert_curvature_adds_up(mesh, placed.cones, placed.cone_angles)
    automatic = place(mesh, existing, angles)
    assert automatic.reached and automatic.cones[:3].tolist() == existing and automatic.cone_angles[1] == 5.0


def test_enough_existing_cones_are_left_alone() -> None:
    mesh = MESHES["bumpy"]
    cones = place(mesh).cones
    again = place(mesh, cones)
    assert again.reached and again.cones.tolist() == cones.tolist()


@pytest.mark.parametrize("mesh", [MESHES["bumpy"], MESHES["flower"], meshes.two_horned(3)])
def test_existing_cones_get_angles_as_good_as_placed_ones(mesh: Mesh) -> None:
    placed = place(mesh, count=8)
    again = place(mesh, placed.cones, count=8)
    assert again.cones.tolist() == placed.cones.tolist()
    assert again.mapped_l2 == pytest.approx(placed.mapped_l2, rel=2e-3)


def test_existing_cones_on_a_border_prescribe_nothing_without_an_angle() -> None:
    mesh = MESHES["hill"]
    corner = int(oracle.boundary_loops(mesh.triangles)[0][0])
    free = place(mesh, [corner], count=3)
    assert corner not in free.cones.tolist() and "CONE_ON_BOUNDARY" in codes(free.warnings)
    square = place(mesh, [corner], [PI / 2], count=3)
    assert square.cones[0] == corner and square.cone_angles[0] == PI / 2


def test_every_component_gets_its_own() -> None:
    first = meshes.bumpy_sphere(2)
    placed = place(meshes.merge([first, meshes.flower(2)]), count=5)
    ours = placed.cones < len(first.positions)
    assert ours.sum() == (~ours).sum() == 5
    assert curvature_of(placed)[ours].sum() == pytest.approx(2 * TURN, abs=1e-9)
    assert placed.factorizations == 2


def test_no_cone_where_parts_meet() -> None:
    mesh, shared = meshes.bow_tie(4)
    assert shared not in place(mesh, count=4).cones.tolist()


def test_one_factorization_and_few_back_substitutions() -> None:
    placed = place(MESHES["bumpy"], count=12)
    assert placed.factorizations == 1
    tried = 5 * 12
    assert placed.back_substitutions <= 2 * 96 + 8 + 8 + 2 * (12 + tried)


def test_a_target_out_of_reach_is_told() -> None:
    mesh = meshes.bumpy_sphere(2)
    placed = place(mesh, target=1.000001)
    assert not placed.reached and len(placed.cones) <= max(57, len(mesh.positions) // 4)
    assert only(placed.warnings, "PLACEMENT_NOT_REACHED").elements.indices.tolist() == sorted(placed.cones.tolist())
    assert "PLACEMENT_NOT_REACHED" not in codes(place(mesh, count=4, target=1.000001).warnings)


@pytest.mark.parametrize(
    ("across", "along", "options"),
    [
        (5, 4, {}),
        (5, 4, {"lattice": "square"}),
        (10, 5, {}),
        *nightly((20, 10, {}), marks=[pytest.mark.many_solves]),
    ],
)
def test_the_number_of_cones_follows_the_genus(across: int, along: int, options: dict[str, str]) -> None:
    mesh = tunneled_plate(across, along, 1)
    placed = place(mesh, **options)
    assert placed.reached and placed.predicted_l2 <= 1.05 and not placed.warnings
    assert_curvature_adds_up(mesh, placed.cones, placed.cone_angles)
    curvature = 2 * TURN * (across * along - 1)
    assert 57 < len(placed.cones) <= np.ceil(curvature / (TURN / 4))
    result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles)
    assert result.distortion.l2_stretch < 1.1 and "FLIPPED_TRIANGLES" not in codes(result.warnings)


def test_a_number_that_the_handles_cannot_do_with_is_refused_with_that_number() -> None:
    with pytest.raises(lsgp.TopologyError, match=r"8 cones cannot take up .* curvature of -13680 degrees") as caught:
        place(tunneled_plate(5, 4, 1), count=8)
    assert caught.value.code == "TOO_FEW_CONES" and len(caught.value.elements.indices) == 8


def assert_names_what_automatic_placement_finds(message: str, mesh: Mesh) -> None:
    automatic = place(mesh)
    found = re.search(r"Left automatic, (\d+) cones are placed, and the map has an L2 stretch of ([\d.]+)\.$", message)
    assert int(found[1]) == len(automatic.cones)
    result = lsgp.parameterize(surface(mesh), automatic.cones, automatic.cone_angles)
    assert float(found[2]) == pytest.approx(result.distortion.l2_stretch, rel=1e-3)


def test_a_number_that_is_too_small_is_refused_with_one_that_does() -> None:
    with pytest.raises(lsgp.TopologyError) as caught:
        place(MESHES["bumpy"], count=2)
    assert caught.value.code == "TOO_FEW_CONES"
    assert_names_what_automatic_placement_finds(caught.value.message, MESHES["bumpy"])


def test_a_number_whose_map_is_stretched_beyond_use_is_told_one_that_does() -> None:
    rod = meshes.cube(3, stretch=(1, 50, 1))
    placed = place(rod, count=3)
    assert len(placed.cones) == 3 and placed.mapped_l2 > 3
    warning = only(placed.warnings, "PLACEMENT_NOT_REACHED")
    assert f"With 3 cones the map has an L2 stretch of {placed.mapped_l2:.4g}." in warning.message
    assert np.array_equal(np.sort(warning.elements.indices), np.sort(placed.cones))
    assert_names_what_automatic_placement_finds(warning.message, rod)


def test_a_number_with_a_usable_map_is_as_asked_for() -> None:
    placed = place(MESHES["bumpy"], count=3)
    assert placed.mapped_l2 > 1.05
    assert "PLACEMENT_NOT_REACHED" not in codes(placed.warnings)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_cones_for_a_sphere_are_refused(count: int) -> None:
    with pytest.raises(lsgp.TopologyError) as caught:
        place(MESHES["bumpy"], count=count)
    assert caught.value.code == "TOO_FEW_CONES"


def test_angles_that_cannot_add_up_are_refused() -> None:
    with pytest.raises(lsgp.CurvatureError) as caught:
        place(MESHES["bumpy"], [7, 33, 500], [2 * TURN, 1.5 * TURN, 1.5 * TURN], count=3)
    assert caught.value.code in ("GAUSS_BONNET", "CONE_ANGLE_RANGE")


@pytest.mark.parametrize(
    "options", [{"target": 1}, {"target": np.nan}, {"target": np.inf}, {"mirror": ([0, 0, 0], [0, 0, 0])}]
)
def test_wrong_parameters_are_refused(options: dict[str, object]) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        place(MESHES["bumpy"], **options)
    assert caught.value.code == "WRONG_PARAMETER"


def test_twice_the_same() -> None:
    first, second = place(MESHES["flower"]), place(MESHES["flower"])
    assert first.cones.tolist() == second.cones.tolist()
    assert first.cone_angles.tobytes() == second.cone_angles.tobytes()


def test_progress_grows_and_can_stop() -> None:
    told: list[float] = []
    place(MESHES["bumpy"], progress=told.append)
    assert told == sorted(told) and told[0] >= 0 and told[-1] == 1 and len(told) > 20
    with pytest.raises(lsgp.Cancelled):
        place(MESHES["bumpy"], progress=lambda done: done < 0.5)
