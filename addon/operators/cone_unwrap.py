# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones."""

import bpy

from .. import cones, identifiers, mesh_read, mesh_write, native, reporting
from .common import ConeGroupProperty, poll_computation, require_region

# Identifier: (rule of the library, label, description); "Automatic" leaves the rule to the library.
PRESCRIPTIONS = {
    "AUTOMATIC": (None, "Automatic", "Keep the angles typed for cones; choose the others for the least distortion"),
    "LEAST_DISTORTION": ("least-distortion", "Least Distortion", "Choose all angles for the least distortion"),
    "HARMONIC": ("harmonic", "Harmonic", "Choose all angles by how much curvature is nearest to each cone"),
    "STRAIGHTNESS": ("straightness", "Straight Seams", "Choose all angles so that seams become straight lines"),
}
UNFOLDINGS = {
    "POISSON": ("poisson", "Direct", "One linear solve; robust on every surface"),
    "SPECTRAL": ("spectral", "Spectral", "The least conformal energy by an eigenvalue solve; slower"),
}


def _items(choices: dict) -> list[tuple[str, str, str]]:
    return [(identifier, label, description) for identifier, (_, label, description) in choices.items()]


class UV_OT_cone_unwrap(ConeGroupProperty, bpy.types.Operator):
    """Unwrap from Cones."""

    bl_idname = identifiers.UNWRAP
    bl_label = "Unwrap from Cones"
    bl_description = (
        "Cut the mesh through its cones and unwrap it so that both sides of every cut have the same length; "
        "marked seams attract the cuts. Works on the selected faces in edit mode, on all faces of the selected "
        "objects in object mode; each object fills the UV square by itself"
    )
    bl_options = {"REGISTER", "UNDO"}

    prescription: bpy.props.EnumProperty(
        name="Cone Angles", description="How the angle left at each cone is chosen", items=_items(PRESCRIPTIONS)
    )
    unfold: bpy.props.EnumProperty(name="Unfold", description="How the surface is flattened", items=_items(UNFOLDINGS))

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "prescription")
        layout.prop(self, "unfold")
        self.draw_vertex_group(layout, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        lsgp = native.lsgp
        options = lsgp.Options(prescription=PRESCRIPTIONS[self.prescription][0], unfold=UNFOLDINGS[self.unfold][0])
        solved = []
        failures = {}
        for obj in mesh_read.target_objects(context):
            try:
                region = require_region(obj)
                if region is None:
                    continue
                marked = cones.marked_cones(obj, self.vertex_group)
                marked = marked[region.vertex_used[marked]]
                angles = cones.given_angles(obj.data, marked)
                solved.append((obj, region, lsgp.parameterize(region.surface, marked, angles, options)))
            except (lsgp.LsgpError, reporting.Refused) as error:
                failures[obj.name] = error
        if not solved and not failures:
            self.report({"ERROR"}, "No face is selected; select the faces to unwrap")
            return {"CANCELLED"}
        # Only now, with all computation behind, is anything written.
        for obj, region, result in solved:
            mesh_write.write_uv(obj, region, result)
        done = [_summary(obj, result) for obj, _, result in solved]
        warnings = {obj.name: result.warnings for obj, _, result in solved}
        return reporting.conclude(self, done, warnings, failures)


def _summary(obj: bpy.types.Object, result) -> str:
    islands = reporting.counted(int(result.island.max()) + 1, "island")
    return (
        f"{obj.name}: {islands} through {reporting.counted(len(result.cones), 'cone')}, "
        f"stretch {result.distortion.l2_stretch:.3f} (1 is none)"
    )
