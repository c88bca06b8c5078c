# SPDX-License-Identifier: GPL-3.0-or-later
"""Components, orientation and everything that is not manifold: repaired on the way in, named in a warning."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_angles_met, assert_exact_transitions, codes, only, unwrap

CUBE = meshes.cube(3)


def test_turned_triangles_are_named_and_unwrapped_as_if_they_were_not() -> None:
    turned = [3, 17, 40]
    result = unwrap(meshes.with_flipped(CUBE, turned))
    finding = only(result.warnings, "REORIENTED")
    assert finding.elements.kind == "triangles" and finding.elements.indices.tolist() == turned
    expected = unwrap(CUBE).corner_uv.copy()
    expected[turned] = expected[turned][:, ::-1]
    assert np.abs(result.corner_uv - expected).max() <= 1e-9
    assert result.flipped.size == 0


def test_inside_out_is_legal() -> None:
    mesh = CUBE._replace(triangles=np.ascontiguousarray(CUBE.triangles[:, ::-1]))
    result = unwrap(mesh)
    assert result.warnings == []
    assert_angles_met(mesh, result)


def test_a_bow_tie_is_two_islands() -> None:
    mesh, tip = meshes.bow_tie(3)
    result = unwrap(mesh)
    finding = only(result.warnings, "SPLIT_VERTEX")
    assert finding.elements.kind == "vertices" and finding.elements.indices.tolist() == [tip]
    half = len(mesh.triangles) // 2
    assert result.island.tolist() == [0] * half + [1] * half
    stretch = oracle.stretches(mesh.positions, mesh.triangles, result.corner_uv)
    assert np.ptp(stretch) <= 1e-9 * stretch.max()  # both patches are flat


def test_an_edge_of_three_triangles_is_opened_and_named() -> None:
    mesh, edge = meshes.with_fin(CUBE)
    result = unwrap(mesh)
    finding = only(result.warnings, "NON_MANIFOLD_EDGE")
    assert finding.elements.kind == "edges"
    assert sorted(finding.elements.indices[0].tolist()) == sorted(edge) and len(finding.elements.indices) == 1
    assert result.solved.all()
    assert result.island[-1] != result.island[0]  # the fin is an island of its own
    assert (oracle.signed_areas(result.corner_uv) > 0).all()


def test_two_triangles_back_to_back_share_a_place() -> None:
    """Two triangles never reach 2 pi about a vertex: of such a pocket one is unwrapped, the other lies on it."""
    mesh = meshes.with_pocket(meshes.hill(6))
    result = unwrap(mesh)
    original, double = len(mesh.triangles) - 2, len(mesh.triangles) - 1
    assert only(result.warnings, "DUPLICATE_FACE").elements.indices.tolist() == [double]
    assert result.solved.all() and result.flipped.size == 0
    assert result.island[double] == result.island[original]
    place = {int(v): uv.tolist() for v, uv in zip(mesh.triangles[original], result.corner_uv[original], strict=True)}
    assert [place[int(v)] for v in mesh.triangles[double]] == result.corner_uv[double].tolist()
    assert (oracle.signed_areas(result.corner_uv[:original]) > 0).all()
    assert np.isfinite(result.distortion.quasi_conformal) and np.isfinite(result.distortion.l2_stretch)


def test_isolated_vertices_change_nothing_and_are_named() -> None:
    result = unwrap(meshes.with_isolated_vertices(CUBE, 3))
    finding = only(result.warnings, "ISOLATED_VERTICES")
    assert finding.elements.kind == "vertices" and finding.elements.indices.tolist() == [0, 1, 2]
    assert np.array_equal(result.corner_uv, unwrap(CUBE).corner_uv)
    assert result.log_scale.shape == (len(CUBE.positions) + 3,)


def test_a_triangle_soup_is_congruent_triangles() -> None:
    mesh = meshes.triangle_soup(meshes.ellipsoid(1))
    result = unwrap(mesh)
    assert sorted(result.island.tolist()) == list(range(len(mesh.triangles)))
    stretch = oracle.stretches(mesh.positions, mesh.triangles, result.corner_uv)
    assert np.ptp(stretch) <= 1e-9 * stretch.max()


@pytest.mark.parametrize("bad", [meshes.moebius_strip(), meshes.klein_bottle()], ids=["moebius", "klein"])
def test_what_cannot_be_oriented_is_left_out_and_named(bad: meshes.Mesh) -> None:
    mesh = meshes.merge([CUBE, bad])
    result = unwrap(mesh)
    count = len(CUBE.triangles)
    assert result.solved.tolist() == [True] * count + [False] * len(bad.triangles)
    assert np.isnan(result.corner_uv[count:]).all() and (result.island[count:] == -1).all()
    finding = only(result.warnings, "COMPONENT_SKIPPED")
    assert finding.elements.kind == "triangles"
    assert finding.elements.indices.tolist() == list(range(count, len(mesh.triangles)))
    assert "orient" in finding.message or "Moebius" in finding.message


def test_a_sliver_without_area_is_survived_and_named() -> None:
    mesh = meshes.with_zero_area(meshes.cube(3), 4)
    result = unwrap(mesh)
    assert result.solved.all() and np.isfinite(result.corner_uv).all()
    finding = only(result.warnings, "DEGENERATE_FACES")
    assert finding.elements.indices.tolist() == [len(mesh.triangles) - 1]


def test_what_many_components_share_is_said_once() -> None:
    cubes = [meshes.with_zero_area(meshes.cube(3), 4)] * 5 + [meshes.moebius_strip()] * 3
    mesh = meshes.merge([cube._replace(cones=np.empty(0, np.int32)) for cube in cubes])
    placed = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles))
    result = unwrap(mesh._replace(cones=placed.cones))
    strip, size = len(cubes[-1].triangles), len(cubes[0].triangles)
    for warnings in (placed.warnings, result.warnings):
        finding = only(warnings, "DEGENERATE_FACES")
        assert finding.elements.indices.tolist() == [size * (i + 1) - 1 for i in range(5)]
        assert finding.message.startswith("5 triangles have no area")
        skipped = only(warnings, "COMPONENT_SKIPPED")
        assert skipped.elements.indices.tolist() == list(range(5 * size, 5 * size + 3 * strip))
        assert skipped.message.endswith("This was found 3 times.")


def test_cones_on_a_boundary_are_named() -> None:
    mesh = meshes.saddle(6)._replace(cones=np.array([0, 24], np.int32))  # a corner, and the middle
    result = unwrap(mesh)
    finding = only(result.warnings, "CONE_ON_BOUNDARY")
    assert finding.elements.kind == "vertices" and finding.elements.indices.tolist() == [0]
    assert 24 in result.cones.tolist()
    assert result.solved.all()


@pytest.mark.parametrize("mesh", [meshes.torus(10, 6), meshes.double_torus()], ids=["genus 1", "genus 2"])
def test_handles_are_cut_exactly_or_refused_with_the_reason(mesh: meshes.Mesh) -> None:
    if len(mesh.positions) == 48:
        mesh = mesh._replace(cones=np.array([0, 7, 20, 31], np.int32))
    try:
        result = unwrap(mesh)
    except lsgp.TopologyError as error:
        assert "handle" in error.message or "genus" in error.message
    else:
        assert result.solved.all()
        assert_exact_transitions(mesh, result)


def test_no_warning_without_a_reason() -> None:
    for mesh in (meshes.cube(2), meshes.flower(2), meshes.saddle(5), meshes.cylinder(8, 3)):
        assert codes(unwrap(mesh).warnings) == []
