# SPDX-License-Identifier: GPL-3.0-or-later
"""Several components: each an island of its own, to one scale, side by side in the unit square."""

from __future__ import annotations

import time

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_angles_met, assert_exact_transitions, components, only, unwrap

PARTS = [
    meshes.cube(2),
    meshes.hill(8),
    meshes.flower(2),
    meshes.grid(3, 5),
    meshes.cylinder(10, 4),
    meshes.tetrahedron(),
]
MANY = meshes.merge(PARTS)


@pytest.fixture(scope="module")
def many() -> lsgp.Result:
    return unwrap(MANY)


def test_every_component_is_an_island(many: lsgp.Result) -> None:
    assert many.solved.all()
    expected = np.concatenate([np.full(len(part.triangles), i) for i, part in enumerate(PARTS)])
    assert many.island.tolist() == expected.tolist()
    assert sorted(many.cones.tolist()) == sorted(MANY.cones.tolist())


def test_islands_have_their_area_in_space(many: lsgp.Result) -> None:
    space = np.bincount(many.island, oracle.triangle_areas(MANY.positions, MANY.triangles))
    plane = np.bincount(many.island, oracle.signed_areas(many.corner_uv))
    assert plane / space == pytest.approx(np.full(len(PARTS), plane[0] / space[0]), rel=1e-9)


def with_needles(mesh: meshes.Mesh, height: float) -> meshes.Mesh:
    """Every eleventh triangle becomes three that meet close to the middle of its first edge: one of them is a needle,
    of this height as a share of the triangle's."""
    positions, triangles = list(mesh.positions), mesh.triangles.tolist()
    for i in range(0, len(mesh.triangles), 11):
        a, b, c = mesh.triangles[i].tolist()
        middle = (mesh.positions[a] + mesh.positions[b]) / 2
        triangles[i] = [a, b, len(positions)]
        triangles += [[a, len(positions), c], [len(positions), b, c]]
        positions.append(middle + height * (mesh.positions[c] - middle))
    return mesh._replace(positions=np.array(positions), triangles=np.array(triangles))


@pytest.mark.parametrize("height", [1e-5, 1e-6, 1e-7])
def test_needles_do_not_shrink_their_island(height: float) -> None:
    """Their images are as wide as they are long: their lengths grow a million times, which is not that of the map."""
    cube, ball = meshes.cube(3), with_needles(meshes.bumpy_sphere(2), height)
    both = meshes.merge([cube, ball])
    result = unwrap(both)
    of_ball = np.arange(len(both.triangles)) >= len(cube.triangles)
    space = np.bincount(of_ball, oracle.triangle_areas(both.positions, both.triangles))
    plane = np.bincount(of_ball, np.abs(oracle.signed_areas(result.corner_uv)))
    assert plane / space == pytest.approx(np.full(2, plane[0] / space[0]), rel=1e-6)


def test_islands_lie_in_the_unit_square(many: lsgp.Result) -> None:
    assert many.corner_uv.min() >= 0 and many.corner_uv.max() <= 1
    assert np.ptp(many.corner_uv.reshape(-1, 2), axis=0).max() > 0.9


def test_a_single_island_fills_the_unit_square_one_way() -> None:
    for mesh in (meshes.cube(2), meshes.grid(3, 2)):
        uv = unwrap(mesh).corner_uv
        assert uv.min() >= 0 and uv.max() <= 1
        assert np.ptp(uv.reshape(-1, 2), axis=0).max() > 0.9


def test_islands_do_not_overlap(many: lsgp.Result) -> None:
    """No sample point of one island lies in a triangle of another."""
    weights = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [8, 8, 1], [1, 8, 8], [8, 1, 8]], float)
    weights /= weights.sum(axis=1, keepdims=True)
    for i in range(len(PARTS)):
        points = oracle.as_complex(np.einsum("sc,fck->fsk", weights, many.corner_uv[many.island == i])).ravel()
        z = oracle.as_complex(many.corner_uv[many.island != i])
        inside = np.ones((len(points), len(z)), bool)
        for c in range(3):
            a, b = z[None, :, c], z[None, :, (c + 1) % 3]
            inside &= ((b - a).conj() * (points[:, None] - a)).imag > 0
        assert not inside.any()


def test_every_island_is_the_map_of_its_component_alone(many: lsgp.Result) -> None:
    angle = dict(zip(many.cones.tolist(), many.cone_angles.tolist(), strict=True))
    for part, faces in components(MANY):
        alone = unwrap(part)
        assert oracle.similarity_gap(alone.corner_uv, many.corner_uv[faces]) <= 1e-9
        assert_exact_transitions(part, alone)
        assert_angles_met(part, alone)
        vertex = np.unique(MANY.triangles[faces])
        assert [angle[v] for v in vertex[alone.cones].tolist()] == pytest.approx(alone.cone_angles.tolist(), abs=1e-12)
        assert many.log_scale[vertex] == pytest.approx(alone.log_scale, abs=1e-9)


def test_a_closed_component_without_cones_is_left_out_and_named() -> None:
    mesh = meshes.merge([meshes.cube(2), meshes.icosphere(1), meshes.grid(2, 2)])
    mesh = mesh._replace(cones=meshes.cube(2).cones)
    result = unwrap(mesh)
    cube, ball = len(meshes.cube(2).triangles), len(meshes.icosphere(1).triangles)
    skipped = np.arange(cube, cube + ball)
    assert np.flatnonzero(~result.solved).tolist() == skipped.tolist()
    assert np.isnan(result.corner_uv[skipped]).all() and np.isfinite(result.corner_uv[result.solved]).all()
    assert (result.island[skipped] == -1).all() and sorted(set(result.island[result.solved].tolist())) == [0, 1]
    finding = only(result.warnings, "COMPONENT_SKIPPED")
    assert finding.elements.kind == "triangles" and finding.elements.indices.tolist() == skipped.tolist()
    assert "cone" in finding.message
    assert result.cones.tolist() == mesh.cones.tolist()


def test_the_first_reason_is_raised_when_nothing_can_be_solved() -> None:
    mesh = meshes.merge([meshes.icosphere(1), meshes.cube(1)])._replace(cones=np.empty(0, np.int32))
    with pytest.raises(lsgp.TopologyError) as caught:
        unwrap(mesh)
    assert caught.value.code == "TOO_FEW_CONES"


def test_figures_leave_out_what_was_not_solved() -> None:
    cube = meshes.bumpy_sphere(1)
    mesh = meshes.merge([cube, meshes.icosphere(1)])._replace(cones=cube.cones)
    alone, result = unwrap(cube), unwrap(mesh)
    assert result.distortion.l2_stretch == pytest.approx(alone.distortion.l2_stretch, rel=1e-9)
    assert result.distortion.area == pytest.approx(alone.distortion.area, rel=1e-9)


def test_hundreds_of_components_take_linear_time() -> None:
    few, lots = meshes.merge([meshes.tetrahedron()] * 20), meshes.merge([meshes.tetrahedron()] * 400)
    for mesh in (few, lots):
        result = unwrap(mesh)
        assert result.solved.all() and result.island.max() + 1 == len(mesh.triangles) // 4
    seconds = []
    for mesh in (few, lots):
        took = []
        for _ in range(3):
            begin = time.process_time()
            unwrap(mesh)
            took.append(time.process_time() - begin)
        seconds.append(min(took))
    assert seconds[1] <= 20 * 8 * seconds[0] + 0.05  # quadratic growth would be 400


def fin(scale: float) -> meshes.Mesh:
    """A thin sheet, back to back but for two long needles, so that its map folds and its signed UV area cancels."""
    positions = np.array(
        [
            [-0.0466142, 0.161558, 0.00340303],
            [-0.047423, 0.161301, 0.00356251],
            [-0.0478141, 0.161547, 0.00395644],
            [-0.047073, 0.161575, 0.00368388],
            [-0.04721415, 0.1715525, 0.003679735],
            [-0.04721415, 0.1515525, 0.003679735],
        ]
    )
    triangles = [[0, 1, 2], [3, 1, 0], [2, 3, 0], [2, 1, 3], [0, 2, 4], [2, 0, 5]]
    return meshes.make(positions * scale, triangles)


@pytest.mark.parametrize("options", [{}, {"unfold": "spectral"}, {"repair": False}, {"method": "lscm"}], ids=str)
@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0])
def test_a_scrap_takes_no_more_of_the_layout_than_of_the_surface(scale: float, options: dict) -> None:
    """Whatever its map is like: folded parts have little signed area, and none is blown up for that."""
    ball = meshes.bumpy_sphere(2)
    mesh = meshes.merge([ball, fin(scale)])
    result = unwrap(mesh, **options)
    of_ball = np.arange(len(mesh.triangles)) < len(ball.triangles)
    space = oracle.triangle_areas(mesh.positions, mesh.triangles)
    plane = np.abs(oracle.signed_areas(result.corner_uv))
    known = result.solved & ~of_ball
    size = np.ptp(result.corner_uv[of_ball].reshape(-1, 2), axis=0).max()
    assert size > 0.4, "the layout is the ball's, not the scrap's"
    if not known.any():
        return
    density = plane[of_ball].sum() / space[of_ball].sum()
    assert plane[known].sum() <= density * space[known].sum() * (1 + 1e-6)
