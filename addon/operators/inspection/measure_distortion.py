# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Distortion and Clear Distortion."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import identifiers
from ...core.text import counted
from ...jobs.uv_maps.measuring import measure_faces
from ...mesh import distortion
from ...mesh.region_read import Faces, Groups, read_region, require_editable, require_uv_map
from ...mesh.targets import target_objects
from ...overlay.settings import settings
from ..shared.conclusion import conclude, for_each
from ..shared.polling import ComputingOperator


class UV_OT_cone_measure(ComputingOperator, bpy.types.Operator):
    """Measure Distortion, or with ``clear`` Clear Distortion."""

    bl_idname = identifiers.MEASURE
    bl_label = "Measure Distortion"
    bl_description = (
        "Measure how the active UV map distorts angles, areas and lengths, and store it in face attributes: "
        + ", ".join(identifiers.DISTORTION_ATTRIBUTES.values())
    )
    bl_options = {"REGISTER", "UNDO"}

    clear: bpy.props.BoolProperty(name="Clear", description="Remove the attributes instead", default=False)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        return "Remove the attributes of the measured distortion" if properties.clear else cls.bl_description

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = target_objects(context)
        return self._clear(objects) if self.clear else self._measure(context, objects)

    def _measure(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> set[str]:
        measured, failures = for_each(objects, _measured)
        for obj, values in measured:
            distortion.write(obj.data, values)
        if measured and settings(context).distortion == "NONE":
            settings(context).distortion = "CONFORMAL"
        faces = sum(len(obj.data.polygons) for obj, _ in measured)
        done = [f"Measured {counted(faces, 'face')}"] if measured else []
        return conclude(self, done, {}, failures)

    def _clear(self, objects: list[bpy.types.Object]) -> set[str]:
        found, failures = for_each(objects, _cleared)
        count = sum(was_there for _, was_there in found)
        if not count and not failures:
            self.report({"WARNING"}, "No distortion was measured on these meshes; there is nothing to clear")
        done = [f"Cleared the distortion of {counted(count, 'mesh', 'meshes')}"] if count else []
        return conclude(self, done, {}, failures)


def _cleared(obj: bpy.types.Object) -> bool:
    """Whether there was any.  Raises Refused."""
    require_editable(obj)
    return distortion.clear(obj.data)


def _measured(obj: bpy.types.Object) -> dict[str, NDArray[np.float32]]:
    """(f,) values of each measure.  Raises LsgpError, Refused."""
    require_editable(obj)
    require_uv_map(obj)
    return measure_faces(read_region(obj, Faces.ALL, Groups()))
