# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges without length: their ends are one vertex for the computation, and their triangles take the coordinates of
neighbors."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.stitching import is_collapsed, stitched_vertices
from map_checks import codes, only
from meshes import Mesh
from opened_surface import named_by

AROUND = 12


def ball_with_many_at_poles() -> Mesh:
    """Its quads are cut in two, and one of the halves at a pole is a line."""
    positions, quads = meshes.ball_of_quads(AROUND)
    return meshes.make(positions, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))


def ball() -> Mesh:
    """The same with single poles, whose other vertices belong to no face."""
    positions, triangles, _ = ball_with_many_at_poles()
    vertex = np.arange(len(positions))
    vertex[:AROUND], vertex[-AROUND:] = 0, len(positions) - AROUND
    return meshes.make(positions, vertex[triangles][~is_collapsed(vertex[triangles])])


def closed(mesh: Mesh) -> lsgp.Surface:
    stitched = lsgp.stitch_borders(mesh.positions, mesh.triangles)
    return lsgp.Surface(mesh.positions, stitched[mesh.triangles], may_collapse=True)


@pytest.mark.parametrize("preset", ("paint", "tile", "bake"))
def test_poles_of_many_vertices_have_the_map_of_one(preset: str) -> None:
    plain = ball()
    surface = closed(ball_with_many_at_poles())
    whole = ~is_collapsed(surface.triangles)
    assert np.count_nonzero(~whole) == 2 * AROUND
    one = lsgp.auto_unwrap(lsgp.Surface(plain.positions, plain.triangles), preset=preset, pack="shelves")
    many = lsgp.auto_unwrap(surface, preset=preset, pack="shelves")
    assert many.distortion == one.distortion
    np.testing.assert_array_equal(many.corner_uv[whole], one.corner_uv)
    assert named_by(many, "DEGENERATE_FACES").tolist() == np.flatnonzero(~whole).tolist()


def test_collapsed_triangles_lie_on_an_edge_of_a_neighbor() -> None:
    surface = closed(ball_with_many_at_poles())
    result = lsgp.auto_unwrap(surface)
    whole = np.flatnonzero(~is_collapsed(surface.triangles))
    at = {(surface.triangles[f, c], *result.corner_uv[f, c]): result.island[f] for f in whole for c in range(3)}
    for f in np.flatnonzero(is_collapsed(surface.triangles)):
        for c in range(3):
            assert at[(surface.triangles[f, c], *result.corner_uv[f, c])] == result.island[f]


def test_every_verb_takes_collapsed_triangles() -> None:
    surface = closed(ball_with_many_at_poles())
    cones = lsgp.place_cones(surface, count=8).cones
    plain = lsgp.place_cones(lsgp.Surface(ball().positions, ball().triangles), count=8)
    assert len(cones) == len(plain.cones) == 8
    edges = np.unique(np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)), axis=0)
    costs = lsgp.cut_costs(replace(surface, edges=edges), front=(0, -1, 0))
    assert costs.shape == (len(edges),)
    result = lsgp.parameterize(replace(surface, edges=edges, cut_costs=costs), cones)
    assert not len(result.flipped)
    measured = lsgp.measure_distortion(surface, result.corner_uv)
    assert measured.distortion.l2_stretch == pytest.approx(result.distortion.l2_stretch, rel=1e-9)


def test_quads_cover_a_ball_with_poles_of_many_vertices() -> None:
    surface = closed(ball_with_many_at_poles())
    mesh = lsgp.remesh_to_quads(surface, target=200).mesh
    quads = mesh.quads
    assert meshes.euler_characteristic(np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])) == 2
    # Its places are on the given surface, whose triangles have other numbers than those with an area.
    first = np.flatnonzero(is_collapsed(surface.triangles)).min()
    assert mesh.triangles.max() > first
    places = np.einsum("vc,vcx->vx", mesh.weights, surface.positions[surface.triangles[mesh.triangles]])
    np.testing.assert_allclose(places, mesh.positions, atol=1e-12)


def test_a_vertex_named_twice_is_refused_unless_it_may_be() -> None:
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.parameterize(replace(closed(ball_with_many_at_poles()), may_collapse=False), ())
    assert caught.value.code == "BAD_FACE"


def test_seams_may_run_along_edges_that_only_collapsed_triangles_have() -> None:
    surface = closed(ball_with_many_at_poles())
    pole = surface.triangles[is_collapsed(surface.triangles)][0]
    seams = [[pole[0], pole[0]], [pole.min(), pole.max()]]
    result = lsgp.parameterize(replace(surface, seams=np.array(seams, np.int32)), lsgp.place_cones(surface).cones)
    assert "SEAM_NOT_AN_EDGE" not in codes(result.warnings)


def test_a_collapsed_triangle_without_neighbors_is_left_out_by_name() -> None:
    grid = meshes.grid(3, 3)
    count = len(grid.positions)
    positions = np.vstack([grid.positions, [[9, 9, 9], [9, 9, 9], [9, 8, 9]]])
    triangles = np.vstack([grid.triangles, [[count, count, count + 2]]])
    result = lsgp.parameterize(lsgp.Surface(positions, triangles, may_collapse=True), ())
    assert only(result.warnings, "COMPONENT_SKIPPED").elements.indices.tolist() == [len(grid.triangles)]
    assert np.isnan(result.corner_uv[-1]).all()
    assert np.isfinite(result.corner_uv[:-1]).all()


def test_a_quad_with_an_edge_without_length_is_a_triangle() -> None:
    positions = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0], [2, 1, 0]], float)
    corners, sizes = np.array([0, 1, 2, 3, 2, 4, 3], np.int32), np.array([4, 3])
    assert stitched_vertices(positions, corners, sizes).tolist() == [0, 1, 1, 3, 4]


def test_a_hole_of_one_point_closes() -> None:
    """A row of vertices at the pole, without faces of their own between them."""
    mesh = ball_with_many_at_poles()
    whole = ~is_collapsed(closed(mesh).triangles)
    open_ball = meshes.make(mesh.positions, mesh.triangles[whole])
    stitched = lsgp.stitch_borders(open_ball.positions, open_ball.triangles)
    assert meshes.euler_characteristic(stitched[open_ball.triangles]) == 2


def test_a_line_in_a_soup_of_triangles_lies_on_an_edge_at_its_place() -> None:
    grid = meshes.triangle_soup(meshes.grid(3, 3))
    count = len(grid.positions)
    a, b = grid.positions[grid.triangles[4, :2]]
    positions = np.vstack([grid.positions, [b, a, a]])
    triangles = np.vstack([grid.triangles, [[count, count + 1, count + 2]]])
    stitched = lsgp.stitch_borders(positions, triangles)
    assert np.array_equal(stitched[stitched], stitched)
    assert np.array_equal(positions[stitched], positions)
    result = lsgp.parameterize(lsgp.Surface(positions, stitched[triangles], may_collapse=True), ())
    assert result.solved.all()
    assert codes(result.warnings) == ["ISOLATED_VERTICES", "DEGENERATE_FACES"]
    assert not np.isnan(result.corner_uv[-1]).any()
