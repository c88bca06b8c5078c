# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a mesh in object mode, or a copy of one in edit mode."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import versions
from ..core.identifiers import ALONG_ATTRIBUTE, FEATURE_ATTRIBUTE, UP_ATTRIBUTE
from .arrays import read_array
from .manifold_triangles import manifold_triangles
from .mesh_reader import FloatArray, MeshReader, each_once, stitched_vertices, triangulated


class StoredMesh(MeshReader):
    """A mesh out of edit mode. Each array is read once, when it is first asked for.

    l and e are the numbers of loops and edges.
    """

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self._mesh = mesh

    # Arrays of all elements

    @cached_property
    def places(self) -> FloatArray:
        """(n, 3) positions of the vertices."""
        return read_array(self._mesh.vertices, "co", np.float32, 3)

    @cached_property
    def edges(self) -> NDArray[np.int32]:
        """(e, 2) vertices of the edges."""
        return read_array(self._mesh.edges, "vertices", np.int32, 2)

    @cached_property
    def is_seam(self) -> NDArray[np.bool_]:
        """(e,)"""
        return read_array(self._mesh.edges, "use_seam", bool)

    @cached_property
    def is_sharp(self) -> NDArray[np.bool_]:
        """(e,)"""
        return read_array(self._mesh.edges, "use_edge_sharp", bool)

    @cached_property
    def is_feature(self) -> NDArray[np.bool_]:
        """(e,)"""
        return self._edge_flags(FEATURE_ATTRIBUTE)

    @cached_property
    def is_along(self) -> NDArray[np.bool_]:
        """(e,)"""
        return self._edge_flags(ALONG_ATTRIBUTE)

    @cached_property
    def loop_start(self) -> NDArray[np.int32]:
        """(f,) first loop of each face."""
        return read_array(self._mesh.polygons, "loop_start", np.int32)

    @cached_property
    def loop_total(self) -> NDArray[np.int32]:
        """(f,) number of loops of each face."""
        return read_array(self._mesh.polygons, "loop_total", np.int32)

    @cached_property
    def face_normals(self) -> FloatArray:
        """(f, 3)"""
        return read_array(self._mesh.polygons, "normal", np.float32, 3)

    @cached_property
    def is_selected(self) -> NDArray[np.bool_]:
        """(f,)"""
        return read_array(self._mesh.polygons, "select", bool)

    @cached_property
    def is_hidden(self) -> NDArray[np.bool_]:
        """(f,)"""
        return read_array(self._mesh.polygons, "hide", bool)

    @cached_property
    def loop_vertices(self) -> NDArray[np.int32]:
        """(l,)"""
        return read_array(self._mesh.loops, "vertex_index", np.int32)

    @cached_property
    def stitched(self) -> NDArray[np.int32]:
        return stitched_vertices(self.places, self.loop_vertices, self.loop_total)

    @cached_property
    def surface_edges(self) -> NDArray[np.int32]:
        """(e, 2) vertices of the surface at the ends of the edges."""
        return self.stitched[self.edges]

    @cached_property
    def surface_edge_of(self) -> NDArray[np.int64]:
        """(e,) a number below e for each edge, the same for edges that are one of the surface."""
        if np.array_equal(self.stitched, np.arange(len(self.stitched))):
            return np.arange(len(self.edges))
        low, high = np.sort(self.surface_edges, axis=1).T
        return np.unique(self._key(low, high), return_inverse=True)[1].ravel()

    @cached_property
    def surface_loops(self) -> NDArray[np.int32]:
        """(l,) the vertex of the surface that each loop is at."""
        return self.stitched[self.loop_vertices]

    @cached_property
    def loop_edges(self) -> NDArray[np.int32]:
        """(l,) edge from each loop's vertex to that of the next loop of the face."""
        return read_array(self._mesh.loops, "edge_index", np.int32)

    @cached_property
    def loop_faces(self) -> NDArray[np.int64]:
        """(l,)"""
        return np.repeat(np.arange(len(self.loop_total)), self.loop_total)

    @cached_property
    def next_loops(self) -> NDArray[np.int64]:
        """(l,) the following loop of the same face."""
        following = np.arange(1, len(self.loop_vertices) + 1)
        following[self.loop_start + self.loop_total - 1] = self.loop_start
        return following

    @cached_property
    def drawn_loops(self) -> NDArray[np.int32]:
        """(m, 3) loops of the triangles that Blender draws the faces with."""
        self._mesh.calc_loop_triangles()
        return read_array(self._mesh.loop_triangles, "loops", np.int32, 3)

    @cached_property
    def triangle_loops(self) -> NDArray[np.int32]:
        """(m, 3) loops of the triangles that computations see, as many of every face as are drawn."""
        return manifold_triangles(self.places, self.loop_vertices, self.loop_total, self.edges, self.drawn_loops)

    @cached_property
    def triangle_faces(self) -> NDArray[np.int32]:
        """(m,) face of each of these triangles."""
        self._mesh.calc_loop_triangles()
        return read_array(self._mesh.loop_triangles, "polygon_index", np.int32)

    @cached_property
    def uv(self) -> FloatArray | None:
        """(l, 2) of the active layer; None without one."""
        layer = self._mesh.uv_layers.active
        return None if layer is None else read_array(layer.uv, "vector", np.float32, 2)

    @cached_property
    def pinned(self) -> NDArray[np.bool_]:
        """(l,) the loops whose UV is pinned in the active layer."""
        layer, mesh = self._mesh.uv_layers.active, self._mesh
        return np.zeros(len(mesh.loops), bool) if layer is None else versions.pinned_loops(mesh, layer.name)

    @cached_property
    def uv_selected(self) -> NDArray[np.bool_]:
        """(l,) the loops whose UV is selected in a UV editor with its own selection; all without a layer."""
        layer = self._mesh.uv_layers.active
        return (
            np.ones(len(self._mesh.loops), bool) if layer is None else versions.selected_loops(self._mesh, layer.name)
        )

    @cached_property
    def drawn_up(self) -> FloatArray | None:
        attribute = self._mesh.attributes.get(UP_ATTRIBUTE)
        if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", "FLOAT_VECTOR"):
            return None
        return read_array(attribute.data, "vector", np.float32, 3)

    @cached_property
    def _border(self) -> NDArray[np.bool_]:
        """(n,) vertices of the surface's edges with a single face."""
        border = np.zeros(len(self.places), bool)
        faces_at = np.bincount(self.surface_edge_of[self.loop_edges], minlength=len(self.edges))
        border[self.surface_edges[faces_at[self.surface_edge_of] == 1]] = True
        return border

    @cached_property
    def _directed_edges(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(l,) the directed edge of each loop as one number, ascending, and (l,) the loops in this order."""
        keys = self._key(self.surface_loops, self.surface_loops[self.next_loops])
        order = np.argsort(keys, kind="stable")
        return keys[order], order

    # As every reader

    def size(self) -> tuple[int, int, int]:
        return len(self._mesh.vertices), len(self._mesh.edges), len(self._mesh.polygons)

    def positions(self, vertices: Sequence[int]) -> FloatArray:
        return self.places[np.asarray(vertices, int)]

    def all_positions(self) -> FloatArray:
        return self.places

    def on_border(self, vertices: Sequence[int]) -> list[bool]:
        return self._border[np.asarray(vertices, int)].tolist()

    def seams(self) -> NDArray[np.int32]:
        return self.surface_edges[self.is_seam]

    def triangles(self, faces: Sequence[int]) -> list[tuple[int, int, int]]:
        found = []
        for face in faces:
            vertices = self.loop_vertices[self.loop_start[face] :][: self.loop_total[face]]
            found += triangulated(vertices.tolist(), self.places[vertices].tolist())
        return found

    def all_triangles(self) -> NDArray[np.int32]:
        return self.surface_loops[self.triangle_loops]

    def drawn_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        return self.loop_vertices[self.drawn_loops], self.triangle_faces

    def corners(self, faces: Sequence[int]) -> tuple[list[int], FloatArray]:
        # Only of these faces: to read all takes longer on large meshes.
        active = self._mesh.uv_layers.active
        stored = None if active is None else active.uv
        loops = [loop for face in faces for loop in self._mesh.polygons[face].loop_indices]
        uv = [] if stored is None else [stored[loop].vector[:] for loop in loops]
        return [self._mesh.loops[loop].vertex_index for loop in loops], np.array(uv, np.float32)

    def vertex_uv(self, vertices: Sequence[int]) -> tuple[NDArray[np.int64], FloatArray]:
        if self.uv is None:
            return np.empty(0, np.int64), np.empty((0, 2), np.float32)
        rows, loops = self._corners_at(tuple(vertices))
        return each_once(rows, self.uv[loops])

    def _corners_at(self, vertices: tuple[int, ...]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The loops of visible faces at some vertices, and which of the vertices each is at."""
        row_of = np.full(len(self.places), -1)
        row_of[np.asarray(vertices, int)] = np.arange(len(vertices))
        loops = np.flatnonzero((row_of[self.surface_loops] >= 0) & self._shown[self.loop_faces])
        return row_of[self.surface_loops[loops]], loops

    def side_normals(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        loops = self._loops(pairs)
        found = self.face_normals[self.loop_faces[loops]]
        found[loops < 0] = np.nan
        return found

    def side_uv(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        loops = self._loops(pairs)
        if self.uv is None:
            return np.full((len(pairs), 2, 2), np.nan, np.float32)
        found = self.uv[np.stack([loops, self.next_loops[loops]], axis=1)]
        found[loops < 0] = np.nan
        return found

    def weights(self, group: int, outside: float) -> NDArray[np.float64]:
        weights = np.full(len(self._mesh.vertices), outside)
        for vertex in self._mesh.vertices:
            for entry in vertex.groups:
                if entry.group == group:
                    weights[vertex.index] = entry.weight
        return weights

    def point_values(self, name: str, item: str, vertices: Sequence[int]) -> list[float]:
        attribute = self._mesh.attributes.get(name)
        if attribute is None or (attribute.domain, attribute.data_type) != ("POINT", item):
            return [0] * len(vertices)
        values = read_array(attribute.data, "value", np.float32 if item == "FLOAT" else np.int32)
        return values[np.asarray(vertices, int)].tolist()

    def face_values(self, name: str) -> FloatArray | None:
        attribute = self._mesh.attributes.get(name)
        if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", "FLOAT"):
            return None
        return read_array(attribute.data, "value", np.float32)

    def along_sides(self) -> NDArray[np.int32]:
        loops = np.flatnonzero(self.is_along[self.loop_edges])
        return np.column_stack([self.edges[self.loop_edges[loops]], self.loop_faces[loops]]).astype(np.int32)

    def _edge_flags(self, name: str) -> NDArray[np.bool_]:
        """(e,) a boolean attribute on edges; False where there is no such attribute."""
        if not versions.has_edge_flags(self._mesh, name):
            return np.zeros(len(self.edges), bool)
        return read_array(self._mesh.attributes[name].data, "value", bool)

    @property
    def _shown(self) -> NDArray[np.bool_]:
        """(f,) the faces that are not hidden; out of edit mode all of them."""
        return np.ones(len(self.loop_start), bool)

    def _key(self, first: NDArray, second: NDArray) -> NDArray[np.int64]:
        return first.astype(np.int64) * len(self.places) + second

    def _loops(self, pairs: Sequence[tuple[int, int]] | NDArray) -> NDArray[np.int64]:
        """(k,) the loop that runs along each directed edge, -1 where there is none."""
        pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
        keys, order = self._directed_edges
        if not len(keys):
            return np.full(len(pairs), -1)
        wanted = self._key(pairs[:, 0], pairs[:, 1])
        place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        return np.where(keys[place] == wanted, order[place], -1)


class FrozenMesh(StoredMesh):
    """A mesh in edit mode of which nothing changes but the UVs, which are set as ``uv``; hidden faces are left out.

    copy: of the mesh, out of edit mode; it may be removed afterward.
    """

    def __init__(self, copy: bpy.types.Mesh) -> None:
        super().__init__(copy)
        # What is not read by now cannot be read later.
        for name, member in vars(StoredMesh).items():
            if isinstance(member, cached_property):
                getattr(self, name)
        # To look for loops takes longer than all else that is drawn while something is dragged.
        self._corners_at = lru_cache(maxsize=1)(self._corners_at)
        drawn = self._shown[self.triangle_faces]
        self._drawn = self.loop_vertices[self.drawn_loops[drawn]], self.triangle_faces[drawn]

    @property
    def _shown(self) -> NDArray[np.bool_]:
        return ~self.is_hidden

    def drawn_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        return self._drawn

    def layout_loops(self, *, selected: bool) -> NDArray[np.int32]:
        """(t, 3) loops of the triangles that a UV editor shows.  selected: only those of faces that were selected."""
        shown = self._shown & self.is_selected if selected else self._shown
        return self.drawn_loops[shown[self.triangle_faces]]

    def _loops(self, pairs: Sequence[tuple[int, int]] | NDArray) -> NDArray[np.int64]:
        loops = super()._loops(pairs)
        return np.where(self.is_hidden[self.loop_faces[loops]], -1, loops)
