# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex bodies from their corners."""

from __future__ import annotations

import meshes
import numpy as np
from meshes import Mesh
from scipy.spatial import ConvexHull


def hull(points: np.ndarray) -> Mesh:
    """points: (n, 3), all of them corners. Their convex hull, with triangles that face outward."""
    found = ConvexHull(points)
    triangles = found.simplices.copy()
    a, b, c = points[triangles].transpose(1, 0, 2)
    is_inward = (np.cross(b - a, c - a) * found.equations[:, :3]).sum(axis=1) < 0
    triangles[is_inward] = triangles[is_inward, ::-1]
    return meshes.make(points, triangles)
