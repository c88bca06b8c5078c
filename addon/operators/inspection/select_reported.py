# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Reported Elements."""

import bpy

from ...core import findings, identifiers
from ...core.text import counted
from ...mesh.selection import EDGE_MODE, FACE_MODE, VERTEX_MODE, select_elements, set_select_mode
from ...mesh.targets import target_objects
from ..shared.conclusion import say_selected
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_select_reported(EditMeshOperator, bpy.types.Operator):
    """Select Reported Elements."""

    bl_idname = identifiers.SELECT_REPORTED
    bl_label = "Select Reported Elements"
    bl_description = "Select the vertices, edges and faces named by the errors and warnings of the last operation"
    bl_options = {"REGISTER", "UNDO"}

    extend: bpy.props.BoolProperty(name="Extend", description="Extend the existing selection", default=False)
    finding: bpy.props.IntProperty(
        name="Finding",
        description="Number of the problem in the sidebar whose elements to select; -1 for all",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = target_objects(context)
        # Counts and indices are those of the mesh itself, which lags behind edit mode.
        for obj in objects:
            obj.update_from_editmode()
        chosen = {obj: self._chosen(obj) for obj in objects}
        current = {}
        for obj, kept in chosen.items():
            size = findings.mesh_size(obj.data)
            current[obj] = findings.joined(finding.elements for finding in kept if finding.mesh_size == size)
        current = {obj: elements for obj, elements in current.items() if elements.count()}
        if not current:
            outdated = [obj.name for obj, kept in chosen.items() if any(finding.elements.count() for finding in kept)]
            self.report(
                {"WARNING"},
                f"{outdated[0]} has changed since it was reported on; unwrap it again"
                if outdated
                else "Nothing was reported on these meshes; there is nothing to select",
            )
            return {"CANCELLED"}
        self._select(context, objects, current)
        return {"FINISHED"}

    def _chosen(self, obj: bpy.types.Object) -> list[findings.KeptFinding]:
        """The findings of the object that were asked for."""
        kept = findings.last(obj)
        return kept if self.finding < 0 else kept[self.finding : self.finding + 1]

    def _select(
        self,
        context: bpy.types.Context,
        objects: list[bpy.types.Object],
        current: dict[bpy.types.Object, findings.MeshElements],
    ) -> None:
        """Select the elements of each object, in the select mode of the smallest, and report their number."""
        if any(len(elements.vertices) for elements in current.values()):
            mode = VERTEX_MODE
        elif any(len(elements.edges) for elements in current.values()):
            mode = EDGE_MODE
        else:
            mode = FACE_MODE
        set_select_mode(context, mode, [obj.data for obj in objects])
        if not self.extend:
            for obj in objects:
                select_elements(obj.data, extend=False)
        visible = sum(
            select_elements(
                obj.data,
                extend=True,
                vertices=elements.vertices.tolist(),
                edges=elements.edges.tolist(),
                faces=elements.faces.tolist(),
            )
            for obj, elements in current.items()
        )
        total = sum(elements.count() for elements in current.values())
        say_selected(self, visible, total, counted(visible, "reported element"))
