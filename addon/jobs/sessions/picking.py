# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices and cones of meshes under a pixel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ...core.screen import Screen
from ...mesh.stored_mesh import FrozenMesh

# Fraction of the mesh's size by which a cone may lie behind the surface and still count as visible.
BEHIND = 1e-3


@dataclass(frozen=True, slots=True)
class Hit:
    """A vertex at a pixel.  depth: of the surface or the vertex there, as of `Screen.pixels`. distance: in pixels.

    edge: the number of an edge there, of which the vertex is the nearer end; -1 where none was looked for.
    """

    vertex: int
    depth: float
    distance: float = 0.0
    edge: int = -1


@dataclass(frozen=True, slots=True)
class PickedPlace:
    """triangle: its number. place: (3,) in the mesh's own space. depth: as of `Screen.pixels`."""

    triangle: int
    place: NDArray[np.float64]
    depth: float


class Picker:
    """Casts rays at the triangles of a mesh as it is drawn, or of its UV map, which is then at z = 0."""

    def __init__(self, points: NDArray[np.float32], triangles: NDArray[np.int32], owner: NDArray[np.int32]) -> None:
        """points: (p, 3). triangles: (t, 3) points. owner: (p,) the vertex of each point."""
        self._points, self._triangles, self._owner = points, triangles, owner
        self._tree = BVHTree.FromPolygons(points.tolist(), triangles.tolist(), all_triangles=True)
        self._size = float(np.linalg.norm(np.ptp(points, axis=0)))

    @classmethod
    def of_mesh(cls, mesh: FrozenMesh) -> Picker:
        points = mesh.all_positions()
        return cls(points, mesh.drawn_triangles()[0], np.arange(len(points)))

    @classmethod
    def of_layout(cls, mesh: FrozenMesh, *, selected: bool) -> Picker | None:
        """None without a UV layer.  selected: only the faces that were selected are shown."""
        if mesh.uv is None:
            return None
        loops, used = mesh.layout_loops(selected=selected), np.zeros(len(mesh.uv), bool)
        used[loops] = True
        points = np.c_[mesh.uv, np.zeros(len(mesh.uv), np.float32)]
        # Points of hidden faces belong to no vertex.
        return cls(points, loops, np.where(used, mesh.surface_loops, -1))

    def vertex_at(self, screen: Screen, x: float, y: float) -> Hit | None:
        """The nearest vertex of the triangle under a pixel; None where there is no triangle."""
        found = self.place_at(screen, x, y)
        if found is None:
            return None
        corners = self._triangles[found.triangle]
        nearest = corners[np.linalg.norm(self._points[corners] - found.place, axis=1).argmin()]
        return Hit(int(self._owner[nearest]), found.depth)

    def place_at(self, screen: Screen, x: float, y: float) -> PickedPlace | None:
        """The place on the first triangle under a pixel; None where there is no triangle."""
        hit, _, triangle, _ = self._tree.ray_cast(*screen.ray(x, y))
        return None if hit is None else PickedPlace(triangle, np.array(hit), float(screen.pixels(hit)[0, 2]))

    def distance(self, place: NDArray[np.float64]) -> float:
        """From a place to the nearest triangle."""
        return float(self._tree.find_nearest(place)[3])

    def cone_at(self, screen: Screen, cones: Iterable[int], x: float, y: float, radius: float) -> Hit | None:
        """The nearest cone to a pixel within a radius, in pixels, that the mesh does not hide; None without one."""
        points = np.flatnonzero(np.isin(self._owner, np.array(sorted(cones), int)))
        pixels = screen.pixels(self._points[points])
        distances = np.hypot(pixels[:, 0] - x, pixels[:, 1] - y)
        for row in np.argsort(distances, kind="stable").tolist():
            if not distances[row] <= radius:
                return None
            if not self.hides(screen, self._points[points[row]], self._size):
                return Hit(int(self._owner[points[row]]), float(pixels[row, 2]), float(distances[row]))
        return None

    def edge_at(
        self, screen: Screen, pairs: NDArray[np.integer], place: tuple[float, float], radius: float
    ) -> Hit | None:
        """The nearest of some edges, (k, 2) vertices, to a pixel within a radius, in pixels, that the mesh does not
        hide; None without one."""
        keys, ends = self._sides
        wanted = _edge_keys(pairs)
        first, last = (np.searchsorted(keys, wanted, side=side) for side in ("left", "right"))
        edge = np.repeat(np.arange(len(pairs)), last - first)
        rows = np.concatenate([np.arange(a, b) for a, b in zip(first, last, strict=True)] or [np.empty(0, int)])
        corners = self._points[ends[rows]]
        low, high = (screen.pixels(corners[:, end]) for end in (0, 1))
        along = high[:, :2] - low[:, :2]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = ((np.array(place) - low[:, :2]) * along).sum(axis=1) / (along**2).sum(axis=1)
        share = np.clip(np.nan_to_num(share), 0, 1)[:, None]
        distances = np.linalg.norm(low[:, :2] + share * along - place, axis=1)
        for row in np.argsort(distances, kind="stable").tolist():
            if not distances[row] <= radius:
                return None
            part = share[row, 0]
            if not self.hides(screen, (1 - part) * corners[row, 0] + part * corners[row, 1], self._size):
                vertex = int(self._owner[ends[rows[row], int(part > 0.5)]])
                depth = (1 - part) * low[row, 2] + part * high[row, 2]
                return Hit(vertex, float(depth), float(distances[row]), int(edge[row]))
        return None

    @cached_property
    def _sides(self) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """(3t,) the vertices of triangles' sides as one number each, ascending, and (3t, 2) the points there."""
        ends = np.stack([self._triangles, np.roll(self._triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        keys = _edge_keys(self._owner[ends])
        order = np.argsort(keys, kind="stable")
        return keys[order], ends[order]

    def hides(self, screen: Screen, place: NDArray[np.float32], size: float = 0.0) -> bool:
        """Whether some of it is in front of a place, by more than a small fraction of a size."""
        pixel = screen.pixels(place)[0]
        origin, direction = screen.ray(pixel[0], pixel[1])
        hit, _, _, distance = self._tree.ray_cast(origin, direction)
        return hit is not None and distance <= np.linalg.norm(place - origin) - BEHIND * size


def _edge_keys(pairs: NDArray[np.integer]) -> NDArray[np.int64]:
    """(k,) one number for the two vertices of each edge, whichever comes first."""
    low, high = np.sort(np.asarray(pairs, np.int64), axis=1).T
    return (low << 32) | high
