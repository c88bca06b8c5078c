# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices and cones of meshes under a pixel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ..core.screen import Screen
from ..mesh.stored_mesh import FrozenMesh

# Fraction of the mesh's size by which a cone may lie behind the surface and still count as visible.
BEHIND = 1e-3


@dataclass(frozen=True, slots=True)
class Hit:
    """A vertex at a pixel.  depth: of the surface or the vertex there, as of `Screen.pixels`. distance: in pixels."""

    vertex: int
    depth: float
    distance: float = 0.0


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
        # Points of faces that are not shown are no vertex's.
        return cls(points, loops, np.where(used, mesh.loop_vertices, -1))

    def vertex_at(self, screen: Screen, x: float, y: float) -> Hit | None:
        """The nearest vertex of the triangle under a pixel; None where there is no triangle."""
        origin, direction = screen.ray(x, y)
        hit, _, triangle, _ = self._tree.ray_cast(origin, direction)
        if hit is None:
            return None
        corners = self._triangles[triangle]
        nearest = corners[np.linalg.norm(self._points[corners] - np.array(hit), axis=1).argmin()]
        return Hit(int(self._owner[nearest]), float(screen.pixels(hit)[0, 2]))

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

    def hides(self, screen: Screen, place: NDArray[np.float32], size: float = 0.0) -> bool:
        """Whether something of it is before a place, by more than a small part of a size."""
        pixel = screen.pixels(place)[0]
        origin, direction = screen.ray(pixel[0], pixel[1])
        hit, _, _, distance = self._tree.ray_cast(origin, direction)
        return hit is not None and distance <= np.linalg.norm(place - origin) - BEHIND * size
