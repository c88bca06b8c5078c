# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones."""

import bpy
import numpy as np

from .. import cells, findings, identifiers, mesh_read, mesh_write, native, packing, reporting, unwrapping
from .common import SEAMS, ConeGroupProperty, SeamsProperty, enum_items, poll_computation, require_region
from .seamless import SeamlessProperties

# Identifier: (value for the library, label, description); "Automatic" leaves the rule to the library.
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
BORDERS = {
    "FREE": ("free", "Free", "Borders take the shape of least distortion; a cone with an angle there is a corner"),
    "STRAIGHT": ("straight", "Straight", "Borders run straight from cone to cone: a cylinder becomes a strip"),
}
MARGIN_METHODS = (
    ("SCALED", "Scaled", "Use scale of existing UVs to multiply margin"),
    ("ADD", "Add", "Just add the margin, ignoring any UV scale"),
    ("FRACTION", "Fraction", "Specify a precise fraction of final UV output"),
)


class UV_OT_cone_unwrap(ConeGroupProperty, SeamsProperty, SeamlessProperties, bpy.types.Operator):
    """Unwrap from Cones."""

    bl_idname = identifiers.UNWRAP
    bl_label = "Unwrap from Cones"
    bl_description = (
        "Cut the mesh through its cones and unwrap it so that both sides of every cut have the same length. "
        "Works on the selected faces in edit mode (in a UV editor with its own selection, on those with all UVs "
        "selected), on all faces of the selected objects in object mode; each object fills the UV square by itself"
    )
    bl_options = {"REGISTER", "UNDO"}

    prescription: bpy.props.EnumProperty(
        name="Cone Angles", description="How the angle left at each cone is chosen", items=enum_items(PRESCRIPTIONS)
    )
    unfold: bpy.props.EnumProperty(
        name="Unfold", description="How the surface is flattened", items=enum_items(UNFOLDINGS)
    )
    border: bpy.props.EnumProperty(
        name="Borders", description="The shape of the mesh's own borders", items=enum_items(BORDERS)
    )
    use_pins: bpy.props.BoolProperty(
        name="Use Pins",
        description="Pinned UVs of the active layer stay where they are; two or more decide the place, size and turn "
        "of their island",
        default=True,
    )
    keep_placement: bpy.props.BoolProperty(
        name="Keep Placement",
        description="Move, turn and scale each island to where its faces were, instead of into the UV square; "
        "in a seamless layout islands are moved by whole tiles only",
        default=False,
    )
    correct_aspect: bpy.props.BoolProperty(
        name="Correct Aspect",
        description="Map UVs taking aspect ratio of the image associated with the material into account; "
        "not in a seamless layout, whose tiles would no longer match after it",
        default=True,
    )
    pack: bpy.props.BoolProperty(
        name="Pack Islands",
        description="Pack the islands of all objects together with Blender's packer; islands with pins stay. "
        "In a seamless layout islands are moved side by side by whole tiles only",
        default=False,
    )
    margin_method: bpy.props.EnumProperty(name="Margin Method", items=MARGIN_METHODS)
    margin: bpy.props.FloatProperty(
        name="Margin", description="Space between islands", default=0.001, min=0.0, max=1.0, precision=3
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("prescription", "unfold", "seams", "border", "use_pins"):
            layout.prop(self, name)
        self.draw_seamless(layout)
        row = layout.row()
        row.active = not self.seamless
        row.prop(self, "correct_aspect")
        row = layout.row()
        row.active = not self.pack
        row.prop(self, "keep_placement")
        layout.prop(self, "pack")
        column = layout.column()
        column.active = self.pack and not self.seamless
        column.prop(self, "margin_method")
        column.prop(self, "margin")
        self.draw_vertex_group(layout, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        solved, failures = self._solve(context)
        if not solved and not failures:
            self.report({"ERROR"}, "No face is selected; select the faces to unwrap")
            return {"CANCELLED"}
        layouts = [unwrapped.corner_uv for unwrapped in solved]
        if self.pack and solved:
            try:
                layouts = cells.pack(solved) if self.seamless else self._packed(solved)
            except (reporting.Refused, MemoryError) as error:
                failures |= {unwrapped.obj.name: _refusal(error) for unwrapped in solved}
                solved = layouts = []
        # Only now, with all computation behind, is anything written.
        for unwrapped, corner_uv in zip(solved, layouts, strict=True):
            mesh_write.write_uv(unwrapped.obj, unwrapped.region, unwrapped.result.solved, corner_uv)
        done = [_summary(unwrapped) for unwrapped in solved]
        warnings = {unwrapped.obj.name: unwrapped.result.warnings for unwrapped in solved}
        return reporting.conclude(self, done, warnings, failures)

    def _solve(self, context: bpy.types.Context) -> tuple[list[unwrapping.Unwrapped], dict[str, Exception]]:
        """The finished maps, and by object name what went wrong with the others; nothing is written."""
        settings = self._settings()
        by_uv = mesh_read.selects_by_uv(context)
        solved = []
        failures = {}
        for obj in mesh_read.target_objects(context):
            region = None
            try:
                region = require_region(obj, by_uv)
                if region is None:
                    continue
                solved.append(unwrapping.unwrap(obj, region, settings))
                findings.keep(obj, region, solved[-1].result.warnings)
            except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
                failures[obj.name] = _refusal(error)
                findings.keep(obj, region, [error])
        return solved, failures

    def _settings(self) -> unwrapping.Settings:
        options = native.lsgp.Options(
            prescription=PRESCRIPTIONS[self.prescription][0],
            unfold=UNFOLDINGS[self.unfold][0],
            seams=SEAMS[self.seams][0],
            border=BORDERS[self.border][0],
            seamless=self.seamless_options(),
        )
        return unwrapping.Settings(
            options=options,
            group=self.vertex_group,
            use_pins=self.use_pins,
            keep_placement=self.keep_placement and not self.pack,
            correct_aspect=self.correct_aspect and not self.seamless,
        )

    def _packed(self, solved: list[unwrapping.Unwrapped]) -> list[np.ndarray]:
        """The coordinates of each object after Blender's packer, as (m, 3, 2) arrays."""
        packed = packing.pack([unwrapped.islands() for unwrapped in solved], self.margin_method, self.margin)
        layouts = []
        for unwrapped, uv in zip(solved, packed, strict=True):
            layouts.append(unwrapped.corner_uv.copy())
            layouts[-1][unwrapped.result.solved] = uv
        return layouts


def _refusal(error: Exception) -> Exception:
    """The error as it can be told."""
    if isinstance(error, MemoryError):
        return reporting.Refused("there is not enough memory; unwrap fewer faces at once")
    return error


def _summary(unwrapped: unwrapping.Unwrapped) -> str:
    result = unwrapped.result
    islands = reporting.counted(int(result.island.max()) + 1, "island")
    return (
        f"{unwrapped.obj.name}: {islands} through {reporting.counted(len(result.cones), 'cone')}, "
        f"stretch {result.distortion.l2_stretch:.3f} (1 is none)"
        f"{'' if result.seamless is None else ', ' + cells.certified(unwrapped)}"
    )
