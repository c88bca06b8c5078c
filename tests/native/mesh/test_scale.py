# SPDX-License-Identifier: GPL-3.0-or-later
"""The factor of lengths at vertices: maps are made, and measured, in the metric that has these lengths."""

from __future__ import annotations

from dataclasses import astuple

import lsgp
import numpy as np
import pytest
from map_checks import digest
from meshes import Mesh, cube, grid, icosphere


def surface_of(mesh: Mesh, scale: object = None) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles, scale=scale)


def strip(cells: int) -> Mesh:
    """A square in the plane, of sides 1 from 0 to 1."""
    mesh = grid(cells, cells)
    low, size = mesh.positions.min(axis=0), np.ptp(mesh.positions, axis=0)
    return mesh._replace(positions=(mesh.positions - low) / np.where(size > 0, size, 1))


def off_exponential(cells: int) -> float:
    """How far the map of the square is from its exponential, relative to its size; both up to a similarity."""
    mesh = strip(cells)
    z = mesh.positions[:, 0] + 1j * mesh.positions[:, 1]
    result = lsgp.parameterize(surface_of(mesh, np.exp(z.real)), ())
    found = np.empty(len(z), complex)
    found[mesh.triangles] = result.corner_uv[..., 0] + 1j * result.corner_uv[..., 1]
    wanted = np.exp(z)
    found, wanted = found - found.mean(), wanted - wanted.mean()
    similarity = np.vdot(found, wanted) / np.vdot(found, found)
    return float(np.abs(similarity * found - wanted).max() / np.abs(wanted).max())


def test_a_flat_metric_is_mapped_to_the_plane_that_it_is_of() -> None:
    """e^x is the factor of lengths of the conformal map exp, whose image is flat: the map converges to it with the
    square of the size of cells."""
    coarse, fine = off_exponential(6), off_exponential(12)
    assert coarse < 0.01
    assert fine < 0.4 * coarse
    mesh = strip(12)
    flat = lsgp.parameterize(surface_of(mesh, np.exp(mesh.positions[:, 0])), ())
    assert flat.distortion.l2_stretch == pytest.approx(1, abs=1e-4)
    in_space = lsgp.measure_distortion(surface_of(mesh), flat.corner_uv).distortion
    assert in_space.l2_stretch > 1.05


@pytest.mark.parametrize("scale", [4.0, 0.25])
def test_one_factor_everywhere_changes_units_alone(scale: float) -> None:
    mesh = icosphere(2)
    everywhere = np.full(len(mesh.positions), scale)
    plain, scaled = (lsgp.place_cones(surface_of(mesh, of)) for of in (None, everywhere))
    assert scaled.cones.tolist() == plain.cones.tolist()
    maps = [lsgp.parameterize(surface_of(mesh, of), plain.cones, plain.cone_angles) for of in (None, everywhere)]
    np.testing.assert_allclose(astuple(maps[1].distortion), astuple(maps[0].distortion), rtol=1e-9)
    uv = maps[0].corner_uv
    for of_scaled, of_plain in zip(
        lsgp.singular_values(surface_of(mesh, everywhere), uv), lsgp.singular_values(surface_of(mesh), uv), strict=True
    ):
        np.testing.assert_allclose(of_scaled * scale, of_plain, rtol=1e-9)
    ones = lsgp.parameterize(surface_of(mesh, np.ones(len(mesh.positions))), plain.cones, plain.cone_angles)
    np.testing.assert_allclose(ones.corner_uv, uv, atol=1e-9)


def test_triangles_are_measured_as_the_whole_map_is() -> None:
    mesh = icosphere(2)
    surface = surface_of(mesh, 2.0 ** mesh.positions[:, 0])
    result = lsgp.parameterize(surface, [0, 1, 2, 3])
    largest, smallest = lsgp.singular_values(surface, result.corner_uv)
    assert (largest / smallest).mean() == pytest.approx(result.distortion.quasi_conformal, rel=1e-9)
    assert lsgp.measure_distortion(surface, result.corner_uv).distortion == result.distortion
    texels = lsgp.texel_density(surface, result.corner_uv, 1024)
    assert texels == lsgp.texel_density(surface_of(mesh), result.corner_uv, 1024)


def test_what_is_kept_of_another_metric_is_not_used() -> None:
    mesh = icosphere(2)
    surface, other = surface_of(mesh), surface_of(mesh, 2.0 ** mesh.positions[:, 0])
    solver = lsgp.Solver(surface)
    solver.parameterize([0, 1, 2, 3])
    after = lsgp.Solver(other, earlier=solver).parameterize([0, 1, 2, 3])
    assert digest(after) == digest(lsgp.parameterize(other, [0, 1, 2, 3]))


def test_creases_do_not_depend_on_the_metric() -> None:
    mesh = cube(6)
    other = surface_of(mesh, 3.0 ** mesh.positions[:, 0])
    straight = lsgp.Options(seamless=lsgp.Seamless(tiles=96), straighten=True)
    ends = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    corners = np.flatnonzero(((mesh.positions == ends[0]) | (mesh.positions == ends[1])).all(axis=1))
    creases = [
        lsgp.parameterize(of, corners, options=straight).seamless.creases.tolist() for of in (surface_of(mesh), other)
    ]
    assert creases[0] and creases[1] == creases[0]


@pytest.mark.parametrize(
    ("change", "reason"),
    [((0, 0.0), "factor of lengths"), ((0, np.nan), "factor of lengths"), ((0, 1e7), "factor of lengths")],
)
def test_factors_that_are_none_are_refused(change: tuple[int, float], reason: str) -> None:
    mesh = icosphere(1)
    scale = np.ones(len(mesh.positions))
    scale[change[0]] = change[1]
    with pytest.raises(lsgp.InputError, match=reason) as caught:
        lsgp.parameterize(surface_of(mesh, scale), ())
    assert caught.value.code == "WRONG_PARAMETER"
    assert (caught.value.elements.kind, caught.value.elements.indices.tolist()) == ("vertices", [0])


def test_metrics_without_triangles_are_refused() -> None:
    """In the middle of the long side of a flat triangle a factor below those of its ends makes the detour shorter."""
    mesh = strip(2)
    positions = np.vstack([mesh.positions[:3], [[0.5, -0.01, 0]]])
    positions[:3] = [[0, 0, 0], [1, 0, 0], [0.5, 1, 0]]
    triangles = [[0, 3, 1], [0, 1, 2]]
    with pytest.raises(lsgp.InputError, match="longer than the two others") as caught:
        lsgp.parameterize(lsgp.Surface(positions, triangles, scale=[1, 1, 1, 0.5]), ())
    assert (caught.value.elements.kind, caught.value.elements.indices.tolist()) == ("triangles", [0])
    lsgp.parameterize(lsgp.Surface(positions, triangles, scale=[1, 1, 1, 1.5]), ())


@pytest.mark.parametrize("count", [0, 3])
def test_a_factor_is_needed_for_each_vertex(count: int) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        surface_of(icosphere(1), np.ones(count))
    assert caught.value.code == "WRONG_SHAPE"
