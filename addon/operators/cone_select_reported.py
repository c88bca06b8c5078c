# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Reported Elements."""

import bpy

from .. import findings, identifiers, mesh_read, reporting, selection
from .common import poll_edit_mesh


class MESH_OT_cone_select_reported(bpy.types.Operator):
    """Select Reported Elements."""

    bl_idname = identifiers.SELECT_REPORTED
    bl_label = "Select Reported Elements"
    bl_description = "Select the vertices, edges and faces that the last unwrap or placement of cones complained about"
    bl_options = {"REGISTER", "UNDO"}

    extend: bpy.props.BoolProperty(name="Extend", description="Keep what is selected already", default=False)
    finding: bpy.props.IntProperty(
        name="Finding",
        description="Which one of those in the sidebar to select the elements of; all where it is -1",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = mesh_read.target_objects(context)
        # Counts and indices are those of the mesh itself, which lags behind what is edited.
        for obj in objects:
            obj.update_from_editmode()
        reported = {obj: self._reported(obj) for obj in objects}
        named = {
            obj: findings.joined(found.named for found in everything if found.mesh_size == findings.mesh_size(obj.data))
            for obj, everything in reported.items()
        }
        current = {obj: found for obj, found in named.items() if found.count()}
        if not current:
            changed = [obj.name for obj, everything in reported.items() if any(f.named.count() for f in everything)]
            self.report(
                {"WARNING"},
                f"{changed[0]} has changed since it was reported on; unwrap it again"
                if changed
                else "Nothing was reported on these meshes; there is nothing to select",
            )
            return {"CANCELLED"}
        if any(len(found.vertices) for found in current.values()):
            mode = selection.VERTEX_MODE
        elif any(len(found.edges) for found in current.values()):
            mode = selection.EDGE_MODE
        else:
            mode = selection.FACE_MODE
        selection.set_select_mode(context, mode, [obj.data for obj in objects])
        if not self.extend:
            for obj in objects:
                selection.select_elements(obj.data, extend=False)
        total = sum(found.count() for found in current.values())
        visible = sum(
            selection.select_elements(
                obj.data, True, found.vertices.tolist(), found.edges.tolist(), found.faces.tolist()
            )
            for obj, found in current.items()
        )
        hidden = f"; {total - visible} more hidden" if visible < total else ""
        self.report({"INFO"}, f"Selected {reporting.counted(visible, 'reported element')}{hidden}")
        return {"FINISHED"}

    def _reported(self, obj: bpy.types.Object) -> list[findings.Reported]:
        """What is asked for of what was said of the object."""
        everything = findings.last(obj)
        return everything if self.finding < 0 else everything[self.finding : self.finding + 1]
