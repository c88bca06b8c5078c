# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads of more equal size, with corners as square as before on average: their vertices move over the surface.

Every quad has a square that is nearest to it, which is given a part of the way to the mean size; a vertex moves toward
the mean of where the squares around it have theirs (shape matching: Bouaziz et al., "Shape-Up: Shaping Discrete
Geometry with Projections", SGP 2012, where this is the projection onto squares). Motions are straight walks over the
surface, so that vertices stay on it, also where it is thin.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..base.angles import arctan2
from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys
from ..base.progress import Progress, tell
from ..surface import Surface
from .quad_mesh import QuadMesh, scale_at
from .surface_walk import SurfaceWalk

_ROUNDS, _ATTEMPTS = 20, 4
# How far squares are brought to the mean size: with more, corners would get worse.
_TO_MEAN_SIZE = 0.2
# No quad gets a corner that is farther from a right angle than this, or an edge shorter than this relative to the mean
# one, unless it had such before.
_CORNER, _SHORT = math.radians(20), 0.7
# Barycentric coordinates below this are zero.
_ZERO = 1e-9


def polished(surface: Surface, mesh: QuadMesh, features: IndexArray, progress: Progress | None = None) -> QuadMesh:
    """The same mesh with other positions of its vertices, but for irregular ones and those on features.

    surface: the one that it is on, in whose metric sizes are to be equal. features: (k, 2), edges of it, which no
    vertex crosses. No quad gets a corner more than 20 degrees off a right angle, or an edge of less than 0.7 of the
    mean one, unless it had a worse one before.
    Raises Cancelled.
    """
    walls = edge_keys(*features.T, len(surface.positions))
    held = _is_on(walls, surface, mesh)
    held[mesh.irregular] = True
    of_quads = scale_at(surface, mesh)[mesh.quads].mean(axis=1)
    walk, places = SurfaceWalk(surface, walls), (mesh.positions, mesh.triangles.astype(np.int64), mesh.weights)
    for attempt in range(_ATTEMPTS):
        positions, triangles, weights = places
        for done in range(_ROUNDS):
            tell(progress, (attempt + done / _ROUNDS) / _ATTEMPTS)
            motion = _toward_squares(positions, mesh.quads, of_quads) - positions
            motion[held] = 0.0
            triangles, weights = walk.move(triangles, weights, motion)
            positions = walk.positions(triangles, weights)
        harmed = ~_without_harm(mesh, positions, of_quads)
        if not (harmed & ~held).any():
            break
        # The others adapt to them then.
        held |= harmed
    is_moved = ~(harmed | held)
    vertex = is_moved[:, np.newaxis]
    return replace(
        mesh,
        positions=np.where(vertex, positions, mesh.positions),
        triangles=np.where(is_moved, triangles, mesh.triangles).astype(np.int32),
        weights=np.where(vertex, weights, mesh.weights),
        surface_vertices=np.where(is_moved, -1, mesh.surface_vertices).astype(np.int32),
    )


def _is_on(walls: NDArray[np.int64], surface: Surface, mesh: QuadMesh) -> NDArray[np.bool_]:
    """(v,) whether vertices are on edges with these keys, or at their ends."""
    count = len(surface.positions)
    corners, is_zero = surface.triangles[mesh.triangles], mesh.weights < _ZERO
    ends = np.unique(np.stack([walls // count, walls % count]))
    on = np.zeros(len(mesh.positions), bool)
    for c in range(3):
        others = is_zero[:, (c + 1) % 3] & is_zero[:, (c + 2) % 3]
        on |= others & np.isin(corners[:, c], ends)
        edge = corners[:, [(c + 1) % 3, (c + 2) % 3]]
        on |= is_zero[:, c] & np.isin(edge_keys(*edge.T, count), walls)
    return on


def _toward_squares(positions: FloatArray, quads: IndexArray, scale: FloatArray) -> FloatArray:
    """(v, 3) where the squares nearest to the quads around each vertex have it, on average.  scale: (q,), as
    of `_without_harm`."""
    corners = positions[quads]
    middle = corners.mean(axis=1)
    first, second = (corners[:, 0] - corners[:, 2]) / 2, (corners[:, 1] - corners[:, 3]) / 2
    normal = np.cross(first, second)
    area = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, area, out=np.zeros_like(normal), where=area > 0)
    # Half a diagonal; the other one is a quarter turn on.
    half = (first + np.cross(second, normal)) / 2
    length = np.linalg.norm(half, axis=1, keepdims=True)
    # Of a square, `area` is the square of half its diagonal.
    of_mean_size = math.sqrt((area * scale[:, np.newaxis] ** 2).mean()) / scale[:, np.newaxis]
    wanted = (1 - _TO_MEAN_SIZE) * length + _TO_MEAN_SIZE * of_mean_size
    half *= np.divide(wanted, length, out=np.ones_like(length), where=length > 0)
    other = np.cross(normal, half)
    goals = np.stack([middle + half, middle + other, middle - half, middle - other], axis=1)
    out = np.zeros_like(positions)
    np.add.at(out, quads.ravel(), goals.reshape(-1, 3))
    return out / np.bincount(quads.ravel(), minlength=len(positions))[:, np.newaxis]


def _without_harm(mesh: QuadMesh, positions: FloatArray, scale: FloatArray) -> NDArray[np.bool_]:
    """(v,) which vertices move there: as many as can without worse corners or shorter edges of bad quads.

    scale: (q,) by which lengths count at each quad.
    """
    worst, shortest = _corners_and_edges(mesh.positions, mesh.quads)
    most, least = np.maximum(worst, _CORNER), np.minimum(shortest, _SHORT * float((shortest * scale).mean()) / scale)
    moves = np.ones(len(positions), bool)
    while True:
        now, length = _corners_and_edges(np.where(moves[:, np.newaxis], positions, mesh.positions), mesh.quads)
        is_bad = ((now > most) | (length < least)) & moves[mesh.quads].any(axis=1)
        if not is_bad.any():
            return moves
        moves[mesh.quads[is_bad]] = False


def _corners_and_edges(positions: FloatArray, quads: IndexArray) -> tuple[FloatArray, FloatArray]:
    """(q,) the largest angle of a quad's corners to a right angle, radians, and the length of its shortest edge."""
    corners = positions[quads]
    along, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    angle = arctan2(np.linalg.norm(np.cross(along, back), axis=2), np.einsum("qcx,qcx->qc", along, back))
    return np.abs(angle - math.pi / 2).max(axis=1), np.linalg.norm(along, axis=2).min(axis=1)
