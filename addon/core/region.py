# SPDX-License-Identifier: GPL-3.0-or-later
"""The arrays that all computations start from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import lsgp

    from .cone_angles import ConeAngles


@dataclass(frozen=True, slots=True)
class Region:
    """Faces of one mesh, as triangles, with everything that is read from Blender about them.

    Vertex indices are those of the mesh, so that the library's errors name Blender's vertices. Where boundaries lie on
    each other, the first vertex at a place is used for all.

    surface: all vertices (the library ignores those without a triangle), the triangles that Blender draws the faces
        with, the edges of the faces, and the marked seams and features among them. In the shape that the object's
        transform gives them, at the size of the mesh.
    triangle_loops: (m, 3) int32, mesh loop of each triangle corner.
    triangle_faces: (m,) int32, mesh face of each triangle.
    face_loop_start: (f,) int32, for all faces of the mesh.
    vertex_used: (n,) bool, the vertices of the region's faces.
    corner_uv: (m, 3, 2) float64, the active UV layer; NaN where the mesh has none.
    pinned: (m, 3) bool, the corners whose UV is pinned in that layer.
    cones: all cones of the mesh, also those outside the region.
    sharp: (s, 2) int32, the edges marked sharp.
    active_edge: vertices of the active edge in edit mode, if it is one of the faces'; None otherwise.
    drawn_up: (m, 3) float64, the drawn upward direction of the texture, 0 for none; None where nothing is drawn.
    along: (k, 2) int32, the edges along which the texture's upward direction is to run, each once.
    cut_paint: (n,) float64, from 0 where cuts should run to 1 where they should not; None without such a vertex group.
    axes: (3, 3), the rotation from the region's shape to the world: a direction in the world, times it, is one here.
    weights: (n,) float64, those of importance or of density that were asked for; None without such a vertex group.
    image_aspect: width over height of the image in the mesh's material; 1 where there is none.
    object_scale: by how much the object's transform scales lengths, on the average; 0 where it leaves none.
    density_weight: how many times the texel density of other objects this one is to have.
    stitched: (n,) int32, the vertex of the surface that each vertex of the mesh is; itself for most.
    mesh_edges: (e, 2) int32, the edges of the faces with the vertices of the mesh.
    in_mirror_plane: (n,) bool, the vertices that a Mirror modifier merges with their images.
    is_rounded: whether the Subdivision Surface modifier makes something round of it, and its edges are no creases.
    """

    surface: lsgp.Surface
    triangle_loops: NDArray[np.int32]
    triangle_faces: NDArray[np.int32]
    face_loop_start: NDArray[np.int32]
    vertex_used: NDArray[np.bool_]
    corner_uv: NDArray[np.float64]
    pinned: NDArray[np.bool_]
    cones: ConeAngles
    sharp: NDArray[np.int32]
    active_edge: tuple[int, int] | None
    drawn_up: NDArray[np.float64] | None
    along: NDArray[np.int32]
    cut_paint: NDArray[np.float64] | None
    axes: NDArray[np.float64]
    weights: NDArray[np.float64] | None
    image_aspect: float
    object_scale: float
    stitched: NDArray[np.int32]
    mesh_edges: NDArray[np.int32]
    in_mirror_plane: NDArray[np.bool_]
    density_weight: float = 1.0
    is_rounded: bool = False

    @property
    def texel_scale(self) -> float:
        """What lengths here are worth in texels, beside those of other objects: their length in the world, weighted."""
        return self.object_scale * self.density_weight

    @property
    def is_whole(self) -> bool:
        """Whether these are all faces of the mesh."""
        return len(np.unique(self.triangle_faces)) == len(self.face_loop_start)

    def edges_in_mesh(self, pairs: NDArray[np.integer]) -> NDArray[np.int32]:
        """(k, 2) the edges of the mesh that are these of the surface, ascending."""
        edges = np.sort(self.mesh_edges, axis=1)
        keys, wanted = (np.sort(self.stitched[ends], axis=1).astype(np.int64) for ends in (edges, pairs))
        count = len(self.stitched)
        named = np.isin(keys @ (count, 1), wanted @ (count, 1))
        return np.unique(edges[named], axis=0)

    @property
    def own_cones(self) -> ConeAngles:
        """The cones in the region."""
        return self.cones.on(self.vertex_used)
