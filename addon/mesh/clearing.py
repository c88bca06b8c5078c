# SPDX-License-Identifier: GPL-3.0-or-later
"""Removes everything that the add-on stores on an object and its mesh."""

from __future__ import annotations

import bpy

from ..core import identifiers
from . import distortion, reports
from .attributes import tag_update
from .own_settings import forget_settings

ATTRIBUTES = (
    identifiers.CONE_ANGLE_ATTRIBUTE,
    identifiers.CONE_ANGLE_KIND_ATTRIBUTE,
    identifiers.LOG_SCALE_ATTRIBUTE,
    identifiers.GAIN_ATTRIBUTE,
    identifiers.UP_ATTRIBUTE,
    identifiers.ALONG_ATTRIBUTE,
    identifiers.FEATURE_ATTRIBUTE,
)


def clear_data(obj: bpy.types.Object, group_name: str) -> bool:
    """Remove the vertex groups of cones and of cut costs, the attributes, the report and the chosen settings.
    Returns whether there were any."""
    mesh = obj.data
    groups = [group for group in obj.vertex_groups if group.name in {group_name, identifiers.SEAM_COST_GROUP}]
    # Blender numbers the groups after a removed one anew.
    for group in reversed(groups):
        obj.vertex_groups.remove(group)
    # All of them, whatever the first ones say.
    removed = [
        distortion.clear(mesh),
        reports.forget(mesh),
        _remove_attributes(mesh),
        bool(groups),
        forget_settings(obj),
    ]
    tag_update(mesh)
    return any(removed)


def _remove_attributes(mesh: bpy.types.Mesh) -> bool:
    present = [name for name in ATTRIBUTES if name in mesh.attributes]
    for name in present:
        mesh.attributes.remove(mesh.attributes[name])
    return bool(present)
