# SPDX-License-Identifier: GPL-3.0-or-later
"""Snap Cone Angles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...core import identifiers, native
from ...core.cone_angles import ConeAngles, Kind
from ...core.region import Region
from ...core.text import counted
from ...jobs.angles.prescribing import snapped
from ...mesh.angles import write_angles
from ..shared.properties import LATTICES, LatticeProperty
from .base import AngleOperator

if TYPE_CHECKING:
    import lsgp


class MESH_OT_cone_snap_angles(LatticeProperty, AngleOperator, bpy.types.Operator):
    """Snap Cone Angles."""

    bl_idname = identifiers.SNAP_ANGLES
    bl_label = "Snap to Quarter Turns"
    bl_description = (
        "Round all cone angles to quarter turns, or to the rotations of another pattern, so that they still add up, "
        "with the least distortion; angles that are multiples of these already are kept"
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("lattice", "seams", "border")

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        self.require_cones(cones)
        seamless = native.lsgp.Seamless(LATTICES[self.lattice][0])
        new = snapped(region.surface, cones, self.library_options(prescription="manual", seamless=seamless))
        write_angles(obj, new.angles.keys(), list(new.angles.values()), [Kind.SNAPPED] * len(new.angles))
        said = f"{counted(len(new.angles), 'cone')} snapped, expected stretch {new.prescription.predicted_l2:.3f}"
        if flat := new.flat():
            said += f"; {counted(flat, 'cone')} became flat and can be cleared"
        return said, new.prescription.warnings
