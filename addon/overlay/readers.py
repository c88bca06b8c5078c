# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay has to know of a mesh, read in edit mode and out of it, for a few elements without reading all."""

from __future__ import annotations

from collections.abc import Sequence

import bmesh
import bpy
import numpy as np
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]


class EditedMesh:
    """A mesh in edit mode."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self._mesh = mesh
        self._bm = bmesh.from_edit_mesh(mesh)
        for sequence in (self._bm.verts, self._bm.edges, self._bm.faces):
            sequence.ensure_lookup_table()
        self._bm.verts.index_update()

    def positions(self, vertices: Sequence[int]) -> FloatArray:
        """(k, 3) places of vertices."""
        return _rows([self._bm.verts[v].co[:] for v in vertices], 3)

    def on_border(self, vertices: Sequence[int]) -> list[bool]:
        """Which vertices have an edge with one face."""
        return [self._bm.verts[v].is_boundary for v in vertices]

    def side_normals(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        """(k, 3) normal of the face to the left of each directed edge; NaN where there is none."""
        normals = np.full((len(pairs), 3), np.nan, np.float32)
        for row, loop in enumerate(map(self._loop, pairs)):
            if loop is not None:
                normals[row] = loop.face.normal
        return normals

    def side_uv(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        """(k, 2, 2) UVs of both ends of each directed edge in the face to its left; NaN where there is none."""
        uv = np.full((len(pairs), 2, 2), np.nan, np.float32)
        layer = self._bm.loops.layers.uv.get(self._mesh.uv_layers.active.name) if self._mesh.uv_layers else None
        for row, loop in enumerate(map(self._loop, pairs)):
            if loop is not None and layer is not None:
                uv[row] = loop[layer].uv, loop.link_loop_next[layer].uv
        return uv

    def triangles(self, faces: Sequence[int]) -> list[tuple[int, int, int]]:
        """The vertices of triangles that cover the faces."""
        found = []
        for face in faces:
            vertices = self._bm.faces[face].verts
            found += _triangulated([v.index for v in vertices], [v.co for v in vertices])
        return found

    def all_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """(t, 3) vertices and (t,) faces of triangles that cover the visible faces."""
        self._bm.faces.index_update()
        loops = [triangle for triangle in self._bm.calc_loop_triangles() if not triangle[0].face.hide]
        vertices = _rows([[loop.vert.index for loop in triangle] for triangle in loops], 3, np.int32)
        return vertices, np.array([triangle[0].face.index for triangle in loops], np.int32)

    def all_positions(self) -> FloatArray:
        """(n, 3) places of all vertices."""
        return _rows([v.co[:] for v in self._bm.verts], 3)

    def face_values(self, name: str) -> FloatArray | None:
        """(f,) a float attribute of faces; None where there is no such attribute."""
        layer = self._bm.faces.layers.float.get(name)
        return None if layer is None else np.array([face[layer] for face in self._bm.faces], np.float32)

    def _loop(self, pair: tuple[int, int]) -> bmesh.types.BMLoop | None:
        first, second = (self._bm.verts[v] for v in pair)
        edge = self._bm.edges.get((first, second))
        if edge is None:
            return None
        return next((loop for loop in edge.link_loops if loop.vert == first and not loop.face.hide), None)


class StoredMesh:
    """A mesh out of edit mode, read once; methods as those of an edited one.

    uv: (l, 2) of the active layer, or what is set in its place; None without one.
    """

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self._mesh = mesh
        self._start = _read(mesh.polygons, "loop_start", np.int32)
        self._total = _read(mesh.polygons, "loop_total", np.int32)
        self._corners = _read(mesh.loops, "vertex_index", np.int32)
        following = np.arange(1, len(self._corners) + 1)
        following[self._start + self._total - 1] = self._start
        self._following = following
        self._face = np.repeat(np.arange(len(self._start)), self._total)
        self._places = _read(mesh.vertices, "co", np.float32, 3)
        # A directed edge as one number, in ascending order.
        keys = self._key(self._corners, self._corners[following])
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]
        self._normals = _read(mesh.polygons, "normal", np.float32, 3)
        self._border = np.zeros(len(self._places), bool)
        faces_at = np.bincount(_read(mesh.loops, "edge_index", np.int32), minlength=len(mesh.edges))
        self._border[_read(mesh.edges, "vertices", np.int32, 2)[faces_at == 1]] = True
        self.uv = _read(mesh.uv_layers.active.uv, "vector", np.float32, 2) if mesh.uv_layers else None

    def positions(self, vertices: Sequence[int]) -> FloatArray:
        return self._places[np.asarray(vertices, int)]

    def on_border(self, vertices: Sequence[int]) -> list[bool]:
        return self._border[np.asarray(vertices, int)].tolist()

    def side_normals(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        loops = self._loops(pairs)
        found = self._normals[self._face[loops]]
        found[loops < 0] = np.nan
        return found

    def side_uv(self, pairs: Sequence[tuple[int, int]]) -> FloatArray:
        loops = self._loops(pairs)
        if self.uv is None:
            return np.full((len(pairs), 2, 2), np.nan, np.float32)
        found = self.uv[np.stack([loops, self._following[loops]], axis=1)]
        found[loops < 0] = np.nan
        return found

    def triangles(self, faces: Sequence[int]) -> list[tuple[int, int, int]]:
        found = []
        for face in faces:
            vertices = self._corners[self._start[face] :][: self._total[face]]
            found += _triangulated(vertices.tolist(), self._places[vertices].tolist())
        return found

    def all_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        self._mesh.calc_loop_triangles()
        triangles = self._mesh.loop_triangles
        return _read(triangles, "vertices", np.int32, 3), _read(triangles, "polygon_index", np.int32)

    def all_positions(self) -> FloatArray:
        return self._places

    def face_values(self, name: str) -> FloatArray | None:
        attribute = self._mesh.attributes.get(name)
        if attribute is None or attribute.domain != "FACE" or attribute.data_type != "FLOAT":
            return None
        return _read(attribute.data, "value", np.float32)

    def _key(self, first: NDArray, second: NDArray) -> NDArray[np.int64]:
        return first.astype(np.int64) * len(self._places) + second

    def _loops(self, pairs: Sequence[tuple[int, int]] | NDArray) -> NDArray[np.int64]:
        """(k,) the loop that runs along each directed edge, -1 where there is none."""
        pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
        if not len(self._keys):
            return np.full(len(pairs), -1)
        wanted = self._key(pairs[:, 0], pairs[:, 1])
        place = np.minimum(np.searchsorted(self._keys, wanted), len(self._keys) - 1)
        return np.where(self._keys[place] == wanted, self._order[place], -1)


class FrozenMesh(StoredMesh):
    """An edited mesh for as long as only its UVs change; those are to be set as ``uv``.

    copy: of the mesh, out of edit mode; not used any more once it is read. Hidden faces are left out, as in edit mode.
    """

    def __init__(self, copy: bpy.types.Mesh) -> None:
        super().__init__(copy)
        self._hidden = _read(copy.polygons, "hide", bool)
        vertices, faces = super().all_triangles()
        shown = ~self._hidden[faces]
        self._shown = vertices[shown], faces[shown]

    def all_triangles(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        return self._shown

    def _loops(self, pairs: Sequence[tuple[int, int]] | NDArray) -> NDArray[np.int64]:
        loops = super()._loops(pairs)
        return np.where(self._hidden[self._face[loops]], -1, loops)


def reader(mesh: bpy.types.Mesh) -> EditedMesh | StoredMesh:
    """The one for the mode the mesh is in; to be used at once, as long as nothing changes."""
    return EditedMesh(mesh) if mesh.is_editmode else StoredMesh(mesh)


def _rows(values: list, columns: int, dtype: type = np.float32) -> NDArray:
    return np.array(values, dtype).reshape(-1, columns)


def _triangulated(vertices: list[int], places: list) -> list[tuple[int, int, int]]:
    if len(vertices) == 3:
        return [tuple(vertices)]
    return [tuple(vertices[i] for i in triangle) for triangle in tessellate_polygon([places])]


def _read(collection: bpy.types.bpy_prop_collection, name: str, dtype: type, columns: int = 1) -> NDArray:
    values = np.empty(len(collection) * columns, dtype)
    collection.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)
