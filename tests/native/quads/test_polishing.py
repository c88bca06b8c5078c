# SPDX-License-Identifier: GPL-3.0-or-later
"""Polished quads: vertices move over the surface, and edges get more equal at corners as square as before."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.quads.polishing import polished
from lsgp.quads.surface_walk import SurfaceWalk
from map_checks import surface
from numpy.typing import NDArray
from quad_checks import require_closed_quads
from zoo import closed

NO_WALLS = np.empty(0, np.int64)


def corner_errors(mesh: lsgp.QuadMesh) -> NDArray[np.float64]:
    """(q, 4) radians."""
    corners = mesh.positions[mesh.quads]
    along, back = (np.roll(corners, by, axis=1) - corners for by in (-1, 1))
    along, back = (each / np.linalg.norm(each, axis=2, keepdims=True) for each in (along, back))
    return np.abs(np.arccos(np.clip((along * back).sum(axis=2), -1, 1)) - np.pi / 2)


@pytest.mark.parametrize("size", [(1, 1, 1), (1, 1.3, 2), (0.6, 1, 1.4)])
def test_quads_of_ellipsoids_get_better_on_their_surface(size: tuple[float, float, float]) -> None:
    ball = meshes.icosphere(3)
    ball = surface(ball._replace(positions=ball.positions * size))
    rough, smooth = (lsgp.remesh_to_quads(ball, target=600, polish=polish) for polish in (False, True))
    require_closed_quads(ball, smooth.mesh)
    places = np.einsum("vc,vcx->vx", smooth.mesh.weights, ball.positions[ball.triangles[smooth.mesh.triangles]])
    np.testing.assert_allclose(smooth.mesh.positions, places, atol=1e-12)
    assert (smooth.mesh.weights >= 0).all()
    np.testing.assert_array_equal(smooth.mesh.quads, rough.mesh.quads)
    held = rough.mesh.irregular
    np.testing.assert_array_equal(smooth.mesh.positions[held], rough.mesh.positions[held])
    before, after = (lsgp.quad_quality(each.mesh.positions, each.mesh.quads) for each in (rough, smooth))
    assert after.edge_deviation < 0.98 * before.edge_deviation
    assert after.angle_error < 1.05 * before.angle_error
    errors = [corner_errors(each.mesh).max(axis=1) for each in (rough, smooth)]
    assert (errors[1] <= np.maximum(errors[0], np.radians(20)) + 1e-9).all()
    assert lsgp.remesh_to_quads(ball, target=600, polish=True) == smooth


def test_creases_stay_rows_of_edges() -> None:
    box = surface(closed.box(5, (1, 1.4, 2)))
    bent = replace(box, positions=box.positions + 0.1 * np.sin(3 * box.positions[:, [1, 2, 0]]))
    marked = replace(bent, features=lsgp.feature_edges(box, angle=0.7))
    remesh = lsgp.remesh_to_quads(marked, target=600, polish=True)
    rough = lsgp.remesh_to_quads(marked, target=600)
    require_closed_quads(marked, remesh.mesh)
    moved = (remesh.mesh.positions != rough.mesh.positions).any(axis=1)
    begin, end = marked.positions[marked.features].transpose(1, 0, 2)
    along = end - begin
    away = rough.mesh.positions[:, np.newaxis] - begin
    share = np.clip((away * along).sum(axis=2) / (along**2).sum(axis=1), 0, 1)
    is_on = np.linalg.norm(away - share[..., np.newaxis] * along, axis=2).min(axis=1) < 1e-9
    assert is_on.sum() > 50 and moved.any() and not moved[is_on].any()


def test_a_plane_without_faults_stays() -> None:
    remesh = lsgp.remesh_to_quads(surface(meshes.cube(4)), target=384)
    again = polished(remesh.surface, remesh.mesh, remesh.layout.seamless.creases)
    np.testing.assert_allclose(again.positions, remesh.mesh.positions, atol=1e-12)


def test_walks_bend_with_the_surface_and_end_at_walls() -> None:
    """Around a corner of 90 degrees between two planes, and across many edges of either."""
    size = 8
    flat = meshes.grid(size, size, lambda x, y: 0 * x)
    folded = flat.positions.copy()
    over = folded[:, 0] > 4
    folded[over, 2], folded[over, 0] = folded[over, 0] - 4, 4
    rng = np.random.default_rng(2)
    triangles = rng.integers(0, len(flat.triangles), 200)
    weights = rng.dirichlet(np.ones(3), 200)
    motion = rng.uniform(-4, 4, (200, 2))

    def moved(positions: NDArray[np.float64], by: NDArray[np.float64], walls: NDArray[np.int64]) -> np.ndarray:
        """Where the walks end, in the plane."""
        walk = SurfaceWalk(lsgp.Surface(positions, flat.triangles), walls)
        ends, shares = walk.move(triangles.astype(np.int64), weights, by)
        assert (shares >= 0).all()
        np.testing.assert_allclose(shares.sum(axis=1), 1)
        return np.einsum("kc,kcx->kx", shares, flat.positions[flat.triangles[ends]])

    start = np.einsum("kc,kcx->kx", weights, flat.positions[flat.triangles[triangles]])
    goal = start[:, :2] + motion
    stays = ((goal >= 0) & (goal <= size)).all(axis=1)
    assert stays.sum() > 50
    in_plane = np.concatenate([motion, np.zeros((200, 1))], axis=1)
    np.testing.assert_allclose(moved(flat.positions, in_plane, NO_WALLS)[stays, :2], goal[stays], atol=1e-9)
    upright = np.where((start[:, 0] > 4)[:, np.newaxis], in_plane[:, [2, 1, 0]], in_plane)
    np.testing.assert_allclose(moved(folded, upright, NO_WALLS)[stays, :2], goal[stays], atol=1e-9)
    edges = meshes.edges_of(flat.triangles)
    middle = edges[(flat.positions[edges, 0] == 4).all(axis=1)]
    walls = np.sort(middle, axis=1).astype(np.int64) @ [len(flat.positions), 1]
    ends = moved(flat.positions, in_plane, walls)
    is_left = start[:, 0] <= 4
    assert (ends[is_left, 0] <= 4 + 1e-12).all() and (ends[~is_left, 0] >= 4 - 1e-12).all()
