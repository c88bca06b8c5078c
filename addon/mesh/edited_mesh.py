# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a mesh in edit mode."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import product

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import versions
from ..core.identifiers import ALONG_ATTRIBUTE, UP_ATTRIBUTE
from .arrays import rows
from .manifold_triangles import manifold_triangles
from .mesh_reader import FloatArray, MeshReader, each_once, stitched_vertices, triangulated


class EditedMesh(MeshReader):
    """A mesh in edit mode, read from its bmesh. Reading all elements takes long, a few are quick."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self._mesh = mesh
        self._bm = bmesh.from_edit_mesh(mesh)
        for sequence in (self._bm.verts, self._bm.edges, self._bm.faces):
            sequence.ensure_lookup_table()
        self._bm.verts.index_update()

    @cached_property
    def stitched(self) -> NDArray[np.int32]:
        # Few faces are at boundaries or at edges without length. What else these have stays out of it without a place.
        ends = (vertex for edge in self._bm.edges if edge.calc_length() == 0 for vertex in edge.verts)
        chosen = list(dict.fromkeys([*ends, *(vertex for vertex in self._bm.verts if vertex.is_boundary)]))
        if not chosen:
            return np.arange(len(self._bm.verts), dtype=np.int32)
        faces = list(dict.fromkeys(face for vertex in chosen for face in vertex.link_faces))
        places = np.full((len(self._bm.verts), 3), np.nan, np.float32)
        places[[vertex.index for vertex in chosen]] = rows([vertex.co[:] for vertex in chosen], 3)
        corners = np.array([vertex.index for face in faces for vertex in face.verts], np.int32)
        return stitched_vertices(places, corners, np.array([len(face.verts) for face in faces], np.int32))

    def size(self) -> tuple[int, int, int]:
        return len(self._bm.verts), len(self._bm.edges), len(self._bm.faces)

    def positions(self, vertices: Sequence[int]) -> FloatArray:
        return rows([self._bm.verts[v].co[:] for v in vertices], 3)

    def all_positions(self) -> FloatArray:
        return rows([v.co[:] for v in self._bm.verts], 3)

    def on_border(self, vertices: Sequence[int]) -> list[bool]:
        return [self._is_open_at(v) for v in vertices]

    def seams(self) -> NDArray[np.int32]:
        return self.stitched[self._ends(edge for edge in self._bm.edges if edge.seam)]

    def triangles(self, faces: Sequence[int]) -> list[tuple[int, int, int]]:
        found = []
        for face in faces:
            vertices = self._bm.faces[face].verts
            found += triangulated([v.index for v in vertices], [v.co for v in vertices])
        return found

    def all_triangles(self) -> NDArray[np.int32]:
        loops = [loop for face in self._bm.faces for loop in face.loops]
        place = {loop: i for i, loop in enumerate(loops)}
        vertices = np.array([loop.vert.index for loop in loops], np.int32)
        drawn = [[place[loop] for loop in triangle] for triangle in self._bm.calc_loop_triangles()]
        sizes = np.array([len(face.loops) for face in self._bm.faces], np.int32)
        triangles = rows(drawn, 3, np.int32)
        return self.stitched[vertices][
            manifold_triangles(self.all_positions(), vertices, sizes, self._ends(self._bm.edges), triangles)
        ]

    def drawn_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        self._bm.faces.index_update()
        drawn = [triangle for triangle in self._bm.calc_loop_triangles() if not triangle[0].face.hide]
        return self._vertices(drawn), np.array([triangle[0].face.index for triangle in drawn], np.int32)

    def corners(self, faces: Sequence[int]) -> tuple[list[int], FloatArray]:
        layer = self._uv_layer()
        loops = [loop for face in faces for loop in self._bm.faces[face].loops]
        uv = [] if layer is None else [loop[layer].uv[:] for loop in loops]
        return [loop.vert.index for loop in loops], np.array(uv, np.float32)

    def vertex_uv(self, vertices: Sequence[int]) -> tuple[NDArray[np.int64], FloatArray]:
        layer = self._uv_layer()
        found = [
            (row, *loop[layer].uv)
            for row, vertex in enumerate(vertices)
            for copy in ([] if layer is None else self._copies(vertex))
            for loop in copy.link_loops
            if not loop.face.hide
        ]
        table = rows(found, 3, np.float64)
        return each_once(table[:, 0], table[:, 1:])

    def side_normals(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        normals = np.full((len(pairs), 3), np.nan, np.float32)
        for row, loop in enumerate(map(self._loop, pairs)):
            if loop is not None:
                normals[row] = loop.face.normal
        return normals

    def side_uv(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        uv = np.full((len(pairs), 2, 2), np.nan, np.float32)
        layer = self._uv_layer()
        for row, loop in enumerate(map(self._loop, pairs)):
            if loop is not None and layer is not None:
                uv[row] = loop[layer].uv, loop.link_loop_next[layer].uv
        return uv

    def weights(self, group: int, outside: float) -> NDArray[np.float64]:
        deform = self._bm.verts.layers.deform.active
        if deform is None:
            return np.full(len(self._bm.verts), outside)
        return np.array([vertex[deform].get(group, outside) for vertex in self._bm.verts], np.float64)

    def point_values(self, name: str, item: str, vertices: Sequence[int]) -> list[float]:
        layer = getattr(self._bm.verts.layers, item.lower()).get(name)
        return [0 if layer is None else self._bm.verts[vertex][layer] for vertex in vertices]

    def face_values(self, name: str) -> FloatArray | None:
        layer = self._bm.faces.layers.float.get(name)
        return None if layer is None else np.array([face[layer] for face in self._bm.faces], np.float32)

    @property
    def drawn_up(self) -> FloatArray | None:
        layer = self._bm.faces.layers.float_vector.get(UP_ATTRIBUTE)
        return None if layer is None else rows([face[layer][:] for face in self._bm.faces], 3)

    def along_sides(self) -> NDArray[np.int32]:
        flags = versions.edited_edge_flags(self._mesh, ALONG_ATTRIBUTE)
        self._bm.faces.index_update()
        marked = [self._bm.edges[number] for number in np.flatnonzero(flags).tolist()]
        return rows([[*(v.index for v in e.verts), face.index] for e in marked for face in e.link_faces], 3, np.int32)

    def _uv_layer(self) -> bmesh.types.BMLayerItem | None:
        active = self._mesh.uv_layers.active
        return None if active is None else self._bm.loops.layers.uv.get(active.name)

    def _ends(self, edges: Iterable[bmesh.types.BMEdge]) -> NDArray[np.int32]:
        return rows([[v.index for v in edge.verts] for edge in edges], 2, np.int32)

    def _vertices(self, triangles: Sequence[Sequence[bmesh.types.BMLoop]]) -> NDArray[np.int32]:
        return rows([[loop.vert.index for loop in triangle] for triangle in triangles], 3, np.int32)

    def _loop(self, pair: tuple[int, int]) -> bmesh.types.BMLoop | None:
        """The visible loop that runs along a directed edge of the surface."""
        for first, second in product(*map(self._copies, pair)):
            edge = self._bm.edges.get((first, second))
            for loop in () if edge is None else edge.link_loops:
                if loop.vert == first and not loop.face.hide and self._is_on_surface(loop.face):
                    return loop
        return None

    def _copies(self, vertex: int) -> list[bmesh.types.BMVert]:
        """The vertices of the mesh that are this one of the surface."""
        indices = np.flatnonzero(self.stitched == vertex) if vertex in self._with_copies else [vertex]
        return [self._bm.verts[i] for i in indices]

    @cached_property
    def _with_copies(self) -> set[int]:
        """The vertices of the surface that several of the mesh are."""
        return set(self.stitched[self.stitched != np.arange(len(self.stitched))].tolist())

    def _is_on_surface(self, face: bmesh.types.BMFace) -> bool:
        """Whether it is more than a line."""
        return len({self.stitched[vertex.index] for vertex in face.verts}) > 2

    def _is_open_at(self, vertex: int) -> bool:
        """Whether this vertex of the surface has an edge with a single face."""
        edges = {edge for copy in self._copies(vertex) for edge in copy.link_edges if edge.is_boundary}
        ends = [tuple(sorted(self.stitched[end.index] for end in edge.verts)) for edge in edges]
        return any(count == 1 and len(set(pair)) > 1 for pair, count in Counter(ends).items())
