# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Texture and Remove Texture."""

import bpy

from .. import identifiers, mesh_read, reporting, reports, texture

PATTERNS = (
    ("CHECKER", "Checker", "Black and white squares: they stay square where angles and sizes are kept"),
    ("ASYMMETRIC", "Asymmetric", "Tiles that look different turned and mirrored: they show how the map lies"),
)


class UV_OT_cone_texture(bpy.types.Operator):
    """Show Texture, or with ``clear`` Remove Texture."""

    bl_idname = identifiers.TEXTURE_SHOW
    bl_label = "Show Texture"
    bl_description = (
        "Show the UV map by a texture in place of all materials of the mesh, which are remembered and come back "
        "when it is removed"
    )
    bl_options = {"REGISTER", "UNDO"}

    pattern: bpy.props.EnumProperty(name="Pattern", description="What the texture shows", items=PATTERNS)
    tiles: bpy.props.IntProperty(
        name="Tiles", description="Tiles along a side of the UV square", default=8, min=1, max=32
    )
    clear: bpy.props.BoolProperty(
        name="Remove", description="Remove the texture instead", default=False, options={"SKIP_SAVE"}
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        if properties.clear:
            return "Take the texture away and put the materials back that were there before"
        return cls.bl_description

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not mesh_read.target_objects(context):
            cls.poll_message_set("Enter edit mode on a mesh, or select mesh objects in object mode")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if not self.properties.is_property_set("tiles"):
            found = [reports.current(obj.data) for obj in mesh_read.target_objects(context)]
            # A tile of a seamless layout is one UV unit.
            if any(report is not None and report.certificate is not None for report in found):
                self.tiles = 1
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = [obj for obj in mesh_read.target_objects(context) if obj.data.is_editable and obj.is_editable]
        if self.clear:
            changed = [obj for obj in objects if texture.remove(obj)]
            texture.forget_unused(context)
        else:
            changed = objects
            material = texture.make_material(self.pattern, self.tiles)
            for obj in objects:
                texture.show(obj, material)
            texture.show_in_view(context, material)
        if not changed:
            self.report(
                {"WARNING"},
                "These meshes do not show the texture; there is nothing to remove"
                if self.clear
                else "These meshes are linked from another file; make them local (Object > Relations)",
            )
            return {"CANCELLED"}
        verb = "Removed the texture from" if self.clear else "Showing the texture on"
        self.report({"INFO"}, f"{verb} {reporting.counted(len(changed), 'mesh', 'meshes')}")
        return {"FINISHED"}
