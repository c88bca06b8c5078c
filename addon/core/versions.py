# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between Blender's versions: where flags of UVs are stored, whether a material has nodes, and how flags of
edges are accessed in edit mode.

The flags of UVs can be read from a mesh in object mode or from a copy; Blender hides the attributes of a mesh in edit
mode.
"""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .errors import Refused

# 5.0 has one UV selection for all layers and nodes in every material.
SINCE_5 = bpy.app.version >= (5, 0)
# Older ones, such as 4.3, give no access to them on meshes in edit mode.
_HAS_FLAGS_OF_EDGES = hasattr(bmesh.types.BMLayerAccessEdge, "bool")


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


def edited_edge_flags(mesh: bpy.types.Mesh, name: str) -> NDArray[np.bool_]:
    """(e,) bool, an attribute of the edges of a mesh in edit mode; False without it."""
    bm = bmesh.from_edit_mesh(mesh)
    flags = np.zeros(len(bm.edges), bool)
    if not has_edge_flags(mesh, name):
        return flags
    if _HAS_FLAGS_OF_EDGES:
        layer = bm.edges.layers.bool[name]
        flags[:] = [edge[layer] for edge in bm.edges]
        return flags
    copy = bpy.data.meshes.new("Cone Unwrap")
    try:
        bm.to_mesh(copy)
        copy.attributes[name].data.foreach_get("value", flags)
    finally:
        bpy.data.meshes.remove(copy)
    return flags


def set_edited_edge_flags(mesh: bpy.types.Mesh, name: str, flags: NDArray[np.bool_]) -> None:
    """Give the edges of a mesh in edit mode an attribute, (e,) bool, or take it off them where none has it.

    This invalidates Python's references to its elements.  Raises Refused where this Blender needs a window for it.
    """
    if not flags.any():
        if has_edge_flags(mesh, name):
            mesh.attributes.remove(mesh.attributes[name])
    elif _HAS_FLAGS_OF_EDGES:
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.edges.layers.bool.get(name) or bm.edges.layers.bool.new(name)
        for edge, flag in zip(bm.edges, flags.tolist(), strict=True):
            edge[layer] = flag
    elif bpy.context.window is None:
        raise Refused("this version of Blender marks edges in its window only; use 4.5 or newer without one")
    else:
        bpy.ops.object.mode_set(mode="OBJECT")
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "BOOLEAN", "EDGE")
        attribute.data.foreach_set("value", flags)
        bpy.ops.object.mode_set(mode="EDIT")


def has_edge_flags(mesh: bpy.types.Mesh, name: str) -> bool:
    """Whether it has a boolean attribute of edges with this name."""
    attribute = mesh.attributes.get(name)
    return attribute is not None and (attribute.domain, attribute.data_type) == ("EDGE", "BOOLEAN")


def _flags(mesh: bpy.types.Mesh, name: str) -> NDArray[np.bool_]:
    flags = np.zeros(len(mesh.loops), bool)
    attribute = mesh.attributes.get(name)
    # Blender leaves the attribute out where no loop has the flag.
    if attribute is not None and attribute.domain == "CORNER" and attribute.data_type == "BOOLEAN":
        attribute.data.foreach_get("value", flags)
    return flags
