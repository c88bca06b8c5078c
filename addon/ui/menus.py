# SPDX-License-Identifier: GPL-3.0-or-later
"""Menu entries; F3 finds an operator only where a menu holds it."""

import bpy

from .. import identifiers


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


def draw_unwrap(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    layout = self.layout
    layout.separator()
    # So that long runs show their progress.
    layout.operator_context = "INVOKE_DEFAULT"
    layout.operator(identifiers.UNWRAP)


def draw_seeing(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_cone_seeing.bl_idname)


def draw_in_object_mode(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    draw_unwrap(self, context)
    self.layout.operator(identifiers.PLACE)
    self.layout.menu(VIEW3D_MT_cone_seeing.bl_idname)


def draw_cones(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    layout = self.layout
    layout.separator()
    layout.operator(identifiers.MARK).clear = False
    layout.operator(identifiers.MARK, text="Clear Cone").clear = True
    layout.operator(identifiers.SELECT)
    layout.operator_context = "INVOKE_DEFAULT"
    layout.operator(identifiers.EDIT)
    layout.operator(identifiers.PLACE)
    layout.menu(VIEW3D_MT_cone_angles.bl_idname)
    layout.operator(identifiers.SELECT_REPORTED)


def draw_cones_for_vertices(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """The context menu serves all select modes; cones belong to vertices."""
    if context.tool_settings.mesh_select_mode[0]:
        draw_cones(self, context)


# IMAGE_MT_uvs_unwrap also shows in the U menu of the 3D view (VIEW3D_MT_uv_map). The cones stand where the seams do.
ENTRIES = (
    ("IMAGE_MT_uvs_unwrap", draw_unwrap),
    ("VIEW3D_MT_object", draw_in_object_mode),
    ("IMAGE_MT_uvs", draw_cones),
    ("IMAGE_MT_uvs", draw_seeing),
    ("VIEW3D_MT_uv_map", draw_cones),
    ("VIEW3D_MT_uv_map", draw_seeing),
    ("VIEW3D_MT_edit_mesh_edges", draw_cones),
    ("VIEW3D_MT_edit_mesh_vertices", draw_cones),
    ("VIEW3D_MT_edit_mesh_context_menu", draw_cones_for_vertices),
)


def append() -> None:
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).append(draw)


def remove() -> None:
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).remove(draw)
