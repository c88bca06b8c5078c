# SPDX-License-Identifier: GPL-3.0-or-later
"""The pie menu, and the keys that open it."""

import bpy

from ..core import identifiers
from ..core.identifiers import TEXTURE_SHOW
from .menus import VIEW3D_MT_cone_islands

KEY = {"type": "U", "value": "PRESS", "shift": True, "alt": True}
"""None of Blender's own in the keymaps below or in those that come before them."""
KEYMAPS = (("Object Mode", "EMPTY"), ("Mesh", "EMPTY"), ("UV Editor", "EMPTY"))

_entries: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


class VIEW3D_MT_cone_pie(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_pie"
    bl_label = "Cone Unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_DEFAULT"
        is_edited = context.mode == "EDIT_MESH"
        # West, east, south, north, and the corners from the upper left on.
        pie.operator(identifiers.PACK)
        pie.operator(identifiers.UNWRAP)
        pie.operator(TEXTURE_SHOW, text="Checker").pattern = "CHECKER"
        pie.operator(identifiers.AUTO_UNWRAP, icon="UV")
        if is_edited:
            pie.operator(identifiers.STRAIGHTEN)
            pie.operator(identifiers.STITCH)
            pie.menu(VIEW3D_MT_cone_islands.bl_idname)
            pie.operator(identifiers.EDIT)


def register() -> None:
    # There are no keymaps of add-ons without a window.
    keymaps = bpy.context.window_manager.keyconfigs.addon
    if keymaps is None:
        return
    for name, space in KEYMAPS:
        keymap = keymaps.keymaps.new(name=name, space_type=space)
        entry = keymap.keymap_items.new("wm.call_menu_pie", **KEY)
        entry.properties.name = VIEW3D_MT_cone_pie.bl_idname
        _entries.append((keymap, entry))


def unregister() -> None:
    for keymap, entry in _entries:
        keymap.keymap_items.remove(entry)
    _entries.clear()
