# SPDX-License-Identifier: GPL-3.0-or-later
"""A UV map of a surface on the quads that cover it.

A map ends at its seams, which quads may lie across. So every corner of a quad takes the value that the map has at its
vertex as seen from the quad's center: ways lead from there to the corners, and where a seam stops one of them, the map
is continued beyond it by the affine map that fits the quad's other values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..surface import Surface
from .edge_partners import edge_partners
from .quad_mesh import QuadMesh

Indices = NDArray[np.int64]

# Of texture coordinates in single precision, relative to the largest: sides of an edge that differ by no more are no
# seam.
_ROUNDING = 4 * np.finfo(np.float32).eps
# Barycentric coordinates below this are zero: those on a surface whose edges were divided are rounded.
_ZERO = 1e-9
# Ways begin inside a triangle, by this much in barycentric coordinates, from where they can run in any direction.
_INSIDE = 1e-3
# A way that gets longer than this, relative to the distance of its ends, has missed its goal.
_LONGEST_WAY = 3.0
# Weight of the map at the center in the fit. It counts where the other values are nearly on one line.
_AT_CENTER = 0.01
# Edges are parallel if the sine of the angle between them, or rather their double area relative to the sum of their
# squares, is rounding.
_PARALLEL = 1e-15
# A way may miss its goal where the surface is folded within a quad. The map's own value there is taken if it is as near
# to the continued one as this, relative to the distance of that one.
_NEAR = 0.5
# A seam this near to a vertex, relative to its distance from the center, is at the vertex.
_AT_VERTEX = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class QuadCenters:
    """The points of a surface below the centers of quads.  triangles: (q,). positions: (q, 3)."""

    triangles: IndexArray
    positions: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class QuadMap:
    """corner_uv: (q, 4, 2) float64. across: (k,) int32, the quads that lie across seams, where it is approximate."""

    corner_uv: FloatArray
    across: IndexArray


def map_on_quads(surface: Surface, mesh: QuadMesh, centers: QuadCenters, corner_uv: ArrayLike) -> QuadMap:
    """The map on the quads.  surface: the one that `mesh` is on. corner_uv: (m, 3, 2)."""
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    ways = _Ways(surface, mesh, centers, _beyond(surface.triangles, uv))
    ways.walk()
    values, missing = ways.values(uv), ways.goal - ways.place
    ends = np.flatnonzero(missing.any(axis=1))
    rows, number = np.unique(ends // 4, return_inverse=True)
    at_center = _gradients(surface, uv, centers.triangles[rows])
    linear = _fitted(at_center, ways.place.reshape(-1, 4, 3)[rows], values.reshape(-1, 4, 2)[rows])
    further = np.einsum("kx,kxc->kc", missing[ends], linear[number])
    continued = values[ends] + further
    own = np.einsum("kc,kcx->kx", ways.goal_weights[ends], uv[ways.goal_triangles[ends]])
    takes_own = ways.is_lost(ends) & (
        np.linalg.norm(own - continued, axis=1) <= _NEAR * np.linalg.norm(further, axis=1)
    )
    values[ends] = np.where(takes_own[:, np.newaxis], own, continued)
    is_far = np.linalg.norm(missing[ends], axis=1) > _AT_VERTEX * np.linalg.norm(ways.ahead[ends], axis=1)
    across = np.unique(ends[is_far & ~takes_own] // 4).astype(np.int32)
    return QuadMap(values.reshape(-1, 4, 2), across)


class _Ways:
    """Ways over a surface from the centers of quads to their corners, each in the plane through both ends that is
    upright on the quad.

    goal: (4q, 3), the corners, each in a triangle, goal_triangles, with weights, goal_weights, (4q, 3). ahead: (4q, 3),
    from the centers to them. place: (4q, 3), the goals where ways arrive, else where they end.
    """

    def __init__(self, surface: Surface, mesh: QuadMesh, centers: QuadCenters, beyond: Indices) -> None:
        self._positions, self._triangles, self._beyond = surface.positions, surface.triangles, beyond
        corners = mesh.positions[mesh.quads]
        across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        self.goal = corners.reshape(-1, 3)
        # The triangle of each place, and the place as a mean of these of its corners.
        self._triangle = np.repeat(centers.triangles, 4).astype(np.int64)
        self._corners = np.tile(np.arange(3), (len(self.goal), 1))
        below = surface.positions[surface.triangles[centers.triangles]]
        shares = np.maximum(_barycentric(below, centers.positions), _INSIDE)
        shares /= shares.sum(axis=1, keepdims=True)
        self._weights = np.repeat(shares, 4, axis=0)
        self.place = np.repeat(np.einsum("qc,qcx->qx", shares, below), 4, axis=0)
        self._start, self.ahead = self.place.copy(), self.goal - self.place
        self._normal = np.cross(self.ahead, np.repeat(across, 4, axis=0))
        quads = mesh.quads.ravel()
        self.goal_triangles = mesh.triangles[quads]
        self.goal_weights = np.where(mesh.weights > _ZERO, mesh.weights, 0.0)[quads]

    def walk(self) -> None:
        """Walk all of them until they arrive, or come to an edge with nothing beyond."""
        active, entered = np.arange(len(self.goal)), np.full(len(self.goal), -1)
        left = _LONGEST_WAY * np.linalg.norm(self.ahead, axis=1)
        while len(active):
            active = active[~self._arrive(active)]
            edge, place, shares = self._way_out(active, entered[active])
            left[active] -= np.linalg.norm(place - self.place[active], axis=1)
            is_on = (edge >= 0) & (left[active] > 0)
            active, edge, place, shares = active[is_on], edge[is_on], place[is_on], shares[is_on]
            self.place[active] = place
            self._corners[active] = (edge[:, np.newaxis] + np.arange(3)) % 3
            self._weights[active] = np.stack([1 - shares, shares, np.zeros(len(active))], axis=1)
            partner = self._beyond[3 * self._triangle[active] + edge]
            active, partner = active[partner >= 0], partner[partner >= 0]
            self._triangle[active], entered[active] = partner // 3, partner % 3

    def values(self, corner_uv: FloatArray) -> FloatArray:
        """(4q, 2) of the map at the places."""
        of_corners = corner_uv[self._triangle[:, np.newaxis], self._corners]
        # One after the other: where no seam is between two quads, they have exactly the same values.
        return sum(self._weights[:, k, np.newaxis] * of_corners[:, k] for k in range(3))

    def is_lost(self, ways: Indices) -> NDArray[np.bool_]:
        """Which of those that did not arrive ended although there is something beyond the edge."""
        return self._beyond[3 * self._triangle[ways] + self._corners[ways, 0]] >= 0

    def _arrive(self, ways: Indices) -> NDArray[np.bool_]:
        """Which of the ways are in a triangle that contains their goals."""
        vertices, weights = self._triangles[self.goal_triangles[ways]], self.goal_weights[ways]
        is_same = vertices[:, :, np.newaxis] == self._triangles[self._triangle[ways]][:, np.newaxis, :]
        arrives = (is_same.any(axis=2) | (weights == 0)).all(axis=1)
        arrived = ways[arrives]
        self.place[arrived] = self.goal[arrived]
        self._corners[arrived], self._weights[arrived] = is_same[arrives].argmax(axis=2), weights[arrives]
        return arrives

    def _way_out(self, ways: Indices, entered: Indices) -> tuple[Indices, FloatArray, FloatArray]:
        """(k,) the edge by which each leaves its triangle, -1 for none, and where: (k, 3), and (k,) as a share of the
        edge."""
        corners = self._positions[self._triangles[self._triangle[ways]]]
        # Component by component, so that both triangles at an edge see its ends on the same sides.
        (x, y, z), normal = np.moveaxis(corners - self._start[ways, np.newaxis], 2, 0), self._normal[ways, np.newaxis]
        height = normal[..., 0] * x + normal[..., 1] * y + normal[..., 2] * z
        following = np.roll(height, -1, axis=1)
        crosses = (height >= 0) != (following >= 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(crosses, height / (height - following), 0.0)
        places = corners + shares[..., np.newaxis] * (np.roll(corners, -1, axis=1) - corners)
        progress = np.einsum("kcx,kx->kc", places - self._start[ways, np.newaxis], self.ahead[ways])
        crosses[np.arange(len(ways)), entered] &= entered < 0
        edge = np.where(crosses, progress, -np.inf).argmax(axis=1)
        rows = np.arange(len(ways))
        return np.where(crosses[rows, edge], edge, -1), places[rows, edge], shares[rows, edge]


def _beyond(triangles: IndexArray, corner_uv: FloatArray) -> Indices:
    """(3m,) the same edge in the triangle beyond, -1 at seams."""
    partner = edge_partners(triangles)
    at_start, at_end = corner_uv.reshape(-1, 2), np.roll(corner_uv, -1, axis=1).reshape(-1, 2)
    limit = _ROUNDING * np.abs(corner_uv).max(initial=0.0)
    apart = np.maximum(np.abs(at_end[partner] - at_start), np.abs(at_start[partner] - at_end)).max(axis=1) > limit
    return np.where(apart, -1, partner)


def _barycentric(corners: FloatArray, points: FloatArray) -> FloatArray:
    """(k, 3) of points in triangles, (k, 3, 3); those of a triangle's middle where it has no area."""
    shares = np.einsum("kex,kx->ke", _dual(corners[:, 1:] - corners[:, :1]), points - corners[:, 0])
    return np.concatenate([1 - shares.sum(axis=1, keepdims=True), shares], axis=1)


def _gradients(surface: Surface, corner_uv: FloatArray, triangles: IndexArray) -> FloatArray:
    """(k, 3, 2) the linear part of the map on some triangles; 0 across them."""
    corners, uv = surface.positions[surface.triangles[triangles]], corner_uv[triangles]
    return np.einsum("kex,kec->kxc", _dual(corners[:, 1:] - corners[:, :1]), uv[:, 1:] - uv[:, :1])


def _dual(edges: FloatArray) -> FloatArray:
    """(k, 2, 3) the pseudoinverses of two edges of triangles, (k, 2, 3), transposed. Not those of numpy, which are
    rounded otherwise on other processors."""
    unit = _sizes(edges)
    edges = edges / unit
    first, second = edges[:, 0], edges[:, 1]
    normal = np.cross(first, second)
    area, size = (normal**2).sum(axis=1), (edges**2).sum(axis=(1, 2))
    # Where the edges are parallel, they are their own duals but for a factor; where both are points, 0.
    is_flat = area <= (_PARALLEL * size) ** 2
    duals = np.where(
        is_flat[:, np.newaxis, np.newaxis],
        edges,
        np.stack([np.cross(second, normal), np.cross(normal, first)], axis=1),
    )
    return duals / np.where(is_flat, np.where(size > 0, size, 1.0), area)[:, np.newaxis, np.newaxis] / unit


def _fitted(at_center: FloatArray, places: FloatArray, values: FloatArray) -> FloatArray:
    """(k, 3, 2) the linear part of the affine map that fits values, (k, c, 2), at places, (k, c, 3), best."""
    offsets = places - places.mean(axis=1, keepdims=True)
    unit = _sizes(offsets)
    offsets = offsets / unit
    square = np.einsum("kcx,kcy->kxy", offsets, offsets)
    weight = _AT_CENTER * np.trace(square, axis1=1, axis2=2)[:, np.newaxis, np.newaxis]
    weight = np.where(weight > 0, weight, 1.0)
    moments = np.einsum("kcx,kcy->kxy", offsets, values - values.mean(axis=1, keepdims=True))
    # By Cramer's rule: the condition is below 1 / _AT_CENTER + 1. numpy.linalg rounds otherwise on other processors.
    rows = np.moveaxis(square + weight * np.eye(3), 1, 0)
    columns = np.stack([np.cross(rows[(i + 1) % 3], rows[(i + 2) % 3]) for i in range(3)], axis=2)
    determinant = (rows[0] * columns[:, :, 0]).sum(axis=1)
    return np.einsum("kxy,kyc->kxc", columns, moments + weight * unit * at_center) / (
        determinant[:, np.newaxis, np.newaxis] * unit
    )


def _sizes(vectors: FloatArray) -> FloatArray:
    """(k, 1, 1) the largest coordinate of each k, in which products of six of them do not overflow; 1 for 0."""
    largest = np.abs(vectors).max(axis=(1, 2), keepdims=True)
    return np.where(largest > 0, largest, 1.0)
