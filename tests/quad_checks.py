# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every mesh of quads has to pass, independent of the library."""

from __future__ import annotations

from collections import Counter

import lsgp
import numpy as np
from lsgp.surface import surface_arrays
from map_checks import surface
from meshes import Mesh, euler_characteristic, torus
from numpy.typing import NDArray

TOLERANCE = 1e-12  # of positions, relative to the surface's size


def flat_torus(cells: tuple[float, float], around: int = 9, along: int = 5) -> tuple[Mesh, NDArray[np.float64]]:
    """A torus, and its layout as a rectangle of so many cells."""
    mesh = torus(around, along)
    place = np.stack(np.divmod(np.arange(len(mesh.positions)), around)[::-1], axis=1)[mesh.triangles]
    size = np.array([around, along])
    wrapped = place + size * ((place == 0) & (place.max(axis=1, keepdims=True) == size - 1))
    return mesh, wrapped * (np.array(cells) / size)


def sides(quads: NDArray[np.int32]) -> Counter:
    """How often each pair of vertices follows each other in a quad."""
    return Counter(zip(quads.ravel().tolist(), np.roll(quads, -1, axis=1).ravel().tolist(), strict=True))


def fans(quads: NDArray[np.int32]) -> int:
    """The number of cycles in which quads lie around vertices: one each on a manifold."""
    around = {}
    for quad in quads.tolist():
        for k in range(4):
            before, vertex, after = quad[k - 1], quad[k], quad[(k + 1) % 4]
            around[vertex, after] = (vertex, before)
    cycles = 0
    while around:
        cycles += 1
        start, at = around.popitem()
        while at != start:
            at = around.pop(at)
    return cycles


def layout_area(corner_uv: NDArray[np.float64]) -> float:
    first, second = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return float((first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum()) / 2


def vertex_angles(mesh: Mesh, corner_uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """The sum of each vertex's angles in the layout, in quarter turns."""
    ahead = np.roll(corner_uv, -1, axis=1) - corner_uv
    back = np.roll(corner_uv, 1, axis=1) - corner_uv
    angles = np.arctan2(ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0], (ahead * back).sum(axis=-1))
    return np.bincount(mesh.triangles.ravel(), angles.ravel(), len(mesh.positions)) / (np.pi / 2)


def distances(mesh: Mesh, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The distance of each point to the surface, by all triangles."""
    a, b, c = mesh.positions[mesh.triangles].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    out = []
    for p in points:
        nearest = np.inf
        # Above the inside of a triangle; otherwise the nearest point is on an edge.
        inside = np.ones(len(a), bool)
        for start, end in ((a, b), (b, c), (c, a)):
            inside &= (np.cross(end - start, p - start) * normal).sum(axis=1) >= 0
            share = ((p - start) * (end - start)).sum(axis=1) / ((end - start) ** 2).sum(axis=1)
            foot = start + np.clip(share, 0, 1)[:, None] * (end - start)
            nearest = min(nearest, np.linalg.norm(foot - p, axis=1).min())
        if inside.any():
            heights = np.abs(((p - a) * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)
            nearest = min(nearest, heights[inside].min())
        out.append(nearest)
    return np.array(out)


def require_quads_of(mesh: Mesh, corner_uv: NDArray[np.float64], found: lsgp.QuadMesh, cell: float = 1.0) -> None:
    """A closed manifold of quads over the surface, as its layout says."""
    require_closed_quads(mesh, found)
    assert len(found.quads) == round(layout_area(corner_uv) / cell**2)
    require_cones(mesh, corner_uv, found)


def require_closed_quads(mesh: Mesh, found: lsgp.QuadMesh) -> None:
    """A closed manifold of quads over the surface."""
    quads, count = found.quads, len(found.positions)
    assert quads.min() == 0 and quads.max() == count - 1
    assert all(len(set(quad)) == 4 for quad in quads.tolist())
    once = sides(quads)
    assert set(once.values()) == {1}
    assert all((b, a) in once for a, b in once)
    assert fans(quads) == count
    assert np.bincount(quads.ravel(), minlength=count).tolist() == found.valences.tolist()
    assert count - len(once) // 2 + len(quads) == euler_characteristic(mesh.triangles)
    require_on_surface(mesh, found)


def require_cones(mesh: Mesh, corner_uv: NDArray[np.float64], found: lsgp.QuadMesh) -> None:
    """Irregular vertices are the cones, with as many quads as these have quarter turns."""
    turns = np.round(vertex_angles(mesh, corner_uv)).astype(int)
    cones = np.flatnonzero((turns != 4) & (turns != 0))
    assert sorted(found.surface_vertices[found.irregular].tolist()) == cones.tolist()
    at = dict(zip(found.surface_vertices.tolist(), found.valences.tolist(), strict=True))
    assert [at[cone] for cone in cones.tolist()] == turns[cones].tolist()


def require_on_surface(mesh: Mesh, found: lsgp.QuadMesh) -> None:
    """Where triangles and weights say, which is on the surface, at vertices exactly."""
    assert found.weights.min() >= 0
    np.testing.assert_allclose(found.weights.sum(axis=1), 1, rtol=0, atol=1e-15)
    corners = mesh.positions[mesh.triangles[found.triangles]]
    size = np.ptp(mesh.positions, axis=0).max()
    np.testing.assert_allclose(
        found.positions, np.einsum("vc,vcx->vx", found.weights, corners), rtol=0, atol=TOLERANCE * size
    )
    at = found.surface_vertices >= 0
    positions = surface_arrays(surface(mesh))[0]  # those of the mesh, or as LSGP_TEST_JITTER has moved them
    assert np.array_equal(found.positions[at], positions[found.surface_vertices[at]])
