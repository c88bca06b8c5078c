# SPDX-License-Identifier: GPL-3.0-or-later
"""Carries what is marked on the edges of one mesh over to the edges of another on its surface."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from .arrays import read_array
from .carried import add_values, carried_attributes, read_values

# How far an edge that runs along others may be from them, relative to its length: at its ends, and in between, where
# it is the chord of an arc.
_AT_ENDS, _BETWEEN = 0.05, 0.2
# Where in between that is looked at.
_SHARES = (0.25, 0.5, 0.75)
# What is read as a property of edges, because not all versions of Blender have it as an attribute of this name.
_FLAGS = {"use_seam": "uv_seam", "use_freestyle_mark": "freestyle_edge"}


def carry_edge_values(
    source: bpy.types.Mesh,
    target: bpy.types.Mesh,
    places: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Mark the target's edges as those of the source are that they run along: seams, sharp edges, numbers, vectors and
    colors.  places: (n, 3) of the vertices of both in one space.
    """
    sides = _Sides(_Edges.of(source, places[0]), _Edges.of(target, places[1]))
    for name in _FLAGS:
        if name in bpy.types.MeshEdge.bl_rna.properties:
            edges, _ = sides.along(read_array(source.edges, name, bool))
            flags = np.zeros(len(target.edges), bool)
            flags[edges] = True
            target.edges.foreach_set(name, flags)
    for attribute in carried_attributes(source, "EDGE", without=_FLAGS.values()):
        values = read_values(attribute)
        edges, at = sides.along(values.reshape(len(values), -1).any(axis=1))
        carried = np.zeros((len(target.edges), *values.shape[1:]), values.dtype)
        carried[edges] = values[at]
        add_values(target, attribute, "EDGE", carried)


@dataclass(frozen=True, slots=True)
class _Edges:
    """vertices: (e, 2). ends: (e, 2, 3), their places. normals: (e, 3), outward, of any length."""

    vertices: NDArray[np.int32]
    ends: NDArray[np.float64]
    normals: NDArray[np.float64]

    @classmethod
    def of(cls, mesh: bpy.types.Mesh, places: NDArray[np.float64]) -> _Edges:
        vertices = read_array(mesh.edges, "vertices", np.int32, 2)
        normals = read_array(mesh.vertex_normals, "vector", np.float32, 3)
        return cls(vertices, places[vertices], normals[vertices].sum(axis=1))

    @property
    def lengths(self) -> NDArray[np.float64]:
        return np.linalg.norm(self.ends[:, 1] - self.ends[:, 0], axis=1)


@dataclass(frozen=True, slots=True)
class _Sides:
    """The edges of two meshes on one surface."""

    source: _Edges
    target: _Edges

    def along(self, marked: NDArray[np.bool_]) -> tuple[list[int], list[int]]:
        """The target's edges that run along marked ones of the source, and the marked one nearest to each."""
        numbers = np.flatnonzero(marked)
        if not len(numbers):
            return [], []
        tree = _tree(self.source.ends[numbers])
        normals = self.source.normals[numbers]

        def nearest(edge: int, share: float, reach: float) -> int | None:
            """Of those on the same side of a thin part."""
            first, last = self.target.ends[edge]
            hits = tree.find_nearest_range((1 - share) * first + share * last, reach)
            facing = [(away, hit) for _, _, hit, away in hits if normals[hit] @ self.target.normals[edge] > 0]
            return min(facing, default=(0.0, None))[1]

        found, lengths = [], self.target.lengths
        for edge in self._with_near_ends(tree, lengths):
            reach = [(share, _BETWEEN * lengths[edge]) for share in _SHARES]
            reach += [(share, _AT_ENDS * lengths[edge]) for share in (0.0, 1.0)]
            hits = [nearest(edge, *at) for at in reach]
            if None not in hits:
                found.append((edge, int(numbers[hits[1]])))
        return [edge for edge, _ in found], [at for _, at in found]

    def _with_near_ends(self, tree: BVHTree, lengths: NDArray[np.float64]) -> list[int]:
        """The target's edges both of whose vertices are near to something in the tree."""
        vertices, ends = self.target.vertices, self.target.ends
        reach, places = np.zeros(vertices.max() + 1), np.zeros((vertices.max() + 1, 3))
        np.maximum.at(reach, vertices, _AT_ENDS * lengths[:, np.newaxis])
        places[vertices] = ends
        found = [tree.find_nearest(*at)[2] for at in zip(places.tolist(), reach.tolist(), strict=True)]
        is_near = np.array([hit is not None for hit in found])
        return np.flatnonzero(is_near[vertices].all(axis=1)).tolist()


def _tree(ends: NDArray[np.float64]) -> BVHTree:
    """Of edges, (k, 2, 3): to Blender they are triangles without area."""
    count = len(ends)
    first = np.arange(count)
    triangles = np.stack([first, first + count, first + count], axis=1)
    points = np.swapaxes(ends, 0, 1).reshape(-1, 3)
    return BVHTree.FromPolygons(points.tolist(), triangles.tolist(), all_triangles=True)
