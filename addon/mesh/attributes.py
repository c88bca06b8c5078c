# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes float attributes, which other tools can draw and read."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.errors import Refused


def write_floats(mesh: bpy.types.Mesh, name: str, domain: str, values: NDArray[np.floating]) -> None:
    """Store a number for every vertex or face, creating the attribute where it is missing.

    domain: "POINT" or "FACE". values: (n,) or (f,).
    """
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        elements = bm.verts if domain == "POINT" else bm.faces
        layer = elements.layers.float.get(name) or elements.layers.float.new(name)
        for element, value in zip(elements, values.tolist(), strict=True):
            element[layer] = value
    else:
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", domain)
        attribute.data.foreach_set("value", values.astype(np.float32))
    tag_update(mesh)


def require_type(mesh: bpy.types.Mesh, name: str, item: str) -> None:
    """Raise Refused where the name belongs to another attribute than a "FLOAT" or "INT" one on points."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", item):
        noun = {"FLOAT": "a float", "INT": "an integer"}[item]
        raise Refused(f'the attribute "{name}" is not {noun} attribute on points; rename it')


def tag_update(mesh: bpy.types.Mesh) -> None:
    """Tell Blender that attributes of a mesh were changed."""
    if mesh.is_editmode:
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        mesh.update_tag()
