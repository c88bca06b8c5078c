# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be read of a mesh, in edit mode and in object mode alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ..core import native

FloatArray = NDArray[np.float32]


class MeshReader(Protocol):
    """Reads a mesh of n vertices and f faces. To be used at once, before anything changes the mesh.

    Where boundaries lie on each other, the surface that is unwrapped has one vertex for several of the mesh, the first
    of them; cones, cuts and reports have the vertices of the surface.
    """

    @property
    def stitched(self) -> NDArray[np.int32]:
        """(n,) the vertex of the surface that each vertex of the mesh is, as by `lsgp.stitch_borders`."""

    def size(self) -> tuple[int, int, int]:
        """Numbers of vertices, edges and faces."""

    def positions(self, vertices: Sequence[int]) -> FloatArray:
        """(k, 3) positions of vertices."""

    def all_positions(self) -> FloatArray:
        """(n, 3) positions of all vertices."""

    def on_border(self, vertices: Sequence[int]) -> list[bool]:
        """Which vertices of the surface have an edge with a single face."""

    def seams(self) -> NDArray[np.int32]:
        """(s, 2) vertex pairs of the surface's edges that are marked as seams."""

    def triangles(self, faces: Sequence[int]) -> list[tuple[int, int, int]]:
        """Vertices of triangles that cover these faces."""

    def all_triangles(self) -> NDArray[np.int32]:
        """(m, 3) vertices of the surface's triangles, as computations see them."""

    def drawn_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """(t, 3) vertices and (t,) faces of triangles that cover what Blender draws: no hidden faces in edit mode."""

    def corners(self, faces: Sequence[int]) -> tuple[list[int], FloatArray]:
        """(c,) vertices and (c, 2) UVs in the active layer of the corners of faces; (0,) UVs without a layer."""

    def vertex_uv(self, vertices: Sequence[int]) -> tuple[NDArray[np.int64], FloatArray]:
        """(c,) rows of vertices of the surface and (c, 2) where these are in the active UV layer, each place once,
        without those of faces that are hidden in edit mode; none without a layer."""

    def side_normals(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        """(k, 3) normal of the face to the left of each directed edge of the surface; NaN where there is none."""

    def side_uv(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        """(k, 2, 2) UVs of both ends of each directed edge of the surface in the face to its left; NaN where there is
        none."""

    def weights(self, group: int, outside: float) -> NDArray[np.float64]:
        """(n,) weight of each vertex in the vertex group with this index, and of those outside it."""

    def point_values(self, name: str, item: str, vertices: Sequence[int]) -> list[float]:
        """(k,) values of a point attribute of type "FLOAT" or "INT" at vertices; 0 where there is no such attribute."""

    def face_values(self, name: str) -> FloatArray | None:
        """(f,) values of a float attribute on faces; None where there is no such attribute."""

    @property
    def drawn_up(self) -> FloatArray | None:
        """(f, 3) the drawn upward direction of the texture, 0 for none; None where there is no such attribute."""

    def along_sides(self) -> NDArray[np.int32]:
        """(s, 3) the vertices of edges along which the texture's upward direction is to run, the same way for all faces
        of an edge, and a face beside it."""


def stitched_vertices(
    places: FloatArray, face_vertices: NDArray[np.int32], face_sizes: NDArray[np.int32]
) -> NDArray[np.int32]:
    """(n,) as `MeshReader.stitched`.  places: (n, 3). face_vertices: (l,) of all faces, one after the other."""
    return native.part("stitching").stitched_vertices(places.astype(np.float64), face_vertices, face_sizes)


def triangulated(vertices: list[int], positions: list) -> list[tuple[int, int, int]]:
    """Vertices of triangles that cover one face."""
    if len(vertices) == 3:
        return [tuple(vertices)]
    return [tuple(vertices[i] for i in triangle) for triangle in tessellate_polygon([positions])]


def each_once(rows: NDArray[np.int64], uv: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
    """(c,) and (c, 2), in the order of rows, without repetitions."""
    found = np.unique(np.c_[rows, uv.reshape(-1, 2)], axis=0)
    return found[:, 0].astype(np.int64), found[:, 1:].astype(np.float32)
