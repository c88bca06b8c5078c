# SPDX-License-Identifier: GPL-3.0-or-later
"""The upward direction of the texture: drawn on faces, as a vector attribute in the object's own space, or marked on
edges, as a boolean attribute."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from mathutils import Vector

from ..core import versions
from ..core.errors import Refused
from ..core.identifiers import ALONG_ATTRIBUTE, UP_ATTRIBUTE
from . import changes
from .attributes import tag_update
from .mesh_reader import MeshReader

Directions = dict[int, tuple[float, float, float]]
"""Unit vectors by face, only of faces that have one."""


def directions_in(mesh: MeshReader) -> Directions:
    """What is drawn on a mesh."""
    stored = mesh.drawn_up
    if stored is None:
        return {}
    return {face: tuple(stored[face].tolist()) for face in np.flatnonzero(stored.any(axis=1)).tolist()}


def write_directions(mesh: bpy.types.Mesh, directions: Directions) -> None:
    """Store the directions of a mesh in edit mode in place of all earlier ones.  Raises Refused."""
    require_up_attribute(mesh)
    bm = bmesh.from_edit_mesh(mesh)
    layers = bm.faces.layers.float_vector
    layer = layers.get(UP_ATTRIBUTE)
    if not directions:
        if layer is not None:
            layers.remove(layer)
    else:
        layer = layers.new(UP_ATTRIBUTE) if layer is None else layer
        for number, face in enumerate(bm.faces):
            face[layer] = Vector(directions.get(number, (0.0, 0.0, 0.0)))
    _tell(mesh)


def mark_edges(mesh: bpy.types.Mesh) -> int:
    """Mark the selected edges of faces of a mesh in edit mode.  Returns how many there are.  Raises Refused."""
    _require(mesh, ALONG_ATTRIBUTE, "EDGE", "BOOLEAN", "a boolean attribute on edges")
    chosen = [edge.select and len(edge.link_faces) > 0 for edge in bmesh.from_edit_mesh(mesh).edges]
    if any(chosen):
        flags = versions.edited_edge_flags(mesh, ALONG_ATTRIBUTE) | chosen
        versions.set_edited_edge_flags(mesh, ALONG_ATTRIBUTE, flags)
        _tell(mesh)
    return sum(chosen)


def clear_edges(mesh: bpy.types.Mesh) -> int:
    """Take the marks off the selected edges of a mesh in edit mode.  Returns how many there were."""
    flags = versions.edited_edge_flags(mesh, ALONG_ATTRIBUTE)
    chosen = flags & [edge.select for edge in bmesh.from_edit_mesh(mesh).edges]
    if chosen.any():
        versions.set_edited_edge_flags(mesh, ALONG_ATTRIBUTE, flags & ~chosen)
        _tell(mesh)
    return int(chosen.sum())


def require_up_attribute(mesh: bpy.types.Mesh) -> None:
    """Raise Refused where the name belongs to another attribute than directions of faces."""
    _require(mesh, UP_ATTRIBUTE, "FACE", "FLOAT_VECTOR", "a vector attribute on faces")


def _require(mesh: bpy.types.Mesh, name: str, domain: str, data_type: str, kind: str) -> None:
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != (domain, data_type):
        raise Refused(f'the attribute "{name}" is not {kind}; rename it')


def _tell(mesh: bpy.types.Mesh) -> None:
    tag_update(mesh)
    changes.mark_changed(mesh)
