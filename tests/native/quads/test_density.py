# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads of a given density: their areas times it are alike, on the same guarantees as without."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import numpy as np
import pytest
from lsgp.quads.density import at_density
from meshes import Mesh, bumpy_sphere, cube, icosphere, tetrahedron, torus
from numpy.typing import NDArray
from oracle import triangle_areas
from quad_checks import require_closed_quads, vertex_angles

Floats = NDArray[np.float64]
MESHES = {"sphere": icosphere(3), "torus": torus(36, 18), "bumpy sphere": bumpy_sphere(3)}
# What linear interpolation over quads, and their chords across a curved surface, add to the deviation of sizes.
OF_QUADS = 0.03


def surface_of(mesh: Mesh, **further) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles, **further)


def ramp(mesh: Mesh, most: float = 16.0) -> Floats:
    x = mesh.positions[:, 0]
    return most ** ((x - x.min()) / np.ptp(x))


def spot(mesh: Mesh) -> Floats:
    away = np.linalg.norm(mesh.positions - mesh.positions[0], axis=1) / np.linalg.norm(np.ptp(mesh.positions, axis=0))
    return 1 + 15 * np.exp(-((away / 0.2) ** 2))


def deviation(mesh: Mesh, density: Floats, found: lsgp.QuadMesh) -> float:
    """Of the areas of quads times the density in their middle: standard deviation relative to the mean."""
    a, b, c, d = found.positions[found.quads].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(c - a, d - b), axis=1) / 2
    at_vertices = (found.weights * np.log(density)[mesh.triangles[found.triangles]]).sum(axis=1)
    sizes = areas * np.exp(at_vertices[found.quads].mean(axis=1))
    return float(sizes.std() / sizes.mean())


def l2_stretch(surface: lsgp.Surface, uv: Floats) -> float:
    """By the singular values of each triangle's map from the plane where it has the lengths of the metric."""
    place, scale = surface.positions[surface.triangles], surface.scale[surface.triangles]
    a, b, c = (
        np.linalg.norm(place[:, i] - place[:, j], axis=1) * (scale[:, i] + scale[:, j]) / 2
        for i, j in ((0, 1), (1, 2), (2, 0))
    )
    x = (a**2 + c**2 - b**2) / (2 * a)
    height = np.sqrt(c**2 - x**2)
    there = np.stack([np.stack([a, x], axis=1), np.stack([0 * a, height], axis=1)], axis=1)
    image = np.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=2)
    values = np.linalg.svd(image @ np.linalg.inv(there), compute_uv=False)
    area, uv_area = a * height / 2, values.prod(axis=1) * a * height / 2
    square = ((values**-2).sum(axis=1) / 2 * area).sum() / area.sum()
    return float(np.sqrt(square * uv_area.sum() / area.sum()))


def require_cones_in_place(remesh: lsgp.QuadRemesh) -> None:
    """Irregular vertices are where the layout's surface has its cones, with as many quads as these have quarters."""
    turns = np.round(vertex_angles(remesh.surface, remesh.layout.corner_uv)).astype(int)
    cones = np.flatnonzero(turns != 4)
    irregular = remesh.mesh.irregular
    away = remesh.mesh.positions[irregular][:, None] - remesh.surface.positions[cones]
    at = np.linalg.norm(away, axis=2)
    assert sorted(at.argmin(axis=1).tolist()) == list(range(len(cones))) and at.min(axis=1).max() < 1e-9
    assert np.array_equal(turns[cones][at.argmin(axis=1)], remesh.mesh.valences[irregular])


@pytest.mark.parametrize("density_of", [ramp, spot])
@pytest.mark.parametrize("name", MESHES)
def test_sizes_times_density_vary_by_what_the_layout_stretches(name: str, density_of) -> None:
    """On a conformal layout the square of the L2 stretch exceeds 1 by the squared relative deviation of the areas that
    have equal images, on others by more."""
    mesh = MESHES[name]
    surface, density = surface_of(mesh), density_of(mesh)
    remesh = lsgp.remesh_to_quads(surface, target=1200, density=density)
    require_closed_quads(mesh, remesh.mesh)
    require_cones_in_place(remesh)
    stretch = remesh.layout.distortion.l2_stretch
    assert stretch == pytest.approx(l2_stretch(remesh.surface, remesh.layout.corner_uv), rel=1e-9)
    assert stretch < 1.08  # cones are placed for 1.05 of a map without a grid
    assert deviation(mesh, density, remesh.mesh) < np.sqrt(stretch**2 - 1) + OF_QUADS
    assert (
        deviation(mesh, density, remesh.mesh)
        < deviation(mesh, density, lsgp.remesh_to_quads(surface, target=1200).mesh) / 2
    )
    assert abs(len(remesh.mesh.quads) - 1200) <= 120


def test_quality_by_the_density_is_that_of_equal_quads() -> None:
    mesh = MESHES["sphere"]
    made = lsgp.remesh_to_quads(surface_of(mesh), target=1200, density=ramp(mesh))
    plain, by_density = (lsgp.quad_quality(made.mesh.positions, made.mesh.quads, of) for of in (None, made.density))
    assert by_density.edge_deviation < 0.2 < plain.edge_deviation
    assert by_density.angle_error == plain.angle_error
    four = np.full(len(made.mesh.positions), 4.0)
    assert lsgp.quad_quality(made.mesh.positions, made.mesh.quads, four).edge_deviation == plain.edge_deviation


@pytest.mark.parametrize("value", [1.0, 7.0])
def test_one_density_everywhere_is_none(value: float) -> None:
    surface = surface_of(MESHES["sphere"])
    even = np.full(len(surface.positions), value)
    assert lsgp.remesh_to_quads(surface, target=500, density=even) == lsgp.remesh_to_quads(surface, target=500)
    at_size = lsgp.remesh_to_quads(surface, size=0.3, density=even)
    assert at_size == lsgp.remesh_to_quads(surface, size=0.3 / np.sqrt(value))


@pytest.mark.slow
def test_only_the_ratios_of_densities_matter_for_a_number_of_quads() -> None:
    mesh = MESHES["torus"]
    surface, density = surface_of(mesh), ramp(mesh)
    made = lsgp.remesh_to_quads(surface, target=800, density=density)
    scaled = lsgp.remesh_to_quads(surface, target=800, density=16 * density)
    assert scaled.mesh == made.mesh
    assert scaled.layout.seamless.tile_size == 4 * made.layout.seamless.tile_size
    rounded = lsgp.remesh_to_quads(surface, target=800, density=density / 7)
    assert deviation(mesh, density, rounded.mesh) == pytest.approx(deviation(mesh, density, made.mesh), abs=0.02)


def test_size_is_the_side_where_the_density_is_one() -> None:
    mesh = MESHES["sphere"]
    density, size = ramp(mesh), 0.2
    made = lsgp.remesh_to_quads(surface_of(mesh), size=size, density=density)
    wanted = (triangle_areas(mesh.positions, mesh.triangles) * density[mesh.triangles].mean(axis=1)).sum() / size**2
    assert len(made.mesh.quads) == pytest.approx(wanted, rel=0.1)


def test_quads_are_the_same_for_any_number_of_threads() -> None:
    mesh = MESHES["bumpy sphere"]
    made = [
        lsgp.remesh_to_quads(
            surface_of(mesh),
            target=600,
            density=spot(mesh),
            options=lsgp.Options(seamless=lsgp.Seamless(), straighten=True, threads=threads),
        )
        for threads in (1, 2)
    ]
    assert made[0].mesh == made[1].mesh


def test_polishing_keeps_the_density() -> None:
    mesh = MESHES["bumpy sphere"]
    density = ramp(mesh)
    plain, polished = (
        lsgp.remesh_to_quads(surface_of(mesh), target=1200, density=density, polish=polish) for polish in (False, True)
    )
    require_closed_quads(mesh, polished.mesh)
    edges = [lsgp.quad_quality(of.mesh.positions, of.mesh.quads, of.density).edge_deviation for of in (plain, polished)]
    assert edges[1] < edges[0]
    assert deviation(mesh, density, polished.mesh) < deviation(mesh, density, plain.mesh)


def test_large_triangles_are_divided_for_the_density() -> None:
    mesh = tetrahedron()
    density = np.array([16.0, 1.0, 1.0, 1.0])
    made = lsgp.remesh_to_quads(surface_of(mesh), target=600, density=density)
    require_closed_quads(mesh, made.mesh)
    assert len(made.surface.positions) > 100
    assert not any(finding.code == "DENSITY_RAISED" for finding in made.warnings)
    # Linear over each face, as the side of quads is.
    found = made.mesh
    linear = (found.weights * np.sqrt(density)[mesh.triangles[found.triangles]]).sum(axis=1)
    np.testing.assert_allclose(np.sqrt(made.density), linear, rtol=1e-12)
    assert deviation(mesh, density, found) < 0.35


def test_creases_are_those_of_the_shape() -> None:
    mesh = cube(8)
    made = lsgp.remesh_to_quads(surface_of(mesh), target=600, density=ramp(mesh, 4.0))
    assert made.layout.seamless.feature_share == 1
    assert len(made.mesh.irregular) == 8


def test_a_cliff_is_lowered_to_what_triangles_can_have() -> None:
    mesh = icosphere(3)
    density = np.where(mesh.positions[:, 0] > 0, 1e4, 1e-4)
    made = lsgp.remesh_to_quads(surface_of(mesh), target=1000, density=density)
    require_closed_quads(mesh, made.mesh)
    told = [finding for finding in made.warnings if finding.code == "DENSITY_RAISED"]
    assert len(told) == 1 and told[0].elements.kind == "vertices"
    assert (density[told[0].elements.indices] == 1e-4).all()
    assert made.density.max() == pytest.approx(1e4)


@pytest.mark.parametrize("seed", range(5))
def test_scales_are_raised_only_as_far_as_triangles_need(seed: int) -> None:
    mesh = [icosphere(2), torus(), bumpy_sphere(2), cube(3), icosphere(1)][seed]
    rng = np.random.default_rng(seed)
    density = np.exp(rng.normal(0, 2, len(mesh.positions)))
    divided, _ = at_density(surface_of(mesh), density, 10.0)  # long enough to divide nothing
    scale, given = divided.surface.scale, np.sqrt(density)
    assert len(scale) == len(given)
    assert (scale >= given).all() and scale.max() == given.max()

    def slack(of: Floats) -> Floats:
        place, at = mesh.positions[mesh.triangles], of[mesh.triangles]
        sides = np.linalg.norm(place - np.roll(place, 1, axis=1), axis=2) * (at + np.roll(at, 1, axis=1)) / 2
        return (sides.sum(axis=1) - 2 * sides.max(axis=1)) / at.mean(axis=1)

    even = slack(np.ones(len(given)))
    assert (slack(given) < 0).any()
    assert (slack(scale) > 0.4 * even).all()
    raised = np.flatnonzero(scale > given)
    assert 0 < len(raised) < len(given)
    for vertex in raised:
        lower = np.where(np.arange(len(scale)) == vertex, 0.97 * scale, scale)
        assert (slack(lower) < 0.5 * even).any()


@pytest.mark.parametrize(
    ("change", "vertices"),
    [((0, 0.0), [0]), ((3, -1.0), [3]), ((5, np.nan), [5]), ((7, np.inf), [7]), ((2, 1e13), [2])],
)
def test_densities_that_are_none_are_refused(change: tuple[int, float], vertices: list[int]) -> None:
    mesh = MESHES["sphere"]
    density = ramp(mesh)
    density[change[0]] = change[1]
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.remesh_to_quads(surface_of(mesh), target=500, density=density)
    assert caught.value.code == "WRONG_PARAMETER" and caught.value.elements.kind == "vertices"
    assert caught.value.elements.indices.tolist() == vertices


@pytest.mark.parametrize("density", [[], [1.0, 2.0], 3.0, [[1.0]], "dense"])
def test_a_density_is_needed_for_each_vertex(density: object) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.remesh_to_quads(surface_of(MESHES["sphere"]), target=500, density=density)
    assert caught.value.code == "WRONG_SHAPE" and "density" in str(caught.value)


def test_open_surfaces_are_refused_with_their_boundary() -> None:
    mesh = MESHES["sphere"]
    opened = replace(surface_of(mesh), triangles=mesh.triangles[1:])
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.remesh_to_quads(opened, target=500, density=ramp(mesh))
    assert caught.value.code == "OPEN_SURFACE"
    assert set(caught.value.elements.indices.ravel().tolist()) == set(mesh.triangles[0].tolist())


def test_cones_are_vertices_of_the_given_surface_not_of_the_divided_one() -> None:
    mesh = tetrahedron()
    with pytest.raises(lsgp.LsgpError) as caught:
        lsgp.remesh_to_quads(surface_of(mesh), [0, 9], target=500, density=[16.0, 1, 1, 1])
    assert caught.value.code == "CONE_INDEX"
