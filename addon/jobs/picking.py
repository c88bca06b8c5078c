# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices and cones of meshes under a pixel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from mathutils.bvhtree import BVHTree

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
    """Casts rays at the drawn triangles of a mesh."""

    def __init__(self, mesh: FrozenMesh) -> None:
        self._points = mesh.all_positions()
        self._triangles, _ = mesh.drawn_triangles()
        self._tree = BVHTree.FromPolygons(self._points.tolist(), self._triangles.tolist(), all_triangles=True)
        self._size = float(np.linalg.norm(np.ptp(self._points, axis=0)))

    def vertex_at(self, screen: Screen, x: float, y: float) -> Hit | None:
        """The nearest vertex of the triangle under a pixel; None where there is no triangle."""
        origin, direction = screen.ray(x, y)
        hit, _, triangle, _ = self._tree.ray_cast(origin, direction)
        if hit is None:
            return None
        vertices = self._triangles[triangle]
        nearest = vertices[np.linalg.norm(self._points[vertices] - np.array(hit), axis=1).argmin()]
        return Hit(int(nearest), float(screen.pixels(hit)[0, 2]))

    def cone_at(self, screen: Screen, cones: Iterable[int], x: float, y: float, radius: float) -> Hit | None:
        """The nearest cone to a pixel within a radius, in pixels, that the mesh does not hide; None without one."""
        vertices = np.array(sorted(cones), int)
        pixels = screen.pixels(self._points[vertices])
        distances = np.hypot(pixels[:, 0] - x, pixels[:, 1] - y)
        for row in np.argsort(distances, kind="stable").tolist():
            if not distances[row] <= radius:
                return None
            if not self.hides(screen, self._points[vertices[row]], self._size):
                return Hit(int(vertices[row]), float(pixels[row, 2]), float(distances[row]))
        return None

    def hides(self, screen: Screen, place: np.ndarray, size: float = 0.0) -> bool:
        """Whether the mesh is before a place in its own space, by more than a small part of a size."""
        pixel = screen.pixels(place)[0]
        origin, direction = screen.ray(pixel[0], pixel[1])
        hit, _, _, distance = self._tree.ray_cast(origin, direction)
        return hit is not None and distance <= np.linalg.norm(place - origin) - BEHIND * size

    def place(self, vertex: int) -> np.ndarray:
        """(3,) position of a vertex."""
        return self._points[vertex]
