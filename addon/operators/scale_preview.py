# SPDX-License-Identifier: GPL-3.0-or-later
"""Preview Stretch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import identifiers, native
from ..angles import ConeAngles
from ..point_attributes import write_floats
from .angle_common import AngleOperator
from .common import SEAMS

if TYPE_CHECKING:
    import lsgp
    from numpy.typing import NDArray

    from ..mesh_read import Region


class MESH_OT_cone_preview(AngleOperator, bpy.types.Operator):
    """Preview Stretch."""

    bl_idname = identifiers.PREVIEW
    bl_label = "Preview Stretch"
    bl_description = (
        f"Write how much larger or smaller the texture will be at each vertex into the attribute "
        f'"{identifiers.LOG_SCALE_ATTRIBUTE}", and tell the stretch to expect, without unwrapping'
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("gains", "seams", "border")

    gains: bpy.props.BoolProperty(
        name="Gain of One More Cone",
        description="Write as well by how much one more cone at each vertex would lower the stretch, into the "
        f'attribute "{identifiers.GAIN_ATTRIBUTE}"',
        default=False,
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        options = self.library_options()
        angles = cones.held(region.surface, options).angles
        found = native.lsgp.prescribe_curvature(region.surface, cones.cones, angles, options)
        gains = self._gains(region.surface, cones, options) if self.gains else None
        write_floats(obj, identifiers.LOG_SCALE_ATTRIBUTE, found.log_scale)
        if gains is not None:
            write_floats(obj, identifiers.GAIN_ATTRIBUTE, gains)
        return f"stretch {found.predicted_l2:.3f} expected (1 is none)", found.warnings

    def _gains(self, surface: lsgp.Surface, cones: ConeAngles, options: lsgp.Options) -> NDArray[np.float64]:
        """(n,) by how much a cone at each vertex lowers the stretch of its part, 0 where none may be placed."""
        lsgp = native.lsgp
        out = np.zeros(len(surface.positions))
        fixed = cones.fixed()
        for part in lsgp.build_ledger(surface, cones.cones, fixed, options):
            own = part.cones
            gains = lsgp.cone_gains(
                lsgp.part_surface(surface, part),
                cones.cones[own],
                [fixed[i] for i in own],
                seams=SEAMS[self.seams][0],
            )
            # A part that needs a cone has no stretch to compare with but that of the worst place for it.
            worst = np.nanmax(gains.predicted_l2, initial=1.0)
            lowered = min(gains.present_l2, worst) - gains.predicted_l2
            out = np.maximum(out, np.nan_to_num(lowered, nan=0.0, posinf=0.0, neginf=0.0))
        return out
