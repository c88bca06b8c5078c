# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight walks over a surface, which bend with it where they cross its edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys
from ..surface import Surface
from .edge_partners import edge_ends, edge_partners

Indices = NDArray[np.int64]

# Triangles that a walk crosses at most; what is left of longer ones is dropped.
_MOST_STEPS = 64


class SurfaceWalk:
    """Walks from places on triangles, whose edges are numbered as by `edge_ends`."""

    def __init__(self, surface: Surface, walls: Indices) -> None:
        """walls: keys of edges that no walk crosses."""
        self._corners = surface.positions[surface.triangles]
        is_wall = np.isin(edge_keys(*edge_ends(surface.triangles), len(surface.positions)), walls)
        self._partner = np.where(is_wall, -1, edge_partners(surface.triangles))

    def positions(self, triangles: Indices, weights: FloatArray) -> FloatArray:
        """(k, 3) of places."""
        return _combined(self._corners[triangles], weights)

    def move(self, triangles: Indices, weights: FloatArray, motion: FloatArray) -> tuple[Indices, FloatArray]:
        """Where walks end, as triangles and barycentric coordinates in them, at which they begin, too: (k,), (k, 3).

        motion: (k, 3), what a walk would be in the plane of its first triangle. At walls and triangles without area
        walks end early.
        """
        triangles, weights, motion = triangles.copy(), weights.copy(), motion.copy()
        active = np.flatnonzero(motion.any(axis=1))
        for _ in range(_MOST_STEPS):
            if not len(active):
                break
            corners, at = self._corners[triangles[active]], weights[active]
            change, area = _change(corners, motion[active])
            with np.errstate(divide="ignore", invalid="ignore"):
                share = np.where(change < 0, at / -change, np.inf)
            out, rows = share.argmin(axis=1), np.arange(len(active))
            part = np.minimum(share[rows, out], 1.0)
            is_across = (part < 1) & (area > 0)
            at += np.where(area > 0, part, 0.0)[:, np.newaxis] * change
            at[rows[is_across], out[is_across]] = 0.0
            at = np.maximum(at, 0.0)
            weights[active] = at / at.sum(axis=1, keepdims=True)
            edge = (out + 1) % 3
            partner = self._partner[3 * triangles[active] + edge]
            goes_on = is_across & (partner >= 0)
            kept = active[goes_on]
            self._cross(triangles, weights, motion, (kept, edge[goes_on], partner[goes_on]))
            motion[kept] *= (1 - part[goes_on])[:, np.newaxis]
            active = kept
        return triangles, weights

    def _cross(
        self,
        triangles: Indices,
        weights: FloatArray,
        motion: FloatArray,
        crossing: tuple[Indices, IndexArray, Indices],
    ) -> None:
        """Take walks over an edge of their triangles into those beyond."""
        walks, edge, partner = crossing
        rows = np.arange(len(walks))
        before, at = self._corners[triangles[walks]], weights[walks]
        triangle, entered = partner // 3, partner % 3
        after = self._corners[triangle]
        along = before[rows, (edge + 1) % 3] - before[rows, edge]
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        outward, inward = (np.cross(along, _normal(corners)) for corners in (before, after))
        amount = [np.einsum("kx,kx->k", motion[walks], axis)[:, np.newaxis] for axis in (along, outward)]
        motion[walks] = amount[0] * along + amount[1] * inward
        # The edge runs the other way there.
        weights[walks] = 0.0
        weights[walks, entered] = at[rows, (edge + 1) % 3]
        weights[walks, (entered + 1) % 3] = at[rows, edge]
        triangles[walks] = triangle


def _combined(corners: FloatArray, weights: FloatArray) -> FloatArray:
    return sum(weights[:, c, np.newaxis] * corners[:, c] for c in range(3))


def _normal(corners: FloatArray) -> FloatArray:
    """Unit normals, (k, 3); 0 without area."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)


def _change(corners: FloatArray, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(k, 3) by how much barycentric coordinates change along a motion in the triangle's plane, and (k,) the square of
    twice its area: 0 where they do not."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]

    def dot(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.einsum("kx,kx->k", a, b)

    square, mixed, other = dot(first, first), dot(first, second), dot(second, second)
    area = square * other - mixed * mixed
    along, across = dot(motion, first), dot(motion, second)
    with np.errstate(divide="ignore", invalid="ignore"):
        one = np.where(area > 0, (other * along - mixed * across) / area, 0.0)
        two = np.where(area > 0, (square * across - mixed * along) / area, 0.0)
    return np.stack([-one - two, one, two], axis=1), np.maximum(area, 0.0)
