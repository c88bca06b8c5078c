# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps of a surface on its quads: exact where a quad is on one side of the seams, else continued beyond them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.quads.quad_map import QuadCenters, QuadMap, map_on_quads
from map_checks import surface
from meshes import Mesh
from numpy.typing import NDArray
from scipy.spatial import cKDTree

AROUND, ALONG = 96, 48
MAJOR, MINOR = 1.0, 0.4
TORUS = meshes.torus(AROUND, ALONG, MAJOR, MINOR)


@cache
def quads_of_torus() -> lsgp.QuadMesh:
    return lsgp.remesh_to_quads(surface(TORUS), target=400).mesh


def centers_of(mesh: Mesh, quads: lsgp.QuadMesh) -> QuadCenters:
    """At the vertices next to the centers, in one of the triangles there."""
    _, vertices = cKDTree(mesh.positions).query(quads.positions[quads.quads].mean(axis=1))
    triangle_at = np.empty(len(mesh.positions), np.int32)
    triangle_at[mesh.triangles.ravel()] = np.repeat(np.arange(len(mesh.triangles)), 3)
    return QuadCenters(triangle_at[vertices], mesh.positions[vertices])


def carried(mesh: Mesh, quads: lsgp.QuadMesh, corner_uv: NDArray[np.float64]) -> QuadMap:
    return map_on_quads(surface(mesh), quads, centers_of(mesh, quads), corner_uv)


def turns(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Both angles of places on the torus, in turns, from 0 to 1."""
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y) - MAJOR)], axis=-1) / (2 * np.pi) % 1


def map_of_torus() -> NDArray[np.float64]:
    """Its angles, with a seam along each."""
    uv = turns(TORUS.positions)[TORUS.triangles]
    uv[np.abs(uv - 1) < 1e-9] = 0
    return uv + ((uv.max(axis=1, keepdims=True) - uv > 0.5) & (uv < 0.5))


def test_a_map_without_seams_is_interpolated() -> None:
    mesh = meshes.bumpy_sphere(4)
    quads = lsgp.remesh_to_quads(surface(mesh), target=500).mesh
    flat = mesh.positions @ np.random.default_rng(0).normal(size=(3, 2))
    found = carried(mesh, quads, flat[mesh.triangles])
    assert not len(found.across)
    expected = np.einsum("vc,vck->vk", quads.weights, flat[mesh.triangles[quads.triangles]])
    np.testing.assert_allclose(found.corner_uv, expected[quads.quads], atol=1e-12)


def test_quads_between_seams_have_the_values_of_their_side() -> None:
    quads, uv = quads_of_torus(), map_of_torus()
    found = carried(TORUS, quads, uv)
    whole = np.setdiff1d(np.arange(len(quads.quads)), found.across)
    assert 0 < len(found.across) < 0.3 * len(quads.quads)
    own = np.einsum("vc,vck->vk", quads.weights, uv[quads.triangles])[quads.quads]
    off = (found.corner_uv - own)[whole]
    np.testing.assert_allclose(off, np.round(off), atol=1e-4)  # a seam may be next to a vertex
    # None is stretched over the texture, from one side of a seam to the other.
    assert np.ptp(found.corner_uv, axis=1).max() < 0.2


def test_quads_across_seams_continue_the_map() -> None:
    quads = quads_of_torus()
    found = carried(TORUS, quads, map_of_torus())
    at = turns(quads.positions)[quads.quads]
    off = (found.corner_uv - at)[found.across]
    size = np.ptp(found.corner_uv[found.across], axis=1).max()
    assert np.abs(off - np.round(off)).max() < 0.1 * size
    at_center = map_of_torus()[centers_of(TORUS, quads).triangles[found.across]].mean(axis=1)
    assert np.abs(found.corner_uv[found.across].mean(axis=1) - at_center).max() < size


def test_neighbors_without_a_seam_between_them_have_the_same_values() -> None:
    """Exactly, so that they are one island in every program."""
    quads = quads_of_torus()
    found = carried(TORUS, quads, map_of_torus())
    pairs = {}
    for q, quad in enumerate(quads.quads.tolist()):
        for k, a in enumerate(quad):
            pairs[a, quad[(k + 1) % 4]] = q, k, (k + 1) % 4
    across, equal, other = set(found.across.tolist()), 0, 0
    for (a, b), (q, k, n) in pairs.items():
        p, m, j = pairs[b, a]
        if across & {q, p}:
            continue
        ours, theirs = found.corner_uv[q, [k, n]], found.corner_uv[p, [j, m]]
        if np.array_equal(ours, theirs):
            equal += 1
        else:
            other += 1
            assert np.abs(ours - theirs).max() > 0.9  # a seam runs along it
    assert equal > 5 * other


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_size_of_the_surface_does_not_matter(scale: float) -> None:
    quads, uv = quads_of_torus(), map_of_torus()
    found = carried(TORUS, quads, uv)
    scaled = TORUS._replace(positions=scale * TORUS.positions)
    again = carried(scaled, replace(quads, positions=scale * quads.positions), uv)
    assert again.across.tolist() == found.across.tolist()
    np.testing.assert_allclose(again.corner_uv, found.corner_uv, atol=1e-9)
