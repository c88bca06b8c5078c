# SPDX-License-Identifier: GPL-3.0-or-later
"""Placement where there is no room: surfaces without an inner vertex, and fewer places than cones."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import codes, only, surface
from placement_checks import place

WITHOUT_INNER_VERTEX = {
    "triangle": meshes.make([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    "quad": meshes.grid(1, 1),
    "strip": meshes.grid(12, 1),
    "tube": meshes.cylinder(6, 1),
    "fin": meshes.make(meshes.tetrahedron().positions, meshes.tetrahedron().triangles[:2]),
}
every_such_mesh = pytest.mark.parametrize("name", WITHOUT_INNER_VERTEX)
WAYS = [{}, {"count": 0}, {"count": 3}, {"lattice": "square"}, {"count": 3, "symmetric": True}, {"prefer_sharp": True}]


@every_such_mesh
@pytest.mark.parametrize("way", WAYS, ids=str)
def test_surface_without_an_inner_vertex_gets_no_cones_and_unfolds(name: str, way: dict) -> None:
    mesh = WITHOUT_INNER_VERTEX[name]
    placed = place(mesh, **way)
    assert len(placed.cones) == 0
    result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles)
    assert result.solved.all() and len(result.flipped) == 0
    assert result.distortion.l2_stretch == pytest.approx(placed.predicted_l2, rel=0.02)


@every_such_mesh
def test_no_cone_can_be_gained_there(name: str) -> None:
    mesh = WITHOUT_INNER_VERTEX[name]
    gains = lsgp.cone_gains(surface(mesh))
    assert gains.best is None and np.isnan(gains.predicted_l2).all()
    assert gains.present_l2 == pytest.approx(lsgp.prescribe_curvature(surface(mesh), []).predicted_l2, rel=1e-9)


def test_cones_that_find_no_room_are_named_by_the_parts_that_lack_it() -> None:
    mesh = meshes.merge([meshes.grid(2, 2), meshes.bumpy_sphere(1)])
    placed = place(mesh, count=5)
    finding = only(placed.warnings, "PLACEMENT_NOT_REACHED")
    assert (
        finding.message.startswith("1 of the 5 cones asked for was placed")
        and "no other interior vertex" in finding.message
    )
    assert finding.elements.kind == "triangles" and finding.elements.indices.tolist() == list(range(8))
    assert len(placed.cones) == 6


def test_every_vertex_of_a_closed_surface_is_room() -> None:
    mesh = meshes.octahedron()
    assert "PLACEMENT_NOT_REACHED" not in codes(place(mesh, count=6).warnings)
    finding = only(place(mesh, count=7).warnings, "PLACEMENT_NOT_REACHED")
    assert finding.message.startswith("6 of the 7 cones asked for were placed")


def test_cones_that_come_out_flat_are_said_to() -> None:
    mesh = meshes.bumpy_sphere(2)
    placed = place(mesh, count=40, lattice="square")
    assert len(placed.cones) < 40
    finding = only(placed.warnings, "PLACEMENT_NOT_REACHED")
    assert finding.message.startswith(f"{len(placed.cones)} of the 40 cones") and "flat" in finding.message


def test_mirrored_pairs_that_are_one_too_many_are_said_to_be() -> None:
    # Its vertices are off the mirror plane, all but none.
    mesh = meshes.cylinder(8, 4)
    placed = place(mesh, count=3, symmetric=True, mirror=([0, 0, 0], [np.sin(np.pi / 8), -np.cos(np.pi / 8), 0]))
    finding = only(placed.warnings, "PLACEMENT_NOT_REACHED")
    assert len(placed.cones) == 2 and "pairs" in finding.message


BALL = meshes.bumpy_sphere(2)
NOWHERE = np.empty((0, 2), np.int32)


def edges_among(vertices: np.ndarray) -> np.ndarray:
    edges = np.unique(np.sort(BALL.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    return edges[np.isin(edges, np.flatnonzero(vertices)).all(axis=1)]


@pytest.mark.parametrize("way", [{}, {"count": 3}, {"lattice": "square"}], ids=str)
@pytest.mark.parametrize("edges", [NOWHERE, BALL.triangles[:1, :2]], ids=["none", "one"])
def test_closed_surface_without_enough_edges_to_cut_is_refused(edges: np.ndarray, way: dict) -> None:
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.place_cones(lsgp.Surface(BALL.positions, BALL.triangles, edges), **way)
    assert caught.value.code == "CUTS_BLOCKED"
    assert f"lead to {2 * len(edges)} places" in caught.value.message


@pytest.mark.parametrize("way", [{}, {"count": 8}, {"lattice": "square"}, {"count": 8, "symmetric": True}], ids=str)
def test_cones_are_placed_where_cuts_can_join_them(way: dict) -> None:
    """Two networks of edges, about the poles: the larger one has all cones."""
    caps = [BALL.positions[:, 2] > 0.3, BALL.positions[:, 2] < -0.6]
    given = lsgp.Surface(BALL.positions, BALL.triangles, np.concatenate([edges_among(cap) for cap in caps]))
    placed = lsgp.place_cones(given, **way)
    assert len(placed.cones) > 0 and caps[0][placed.cones].all()
    assert lsgp.parameterize(given, placed.cones, placed.cone_angles).solved.all()
    gains = lsgp.cone_gains(given)
    assert caps[0][~np.isnan(gains.predicted_l2)].all()


def test_cones_join_those_there_are() -> None:
    caps = [BALL.positions[:, 2] > 0.3, BALL.positions[:, 2] < -0.6]
    given = lsgp.Surface(BALL.positions, BALL.triangles, np.concatenate([edges_among(cap) for cap in caps]))
    placed = lsgp.place_cones(given, [int(np.flatnonzero(caps[1])[0])], count=5)
    assert len(placed.cones) == 5 and caps[1][placed.cones].all()


def test_handles_that_no_cut_opens_are_refused_before_cones_are_placed() -> None:
    mesh = meshes.torus()
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles, mesh.triangles[:4, :2]))
    assert caught.value.code == "CUTS_BLOCKED"


def test_a_cone_where_parts_touch_is_named_if_its_angles_differ() -> None:
    cube, ball = meshes.cube(2), meshes.bumpy_sphere(2)
    corner = int(cube.cones[0])
    mesh = meshes.merge([cube, ball])
    triangles = mesh.triangles.copy()
    triangles[triangles == len(cube.positions)] = corner
    apart = lsgp.place_cones(surface(mesh), [corner])
    touching = lsgp.place_cones(lsgp.Surface(mesh.positions, triangles), [corner])
    named = [f for f in touching.warnings if f.code == "SPLIT_VERTEX" and "separate angle" in f.message]
    assert [f.elements.indices.tolist() for f in named] == [[corner]]
    assert "SPLIT_VERTEX" not in codes(apart.warnings)
