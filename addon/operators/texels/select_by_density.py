# SPDX-License-Identifier: GPL-3.0-or-later
"""Select by Texel Density."""

from __future__ import annotations

import bpy
import numpy as np

from ...core import identifiers
from ...core.text import counted
from ...jobs.uv_maps.texels import face_densities
from ...mesh.region_read import Faces
from ...mesh.selection import FACE_MODE, select_elements, set_select_mode
from ...mesh.targets import target_objects
from ...mesh.texel_settings import shown_density
from ..shared.conclusion import conclude, for_each, say_selected
from ..shared.density import DensityProperty, density_in_world
from ..shared.polling import poll_edit_mesh
from .base import TexelOperator


class MESH_OT_cone_texel_select(DensityProperty, TexelOperator, bpy.types.Operator):
    """Select by Texel Density."""

    bl_idname = identifiers.TEXEL_SELECT
    bl_label = "Select by Texel Density"
    bl_description = "Select the faces that have about this many pixels per unit of length, fewer, or more"
    bl_options = {"REGISTER", "UNDO"}

    compare: bpy.props.EnumProperty(
        name="Compare",
        description="Which faces to select",
        items=(
            ("EQUAL", "Equal", "Faces whose density differs by at most the tolerance"),
            ("LESS", "Less", "Faces whose density is lower by more than the tolerance"),
            ("GREATER", "Greater", "Faces whose density is higher by more than the tolerance"),
        ),
    )
    tolerance: bpy.props.FloatProperty(
        name="Tolerance",
        description="Percentage of the density by which faces may deviate from it",
        default=10.0,
        min=0.0,
        soft_max=100.0,
        precision=1,
        subtype="PERCENTAGE",
    )
    extend: bpy.props.BoolProperty(name="Extend", description="Extend the existing selection", default=False)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context) and super().poll(context)

    def draw_choices(self, layout: bpy.types.UILayout) -> None:
        layout.prop(self, "compare")
        layout.prop(self, "tolerance")
        layout.prop(self, "extend")

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.adopt_settings(context)
        wanted, off = density_in_world(self, context), self.tolerance / 100

        def accepted(obj: bpy.types.Object) -> list[int]:
            ratio = face_densities(self.measured(context, obj, Faces.ALL)) / wanted
            tests = {"EQUAL": abs(ratio - 1) <= off, "LESS": ratio < 1 - off, "GREATER": ratio > 1 + off}
            return np.flatnonzero(tests[self.compare]).tolist()

        found, failures = for_each(target_objects(context), accepted)
        total = sum(len(faces) for _, faces in found)
        if not total:
            if found:
                self.report({"WARNING"}, f"No face fits {shown_density(context.scene, self.density)}")
            return conclude(self, [], {}, failures)
        set_select_mode(context, FACE_MODE, [obj.data for obj, _ in found])
        visible = sum(select_elements(obj.data, extend=self.extend, faces=faces) for obj, faces in found)
        if failures:
            conclude(self, [counted(len(found), "mesh", "meshes")], {}, failures)
        say_selected(self, visible, total, counted(visible, "face"))
        return {"FINISHED"}
