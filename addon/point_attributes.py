# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes float attributes on points, which other tools can draw and read."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .reporting import Refused


def write_floats(obj: bpy.types.Object, name: str, values: NDArray[np.float64]) -> None:
    """Store a number of every vertex, (n,), creating the attribute.  Raises Refused where the name is taken."""
    mesh = obj.data
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", "FLOAT"):
        raise Refused(f'the attribute "{name}" is no float on points; rename it')
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        layers = bm.verts.layers.float
        layer = layers.get(name) or layers.new(name)
        for vertex, value in zip(bm.verts, values.tolist(), strict=True):
            vertex[layer] = value
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        attribute = attribute or mesh.attributes.new(name, "FLOAT", "POINT")
        attribute.data.foreach_set("value", values.astype(np.float32))
        mesh.update_tag()
