# SPDX-License-Identifier: GPL-3.0-or-later
"""The drawn upward direction of the texture on faces, as a vector attribute in the object's own space."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from mathutils import Vector

from ..core.errors import Refused
from ..core.identifiers import UP_ATTRIBUTE
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
    require_attribute(mesh)
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
    tag_update(mesh)
    changes.mark_changed(mesh)


def require_attribute(mesh: bpy.types.Mesh) -> None:
    """Raise Refused where the name belongs to another attribute."""
    attribute = mesh.attributes.get(UP_ATTRIBUTE)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("FACE", "FLOAT_VECTOR"):
        raise Refused(f'the attribute "{UP_ATTRIBUTE}" is not a vector attribute on faces; rename it')
