# SPDX-License-Identifier: GPL-3.0-or-later
"""Place Cones."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import angles, cones, findings, identifiers, mesh_read, native, reporting, targets
from ..placing import PlacementSettings, PlacementTask, place_all
from .background import BackgroundComputation
from .common import SEAMS, ConeGroupProperty, SeamsProperty, enum_items, poll_computation, require_region
from .seamless import LATTICES

if TYPE_CHECKING:
    import lsgp

# Identifier: (normal of the plane, label, description).
MIRRORS = {
    "FOUND": (None, "Found", "The plane in which each connected part is its own mirror image, where there is one"),
    "X": ((1.0, 0.0, 0.0), "X", "The object's plane across X, as in a Mirror modifier"),
    "Y": ((0.0, 1.0, 0.0), "Y", "The object's plane across Y, as in a Mirror modifier"),
    "Z": ((0.0, 0.0, 1.0), "Z", "The object's plane across Z, as in a Mirror modifier"),
}
ORIGIN = (0.0, 0.0, 0.0)


class MESH_OT_cone_place(ConeGroupProperty, SeamsProperty, BackgroundComputation, bpy.types.Operator):
    """Place Cones."""

    bl_idname = identifiers.PLACE
    bl_label = "Place Cones"
    bl_description = (
        "Mark cones where they lower the stretch most, with the angles that go with them; "
        "on the selected faces in edit mode, on all faces of the selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO"}
    activity = "Placing cones"

    automatic: bpy.props.BoolProperty(
        name="Automatic", description="Place as few cones as it takes to keep the stretch low", default=True
    )
    target: bpy.props.FloatProperty(
        name="Stretch",
        description="The stretch (L2, 1 is none) to stay within on every connected part, as far as that can be",
        default=1.05,
        min=1.001,
        soft_max=1.5,
        step=1,
        precision=3,
    )
    count: bpy.props.IntProperty(
        name="Count",
        description="Cones on each connected part, those marked already included",
        default=8,
        min=0,
        soft_max=64,
    )
    seamless: bpy.props.BoolProperty(
        name="Seamless",
        description="Choose places and angles for a seamless layout, whose angles are turns of its pattern",
        default=False,
    )
    lattice: bpy.props.EnumProperty(
        name="Pattern", description="Which turns leave the texture as it is", items=enum_items(LATTICES)
    )
    symmetric: bpy.props.BoolProperty(
        name="Symmetric", description="Place the same cones on both sides of a mirror plane", default=False
    )
    mirror: bpy.props.EnumProperty(name="Plane", description="The mirror plane", items=enum_items(MIRRORS))
    prefer_sharp: bpy.props.BoolProperty(
        name="Prefer Sharp",
        description="Place cones on sharp corners before smooth places where that costs little",
        default=False,
    )
    keep: bpy.props.BoolProperty(
        name="Keep Marked",
        description="Keep the cones marked already, with prescribed and snapped angles, and add to them; "
        "otherwise they are cleared first",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "automatic")
        layout.prop(self, "target" if self.automatic else "count")
        layout.prop(self, "keep")
        layout.prop(self, "prefer_sharp")
        layout.prop(self, "symmetric")
        if self.symmetric:
            layout.prop(self, "mirror")
        layout.prop(self, "seamless")
        if self.seamless:
            layout.prop(self, "lattice")
        layout.separator()
        layout.prop(self, "seams")
        self.draw_vertex_group(layout, context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        # Without a window there are no events.
        if bpy.app.background or context.window is None:
            return self.execute(context)
        gathered, self._failures = self._gather(context)
        self._targets = [targets.target(obj) for obj, _ in gathered]
        self._tasks = [task for _, task in gathered]
        return self.start(context, partial(place_all, self._tasks))

    def conclude_computation(self, _context: bpy.types.Context, outcomes: list[lsgp.Placement | Exception]) -> set[str]:
        found = []
        for target, task, outcome in zip(self._targets, self._tasks, outcomes, strict=True):
            try:
                found.append((target.find(), task, outcome))
            except reporting.Refused as error:
                self._failures[target.name] = error
        return self._conclude_placement(found, self._failures)

    def execute(self, context: bpy.types.Context) -> set[str]:
        gathered, failures = self._gather(context)
        outcomes = place_all([task for _, task in gathered])
        found = [(obj, task, outcome) for (obj, task), outcome in zip(gathered, outcomes, strict=True)]
        return self._conclude_placement(found, failures)

    def _settings(self) -> PlacementSettings:
        normal = MIRRORS[self.mirror][0]
        return PlacementSettings(
            count=None if self.automatic else self.count,
            target=self.target,
            lattice=LATTICES[self.lattice][0] if self.seamless else None,
            prefer_sharp=self.prefer_sharp,
            symmetric=self.symmetric,
            mirror=None if normal is None or not self.symmetric else (ORIGIN, normal),
            seams=SEAMS[self.seams][0],
        )

    def _gather(
        self, context: bpy.types.Context
    ) -> tuple[list[tuple[bpy.types.Object, PlacementTask]], dict[str, Exception]]:
        """What is to be solved, and by object name what went wrong with the others."""
        settings = self._settings()
        by_uv = mesh_read.selects_by_uv(context)
        gathered = []
        failures = {}
        for obj in mesh_read.target_objects(context):
            try:
                region = require_region(obj, by_uv)
                angles.require_attributes(obj.data)
                if region is not None:
                    marked = angles.read_angles(obj, self.vertex_group).on(region.vertex_used)
                    gathered.append((obj, PlacementTask(region, marked, self.keep, settings)))
            except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
                failures[obj.name] = error
                findings.keep(obj, None, [error])
        return gathered, failures

    def _conclude_placement(
        self,
        outcomes: Iterable[tuple[bpy.types.Object, PlacementTask, lsgp.Placement | Exception]],
        failures: dict[str, Exception],
    ) -> set[str]:
        """Write and report.  failures: by object name, of objects that are not among the outcomes."""
        done = []
        warnings = {}
        for obj, task, outcome in outcomes:
            if isinstance(outcome, Exception):
                failures[obj.name] = outcome
                findings.keep(obj, task.region, [outcome])
                continue
            done.append(f"{obj.name}: {self._write(obj, task, outcome)}")
            warnings[obj.name] = outcome.warnings
            findings.keep(obj, task.region, outcome.warnings)
        if not done and not failures:
            self.report({"ERROR"}, "No face is selected; select the faces to place cones on")
            return {"CANCELLED"}
        return reporting.conclude(self, done, warnings, failures)

    def _write(self, obj: bpy.types.Object, task: PlacementTask, placement: lsgp.Placement) -> str:
        """Mark the cones and store their angles; what was done."""
        new = np.setdiff1d(placement.cones, task.marked.cones)
        dropped = task.dropped(placement)
        if len(dropped):
            cones.clear_cones(obj, self.vertex_group, dropped)
            angles.forget_angles(obj, dropped)
        if len(new):
            cones.mark_cones(obj, self.vertex_group, new)
        chosen = dict(zip(task.marked.cones.tolist(), task.marked.fixed(), strict=True)) if task.keep else {}
        found = [
            (vertex, angle)
            for vertex, angle in zip(placement.cones.tolist(), placement.cone_angles.tolist(), strict=True)
            if chosen.get(vertex) is None
        ]
        if found:
            kinds = [angles.Kind.FOUND] * len(found)
            angles.write_angles(obj, [vertex for vertex, _ in found], [angle for _, angle in found], kinds)
        count = reporting.counted(len(placement.cones), "cone")
        return f"{count}, {len(new)} of them new, stretch {placement.predicted_l2:.3f} expected (1 is none)"
