# SPDX-License-Identifier: GPL-3.0-or-later
"""Carries values of one mesh over to another on its surface: attributes and vertex groups."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.identifiers import DISTORTION_ATTRIBUTES
from .arrays import read_array
from .clearing import ATTRIBUTES

# The property, its type and its number of components, by type of attribute.
_MEANS = {
    "FLOAT": ("value", np.float32, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
}
_KINDS = {"INT": ("value", np.int32, 1), "BOOLEAN": ("value", bool, 1)}
_COLORS = ("FLOAT_COLOR", "BYTE_COLOR")
# Of the mesh's shape, or of what the add-on has computed for that mesh.
_OF_THE_MESH = frozenset({"position", "custom_normal", *ATTRIBUTES, *DISTORTION_ATTRIBUTES.values()})


@dataclass(frozen=True, slots=True)
class SurfacePoints:
    """Points on a mesh: the three vertices (v, 3) of a triangle that each is in, and their weights (v, 3), of sum 1."""

    vertices: NDArray[np.int32]
    weights: NDArray[np.float64]

    def mean(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """(v,) or (v, k): values of the mesh's vertices, (n,) or (n, k), at the points."""
        return np.einsum("vc,vc...->v...", self.weights, values[self.vertices])


def carry_point_values(source: bpy.types.Mesh, target: bpy.types.Mesh, points: SurfacePoints) -> None:
    """Store the numbers, vectors and colors of points, and the colors of corners, on the target's points.

    Colors of corners are first averaged at each vertex. points: on the source, those of the target's vertices.
    """
    for attribute in carried_attributes(source, "POINT"):
        add_values(target, attribute, "POINT", points.mean(read_values(attribute)))
    for attribute in carried_attributes(source, "CORNER"):
        if attribute.data_type in _COLORS:
            add_values(target, attribute, "POINT", points.mean(_mean_of_corners(source, read_values(attribute))))
    for name in ("active_color_name", "default_color_name"):
        if getattr(source.attributes, name) in target.attributes:
            setattr(target.attributes, name, getattr(source.attributes, name))


def carry_face_values(source: bpy.types.Mesh, target: bpy.types.Mesh, faces: NDArray[np.int32]) -> None:
    """Store the values of faces, material and flat shading among them.  faces: that of the source below each face."""
    for attribute in carried_attributes(source, "FACE"):
        add_values(target, attribute, "FACE", read_values(attribute)[faces])


def carry_groups(source: bpy.types.Object, target: bpy.types.Object, points: SurfacePoints, without: str) -> None:
    """Give the target the source's vertex groups but one, with their weights at the points."""
    groups, vertices, weights = _weights(source.data)
    for group in source.vertex_groups:
        if group.name == without:
            continue
        of_group = groups == group.index
        values = np.zeros(len(source.data.vertices))
        values[vertices[of_group]] = weights[of_group]
        carried = np.minimum(points.mean(values), 1.0)
        made = target.vertex_groups.new(name=group.name)
        for vertex in np.flatnonzero(carried > 0).tolist():
            made.add([vertex], float(carried[vertex]), "REPLACE")


def carried_attributes(
    source: bpy.types.Mesh, domain: str, without: Collection[str] = _OF_THE_MESH
) -> list[bpy.types.Attribute]:
    """The numbers, vectors and colors of a domain that say something of the surface, and the whole numbers and flags,
    which have no mean, of faces and edges.  Blender's own flags begin with a dot."""
    types = _MEANS | _KINDS if domain in {"FACE", "EDGE"} else _MEANS
    return [
        attribute
        for attribute in source.attributes
        if (attribute.domain == domain and attribute.data_type in types)
        and not (attribute.name in without or attribute.name.startswith("."))
    ]


def read_values(attribute: bpy.types.Attribute) -> NDArray:
    name, dtype, columns = (_MEANS | _KINDS)[attribute.data_type]
    return read_array(attribute.data, name, dtype, columns)


def add_values(target: bpy.types.Mesh, attribute: bpy.types.Attribute, domain: str, values: NDArray) -> None:
    """An attribute of the same name and type on a domain of another mesh."""
    name, dtype, _ = (_MEANS | _KINDS)[attribute.data_type]
    made = target.attributes.new(attribute.name, attribute.data_type, domain)
    made.data.foreach_set(name, np.ascontiguousarray(values, dtype).ravel())


def _mean_of_corners(source: bpy.types.Mesh, values: NDArray[np.float32]) -> NDArray[np.float64]:
    """(n, k) mean of values of corners, (l, k), at each vertex; 0 where it has none."""
    vertices, count = read_array(source.loops, "vertex_index", np.int32), len(source.vertices)
    sums = np.zeros((count, values.shape[1]))
    np.add.at(sums, vertices, values)
    return sums / np.maximum(np.bincount(vertices, minlength=count), 1)[:, None]


def _weights(mesh: bpy.types.Mesh) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float64]]:
    """Group, vertex and weight of every entry of a vertex in a group."""
    entries = [(entry.group, vertex.index, entry.weight) for vertex in mesh.vertices for entry in vertex.groups]
    groups, vertices, weights = np.array(entries, np.float64).reshape(-1, 3).T
    return groups.astype(np.int32), vertices.astype(np.int32), weights
