# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Distortion and Clear Distortion."""

import bpy

from .. import distortion, identifiers, mesh_read, native, reporting
from ..overlay.settings import settings
from .common import poll_computation


class UV_OT_cone_measure(bpy.types.Operator):
    """Measure Distortion, or with ``clear`` Clear Distortion."""

    bl_idname = identifiers.MEASURE
    bl_label = "Measure Distortion"
    bl_description = (
        "Measure how the active UV map distorts angles, areas and lengths, and keep it on the faces as attributes: "
        + ", ".join(identifiers.DISTORTION_ATTRIBUTES.values())
    )
    bl_options = {"REGISTER", "UNDO"}

    clear: bpy.props.BoolProperty(name="Clear", description="Take the attributes away instead", default=False)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        return "Take the attributes of distortion away" if properties.clear else cls.bl_description

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = mesh_read.target_objects(context)
        return self._clear(objects) if self.clear else self._measure(context, objects)

    def _measure(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> set[str]:
        measured, failures = [], {}
        for obj in objects:
            try:
                measured.append((obj, _measured(obj)))
            except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
                failures[obj.name] = error
        for obj, values in measured:
            distortion.write(obj.data, values)
        if measured and settings(context).distortion == "NONE":
            settings(context).distortion = "CONFORMAL"
        faces = sum(len(obj.data.polygons) for obj, _ in measured)
        done = [f"Measured {reporting.counted(faces, 'face')}"] if measured else []
        return reporting.conclude(self, done, {}, failures)

    def _clear(self, objects: list[bpy.types.Object]) -> set[str]:
        cleared = [obj for obj in objects if obj.data.is_editable and distortion.clear(obj.data)]
        if not cleared:
            self.report({"WARNING"}, "No distortion was measured on these meshes; there is nothing to clear")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Cleared the distortion of {reporting.counted(len(cleared), 'mesh', 'meshes')}")
        return {"FINISHED"}


def _measured(obj: bpy.types.Object) -> dict:
    if not obj.data.is_editable:
        raise reporting.Refused("the mesh is linked from another file; make it local (Object > Relations)")
    if obj.data.uv_layers.active is None:
        raise reporting.Refused("the mesh has no UV map; unwrap it first")
    region = mesh_read.read_all(obj)
    if region is None:
        raise reporting.Refused("the mesh has no faces; add some or select another object")
    return distortion.measure(region, len(obj.data.polygons))
