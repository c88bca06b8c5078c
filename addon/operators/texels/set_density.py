# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Texel Density."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...core.region import Region
from ...core.text import counted
from ...jobs.uv_maps.texels import Scaled, report_on_scaled, scale_islands
from ...mesh import reports
from ...mesh.reports import Report
from ...mesh.targets import target_objects
from ...mesh.texel_settings import shown_density
from ...mesh.uv_write import write_uv
from ..shared.conclusion import conclude, for_each
from ..shared.density import DensityProperty, density_in_world
from .base import NOTHING_SELECTED, TexelOperator


class UV_OT_cone_texel_set(DensityProperty, TexelOperator, bpy.types.Operator):
    """Set Texel Density."""

    bl_idname = identifiers.TEXEL_SET
    bl_label = "Set Texel Density"
    bl_description = (
        "Scale the islands of the selected faces, all islands of the selected objects in object mode, about their "
        "middles until a unit of length gets this many pixels"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.adopt_settings(context)
        density = density_in_world(self, context)

        def scaled(obj: bpy.types.Object) -> tuple[Region, Scaled, Report | None] | None:
            measured = self.measured(context, obj)
            if measured is None:
                return None
            report, result = reports.find(obj.data), scale_islands(measured, density)
            return measured.region, result, report and report_on_scaled(report, measured.region, result)

        found, failures = for_each(target_objects(context), scaled)
        found = [(obj, result) for obj, result in found if result is not None]
        if not found and not failures:
            self.report({"ERROR"}, NOTHING_SELECTED)
        skipped = sum(result.skipped for _, (_, result, _) in found)
        if skipped:
            self.report({"WARNING"}, f"{counted(skipped, 'island')} skipped because they have no area; unwrap first")
        count = sum(result.islands for _, (_, result, _) in found)
        if not count:
            return conclude(self, [], {}, failures)
        for obj, (region, result, report) in found:
            write_uv(obj, region, result.moved, result.corner_uv)
            if report is not None:
                reports.store(obj.data, report)
        return conclude(
            self, [f"{counted(count, 'island')} at {shown_density(context.scene, self.density)}"], {}, failures
        )
