# SPDX-License-Identifier: GPL-3.0-or-later
"""Families of surfaces of about any number of triangles, each with much of one thing: islands, boundary, handles,
holes, seams, features, components, needles, corners of single polygons."""

from __future__ import annotations

import math
from collections.abc import Callable

import lsgp
import meshes
import numpy as np
from lsgp.io.mesh_files import triangulated
from lsgp.io.polygons import PolygonMesh
from meshes import Mesh


def bumpy(count: int) -> Mesh:
    """A ball of rows of triangles."""
    rows = max(3, math.isqrt(count // 4))
    positions, faces = meshes.ball_of_quads(2 * rows, rows)
    own = np.arange(len(positions))
    own[: 2 * rows], own[-2 * rows :] = own[0], own[-1]  # one vertex at each pole
    corners = own[np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    height = 1 + 0.15 * np.sin(5 * positions[:, 0] + 1) * np.cos(4 * positions[:, 1]) * np.sin(3 * positions[:, 2])
    return meshes.compact(meshes.make(positions * height[:, None], corners))


def boxes(count: int) -> Mesh:
    """Many boxes, no two alike."""
    random = np.random.RandomState(0)
    number = max(1, count // 12)
    sizes = random.uniform(0.3, 1.5, (number, 1, 3))
    box = meshes.cube(1)
    at = np.stack([np.arange(number), np.zeros(number), np.zeros(number)], axis=1)[:, None]
    positions = box.positions * sizes + 2 * at
    triangles = box.triangles + 8 * np.arange(number)[:, None, None]
    return meshes.make(positions, triangles)


def strip(count: int) -> Mesh:
    """A long strip one cell wide."""
    mesh = meshes.grid(max(1, count // 2), 1)
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    return mesh._replace(positions=np.stack([0.1 * x, 0.05 * y, 0.3 * np.sin(0.05 * x)], axis=1))


def spiral(count: int) -> Mesh:
    """A strip wound about an axis many times."""
    mesh = meshes.grid(max(1, count // 2), 1)
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    radius = 1 + 0.2 * y
    return mesh._replace(positions=np.stack([radius * np.cos(0.1 * x), radius * np.sin(0.1 * x), 0.003 * x], axis=1))


def handles(count: int) -> Mesh:
    """A slab with many holes through it."""
    number = max(1, round(math.sqrt(count / 22)))
    filled = np.ones((2 * number + 1, 2 * number + 1, 1), bool)
    filled[1::2, 1::2] = False
    return meshes.voxels(filled)


def pinched(count: int) -> Mesh:
    """Cells at random, which meet in edges and corners as well."""
    side = max(2, round((count / 3.2) ** (1 / 3)))
    return meshes.voxels(np.random.RandomState(1).random_sample((side, side, side)) < 0.35)


def holes(count: int) -> Mesh:
    return meshes.plate(max(1, round(math.sqrt(count / 30))))


def tube(count: int) -> Mesh:
    """A closed tube that winds through a plane."""
    number = max(2, round(math.sqrt(count / 16)))
    filled = np.zeros((2 * number + 1, 2 * number + 1, 1), bool)
    filled[::2] = True
    filled[1::4, 0] = filled[3::4, -1] = True
    return meshes.voxels(filled)


def needles(count: int) -> Mesh:
    """A tall cylinder whose triangles go all along it."""
    around = max(3, count // 4)
    turn = 2 * np.pi * np.arange(around) / around
    ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(around)], axis=1)
    i = np.arange(around)
    j = (i + 1) % around
    low, high = np.full(around, 2 * around), np.full(around, 2 * around + 1)
    triangles = [(i, j, around + j), (i, around + j, around + i), (low, j, i), (high, around + i, around + j)]
    positions = np.concatenate([ring, ring + np.array([0, 0, 100]), [[0, 0, 0], [0, 0, 100]]])
    return meshes.make(positions, np.concatenate([np.stack(corners, axis=1) for corners in triangles]))


def soup(count: int) -> Mesh:
    """Triangles that have nothing in common."""
    random = np.random.RandomState(2)
    corners = random.random_sample((count, 1, 3)) * 10 + 0.3 * random.random_sample((count, 3, 3))
    return meshes.make(corners, np.arange(3 * count))


def comb(teeth: int) -> PolygonMesh:
    """Four corners a tooth on both caps, and a square for each of their sides."""
    along = np.arange(teeth)[:, None] + np.array([0.2, 0.2, 0.7, 0.7])
    outline = np.stack([along, np.tile([0.0, 5.0, 5.0, 0.0], (teeth, 1))], axis=-1).reshape(-1, 2)[::-1]
    outline = np.concatenate([[[0, -1], [teeth, -1]], outline])
    n = len(outline)
    positions = np.concatenate([np.insert(outline, 2, z, axis=1) for z in (0.0, 0.5)])
    low = np.arange(n)
    sides = np.stack([low, np.roll(low, -1), np.roll(low, -1) + n, low + n], axis=1)
    vertices = np.concatenate([low[::-1], low + n, sides.ravel()]).astype(np.int32)
    return PolygonMesh(positions, vertices, np.array([n, n] + [4] * n, np.int64))


def of_polygons(mesh: PolygonMesh) -> lsgp.Surface:
    cut, _ = triangulated(mesh)
    return lsgp.Surface(mesh.positions, cut.triangles, cut.edges)


def _some_edges(mesh: Mesh) -> np.ndarray:
    edges = meshes.edges_of(mesh.triangles)
    return edges[np.random.RandomState(3).random_sample(len(edges)) < 0.3]


def _seams(count: int) -> lsgp.Surface:
    mesh = bumpy(count)
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=_some_edges(mesh))


def _features(count: int) -> lsgp.Surface:
    mesh = bumpy(count)
    return lsgp.Surface(mesh.positions, mesh.triangles, features=_some_edges(mesh))


def _plain(mesh: Callable[[int], Mesh]) -> Callable[[int], lsgp.Surface]:
    def make(count: int) -> lsgp.Surface:
        found = mesh(count)
        return lsgp.Surface(found.positions, found.triangles)

    return make


_MESHES = (bumpy, boxes, strip, spiral, handles, pinched, holes, tube, needles, soup)
FAMILIES: dict[str, Callable[[int], lsgp.Surface]] = {
    **{mesh.__name__: _plain(mesh) for mesh in _MESHES},
    "seams": _seams,
    "features": _features,
    "comb": lambda count: of_polygons(comb(max(1, count // 16))),
}
"""From about how many triangles they are to have."""
