# SPDX-License-Identifier: GPL-3.0-or-later
"""Cone angles (the paper's section 5): Gauss-Bonnet, the rules derived a second time, angles given by hand."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import scipy.optimize
import zoo
from map_checks import assert_curvature_adds_up, codes, inner_vertices, only, prescribe, surface, unwrap
from placement_checks import middle_l2
from sanitized_run import many_solves
from shared_meshes import shared_mesh

PI, TURN = np.pi, 2 * np.pi
CLOSED = {
    "cube": meshes.cube(3),
    "bumpy sphere": meshes.bumpy_sphere(2),
    "flower": meshes.flower(3),
    "ellipsoid": meshes.ellipsoid(2),
    "skewed": meshes.transform(
        meshes.bumpy_sphere(3, 0.3)._replace(cones=np.array([5, 100, 300, 500, 17], np.int32)), 2
    ),
}
OPEN = {
    "hill": meshes.hill(),
    "two holes": meshes.disk_with_holes(12, 2)._replace(cones=np.array([31, 91], np.int32)),
    "tube": meshes.cylinder(),
}
# On these the bounds of the angles are reached: cones crowded where the surface has little curvature.
BOUNDED = {
    "crowded": meshes.bumpy_sphere(2, 0.35)._replace(cones=np.array([0, 2, 4, 42, 43, 44, 45, 46, 100], np.int32)),
    "tetrahedron": meshes.subdivide(meshes.subdivide(meshes.tetrahedron())),
}


@pytest.mark.parametrize("rule", ["least-distortion", "harmonic", "straightness"])
@pytest.mark.parametrize("name", CLOSED)
def test_curvature_adds_up(name: str, rule: str) -> None:
    mesh = CLOSED[name]
    found = prescribe(mesh, prescription=rule)
    assert found.cones.tolist() == mesh.cones.tolist()
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)


def test_curvature_adds_up_on_every_component() -> None:
    parts = [meshes.cube(2), meshes.bumpy_sphere(1), meshes.flower(2)]
    mesh = meshes.merge(parts)
    found = prescribe(mesh)
    assert sorted(found.cones.tolist()) == mesh.cones.tolist()
    angle = dict(zip(found.cones.tolist(), found.cone_angles.tolist(), strict=True))
    first = 0
    for part in parts:
        own = mesh.cones[first : first + len(part.cones)]
        assert sum(TURN - angle[c] for c in own.tolist()) == pytest.approx(4 * PI, abs=1e-9)
        first += len(part.cones)


@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_harmonic_angles(name: str) -> None:
    mesh = {**CLOSED, **OPEN}[name]
    found = prescribe(mesh, prescription="harmonic")
    assert found.cone_angles == pytest.approx(oracle.harmonic_angles(*mesh), abs=1e-9)


@pytest.mark.parametrize("rule", ["least-distortion", "harmonic"])
@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_log_scale_is_the_one_the_angles_imply(name: str, rule: str) -> None:
    mesh = {**CLOSED, **OPEN}[name]
    found = prescribe(mesh, prescription=rule)
    kappa = np.zeros(len(mesh.positions))
    kappa[found.cones] = TURN - found.cone_angles
    laplacian = oracle.cotan_laplacian(mesh.positions, mesh.triangles)
    residual = laplacian @ found.log_scale - (kappa - oracle.angle_defects(mesh.positions, mesh.triangles))
    assert np.abs(residual[inner_vertices(mesh)]).max() <= 1e-9
    share = oracle.vertex_shares(mesh.positions, mesh.triangles)
    assert abs(share @ found.log_scale) <= 1e-9
    for loop in oracle.boundary_loops(mesh.triangles):
        assert np.ptp(found.log_scale[loop]) <= 1e-9  # free boundaries keep their length up to one factor
    assert found.predicted_l2 == pytest.approx(middle_l2(mesh, found.log_scale), rel=1e-9)


@pytest.mark.parametrize("name", [*CLOSED, *BOUNDED, "hill", "two holes"])
def test_least_distortion_is_not_beaten_by_a_general_optimizer(name: str) -> None:
    mesh = {**CLOSED, **BOUNDED, **OPEN}[name]
    found = prescribe(mesh)
    _, best = oracle.least_distortion_angles(*mesh)
    model = oracle.scale_model(*mesh)
    assert model.objective(TURN - found.cone_angles)[0] <= best + 1e-9
    low, high = oracle.angle_box(*mesh)
    assert (found.cone_angles >= low - 1e-9).all() and (found.cone_angles <= high + 1e-9).all()
    if name != "two holes":  # there the scale moves on along the holes, so that they close without cuts
        lumped = oracle.predicted_l2(found.log_scale, oracle.vertex_shares(mesh.positions, mesh.triangles))
        assert 2 * np.log(lumped) == pytest.approx(model.objective(TURN - found.cone_angles)[0], abs=1e-9)


def test_a_bound_is_reached_somewhere() -> None:
    """Otherwise the comparison above says nothing of the bounds."""
    mesh = BOUNDED["crowded"]
    low, high = oracle.angle_box(*mesh)
    angles = prescribe(mesh).cone_angles
    assert (np.minimum(angles - low, high - angles) <= 1e-7).any()


def test_least_distortion_beats_harmonic_where_it_can() -> None:
    mesh = CLOSED["skewed"]
    assert prescribe(mesh).predicted_l2 < prescribe(mesh, prescription="harmonic").predicted_l2 - 1e-3


def test_regular_solids_share_their_curvature_evenly() -> None:
    for mesh, angle in (
        (meshes.tetrahedron(), PI),
        (meshes.octahedron(), 4 * PI / 3),
        (meshes.icosahedron(), 5 * PI / 3),
    ):
        fine = meshes.subdivide(mesh)
        for rule in ("least-distortion", "harmonic", "straightness"):
            assert prescribe(fine, prescription=rule).cone_angles == pytest.approx(
                np.full(len(mesh.cones), angle), abs=1e-9
            )


@pytest.mark.parametrize("factorization", ["automatic", "cut", "sparse"])
def test_angles_prescribed_are_those_of_the_map_to_the_last_bit(factorization: str) -> None:
    """However badly the system is conditioned."""
    mesh = meshes.bumpy_sphere(3)
    cones = np.random.default_rng(0).choice(len(mesh.positions), 8, replace=False).astype(np.int32)
    options = lsgp.Options(factorization=factorization)
    told = lsgp.prescribe_curvature(surface(mesh), cones, None, options)
    mapped = lsgp.parameterize(surface(mesh), cones, None, options)
    assert told.cone_angles.tolist() == mapped.cone_angles.tolist()


# --- angles by hand -------------------------------------------------------------------------------------------------


def test_given_angles_are_kept_when_they_add_up() -> None:
    mesh = meshes.cube(3)
    angles = [PI / 2 * k for k in (3, 3, 3, 3, 2, 4, 2.5, 3.5)]
    found = prescribe(mesh, angles)
    assert found.cone_angles == pytest.approx(angles, abs=1e-14)
    assert found.cones.tolist() == mesh.cones.tolist()


def test_cones_without_an_angle_take_up_the_rest_with_least_distortion() -> None:
    mesh = meshes.bumpy_sphere(2)
    angles = [None, 1.1 * PI, None, None, 1.6 * PI, None]
    found = prescribe(mesh, angles)
    assert found.cone_angles[[1, 4]] == pytest.approx([1.1 * PI, 1.6 * PI], abs=1e-12)
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    model = oracle.scale_model(*mesh)
    kappa = np.array([0, TURN - 1.1 * PI, 0, 0, TURN - 1.6 * PI, 0])
    free = [0, 2, 3, 5]

    def objective(x: np.ndarray) -> tuple[float, np.ndarray]:
        value, gradient = model.objective(np.insert(x, [1, 3], kappa[[1, 4]]))
        return value, gradient[free]

    rest = model.total - kappa.sum()
    sums = {"type": "eq", "fun": lambda x: x.sum() - rest, "jac": lambda x: np.ones((1, 4))}
    best = scipy.optimize.minimize(
        objective, np.full(4, rest / 4), jac=True, method="SLSQP", constraints=[sums], options={"ftol": 1e-15}
    )
    assert model.objective(TURN - found.cone_angles)[0] <= best.fun + 1e-9


def test_one_free_cone_closes_the_sum() -> None:
    found = prescribe(meshes.cube(2), [1.5 * PI] * 6 + [1.2 * PI, None])
    assert found.cone_angles[7] == pytest.approx(1.8 * PI, abs=1e-9)


def test_all_angles_free_is_least_distortion() -> None:
    mesh = meshes.bumpy_sphere(2)
    expected = prescribe(mesh).cone_angles
    assert prescribe(mesh, [None] * 6).cone_angles == pytest.approx(expected, abs=1e-12)
    assert prescribe(mesh, [None] * 6, prescription="manual").cone_angles == pytest.approx(expected, abs=1e-12)


def test_the_rest_left_for_one_cone_must_be_possible() -> None:
    """Seven corners of 2 pi leave -2 pi for the eighth."""
    with pytest.raises(lsgp.CurvatureError) as caught:
        prescribe(meshes.cube(2), [2 * PI] * 7 + [None])
    assert caught.value.code in ("GAUSS_BONNET", "CONE_ANGLE_RANGE")


@pytest.mark.parametrize("off", [2e-6, -2e-6, 1e-3, 4.0])
def test_a_sum_that_is_off_is_refused(off: float) -> None:
    with pytest.raises(lsgp.CurvatureError) as caught:
        prescribe(meshes.cube(2), [1.5 * PI] * 7 + [1.5 * PI + off])
    assert caught.value.code == "GAUSS_BONNET"


@pytest.mark.parametrize("off", [1e-9, -1e-9, 9e-7, -9e-7])
def test_a_sum_that_is_off_by_rounding_is_renormalized(off: float) -> None:
    mesh = meshes.cube(2)
    given = np.array([1.5 * PI] * 7 + [1.5 * PI + off])
    found = prescribe(mesh, given.tolist())
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert np.abs(found.cone_angles - given).max() <= abs(off)
    assert unwrap(mesh, given.tolist()).flipped.size == 0


def test_the_sum_is_required_of_every_closed_component() -> None:
    """Two cubes whose errors cancel are still refused or left out, never mixed."""
    mesh = meshes.merge([meshes.cube(1), meshes.cube(1)])
    angles = [1.5 * PI] * 7 + [1.6 * PI] + [1.5 * PI] * 7 + [1.4 * PI]
    with pytest.raises(lsgp.CurvatureError) as caught:
        unwrap(mesh, angles)
    assert caught.value.code == "GAUSS_BONNET"


def test_a_free_boundary_takes_any_sum() -> None:
    mesh = meshes.hill()
    for angle in (1.4 * PI, 2.3 * PI):
        found = prescribe(mesh, [angle])
        assert found.cone_angles.tolist() == [angle]


def test_an_angle_no_triangles_can_hold_is_refused_and_named() -> None:
    """A corner of the cube with five or fewer triangles cannot keep more than pi in each."""
    mesh = meshes.cube(1)
    valence = np.bincount(mesh.triangles.ravel())
    cone = int(np.argmin(valence))
    angles: list[float | None] = [None] * 8
    angles[cone] = valence[cone] * PI + 0.1
    with pytest.raises(lsgp.CurvatureError) as caught:
        prescribe(mesh, angles)
    assert caught.value.code == "CONE_ANGLE_RANGE"
    assert caught.value.elements.indices.tolist() == [cone]


# --- straightness ---------------------------------------------------------------------------------------------------


def test_straight_cuts_of_developable_boxes_keep_their_angles() -> None:
    """Cuts along the box's own edges are straight already, so the paper's angles are the true ones."""
    for mesh in (meshes.cube(4), meshes.cube(3, (1, 2, 0.5))):
        found = prescribe(mesh, prescription="straightness")
        assert codes(found.warnings) == []
        assert found.cone_angles == pytest.approx(np.full(8, 1.5 * PI), abs=1e-9)


def test_straightness_on_a_flower_is_near_the_best() -> None:
    mesh = meshes.flower(3)
    found = prescribe(mesh, prescription="straightness")
    assert "STRAIGHTNESS_FAILED" not in codes(found.warnings)
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.predicted_l2 <= 1.02 * prescribe(mesh).predicted_l2
    cuts = lsgp.find_cuts(surface(mesh), mesh.cones)
    degree = np.bincount(cuts.edges.ravel(), minlength=len(mesh.positions))
    junctions = np.setdiff1d(np.flatnonzero(degree >= 3), mesh.cones)
    if len(junctions):
        finding = only(found.warnings, "JUNCTION_SHARE")
        assert finding.elements.kind == "vertices" and finding.elements.indices.tolist() == junctions.tolist()


def with_handles(cones: int, seed: int) -> meshes.Mesh:
    """A ball with eight handles and a few cones anywhere."""
    mesh = zoo.member("ball-with-handles-levels=2-handles=8-seed=1").mesh()
    chosen = np.random.default_rng(seed).choice(len(mesh.positions), cones, replace=False)
    return mesh._replace(cones=chosen.astype(np.int32))


def test_straightness_that_cannot_be_kept_says_so_and_falls_back() -> None:
    mesh = with_handles(cones=8, seed=2)
    found = prescribe(mesh, prescription="straightness")
    finding = only(found.warnings, "STRAIGHTNESS_FAILED")
    assert "cross" in finding.message and "other trees" in finding.message
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.cone_angles == pytest.approx(prescribe(mesh).cone_angles, abs=1e-9)


@pytest.mark.parametrize(("first", "step"), [(3, 4), (1, 3)])
def test_angles_are_read_where_straight_cuts_cross(first: int, step: int) -> None:
    """A layout that overlaps itself has angles as well."""
    mesh = meshes.bumpy_sphere(3, 0.15)._replace(cones=np.arange(first, 642, step, dtype=np.int32))
    found = prescribe(mesh, prescription="straightness")
    assert codes(found.warnings) == ["JUNCTION_SHARE"]
    assert "trees of cuts" not in found.warnings[0].message
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.predicted_l2 <= 1.5 * prescribe(mesh).predicted_l2


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "star-points=8-inner=0.7-height=2",
        "sponge-cells=1",
        *many_solves(
            "gear-teeth=12-depth=0.4-layers=3",
            "noise-ball-levels=2-amount=1-seed=1",
            "tunneled-plate-across=4-along=3-thickness=3",
            "ball-with-handles-levels=2-handles=8-seed=1",
        ),
    ],
)
def test_placed_cones_admit_straight_cuts(name: str) -> None:
    mesh = zoo.member(name).mesh()
    mesh = mesh._replace(cones=lsgp.place_cones(surface(mesh)).cones)
    found = prescribe(mesh, prescription="straightness")
    assert "STRAIGHTNESS_FAILED" not in codes(found.warnings)
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.predicted_l2 <= 1.5 * prescribe(mesh).predicted_l2


@pytest.mark.parametrize("seed", [0, 2, 3])
def test_straight_cuts_are_found_among_other_trees(seed: int) -> None:
    """The usual tree has no angles that a map can keep."""
    mesh = with_handles(cones=20, seed=seed)
    found = prescribe(mesh, prescription="straightness")
    assert "STRAIGHTNESS_FAILED" not in codes(found.warnings)
    assert "trees of cuts" in only(found.warnings, "JUNCTION_SHARE").message
    assert_curvature_adds_up(mesh, found.cones, found.cone_angles)
    assert found.predicted_l2 <= 1.5 * prescribe(mesh).predicted_l2


@pytest.mark.parametrize("name", ["camel-head-disk", pytest.param("julius", marks=pytest.mark.many_solves)])
def test_cuts_to_a_free_boundary_can_be_straight(name: str) -> None:
    mesh = shared_mesh(name)
    found = prescribe(mesh, prescription="straightness")
    assert "STRAIGHTNESS_FAILED" not in codes(found.warnings)
    least = prescribe(mesh)
    assert np.abs(found.cone_angles - least.cone_angles).max() > 1e-6
    assert found.predicted_l2 <= 1.5 * least.predicted_l2
