# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders: corners with their own angle, straight sides, prescribed turning, holes that need no cut."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import RESIDUAL, codes, only, surface, unwrap

RIGHT = np.pi / 2


def border_directions(mesh: meshes.Mesh, result: lsgp.Result) -> dict[tuple[int, int], float]:
    """Direction of every border edge in the layout, radians, by its vertices with the surface on the left."""
    tail, head, twin = oracle.halfedges(mesh.triangles)
    z = oracle.as_complex(result.corner_uv)
    along = (z[:, [1, 2, 0]] - z).ravel()
    return {(int(tail[h]), int(head[h])): float(np.angle(along[h])) for h in np.flatnonzero(twin < 0)}


def turnings(mesh: meshes.Mesh, result: lsgp.Result) -> list[float]:
    """Total turning of every border in the layout, radians, by the exterior angles of its vertices."""
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    return [float((np.pi - sums[loop]).sum()) for loop in oracle.boundary_loops(mesh.triangles)]


def square_hill() -> meshes.Mesh:
    return meshes.hill(10)._replace(cones=np.array([0, 10, 110, 120], np.int32))


def test_straight_border_with_right_corners_is_a_rectangle() -> None:
    mesh = square_hill()
    result = unwrap(mesh, [RIGHT] * 4, border="straight")
    directions = np.array(list(border_directions(mesh, result).values()))
    quarter_turns = (directions - directions[0]) / RIGHT
    assert np.abs(quarter_turns - np.round(quarter_turns)).max() <= 1e-9
    assert sorted(set(np.round(quarter_turns).astype(int) % 4)) == [0, 1, 2, 3]
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0


def test_straight_border_chooses_its_corner_angles_under_gauss_bonnet() -> None:
    mesh = square_hill()
    result = unwrap(mesh, border="straight")
    assert (np.pi - result.cone_angles).sum() == pytest.approx(2 * np.pi, abs=1e-9)
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    assert sums[result.cones] == pytest.approx(result.cone_angles, abs=1e-9)
    others = np.setdiff1d(oracle.boundary_loops(mesh.triangles)[0], mesh.cones)
    assert sums[others] == pytest.approx(np.pi, abs=1e-9)


def test_cylinder_becomes_a_strip() -> None:
    mesh = meshes.cylinder()
    result = unwrap(mesh, border="straight")
    directions = np.array(list(border_directions(mesh, result).values()))
    assert np.abs(np.sin(directions - directions[0])).max() <= 1e-9
    # The strip's two ends are related by a translation alone.
    ends = oracle.seam_quality(
        mesh.triangles,
        result.corner_uv,
        result.cut_edges,
        np.concatenate(oracle.boundary_loops(mesh.triangles)),
        np.zeros(len(result.cut_edges)),
    )
    assert np.abs(ends.turn - 1).max() <= 1e-9 and ends.translation_residual <= RESIDUAL
    assert result.distortion.l2_stretch <= 1.05 and result.flipped.size == 0


def test_a_tooth_on_a_straight_border_keeps_its_shape() -> None:
    """A border vertex with a single triangle cannot lie on a straight line."""
    mesh = square_hill()
    a, b = 4, 5  # an edge of the lower side, away from its corners
    middle = mesh.positions[[a, b]].mean(axis=0) + np.array([0.0, -0.8, 0.1])
    toothed = meshes.make(
        np.vstack([mesh.positions, middle]), np.vstack([mesh.triangles, [b, a, len(mesh.positions)]]), mesh.cones
    )
    assert len(oracle.boundary_loops(toothed.triangles)[0]) == len(oracle.boundary_loops(mesh.triangles)[0]) + 1
    result = unwrap(toothed, [RIGHT] * 4, border="straight")
    directions = border_directions(toothed, result)
    base = np.array([d for edge, d in directions.items() if len(mesh.positions) not in edge])
    quarter_turns = (base - base[0]) / RIGHT
    assert np.abs(quarter_turns - np.round(quarter_turns)).max() <= 1e-9
    assert result.flipped.size == 0
    stretch = oracle.stretches(toothed.positions, toothed.triangles[-1:], result.corner_uv[-1:])
    assert stretch.max() / stretch.min() <= 1.05


def test_straight_border_without_corners_is_refused_on_a_disk() -> None:
    with pytest.raises(lsgp.TopologyError) as caught:
        unwrap(meshes.hill(6)._replace(cones=np.empty(0, np.int32)), border="straight")
    assert caught.value.code == "TOO_FEW_CONES" and "corner" in caught.value.message


def test_corner_on_a_free_border_has_its_angle_and_the_rest_stays_free() -> None:
    mesh = square_hill()
    free = unwrap(mesh._replace(cones=np.empty(0, np.int32)))
    result = unwrap(mesh, [RIGHT * 0.8] * 4)
    assert "CONE_ON_BOUNDARY" not in codes(result.warnings)
    assert result.cone_angles == pytest.approx(RIGHT * 0.8, abs=1e-12)
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))[mesh.cones]
    before = oracle.uv_angle_sums(mesh.triangles, free.corner_uv, len(mesh.positions))[mesh.cones]
    assert sums == pytest.approx(RIGHT * 0.8, abs=1e-9)
    assert np.abs(before - RIGHT * 0.8).min() > np.radians(5)


def test_cone_on_a_free_border_without_an_angle_prescribes_nothing() -> None:
    mesh = square_hill()
    result = unwrap(mesh)
    assert sorted(only(result.warnings, "CONE_ON_BOUNDARY").elements.indices.tolist()) == mesh.cones.tolist()
    assert np.array_equal(result.corner_uv, unwrap(mesh._replace(cones=np.empty(0, np.int32))).corner_uv)


@pytest.mark.parametrize("holes", [1, 2, 3])
def test_holes_about_which_the_metric_turns_once_need_no_cut(holes: int) -> None:
    mesh = meshes.disk_with_holes(14, holes)
    result = unwrap(mesh)
    assert result.cut_edges.size == 0
    assert result.distortion.l2_stretch <= 1.01
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0


def test_turning_of_a_border_is_as_prescribed() -> None:
    mesh = meshes.disk_with_holes(14, 2)
    hole = int(oracle.boundary_loops(mesh.triangles)[1][0])
    wanted = -1.5 * np.pi
    result = lsgp.parameterize(surface(mesh), [], options=lsgp.Options(loop_turning={hole: wanted}))
    assert result.cut_edges.size > 0
    uncut = turnings(mesh, unwrap(mesh))
    turned = turnings(mesh, result)
    assert uncut[1] == pytest.approx(-2 * np.pi, abs=1e-6)
    # A cut divides the border vertex it ends at, which keeps the sum of the angles.
    assert turned[1] == pytest.approx(wanted, abs=np.radians(3))
    assert result.seams.translation_residual <= RESIDUAL


def test_turning_is_refused_where_it_cannot_be() -> None:
    mesh = meshes.hill(6)
    rim = int(oracle.boundary_loops(mesh.triangles)[0][0])
    inside = int(np.setdiff1d(mesh.triangles, oracle.boundary_loops(mesh.triangles)[0])[0])
    for turning in ({rim: 1.0}, {inside: 1.0}, {rim: float("nan")}):
        with pytest.raises(lsgp.InputError) as caught:
            lsgp.parameterize(surface(mesh), [], options=lsgp.Options(loop_turning=turning))
        assert caught.value.code == "LOOP_TURNING"
