# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices and cones of a mesh under a pixel."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ..core.screen import Screen
from ..mesh.stored_mesh import FrozenMesh

# Fraction of the mesh's size by which a cone may lie behind the surface and still count as visible.
BEHIND = 1e-3


class Picker:
    """Casts rays at the drawn triangles of a mesh."""

    def __init__(self, mesh: FrozenMesh) -> None:
        self._points = mesh.all_positions()
        self._triangles, _ = mesh.drawn_triangles()
        self._tree = BVHTree.FromPolygons(self._points.tolist(), self._triangles.tolist(), all_triangles=True)
        self._size = float(np.linalg.norm(np.ptp(self._points, axis=0)))

    def vertex_at(self, screen: Screen, x: float, y: float) -> int | None:
        """The nearest vertex of the triangle under a pixel; None where there is no triangle."""
        origin, direction = screen.ray(x, y)
        hit, _, triangle, _ = self._tree.ray_cast(origin, direction)
        if hit is None:
            return None
        vertices = self._triangles[triangle]
        return int(vertices[np.linalg.norm(self._points[vertices] - np.array(hit), axis=1).argmin()])

    def cone_at(self, screen: Screen, cones: Iterable[int], x: float, y: float, radius: float) -> int | None:
        """The nearest cone to a pixel within a radius, in pixels, that the mesh does not hide; None without one."""
        vertices = np.array(sorted(cones), int)
        pixels = screen.pixels(self._points[vertices])
        distances = np.hypot(pixels[:, 0] - x, pixels[:, 1] - y)
        for row in np.argsort(distances, kind="stable").tolist():
            if not distances[row] <= radius:
                return None
            if self._is_visible(screen, vertices[row], pixels[row]):
                return int(vertices[row])
        return None

    def _is_visible(self, screen: Screen, vertex: int, pixel: NDArray) -> bool:
        origin, direction = screen.ray(pixel[0], pixel[1])
        hit, _, _, distance = self._tree.ray_cast(origin, direction)
        own = np.linalg.norm(self._points[vertex] - origin)
        return hit is None or distance > own - BEHIND * self._size
