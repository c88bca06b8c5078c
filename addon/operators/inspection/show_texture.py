# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Texture and Remove Texture."""

from collections.abc import Iterable

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh import reports, texture, texture_note
from ...mesh.region_read import require_editable
from ...mesh.targets import target_objects
from ..shared.conclusion import conclude, for_each
from ..shared.polling import poll_meshes

PATTERNS = (
    (
        "CHECKER",
        "Checker",
        "Dark and light squares, which stay squares of one size where angles and areas are preserved",
    ),
    ("ASYMMETRIC", "Asymmetric", "Tiles that show how the UV map is rotated and whether it is mirrored"),
)


class UV_OT_cone_texture(bpy.types.Operator):
    """Show Texture, or with ``clear`` Remove Texture."""

    bl_idname = identifiers.TEXTURE_SHOW
    bl_label = "Show Texture"
    bl_description = (
        "Show the UV map with a texture in place of all materials of the mesh, which are remembered and restored "
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
            return "Remove the texture and restore the previous materials"
        return cls.bl_description

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_meshes(cls, context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        # A tile of a seamless layout is one UV unit.
        if not self.properties.is_property_set("tiles") and _repeated(target_objects(context)):
            self.tiles = 1
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), require_editable)
        objects = [obj for obj, _ in found]
        if self.clear:
            changed = [obj for obj in objects if texture.remove(obj)]
            texture.remove_unused(context)
        else:
            changed = objects
            if objects:
                material = texture.make_material(self.pattern, self.tiles, _repeated(objects) or 1.0)
                for obj in objects:
                    texture.show(obj, material)
                texture.show_in_view(context, material)
        texture_note.update_note()
        if not changed and not failures:
            self.report({"WARNING"}, "These meshes do not show the texture; there is nothing to remove")
        verb = "Removed the texture from" if self.clear else "Showing the texture on"
        done = [f"{verb} {counted(len(changed), 'mesh', 'meshes')}"] if changed else []
        return conclude(self, done, {}, failures)


def _repeated(objects: Iterable[bpy.types.Object]) -> float:
    """How many UV units the seamless layouts of objects are wide at most; 0 where none is seamless."""
    found = [reports.current(obj.data) for obj in objects]
    certificates = [report.certificate for report in found if report is not None and report.certificate is not None]
    return max((certificate["tiles"] * certificate["cell"] for certificate in certificates), default=0.0)
