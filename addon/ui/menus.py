# SPDX-License-Identifier: GPL-3.0-or-later
"""Menu entries; the search with F3 only finds operators that are in a menu."""

import bpy

from ..core import identifiers


class VIEW3D_MT_cone_angles(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_angles"
    bl_label = "Cone Angles"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(identifiers.SET_ANGLE)
        layout.operator(identifiers.SPREAD_REST)
        layout.operator(identifiers.SNAP_ANGLES)
        layout.operator(identifiers.SUGGEST)
        layout.operator(identifiers.PREVIEW)


class VIEW3D_MT_cone_seeing(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_seeing"
    bl_label = "Show UV Map"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(identifiers.MEASURE).clear = False
        layout.operator(identifiers.MEASURE, text="Clear Distortion").clear = True
        layout.separator()
        layout.operator(identifiers.TEXTURE_SHOW, text="Checker").pattern = "CHECKER"
        layout.operator(identifiers.TEXTURE_SHOW, text="Asymmetric Tiles").pattern = "ASYMMETRIC"
        layout.operator(identifiers.TEXTURE_SHOW, text="Remove Texture").clear = True


class VIEW3D_MT_cone_texels(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_texels"
    bl_label = "Texel Density"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(identifiers.TEXEL_GET)
        layout.operator(identifiers.TEXEL_SET)
        layout.operator(identifiers.TEXEL_SELECT)


class VIEW3D_MT_cone_islands(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_islands"
    bl_label = "Islands"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(identifiers.STRAIGHTEN)
        layout.operator(identifiers.RECTIFY)
        layout.operator(identifiers.GRID)
        layout.separator()
        layout.operator_menu_enum(identifiers.ORIENT, "by")
        layout.operator_menu_enum(identifiers.ALIGN, "side")
        layout.separator()
        layout.operator(identifiers.STITCH)
        layout.operator(identifiers.RIP)


class VIEW3D_MT_cone_unwrap(bpy.types.Menu):
    bl_idname = "VIEW3D_MT_cone_unwrap"
    bl_label = "Cone Unwrap"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        # Edit Cones and Edit Cuts need events, and so does the progress of long runs.
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator(identifiers.AUTO_UNWRAP)
        layout.operator(identifiers.UNWRAP)
        layout.operator(identifiers.PACK)
        layout.menu(VIEW3D_MT_cone_islands.bl_idname)
        layout.operator(identifiers.REMESH_TO_QUADS)
        layout.separator()
        layout.operator(identifiers.MARK).clear = False
        layout.operator(identifiers.MARK, text="Clear Cone").clear = True
        layout.operator(identifiers.SELECT)
        layout.operator(identifiers.EDIT)
        layout.operator(identifiers.PLACE)
        layout.menu(VIEW3D_MT_cone_angles.bl_idname)
        layout.separator()
        layout.operator(identifiers.EDIT_CUTS)
        layout.operator_menu_enum(identifiers.STEER_CUTS, "effect")
        layout.operator(identifiers.SELECT_CUTS)
        layout.operator(identifiers.SEAMS_FROM_CUTS)
        layout.separator()
        layout.operator(identifiers.DRAW_UP)
        layout.operator(identifiers.MARK_UP).clear = False
        layout.operator(identifiers.MARK_UP, text="Clear Texture Up").clear = True
        layout.separator()
        layout.operator(identifiers.SELECT_REPORTED)
        layout.menu(VIEW3D_MT_cone_seeing.bl_idname)
        layout.menu(VIEW3D_MT_cone_texels.bl_idname)
        layout.operator(identifiers.EXTEND_IMAGE)
        layout.operator(identifiers.CLEAR_DATA)


def draw_submenu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_cone_unwrap.bl_idname)


def draw_unwrap(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    layout = self.layout
    before = layout.operator_context
    layout.operator_context = "INVOKE_DEFAULT"
    layout.operator(identifiers.AUTO_UNWRAP)
    # Blender's own entries, which follow, keep theirs.
    layout.operator_context = before
    layout.menu(VIEW3D_MT_cone_unwrap.bl_idname)
    layout.separator()


def draw_remesh(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator_context = "INVOKE_DEFAULT"
    self.layout.operator(identifiers.REMESH_TO_QUADS)


def draw_for_vertices(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """The context menu is shared by all select modes; cones are vertices."""
    if context.tool_settings.mesh_select_mode[0]:
        draw_submenu(self, context)


# Cones are next to seams.
ENTRIES = (
    ("IMAGE_MT_uvs", draw_submenu),
    ("VIEW3D_MT_object", draw_submenu),
    ("VIEW3D_MT_object_convert", draw_remesh),
    ("VIEW3D_MT_edit_mesh_edges", draw_submenu),
    ("VIEW3D_MT_edit_mesh_vertices", draw_submenu),
    ("VIEW3D_MT_edit_mesh_context_menu", draw_for_vertices),
)


def append() -> None:
    # Auto Unwrap comes first: this menu is also the beginning of the 3D view's U menu (VIEW3D_MT_uv_map).
    bpy.types.IMAGE_MT_uvs_unwrap.prepend(draw_unwrap)
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).append(draw)


def remove() -> None:
    bpy.types.IMAGE_MT_uvs_unwrap.remove(draw_unwrap)
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).remove(draw)
