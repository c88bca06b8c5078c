# SPDX-License-Identifier: GPL-3.0-or-later
"""A script in the file that puts back the materials that the texture replaces, for those without the extension."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..core.identifiers import TEXTURE
from .texture import find_material

NOTE = f"{TEXTURE}.py"

SCRIPT = """# Cone Unwrap shows UV maps by the material {texture!r}, in place of these materials.
# With the extension, Show UV Map > Remove Texture puts them back; without it, press Run Script above.

import bpy

# Where the slot is, its number, and the material that was there; None: the slot was empty, "": there was no slot.
REPLACED = [
{rows}]

texture = bpy.data.materials.get({texture!r})
for owner, slot, name in REPLACED:
    if isinstance(owner, bpy.types.Object):
        slots = owner.material_slots
        shown = slot < len(slots) and slots[slot].material == texture
        if shown:
            slots[slot].material = bpy.data.materials.get(name) if name else None
    elif owner is not None and slot < len(owner.materials) and owner.materials[slot] == texture:
        if name == "" and len(owner.materials) == 1:
            owner.materials.clear()
        else:
            owner.materials[slot] = bpy.data.materials.get(name) if name else None
"""


def update_note() -> None:
    """Write the text anew, or remove it where no slot shows the texture."""
    material = find_material()
    rows = "" if material is None else "".join(f"    {row},\n" for row in _rows())
    text = bpy.data.texts.get(NOTE)
    if not rows:
        if text is not None:
            bpy.data.texts.remove(text)
        return
    if text is None:
        text = bpy.data.texts.new(NOTE)
        text.use_fake_user = True
    text.from_string(SCRIPT.format(texture=material.name, rows=rows))


def _rows() -> Iterator[str]:
    """The entries of the list in the script."""
    for kind, owners in (("meshes", bpy.data.meshes), ("objects", bpy.data.objects)):
        for owner in owners:
            if owner.library is not None:
                continue
            for entry in owner.cone_unwrap_replaced:
                name = "" if entry.added else getattr(entry.material, "name", None)
                yield f"(bpy.data.{kind}.get({owner.name!r}), {entry.slot}, {name!r})"
