# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of single triangles against numpy's singular value decomposition and against that of the whole map."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface, unwrap

MAPPED = {"bumpy sphere": meshes.bumpy_sphere(2), "flower": meshes.flower(2), "hill": meshes.hill()}


def decomposed(mesh: meshes.Mesh, uv: np.ndarray) -> np.ndarray:
    """(m, 2) singular values by numpy: the map takes the two edge vectors, seen in an orthonormal basis, to UV."""
    place = mesh.positions[mesh.triangles]
    edges = np.stack([place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]], axis=2)
    in_plane = np.linalg.qr(edges)[1]
    images = np.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=2)
    return np.linalg.svd(images @ np.linalg.inv(in_plane), compute_uv=False)


@pytest.mark.parametrize("name", MAPPED)
def test_singular_values_are_numpys(name):
    mesh = MAPPED[name]
    rng = np.random.default_rng(3)
    for uv in (unwrap(mesh).corner_uv, rng.normal(size=(len(mesh.triangles), 3, 2))):
        largest, smallest = lsgp.singular_values(surface(mesh), uv)
        expected = decomposed(mesh, uv)
        assert largest == pytest.approx(expected[:, 0], rel=1e-9)
        assert smallest == pytest.approx(expected[:, 1], rel=1e-7, abs=1e-12)


@pytest.mark.parametrize("name", MAPPED)
def test_means_over_triangles_are_the_figures_of_the_map(name):
    mesh = MAPPED[name]
    result = unwrap(mesh)
    found = lsgp.triangle_distortion(surface(mesh), result.corner_uv)
    place = mesh.positions[mesh.triangles]
    areas = np.linalg.norm(np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]), axis=1)
    assert found.conformal.mean() == pytest.approx(result.distortion.quasi_conformal, rel=1e-9)
    assert (1 / found.area).mean() == pytest.approx(result.distortion.area, rel=1e-9)
    l2 = np.sqrt((found.stretch**2 * areas).sum() / areas.sum())
    assert l2 == pytest.approx(result.distortion.l2_stretch, rel=1e-9)


def test_a_map_that_only_turns_mirrors_and_scales_has_no_distortion():
    mesh = meshes.grid()
    for matrix in (((0, -7), (7, 0)), ((3, 0), (0, -3))):
        uv = mesh.positions[mesh.triangles][..., :2] @ np.array(matrix, float).T
        found = lsgp.triangle_distortion(surface(mesh), uv)
        for measure in (found.conformal, found.area, found.stretch):
            assert measure == pytest.approx(np.ones(len(mesh.triangles)), rel=1e-12)


@pytest.mark.parametrize("exponent", [-900, 600, 1000])
def test_measures_do_not_depend_on_the_unit_of_the_coordinates(exponent: int) -> None:
    mesh = meshes.grid()
    uv = mesh.positions[mesh.triangles][..., :2] @ np.array([[2.0, 0.5], [0.0, 1.0]])
    scaled = np.ldexp(uv, exponent)
    assert lsgp.triangle_distortion(surface(mesh), scaled) == lsgp.triangle_distortion(surface(mesh), uv)
    for own, plain in zip(*(lsgp.singular_values(surface(mesh), of) for of in (scaled, uv)), strict=True):
        np.testing.assert_array_equal(own, np.ldexp(plain, exponent))


def test_triangles_without_an_area_or_coordinates_are_left_out():
    mesh = meshes.with_zero_area(meshes.grid(2, 2), 3)
    place = mesh.positions[mesh.triangles]
    flat = np.linalg.norm(np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]), axis=1) == 0
    assert flat.any() and not flat[:3].any()
    uv = place[..., :2].copy()
    uv[0] = np.nan
    uv[1] = uv[1, 0]
    uv[2] = [[0, 0], [1, 0], [2, 0]]
    found = lsgp.triangle_distortion(surface(mesh), uv)
    left_out = flat | (np.arange(len(flat)) == 0)
    collapsed = np.isin(np.arange(len(flat)), (1, 2))
    for measure in (found.conformal, found.area, found.stretch):
        assert np.isnan(measure[left_out]).all()
        assert np.isfinite(measure[~left_out & ~collapsed]).all()
    for collapsed in (1, 2):
        assert found.conformal[collapsed] == np.inf
        assert found.area[collapsed] == 0
        assert found.stretch[collapsed] == np.inf


def test_wrong_shapes_are_refused():
    mesh = meshes.grid(2, 2)
    with pytest.raises(lsgp.InputError, match="corner_uv has shape"):
        lsgp.triangle_distortion(surface(mesh), np.zeros((1, 3, 2)))
