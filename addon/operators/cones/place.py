# SPDX-License-Identifier: GPL-3.0-or-later
"""Place Cones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy

from ...core import identifiers
from ...core.choices import enum_items
from ...core.preferences import chosen_threads
from ...core.region import Region
from ...jobs.tasks.placing import PlacementSettings, PlacementTask, place_all, write_placement
from ...jobs.tasks.summaries import placement_summary
from ...jobs.tasks.unwrapping import USUAL_TARGET
from ...mesh.angles import require_attributes
from ...mesh.region_read import Groups
from ..shared.background import BackgroundOperator, Solved
from ..shared.cut_choices import chosen_cuts
from ..shared.properties import (
    LATTICES,
    SEAMS,
    ConeGroupProperty,
    CutsProperty,
    LatticeProperty,
    SeamsProperty,
    max_stretch_property,
)

if TYPE_CHECKING:
    import lsgp

    from ...jobs.tasks.solving import Progress

MIRRORS = {
    "FOUND": (None, "Found", "The plane in which each connected component is its own mirror image, if there is one"),
    "X": ((1.0, 0.0, 0.0), "X", "The object's plane across X, as in a Mirror modifier"),
    "Y": ((0.0, 1.0, 0.0), "Y", "The object's plane across Y, as in a Mirror modifier"),
    "Z": ((0.0, 0.0, 1.0), "Z", "The object's plane across Z, as in a Mirror modifier"),
}
"""Normal of the plane, label and description by identifier."""
ORIGIN = (0.0, 0.0, 0.0)


class MESH_OT_cone_place(
    ConeGroupProperty, SeamsProperty, CutsProperty, LatticeProperty, BackgroundOperator, bpy.types.Operator
):
    """Place Cones."""

    bl_idname = identifiers.PLACE
    bl_label = "Place Cones"
    bl_description = (
        "Mark cones where they lower the stretch most, with matching angles; "
        "on the selected faces in edit mode, on all faces of the selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO"}
    activity = "Placing cones"
    nothing_selected = "No face is selected; select the faces to place cones on"

    automatic: bpy.props.BoolProperty(
        name="Automatic", description="Place as few cones as it takes to keep the stretch low", default=True
    )
    target: bpy.props.FloatProperty(
        name="Stretch",
        description="The stretch (L2, 1 is none) not to exceed on any connected component, as far as possible",
        default=USUAL_TARGET,
        min=1.001,
        soft_max=1.5,
        step=1,
        precision=3,
    )
    max_stretch: max_stretch_property()
    count: bpy.props.IntProperty(
        name="Count",
        description="Cones on each connected component, including those already marked",
        default=8,
        min=0,
        soft_max=64,
    )
    seamless: bpy.props.BoolProperty(
        name="Seamless",
        description="Choose places and angles for a seamless layout, whose angles are multiples of the rotation of "
        "its pattern",
        default=False,
    )
    symmetric: bpy.props.BoolProperty(
        name="Symmetric", description="Place the same cones on both sides of a mirror plane", default=False
    )
    mirror: bpy.props.EnumProperty(name="Plane", description="The mirror plane", items=enum_items(MIRRORS))
    prefer_sharp: bpy.props.BoolProperty(
        name="Prefer Sharp",
        description="Prefer sharp corners to smooth places where that costs little",
        default=False,
    )
    keep: bpy.props.BoolProperty(
        name="Keep Marked",
        description="Keep marked cones, with their prescribed and snapped angles, and add to them; "
        "otherwise they are cleared first",
        default=True,
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "automatic")
        layout.prop(self, "max_stretch" if self.automatic else "count")
        layout.prop(self, "keep")
        layout.prop(self, "prefer_sharp")
        layout.prop(self, "symmetric")
        if self.symmetric:
            layout.prop(self, "mirror")
        layout.prop(self, "seamless")
        if self.seamless:
            layout.prop(self, "lattice")
        layout.separator()
        layout.prop(self, "cuts")
        self.draw_seams(layout)
        self.draw_vertex_group(layout, context)

    def plan(self) -> tuple[Groups, Callable[[bpy.types.Object, Region], PlacementTask]]:
        normal = MIRRORS[self.mirror][0]
        settings = PlacementSettings(
            count=None if self.automatic else self.count,
            target=self.target,
            lattice=LATTICES[self.lattice][0] if self.seamless else None,
            prefer_sharp=self.prefer_sharp,
            symmetric=self.symmetric,
            mirror=None if normal is None or not self.symmetric else (ORIGIN, normal),
            seams=SEAMS[self.seams][0],
            threads=chosen_threads(),
        )
        cuts = chosen_cuts(self.cuts)

        def make_task(obj: bpy.types.Object, region: Region) -> PlacementTask:
            require_attributes(obj.data)
            return PlacementTask(region, region.own_cones, self.keep, settings, cuts)

        return Groups(cones=self.vertex_group), make_task

    @staticmethod
    def solve(tasks: list[PlacementTask], progress: Progress | None = None) -> list[lsgp.Placement | Exception]:
        return place_all(tasks, progress)

    def write(self, solved: Solved) -> list[str]:
        return [
            placement_summary(placement, write_placement(obj, self.vertex_group, task, placement))
            for obj, task, placement in solved
        ]
