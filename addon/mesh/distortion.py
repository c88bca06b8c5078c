# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of the active UV map on every face, as attributes that are written and removed together."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.identifiers import DISTORTION_ATTRIBUTES
from . import changes
from .attributes import tag_update, write_floats
from .uv_digest import uv_digest

# Digests of the UV maps measured since Blender started; undo in edit mode restores attributes, but no mesh properties.
_measured: set[str] = set()


def write(mesh: bpy.types.Mesh, values: dict[str, NDArray[np.float32]]) -> None:
    """Write the attributes of all measures, and remember which UV map they belong to.  values: (f,) by measure."""
    for measure, of_face in values.items():
        write_floats(mesh, DISTORTION_ATTRIBUTES[measure], "FACE", of_face)
    mesh.cone_unwrap_measured = uv_digest(mesh)
    _measured.add(mesh.cone_unwrap_measured)
    changes.mark_changed(mesh)


def clear(mesh: bpy.types.Mesh) -> bool:
    """Remove the attributes and the record of their UV map.  Returns whether there were any."""
    present = is_measured(mesh)
    for name in DISTORTION_ATTRIBUTES.values():
        if mesh.is_editmode:
            layers = bmesh.from_edit_mesh(mesh).faces.layers.float
            if (layer := layers.get(name)) is not None:
                layers.remove(layer)
        elif (attribute := mesh.attributes.get(name)) is not None:
            mesh.attributes.remove(attribute)
    mesh.property_unset("cone_unwrap_measured")
    if present:
        tag_update(mesh)
        changes.mark_changed(mesh)
    return present


def is_measured(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh has one of these attributes."""
    names = set(DISTORTION_ATTRIBUTES.values())
    if mesh.is_editmode:
        return not names.isdisjoint(bmesh.from_edit_mesh(mesh).faces.layers.float.keys())
    return not names.isdisjoint(mesh.attributes.keys())


def is_current(mesh: bpy.types.Mesh) -> bool:
    """Whether the attributes belong to the active UV map as it is now."""
    if not is_measured(mesh):
        return False
    digest = uv_digest(mesh)
    return digest == mesh.cone_unwrap_measured or digest in _measured


def register() -> None:
    bpy.types.Mesh.cone_unwrap_measured = bpy.props.StringProperty(
        name="Cone Unwrap Measured",
        description="The UV map that the measured distortion belongs to",
        options={"HIDDEN"},
    )


def unregister() -> None:
    del bpy.types.Mesh.cone_unwrap_measured
    _measured.clear()
