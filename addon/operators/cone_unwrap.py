# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones."""

from collections.abc import Iterable
from functools import partial

import bpy
import numpy as np

from .. import (
    cells,
    findings,
    gathering,
    identifiers,
    mesh_read,
    mesh_write,
    native,
    packing,
    reporting,
    reports,
    targets,
    unwrapping,
)
from .background import BackgroundComputation
from .common import (
    BORDERS,
    SEAMS,
    BorderProperty,
    ConeGroupProperty,
    SeamsProperty,
    enum_items,
    poll_computation,
    require_region,
)
from .low_stretch import MODES, LowStretchProperties
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
OVERLAPS = {
    "KEEP": ("keep", "Keep", "Leave islands that lie on themselves as they are; where they do is reported"),
    "SPLIT": (
        "split",
        "Split",
        "Cut islands further until none lies on itself; both sides of every cut still match. "
        "Those of each object are packed then, unless they keep their placement or are seamless",
    ),
}
MARGIN_METHODS = (
    ("SCALED", "Scaled", "Use scale of existing UVs to multiply margin"),
    ("ADD", "Add", "Just add the margin, ignoring any UV scale"),
    ("FRACTION", "Fraction", "Specify a precise fraction of final UV output"),
)


class UV_OT_cone_unwrap(
    ConeGroupProperty,
    SeamsProperty,
    BorderProperty,
    LowStretchProperties,
    SeamlessProperties,
    BackgroundComputation,
    bpy.types.Operator,
):
    """Unwrap from Cones."""

    bl_idname = identifiers.UNWRAP
    bl_label = "Unwrap from Cones"
    bl_description = (
        "Cut the mesh through its cones and unwrap it so that both sides of every cut have the same length. "
        "Works on the selected faces in edit mode (in a UV editor with its own selection, on those with all UVs "
        "selected), on all faces of the selected objects in object mode; each object fills the UV square by itself"
    )
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    activity = "Unwrapping from cones"

    prescription: bpy.props.EnumProperty(
        name="Cone Angles", description="How the angle left at each cone is chosen", items=enum_items(PRESCRIPTIONS)
    )
    unfold: bpy.props.EnumProperty(
        name="Unfold", description="How the surface is flattened", items=enum_items(UNFOLDINGS)
    )
    repair: bpy.props.BoolProperty(
        name="Repair Flips",
        description="Turn flipped faces over, and put angles right that are off by a whole turn",
        default=True,
    )
    overlaps: bpy.props.EnumProperty(
        name="Overlaps", description="What becomes of islands that lie on themselves", items=enum_items(OVERLAPS)
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
        self.draw_mode(layout, context)
        layout.separator()
        self.draw_vertex_group(layout, context)
        for name in ("prescription", "unfold", "seams", "border"):
            layout.prop(self, name)
        layout.separator()
        layout.prop(self, "overlaps")
        layout.prop(self, "repair")
        self.draw_seamless(layout)
        layout.separator()
        layout.prop(self, "use_pins")
        if not self.seamless:
            layout.prop(self, "correct_aspect")
        if not self.pack:
            layout.prop(self, "keep_placement")
        if self.pack or not self._uses_packer():
            layout.prop(self, "pack")
        if self._uses_packer():
            layout.prop(self, "margin_method")
            layout.prop(self, "margin")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        # Without a window there are no events.
        if bpy.app.background or context.window is None:
            return self.execute(context)
        gathered, self._failures = self._gather(context)
        self._targets = [targets.target(obj) for obj, _ in gathered]
        self._tasks = [task for _, task in gathered]
        return self.start(context, partial(unwrapping.unwrap_all, self._tasks))

    def conclude_computation(
        self, _context: bpy.types.Context, outcomes: list[unwrapping.Unwrapped | Exception]
    ) -> set[str]:
        found = []
        failures = self._failures
        for target, task, outcome in zip(self._targets, self._tasks, outcomes, strict=True):
            try:
                found.append((target.find(), task, outcome))
            except reporting.Refused as error:
                failures[target.name] = error
        return self._conclude_unwrap(found, failures)

    def execute(self, context: bpy.types.Context) -> set[str]:
        gathered, failures = self._gather(context)
        outcomes = unwrapping.unwrap_all([task for _, task in gathered])
        found = [(obj, task, outcome) for (obj, task), outcome in zip(gathered, outcomes, strict=True)]
        return self._conclude_unwrap(found, failures)

    def _gather(
        self, context: bpy.types.Context
    ) -> tuple[list[tuple[bpy.types.Object, unwrapping.Task]], dict[str, Exception]]:
        """What is to be solved, and by object name what went wrong with the others."""
        settings = chosen_settings(self)
        by_uv = mesh_read.selects_by_uv(context)
        gathered = []
        failures = {}
        for obj in mesh_read.target_objects(context):
            try:
                region = require_region(obj, by_uv)
                if region is not None:
                    gathered.append((obj, gathering.gather(obj, region, settings)))
            except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
                failures[obj.name] = error
                findings.keep(obj, None, [error])
        return gathered, failures

    def _conclude_unwrap(
        self,
        outcomes: Iterable[tuple[bpy.types.Object, unwrapping.Task, unwrapping.Unwrapped | Exception]],
        failures: dict[str, Exception],
    ) -> set[str]:
        """Pack, write and report.  failures: by object name, of objects that are not among the outcomes."""
        solved = []
        for obj, task, outcome in outcomes:
            if isinstance(outcome, Exception):
                failures[obj.name] = outcome
                findings.keep(obj, task.region, [outcome])
            else:
                solved.append((obj, outcome))
                findings.keep(obj, task.region, outcome.result.warnings)
        if not solved and not failures:
            self.report({"ERROR"}, "No face is selected; select the faces to unwrap")
            return {"CANCELLED"}
        try:
            layouts = self._packed([unwrapped for _, unwrapped in solved]) if solved else []
        except (reporting.Refused, MemoryError) as error:
            failures |= {obj.name: error for obj, _ in solved}
            solved = layouts = []
        # Only now, with all computation behind, is anything written.
        for (obj, unwrapped), corner_uv in zip(solved, layouts, strict=True):
            report = reports.joined(reports.find(obj.data), reports.report_on(unwrapped), unwrapped)
            mesh_write.write_uv(obj, unwrapped.region, unwrapped.result.solved, corner_uv)
            reports.store(obj.data, report)
        done = [_summary(obj, unwrapped) for obj, unwrapped in solved]
        warnings = {obj.name: unwrapped.result.warnings for obj, unwrapped in solved}
        return reporting.conclude(self, done, warnings, failures)

    def _uses_packer(self) -> bool:
        """Whether Blender's packer is used: on all islands together as asked, or on those of each object once split."""
        return not self.seamless and (self.pack or (self.overlaps == "SPLIT" and not self.keep_placement))

    def _packed(self, solved: list[unwrapping.Unwrapped]) -> list[np.ndarray]:
        """The coordinates of each object as they are to be written, (m, 3, 2) arrays.  Raises Refused."""
        if self.seamless and self.pack:
            return cells.pack(solved)
        if not self._uses_packer():
            return [unwrapped.corner_uv for unwrapped in solved]
        layouts = []
        for together in [solved] if self.pack else [[unwrapped] for unwrapped in solved]:
            packed = packing.pack([unwrapped.islands() for unwrapped in together], self.margin_method, self.margin)
            for unwrapped, uv in zip(together, packed, strict=True):
                layouts.append(unwrapped.corner_uv.copy())
                layouts[-1][unwrapped.result.solved] = uv
        return layouts


def chosen_settings(chosen: bpy.types.OperatorProperties) -> gathering.Settings:
    """What the operator is to do, or was the last time.  Raises InputError."""
    options = native.lsgp.Options(
        prescription=PRESCRIPTIONS[chosen.prescription][0],
        unfold=UNFOLDINGS[chosen.unfold][0],
        seams=SEAMS[chosen.seams][0],
        border=BORDERS[chosen.border][0],
        seamless=SeamlessProperties.seamless_options(chosen),
        mode=MODES[chosen.mode][0],
        stretch=chosen.stretch,
        repair=chosen.repair,
        overlaps=OVERLAPS[chosen.overlaps][0],
    )
    return gathering.Settings(
        options=options,
        group=chosen.vertex_group,
        weight_group=chosen.weight_group if chosen.use_weights else None,
        weight_factor=chosen.weight_factor,
        use_pins=chosen.use_pins,
        keep_placement=chosen.keep_placement and not chosen.pack,
        correct_aspect=chosen.correct_aspect and not chosen.seamless,
    )


def _summary(obj: bpy.types.Object, unwrapped: unwrapping.Unwrapped) -> str:
    result = unwrapped.result
    parts = [
        f"{reporting.counted(int(result.island.max()) + 1, 'island')} through "
        f"{reporting.counted(len(result.cones), 'cone')}",
        f"stretch {result.distortion.l2_stretch:.3f} (1 is none)",
    ]
    if result.overlap_area > 0:
        parts.append(f"{100 * result.overlap_area:.2g} % overlapping")
    if result.seamless is not None:
        parts.append(cells.certified(unwrapped))
    return f"{obj.name}: {', '.join(parts)}"
