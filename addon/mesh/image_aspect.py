# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh's image texture and its aspect ratio, determined as in Blender's own unwrap."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.versions import has_nodes
from .arrays import read_array
from .texture import material_of


def image_aspect(obj: bpy.types.Object) -> float:
    """Width over height of the image in the material of the active face; 1 where there is none."""
    image = active_image(obj)
    if image is None:
        return 1.0
    width, height = (size * aspect for size, aspect in zip(image.size, image.display_aspect, strict=True))
    return width / height


def active_image(obj: bpy.types.Object) -> bpy.types.Image | None:
    """The image in the material of the active face; None where there is none, or it has no pixels."""
    faces = obj.data.polygons
    # As in Blender, the first face stands in where none is active.
    if not faces:
        return None
    face = faces[faces.active if 0 <= faces.active < len(faces) else 0]
    slots = len(obj.material_slots)
    return _image_in(material_of(obj, min(face.material_index, slots - 1))) if slots else None


def faces_showing(obj: bpy.types.Object, image: bpy.types.Image) -> NDArray[np.bool_]:
    """(f,), the faces whose material has this image; the mesh has a material.  In edit mode as last read."""
    slots = np.array([_image_in(material_of(obj, slot)) == image for slot in range(len(obj.material_slots))])
    return slots[np.minimum(read_array(obj.data.polygons, "material_index", np.int32), len(slots) - 1)]


def _image_in(material: bpy.types.Material | None) -> bpy.types.Image | None:
    if material is None or not has_nodes(material):
        return None
    image = getattr(_active_texture(material.node_tree), "image", None)
    return None if image is None or not all(image.size) else image


def _active_texture(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """The texture node that the viewport shows, in this tree or in one of its groups; otherwise any texture node."""
    shown = [node for node in tree.nodes if node.show_texture]
    if shown:
        return next((node for node in shown if node == tree.nodes.active), shown[-1])
    groups = [node for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None]
    for group in sorted(groups, key=lambda node: node != tree.nodes.active):
        found = _active_texture(group.node_tree)
        if found is not None:
            return found
    return next((node for node in tree.nodes if node.type in {"TEX_IMAGE", "TEX_ENVIRONMENT"}), None)
