# SPDX-License-Identifier: GPL-3.0-or-later
"""Extremities of surfaces: tips of fingers, ears and tails, and bodies that have them."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
from meshes import Mesh
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

STARTS = 60  # points, far apart, whose mean distance tells how far out a vertex is
LEAST_LENGTH = 0.04  # of a limb, in square roots of the area
FAR = 4  # edges: a cone so far from an extremity is no cone of that extremity


def body_with_limbs(count: int, length: float, sharpness: float, seed: int) -> tuple[Mesh, NDArray[np.int64]]:
    """A ball with limbs in random directions, and the outermost vertex of each."""
    rng = np.random.default_rng(seed)
    along: list[NDArray[np.float64]] = []
    while len(along) < count:
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        if all(direction @ other < 0.6 for other in along):
            along.append(direction)
    ball = meshes.icosphere(3)
    nearness = ball.positions @ np.array(along).T
    radius = 1 + length * np.exp(sharpness * (nearness - 1)).sum(axis=1)
    return meshes.make(ball.positions * radius[:, None], ball.triangles), nearness.argmax(axis=0)


def largest_component(mesh: Mesh) -> Mesh:
    _, of_vertex = connected_components(_lengths(mesh))
    largest = np.bincount(of_vertex[mesh.triangles[:, 0]]).argmax()
    kept = mesh.triangles[of_vertex[mesh.triangles[:, 0]] == largest]
    return meshes.compact(meshes.make(mesh.positions, kept))


def extremities(mesh: Mesh) -> NDArray[np.int64]:
    """The vertices of a connected mesh that are the farthest out of all that are reached without going inwards by more
    than LEAST_LENGTH; by distances along edges, whatever the curvature."""
    lengths = _lengths(mesh)
    distance = [dijkstra(lengths, indices=0)]
    for _ in range(STARTS):
        distance.append(dijkstra(lengths, indices=int(np.min(distance[1:] or distance, axis=0).argmax())))
    outward = np.mean(distance[1:], axis=0)
    least = LEAST_LENGTH * np.sqrt(area(mesh))
    # Hills of those that are farther out are merged where they meet.
    hill = np.full(len(outward), -1)
    peaks: list[int] = []

    def top(v: int) -> int:
        while hill[v] != v:
            hill[v] = v = hill[hill[v]]
        return v

    for v in np.argsort(-outward, kind="stable").tolist():
        row = lengths.indices[lengths.indptr[v] : lengths.indptr[v + 1]]
        tops = sorted({top(w) for w in row[hill[row] >= 0].tolist()}, key=lambda w: (-outward[w], w))
        hill[v] = tops[0] if tops else v
        for lower in tops[1:]:
            hill[lower] = tops[0]
            if outward[lower] - outward[v] >= least:
                peaks.append(lower)
    return np.array(sorted([*peaks, int(outward.argmax())]))


def with_cones_at(mesh: Mesh, tips: NDArray[np.integer], placed: lsgp.Placement) -> lsgp.Placement:
    """As many cones, where the nearest cone of each extremity is at the extremity itself, with the angles of placement.
    Without cones that stand farther off than FAR."""
    away = distances_to_cones(mesh, tips, placed)
    cones = placed.cones.copy()
    for i in np.argsort(away.min(axis=1)).tolist():
        if away[i].min() <= FAR and tips[i] not in cones:
            cones[away[i].argmin()] = tips[i]
    if np.array_equal(cones, placed.cones):
        return placed
    return lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles), cones, count=len(cones))


def distances_to_cones(mesh: Mesh, tips: NDArray[np.integer], placed: lsgp.Placement) -> NDArray[np.float64]:
    """(tips, cones) along edges, in mean edges; infinite for cones that are not as of tips, but as of saddles."""
    return np.where(placed.cone_angles < 2 * np.pi, distances(mesh, tips)[:, placed.cones], np.inf)


def distances(mesh: Mesh, vertices: NDArray[np.integer]) -> NDArray[np.float64]:
    """(vertices, n) along edges, in mean edges."""
    ends = mesh.positions[meshes.edges_of(mesh.triangles)]
    return dijkstra(_lengths(mesh), indices=vertices) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean()


def area(mesh: Mesh) -> float:
    corners = mesh.positions[mesh.triangles]
    return float(
        np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    )


def _lengths(mesh: Mesh) -> csr_array:
    edges = meshes.edges_of(mesh.triangles)
    length = np.linalg.norm(mesh.positions[edges[:, 1]] - mesh.positions[edges[:, 0]], axis=1)
    both = np.concatenate([edges, edges[:, ::-1]]).T
    n = len(mesh.positions)
    return coo_array((np.tile(np.maximum(length, 1e-300), 2), (both[0], both[1])), (n, n)).tocsr()
