# SPDX-License-Identifier: GPL-3.0-or-later
"""Low stretch: of all maps with the same transitions the one of least symmetric Dirichlet energy; what it must keep."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import scipy.sparse as sp
from map_checks import assert_angles_met, assert_exact_transitions, surface, unwrap
from meshes import Mesh
from result_check import undeclared_faults
from shared_meshes import shared_mesh

RIGHT = np.pi / 2
# What an energy may lie above the least one, as a share of what the least one has above 1, the isometric map's.
STOPPED_EARLY = 1e-3


def bent_corners(mesh: Mesh, step: int) -> Mesh:
    """Every so-many-th vertex at which a surface of voxels is bent as a cone."""
    bent = np.abs(oracle.angle_defects(mesh.positions, mesh.triangles)) > 0.1
    return mesh._replace(cones=np.flatnonzero(bent)[::step].astype(np.int32))


BUMPY = meshes.bumpy_sphere(2)
HILL = meshes.hill()
SURFACES = {
    "closed": BUMPY,
    "flower": meshes.flower(2),
    "torus": meshes.torus(),
    "torus with cones": meshes.torus()._replace(cones=np.array([0, 5, 90, 95, 140], np.int32)),
    "genus 2": bent_corners(meshes.subdivide(meshes.double_torus()), 3),
    "disk": meshes.saddle(),
    "disk with a cone": HILL,
    "annulus": meshes.cylinder(),
    "closed holes": meshes.disk_with_holes(12, 2),
}
every_surface = pytest.mark.parametrize("name", SURFACES)
STEPS = (0.0, 0.25, 0.5, 0.75, 1.0)


def low_stretch(mesh: Mesh, stretch: float = 1.0, importance: object = None, **options: object) -> lsgp.Result:
    wanted = lsgp.Options(mode="low-stretch", stretch=stretch, **options)
    weighted = lsgp.Surface(mesh.positions, mesh.triangles, importance=importance)
    return lsgp.parameterize(weighted, mesh.cones, options=wanted)


@cache
def of_surface(name: str, stretch: float) -> lsgp.Result:
    return low_stretch(SURFACES[name], stretch)


def weights(mesh: Mesh, importance: np.ndarray) -> np.ndarray:
    """Areas times the mean importance of the corners."""
    return oracle.triangle_areas(mesh.positions, mesh.triangles) * importance[mesh.triangles].mean(axis=1)


def energy(mesh: Mesh, result: lsgp.Result, stretch: float = 1.0, weight: np.ndarray | None = None) -> float:
    scale = oracle.rest_scales(mesh.triangles, result.log_scale, stretch)
    return oracle.symmetric_dirichlet(mesh.positions, mesh.triangles, result.corner_uv, scale, weight)


def least_energy(
    mesh: Mesh, result: lsgp.Result, start: np.ndarray, stretch: float = 1.0, weight: np.ndarray | None = None
) -> float:
    """Of all maps that have the transitions' rotations of a result, found from another map with these."""
    opened = oracle.cut_open(mesh.triangles, result.cut_edges)
    nodes = np.concatenate([result.cones, *oracle.boundary_loops(mesh.triangles)]).astype(int)
    turn = np.ones(0)
    if len(result.cut_edges):
        turn = oracle.seam_quality(mesh.triangles, result.corner_uv, result.cut_edges, nodes).turn
    place = sp.csr_matrix(([1.0], ([0], [0])), (1, opened.count))
    rows = sp.vstack([oracle.transition_rows(opened, np.angle(turn)), place]).tocsr()
    scale = oracle.rest_scales(mesh.triangles, result.log_scale, stretch)
    corner_uv = oracle.least_symmetric_dirichlet(mesh.positions, mesh.triangles, opened, rows, start, scale, weight)
    assert (oracle.signed_areas(corner_uv) > 0).all()
    return oracle.symmetric_dirichlet(mesh.positions, mesh.triangles, corner_uv, scale, weight)


def assert_least(mesh: Mesh, result: lsgp.Result, stretch: float = 1.0, weight: np.ndarray | None = None) -> None:
    """No hundreds of steps of another method find less, neither from there nor from the conformal map."""
    found = energy(mesh, result, stretch, weight)
    for start in (result, unwrap(mesh)):
        least = least_energy(mesh, result, start.corner_uv, stretch, weight)
        assert found - least <= STOPPED_EARLY * (least - 1)


# --- the least energy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stretch", [0.5, 1.0])
@every_surface
def test_no_map_with_the_same_transitions_has_less_energy(name: str, stretch: float) -> None:
    assert_least(SURFACES[name], of_surface(name, stretch), stretch)


@every_surface
def test_the_setting_trades_conformality_for_stretch(name: str) -> None:
    of_step = [of_surface(name, stretch).distortion for stretch in STEPS]
    assert (np.diff([figures.l2_stretch for figures in of_step]) < 0).all()
    # On meshes as coarse as these the least conformal energy is not the least mean ratio of stretches.
    assert (np.diff([figures.quasi_conformal_area_weighted for figures in of_step[1:]]) > 0).all()


@every_surface
def test_at_nought_it_is_as_conformal_as_the_conformal_map(name: str) -> None:
    figures, conformal = of_surface(name, 0.0).distortion, unwrap(SURFACES[name]).distortion
    assert figures.quasi_conformal_area_weighted <= conformal.quasi_conformal_area_weighted + 1e-9
    assert figures.l2_stretch <= 1.02 * conformal.l2_stretch


def test_an_isometric_map_stays_as_it_is() -> None:
    mesh = meshes.cube(4)
    assert oracle.similarity_gap(unwrap(mesh).corner_uv, low_stretch(mesh).corner_uv) <= 1e-9


def test_the_setting_means_nothing_to_conformal_maps() -> None:
    assert np.array_equal(unwrap(BUMPY, stretch=0.3).corner_uv, unwrap(BUMPY).corner_uv)


@pytest.mark.parametrize("stretch", [-0.01, 1.01, np.nan, np.inf])
def test_settings_out_of_range_are_refused(stretch: float) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        low_stretch(BUMPY, stretch)
    assert caught.value.code == "WRONG_PARAMETER"


# --- what stays -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("stretch", [0.25, 1.0])
@every_surface
def test_transitions_and_angles_stay_exact(name: str, stretch: float) -> None:
    mesh, result = SURFACES[name], of_surface(name, stretch)
    assert_exact_transitions(mesh, result)
    assert_angles_met(mesh, result)
    conformal = unwrap(mesh)
    assert np.array_equal(result.cones, conformal.cones)
    assert result.cone_angles == pytest.approx(conformal.cone_angles, abs=1e-12)
    assert result.log_scale == pytest.approx(conformal.log_scale, abs=1e-12)
    assert np.array_equal(result.cut_edges, conformal.cut_edges)
    assert result.repair.iterations > 0


def test_given_angles_stay() -> None:
    angles = [1.5 * np.pi] * 4 + [np.pi] * 2
    result = lsgp.parameterize(surface(BUMPY), BUMPY.cones, angles, lsgp.Options(mode="low-stretch"))
    assert result.cone_angles == pytest.approx(angles, abs=1e-12)
    assert_angles_met(BUMPY, result)
    assert_exact_transitions(BUMPY, result)


def test_components_are_relaxed_each_by_itself() -> None:
    mesh = meshes.merge([BUMPY, HILL, meshes.torus()])
    result = low_stretch(mesh)
    count = 0
    for part in (BUMPY, HILL, meshes.torus()):
        alone = low_stretch(part)
        here = result.corner_uv[count : count + len(part.triangles)]
        assert oracle.metric_gap(alone.corner_uv, here) <= 1e-6
        count += len(part.triangles)
    assert result.distortion.l2_stretch < unwrap(mesh).distortion.l2_stretch


@pytest.mark.parametrize("size", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("name", ["closed", "disk with a cone"])
def test_one_or_two_pins_give_place_size_and_turn_and_cost_little(name: str, count: int, size: float) -> None:
    mesh = SURFACES[name]
    corners, uv = np.array([10, 190]), np.array([[3.0, -1.0], [3.0 - 0.5 * size, -1 + 1.25 * size]])
    pins = lsgp.Pins(corners[:count], uv[:count])
    pinned = lsgp.parameterize(surface(mesh), mesh.cones, options=lsgp.Options(mode="low-stretch"), pins=pins)
    assert pinned.corner_uv.reshape(-1, 2)[corners[:count]] == pytest.approx(uv[:count], abs=1e-9)
    assert energy(mesh, pinned) - 1 <= 1.03 * (energy(mesh, of_surface(name, 1.0)) - 1)
    assert_exact_transitions(mesh, pinned)
    assert_angles_met(mesh, pinned)


@pytest.mark.parametrize("mesh", [BUMPY, HILL], ids=["closed", "open"])
def test_pinned_vertices_stay_where_they_are_pinned(mesh: Mesh) -> None:
    """Whatever the size they are pinned in."""
    plain = unwrap(mesh).corner_uv.reshape(-1, 2)
    _, first = np.unique(mesh.triangles, return_index=True)
    corners = first[np.linspace(0, len(first) - 1, 6).astype(int)]
    places = plain[corners] + 0.01 * np.random.default_rng(1).standard_normal((6, 2))
    maps = []
    for size in (0.2, 5.0):
        pins = lsgp.Pins(corners, size * places)
        conformal, relaxed = (
            lsgp.parameterize(surface(mesh), mesh.cones, options=lsgp.Options(mode=mode), pins=pins)
            for mode in ("conformal", "low-stretch")
        )
        assert relaxed.corner_uv.reshape(-1, 2)[corners] == pytest.approx(size * places, abs=1e-9)
        assert_exact_transitions(mesh, relaxed)
        assert relaxed.flipped.size == 0
        assert energy(mesh, relaxed) < energy(mesh, conformal)
        maps.append(relaxed.corner_uv)
    assert oracle.similarity_gap(*maps) <= 1e-6


def test_straight_borders_stay_straight() -> None:
    mesh = HILL._replace(cones=np.array([0, 10, 110, 120], np.int32))
    options = {"border": "straight"}
    conformal = unwrap(mesh, [RIGHT] * 4, **options)
    relaxed = unwrap(mesh, [RIGHT] * 4, mode="low-stretch", **options)
    tail, _, twin = oracle.halfedges(mesh.triangles)
    z = oracle.as_complex(relaxed.corner_uv)
    along = np.angle((z[:, [1, 2, 0]] - z).ravel()[twin < 0])
    quarter_turns = (along - along[0]) / RIGHT
    assert np.abs(quarter_turns - np.round(quarter_turns)).max() <= 1e-9
    assert_angles_met(mesh, relaxed)
    sums = oracle.uv_angle_sums(mesh.triangles, relaxed.corner_uv, len(mesh.positions))
    assert sums[mesh.cones] == pytest.approx(RIGHT, abs=1e-9)
    assert sums[np.setdiff1d(tail[twin < 0], mesh.cones)] == pytest.approx(np.pi, abs=1e-9)
    assert energy(mesh, relaxed) < energy(mesh, conformal)


SEAMLESS = {
    "closed": meshes.bumpy_sphere(3),
    "torus with cones": SURFACES["torus with cones"],
    "disk with a cone": HILL,
}


@pytest.mark.parametrize("lattice", ["square", "hexagon"])
@pytest.mark.parametrize("name", SEAMLESS)
def test_seamless_layouts_stay_exact(name: str, lattice: str) -> None:
    mesh = SEAMLESS[name]
    grid = lsgp.Seamless(lattice=lattice, tiles=24)
    conformal, relaxed = (
        lsgp.parameterize(surface(mesh), mesh.cones, options=lsgp.Options(seamless=grid, mode=mode))
        for mode in ("conformal", "low-stretch")
    )
    assert undeclared_faults(surface(mesh), relaxed, lsgp.Options(seamless=grid, mode="low-stretch")) == []
    assert relaxed.flipped.size == 0 and relaxed.wrong_angle_sums.size == 0
    assert lattice != "square" or relaxed.seamless.error == 0
    assert relaxed.seamless.energy_after < conformal.seamless.energy_after
    assert relaxed.seamless.energy_after == pytest.approx(energy(mesh, relaxed), rel=1e-5)  # float32
    assert relaxed.distortion.l2_stretch < conformal.distortion.l2_stretch


# --- importance -------------------------------------------------------------------------------------------------------


def upper_half(mesh: Mesh) -> np.ndarray:
    x = mesh.positions[:, 0]
    return x > np.median(x)


@pytest.mark.parametrize("name", ["closed", "torus with cones", "disk with a cone"])
def test_heavy_vertices_are_stretched_less(name: str) -> None:
    mesh, plain = SURFACES[name], of_surface(name, 1.0)
    heavy = upper_half(mesh)
    result = low_stretch(mesh, importance=np.where(heavy, 100.0, 1.0))
    there = np.where(heavy[mesh.triangles].all(axis=1), oracle.triangle_areas(mesh.positions, mesh.triangles), 0)
    before, after = energy(mesh, plain, weight=there), energy(mesh, result, weight=there)
    assert after - 1 < 0.95 * (before - 1)
    assert_angles_met(mesh, result)
    assert_exact_transitions(mesh, result)


@pytest.mark.parametrize("name", ["closed", "torus with cones", "disk with a cone"])
def test_triangles_weigh_by_area_and_the_mean_importance_of_their_corners(name: str) -> None:
    mesh = SURFACES[name]
    importance = 0.1 + np.random.default_rng(2).random(len(mesh.positions)) * upper_half(mesh)
    assert_least(mesh, low_stretch(mesh, importance=importance), weight=weights(mesh, importance))


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_equal_weights_are_none(size: float) -> None:
    result = low_stretch(BUMPY, importance=np.full(len(BUMPY.positions), size))
    assert oracle.similarity_gap(of_surface("closed", 1.0).corner_uv, result.corner_uv) <= 1e-9


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_vertices_without_importance_leave_a_valid_map(share: float) -> None:
    importance = np.where(np.arange(len(BUMPY.positions)) < share * len(BUMPY.positions), 0.0, 1.0)
    result = low_stretch(BUMPY, importance=importance)
    assert_angles_met(BUMPY, result)
    assert_exact_transitions(BUMPY, result)


# --- real meshes ------------------------------------------------------------------------------------------------------

# Upper bounds of the L2 stretch.
BOUNDS = {"fandisk": 1.006, "igea-16k": 1.010, "bird": 1.010, "max-planck-25k": 1.022, "hand-5k": 1.018}


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", BOUNDS)
def test_real_meshes_with_their_cones(name: str) -> None:
    mesh = shared_mesh(name)
    result = low_stretch(mesh)
    assert oracle.distortion(mesh.positions, mesh.triangles, result.corner_uv)["l2_stretch"] <= BOUNDS[name]
    assert undeclared_faults(surface(mesh), result) == []
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    seams = oracle.seam_quality(mesh.triangles, result.corner_uv, result.cut_edges, result.cones)
    assert seams.ratio.max() - 1 <= 1e-9
    assert seams.translation_residual <= 1e-12


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", ["bird", "kitten-genus1", "camel-head-disk"])
def test_the_setting_trades_conformality_for_stretch_on_real_meshes(name: str) -> None:
    mesh = shared_mesh(name)
    of_step = [low_stretch(mesh, stretch).distortion for stretch in STEPS]
    assert (np.diff([figures.l2_stretch for figures in of_step]) < 0).all()
    assert (np.diff([figures.quasi_conformal for figures in of_step]) > 0).all()


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", ["kitten-genus1", "eight-genus2", "camel-head-disk"])
def test_real_meshes_with_handles_and_borders(name: str) -> None:
    mesh = shared_mesh(name)
    conformal, result = unwrap(mesh), low_stretch(mesh)
    assert undeclared_faults(surface(mesh), result) == []
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    assert result.distortion.l2_stretch < conformal.distortion.l2_stretch
    assert energy(mesh, result) < energy(mesh, conformal)
