# SPDX-License-Identifier: GPL-3.0-or-later
"""Snap Cone Angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy

from .. import identifiers, native, reporting
from ..angles import ConeAngles, Kind, write_angles
from .angle_common import AngleOperator
from .common import enum_items
from .seamless import LATTICES

if TYPE_CHECKING:
    import lsgp

    from ..mesh_read import Region


class MESH_OT_cone_snap_angles(AngleOperator, bpy.types.Operator):
    """Snap Cone Angles."""

    bl_idname = identifiers.SNAP_ANGLES
    bl_label = "Snap to Quarter Turns"
    bl_description = (
        "Round all cone angles to quarter turns, or to the turns of another pattern, so that they still add up and "
        "distort least; angles that are such turns already stay"
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("lattice", "seams", "border")

    lattice: bpy.props.EnumProperty(
        name="Pattern", description="Which turns leave the texture as it is", items=enum_items(LATTICES)
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        self.require_cones(cones)
        lattice = LATTICES[self.lattice][0]
        options = self.library_options(prescription="manual", seamless=native.lsgp.Seamless(lattice))
        before = cones.fixed()
        found = native.lsgp.prescribe_curvature(region.surface, cones.cones, before, options)
        # Prescribed angles that stay are prescribed as they were.
        given = {vertex: angle for vertex, angle in zip(cones.cones.tolist(), before, strict=True) if angle is not None}
        snapped = [
            (vertex, angle)
            for vertex, angle in zip(found.cones.tolist(), found.cone_angles.tolist(), strict=True)
            if abs(angle - given.get(vertex, math.inf)) > 1e-6
        ]
        write_angles(obj, [v for v, _ in snapped], [angle for _, angle in snapped], [Kind.SNAPPED] * len(snapped))
        flat = sum(abs(angle - 2 * math.pi) < 1e-6 for angle in found.cone_angles)
        said = f"{reporting.counted(len(snapped), 'cone')} snapped, stretch {found.predicted_l2:.3f} expected"
        if flat:
            said += f"; {reporting.counted(flat, 'cone')} came out flat and can be cleared"
        return said, found.warnings
