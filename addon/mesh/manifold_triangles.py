# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangles that computations see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core import native


def manifold_triangles(
    places: NDArray[np.float32],
    face_vertices: NDArray[np.int32],
    face_sizes: NDArray[np.int32],
    edges: NDArray[np.int32],
    drawn: NDArray[np.int32],
) -> NDArray[np.int32]:
    """The triangles that Blender draws, but for those of faces whose diagonal lies on an edge or on another face's: an
    edge of more than two triangles, along which these faces would be torn. Two quads that share two edges are such.

    places: (n, 3). face_vertices: (l,) of all faces, one after the other. face_sizes: (f,) their numbers of vertices.
    edges: (e, 2). drawn: (m, 3) indices into face_vertices, as are those returned.
    """
    polygons = native.part("io.polygons")
    faces = polygons.PolygonMesh(places.astype(np.float64), face_vertices, face_sizes.astype(np.int64))
    triangles = drawn.copy()
    polygons.separate_diagonals(faces, triangles, edges)
    return triangles
