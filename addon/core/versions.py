# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between Blender's versions: where flags of UVs are stored, and whether a material has nodes.

The flags can be read from a mesh in object mode or from a copy; Blender hides the attributes of a mesh in edit mode.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

# 5.0 has one UV selection for all layers and nodes in every material.
SINCE_5 = bpy.app.version >= (5, 0)


def pinned_loops(mesh: bpy.types.Mesh, layer: str) -> NDArray[np.bool_]:
    """(l,) bool, the loops whose UV is pinned in this layer."""
    return _flags(mesh, f".pn.{layer}")


def set_pinned_loops(mesh: bpy.types.Mesh, layer: str, pinned: NDArray[np.bool_]) -> None:
    """Pin the UVs of these loops, (l,) bool, in a layer without pins.

    This invalidates Python's references to other layers; look those up again.
    """
    mesh.attributes.new(f".pn.{layer}", "BOOLEAN", "CORNER").data.foreach_set("value", pinned)


def selected_loops(mesh: bpy.types.Mesh, layer: str) -> NDArray[np.bool_]:
    """(l,) bool, the loops whose UV is selected in a UV editor that has a selection of its own."""
    return _flags(mesh, ".uv_select_vert" if SINCE_5 else f".vs.{layer}")


def has_nodes(material: bpy.types.Material) -> bool:
    """Whether a material uses nodes."""
    return material.node_tree is not None and (SINCE_5 or material.use_nodes)


def _flags(mesh: bpy.types.Mesh, name: str) -> NDArray[np.bool_]:
    flags = np.zeros(len(mesh.loops), bool)
    attribute = mesh.attributes.get(name)
    # Blender leaves the attribute out where no loop has the flag.
    if attribute is not None and attribute.domain == "CORNER" and attribute.data_type == "BOOLEAN":
        attribute.data.foreach_get("value", flags)
    return flags
