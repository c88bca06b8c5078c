# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender's versions store in different ways: flags of UVs and whether a material has nodes.

The flags need a mesh out of edit mode, or a copy of it; Blender hides the attributes of an edited mesh.
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

    Adding them moves what Python holds of other layers; look those up again.
    """
    mesh.attributes.new(f".pn.{layer}", "BOOLEAN", "CORNER").data.foreach_set("value", pinned)


def selected_loops(mesh: bpy.types.Mesh, layer: str) -> NDArray[np.bool_]:
    """(l,) bool, the loops whose UV is selected in the UV editor while it does not follow the mesh selection."""
    return _flags(mesh, ".uv_select_vert" if SINCE_5 else f".vs.{layer}")


def has_nodes(material: bpy.types.Material) -> bool:
    """True where the nodes of a material count."""
    return material.node_tree is not None and (SINCE_5 or material.use_nodes)


def _flags(mesh: bpy.types.Mesh, name: str) -> NDArray[np.bool_]:
    flags = np.zeros(len(mesh.loops), bool)
    attribute = mesh.attributes.get(name)
    # Blender leaves the attribute out where no loop has the flag.
    if attribute is not None and attribute.domain == "CORNER" and attribute.data_type == "BOOLEAN":
        attribute.data.foreach_get("value", flags)
    return flags
