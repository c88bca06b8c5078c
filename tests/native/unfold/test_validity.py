# SPDX-License-Identifier: GPL-3.0-or-later
"""The check that makes a map valid: no triangle flipped, and no vertex off by a turn."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes, inner_vertices, only, surface, unwrap, wanted_angle_sums

PI = np.pi


def flat_uv(mesh: meshes.Mesh) -> np.ndarray:
    return mesh.positions[mesh.triangles][..., :2].copy()


def moved_vertex(mesh: meshes.Mesh, uv: np.ndarray, vertex: int, place: tuple[float, float]) -> np.ndarray:
    out = uv.copy()
    out[mesh.triangles == vertex] = place
    return out


def test_a_hand_made_flip_is_found() -> None:
    mesh = meshes.grid(4, 4)
    uv = moved_vertex(mesh, flat_uv(mesh), 12, (0.5, 2.0))  # the middle pushed past its left neighbor
    expected = np.flatnonzero(oracle.signed_areas(uv) <= 0)
    assert len(expected) > 0
    assert lsgp.measure_distortion(surface(mesh), uv).flipped.tolist() == expected.tolist()


def test_a_triangle_without_area_counts_as_flipped() -> None:
    mesh = meshes.grid(2, 2)
    uv = moved_vertex(mesh, flat_uv(mesh), 4, (0.0, 1.0))
    expected = np.flatnonzero(oracle.signed_areas(uv) <= 0)
    assert len(expected) >= 2
    assert lsgp.measure_distortion(surface(mesh), uv).flipped.tolist() == expected.tolist()


def test_a_mirrored_island_is_not_flipped_but_its_odd_one_out_is() -> None:
    """Texture coordinates may be mirrored on purpose; a triangle is flipped against the rest of its island."""
    mesh = meshes.merge([meshes.grid(3, 3), meshes.grid(3, 3)])
    uv = flat_uv(mesh)
    uv[18:, :, 0] *= -1
    assert lsgp.measure_distortion(surface(mesh), uv).flipped.size == 0
    pushed = moved_vertex(mesh, uv, 16 + 5, (-uv[18:, :, 0].min() - 20.0, 1.0))
    turned = oracle.signed_areas(pushed) >= 0
    turned[:18] = False
    assert turned.any()
    assert lsgp.measure_distortion(surface(mesh), pushed).flipped.tolist() == np.flatnonzero(turned).tolist()


# Angles that have no flip-free map, or none that the linear solve finds.
HARD = {
    "crowded turns": (meshes.bumpy_sphere(2), [0.05 * PI] * 4 + [3.9 * PI] * 2),
    "a spike and a saddle": (
        meshes.ellipsoid(2),
        [0.2 * PI] * 2 + [1.75 * PI] * 6 + [2.9 * PI] + [1.75 * PI] * 2 + [2.7 * PI],
    ),
}


@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
@pytest.mark.parametrize("name", HARD)
def test_what_went_wrong_is_listed_completely(name: str, unfold: str) -> None:
    mesh, angles = HARD[name]
    result = unwrap(mesh, angles, unfold=unfold, repair=False)
    flipped = np.flatnonzero(oracle.signed_areas(result.corner_uv) <= 0)
    assert result.flipped.tolist() == flipped.tolist()
    inner = inner_vertices(mesh)
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    off = np.abs(sums - wanted_angle_sums(mesh, result.cones, result.cone_angles)) > 1
    wrong = inner[off[inner]]
    assert len(flipped) + len(wrong) > 0, "this input is meant to be too hard"
    beside_flips = np.unique(mesh.triangles[flipped])
    assert set(np.setdiff1d(wrong, beside_flips).tolist()) <= set(result.wrong_angle_sums.tolist())
    assert set(result.wrong_angle_sums.tolist()) <= set(wrong.tolist()) | set(beside_flips.tolist())
    if len(flipped):
        finding = only(result.warnings, "FLIPPED_TRIANGLES")
        assert finding.elements.kind == "triangles" and finding.elements.indices.tolist() == flipped.tolist()
    if result.wrong_angle_sums.size:
        finding = only(result.warnings, "WRONG_ANGLE_SUMS")
        assert finding.elements.kind == "vertices"
        assert finding.elements.indices.tolist() == result.wrong_angle_sums.tolist()


def test_an_overwound_map_without_flips_is_found() -> None:
    """Transitions know angles modulo 2 pi: here the spectral map puts the turn of a wide cone at another vertex."""
    mesh = meshes.bumpy_sphere(3)
    mesh = mesh._replace(cones=np.append(np.arange(12), 129).astype(np.int32))
    angles = [18.5 * PI / 12] * 12 + [3.5 * PI]
    result = unwrap(mesh, angles, unfold="spectral")
    assert (oracle.signed_areas(result.corner_uv) > 0).all() and result.flipped.size == 0
    off = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    off -= wanted_angle_sums(mesh, result.cones, result.cone_angles)
    wrong = np.flatnonzero(np.abs(off) > 1)
    assert len(wrong) == 2 and 129 in wrong
    assert off[129] == pytest.approx(-2 * PI, abs=1e-6) and off[wrong].sum() == pytest.approx(0, abs=1e-6)
    assert result.wrong_angle_sums.tolist() == wrong.tolist()
    assert only(result.warnings, "WRONG_ANGLE_SUMS").elements.indices.tolist() == wrong.tolist()
    assert result.cone_angle_error == pytest.approx(2 * PI, abs=1e-6)
    # The Poisson map of the same angles knows the metric and winds as it should.
    assert 129 not in unwrap(mesh, angles).wrong_angle_sums


def test_cone_angle_error_is_the_largest_deviation_at_a_cone() -> None:
    mesh, angles = HARD["crowded turns"]
    result = unwrap(mesh, angles)
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    if not np.isin(mesh.triangles[result.flipped], result.cones).any():
        assert result.cone_angle_error == pytest.approx(np.abs(sums[result.cones] - result.cone_angles).max(), abs=1e-9)


def test_high_distortion_is_foretold() -> None:
    """All curvature of a sphere in three neighboring points: nothing sensible can come of it."""
    mesh = meshes.icosphere(3)
    mesh = mesh._replace(cones=np.sort(mesh.triangles[0]).astype(np.int32))
    found = lsgp.prescribe_curvature(surface(mesh), mesh.cones)
    assert found.predicted_l2 > 2
    assert "HIGH_DISTORTION" in codes(found.warnings)
    assert "HIGH_DISTORTION" not in codes(lsgp.prescribe_curvature(surface(meshes.icosphere(3)), range(12)).warnings)
