# SPDX-License-Identifier: GPL-3.0-or-later
"""A texture that shows the UV map in place of a mesh's materials, which are remembered and restored."""

from __future__ import annotations

import bpy

from ..core import tile_pictures
from ..core.identifiers import TEXTURE
from ..core.versions import has_nodes

# Property of the material: how the 3D view showed colors before.
VIEW_COLORS = "color_type"


class ConeUnwrapReplaced(bpy.types.PropertyGroup):
    """A slot that shows the texture, and the material that was there.  added: there was no slot."""

    slot: bpy.props.IntProperty()
    material: bpy.props.PointerProperty(type=bpy.types.Material)
    added: bpy.props.BoolProperty()


def make_material(pattern: str, tiles: int, repeated: float = 1.0) -> bpy.types.Material:
    """The material, created or changed to show this pattern.  Arguments as in `tile_pictures.picture`."""
    material = find_material()
    if material is None:
        material = bpy.data.materials.new(TEXTURE)
        material.cone_unwrap_texture = True
        if not has_nodes(material):
            material.use_nodes = True
        tree = material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.location = (-320, 300)
        shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
        shader.inputs["Roughness"].default_value = 1.0
        tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
        tree.nodes.active = node
    node = material.node_tree.nodes.active
    old, node.image = node.image, _make_image(pattern, tiles, repeated)
    if old is not None and not old.users:
        bpy.data.images.remove(old)
    return material


def find_material() -> bpy.types.Material | None:
    """The material that shows the texture; None where this file has none."""
    return next((m for m in bpy.data.materials if m.cone_unwrap_texture and m.library is None), None)


def is_shown(obj: bpy.types.Object) -> bool:
    """Whether a slot of the object shows the texture."""
    return any(slot.material is not None and slot.material.cone_unwrap_texture for slot in obj.material_slots)


def material_of(obj: bpy.types.Object, index: int) -> bpy.types.Material | None:
    """The material in a slot; where the slot shows the texture, the material it replaces."""
    slot = obj.material_slots[index]
    if slot.material is None or not slot.material.cone_unwrap_texture:
        return slot.material
    entries = _owner(obj, slot).cone_unwrap_replaced
    return next((entry.material for entry in entries if entry.slot == index), None)


def show(obj: bpy.types.Object, material: bpy.types.Material) -> None:
    """Put the material into all slots, adding one if there are none, and remember the replaced materials."""
    if not obj.material_slots:
        obj.data.materials.append(material)
        obj.data.cone_unwrap_replaced.add().added = True
    for index, slot in enumerate(obj.material_slots):
        if slot.material is not None and slot.material.cone_unwrap_texture:
            continue
        entry = _owner(obj, slot).cone_unwrap_replaced.add()
        entry.slot, entry.material = index, slot.material
        slot.material = material


def remove(obj: bpy.types.Object) -> bool:
    """Restore the materials of all slots that still show the texture.  Returns whether there were any."""
    present = is_shown(obj)
    for owner in (obj.data, obj):
        for entry in owner.cone_unwrap_replaced:
            slot = obj.material_slots[entry.slot] if entry.slot < len(obj.material_slots) else None
            if slot is None or slot.material is None or not slot.material.cone_unwrap_texture:
                continue
            if entry.added and len(obj.material_slots) == 1:
                # Unlike `pop`, this also removes the objects' slots.
                obj.data.materials.clear()
            else:
                slot.material = entry.material
        owner.property_unset("cone_unwrap_replaced")
    return present


def remove_unused(context: bpy.types.Context) -> None:
    """Remove the material and its image from the file if nothing shows them any longer."""
    material = find_material()
    if material is None or material.users:
        return
    view = context.space_data
    before = material.get(VIEW_COLORS)
    if before is not None and _is_solid_view(view) and view.shading.color_type == "TEXTURE":
        view.shading.color_type = before
    image = material.node_tree.nodes.active.image
    bpy.data.materials.remove(material)
    if image is not None and not image.users:
        bpy.data.images.remove(image)


def show_in_view(context: bpy.types.Context, material: bpy.types.Material) -> None:
    """Make a 3D view with solid shading show textures."""
    view = context.space_data
    if _is_solid_view(view) and view.shading.color_type != "TEXTURE":
        material[VIEW_COLORS] = view.shading.color_type
        view.shading.color_type = "TEXTURE"


def _is_solid_view(space: bpy.types.Space | None) -> bool:
    return space is not None and space.type == "VIEW_3D" and space.shading.type == "SOLID"


def _make_image(pattern: str, tiles: int, repeated: float) -> bpy.types.Image:
    pixels = tile_pictures.picture(pattern, tiles, repeated)
    image = bpy.data.images.new(TEXTURE, pixels.shape[1], pixels.shape[0])
    image.pixels.foreach_set(pixels.ravel())
    # Packed, its pixels are saved with the file and restored by undo.
    image.pack()
    return image


def _owner(obj: bpy.types.Object, slot: bpy.types.MaterialSlot) -> bpy.types.ID:
    """The object or its mesh, whichever the slot's material belongs to."""
    return obj if slot.link == "OBJECT" else obj.data


def register() -> None:
    bpy.utils.register_class(ConeUnwrapReplaced)
    for owner in (bpy.types.Mesh, bpy.types.Object):
        owner.cone_unwrap_replaced = bpy.props.CollectionProperty(
            type=ConeUnwrapReplaced, name="Cone Unwrap Replaced", options={"HIDDEN"}
        )
    bpy.types.Material.cone_unwrap_texture = bpy.props.BoolProperty(
        name="Cone Unwrap Texture", description="Whether this is the material of Show Texture", options={"HIDDEN"}
    )


def unregister() -> None:
    del bpy.types.Material.cone_unwrap_texture
    for owner in (bpy.types.Mesh, bpy.types.Object):
        del owner.cone_unwrap_replaced
    bpy.utils.unregister_class(ConeUnwrapReplaced)
