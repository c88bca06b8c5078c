# SPDX-License-Identifier: GPL-3.0-or-later
"""Removes everything that the add-on stores on an object and its mesh."""

from __future__ import annotations

import bmesh
import bpy

from ..core import identifiers
from . import distortion, reports
from .attributes import tag_update

ATTRIBUTES = (
    identifiers.CONE_ANGLE_ATTRIBUTE,
    identifiers.CONE_ANGLE_KIND_ATTRIBUTE,
    identifiers.LOG_SCALE_ATTRIBUTE,
    identifiers.GAIN_ATTRIBUTE,
    identifiers.UP_ATTRIBUTE,
)


def clear_data(obj: bpy.types.Object, group_name: str) -> bool:
    """Remove the vertex group, the attributes and the report.  Returns whether there were any."""
    mesh = obj.data
    group = obj.vertex_groups.get(group_name)
    if group is not None:
        obj.vertex_groups.remove(group)
    # All of them, whatever the first ones say.
    removed = [distortion.clear(mesh), reports.forget(mesh), _remove_attributes(mesh), group is not None]
    tag_update(mesh)
    return any(removed)


def _remove_attributes(mesh: bpy.types.Mesh) -> bool:
    if not mesh.is_editmode:
        present = [name for name in ATTRIBUTES if name in mesh.attributes]
        for name in present:
            mesh.attributes.remove(mesh.attributes[name])
        return bool(present)
    bm = bmesh.from_edit_mesh(mesh)
    present = False
    for kind in (bm.verts.layers.float, bm.verts.layers.int, bm.faces.layers.float_vector):
        for name in ATTRIBUTES:
            if (layer := kind.get(name)) is not None:
                kind.remove(layer)
                present = True
    return present
