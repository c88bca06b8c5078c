# SPDX-License-Identifier: GPL-3.0-or-later
"""Remesh to Quads."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy

from ...core import findings, identifiers, native
from ...core.choices import Choices, enum_items
from ...core.region import Region
from ...jobs.tasks.quads import QuadSettings, QuadTask, quad_task, remesh_all
from ...jobs.tasks.summaries import quad_summary
from ...mesh.carried_uv import uv_findings
from ...mesh.quad_object import add_quad_object
from ...mesh.region_read import Faces, Groups
from ...mesh.targets import selected_meshes
from ..shared.background import BackgroundOperator, Solved
from ..shared.polling import poll_computation_on_objects
from ..shared.properties import ConeGroupProperty
from ..unwrapping.direction_choices import chosen_direction

if TYPE_CHECKING:
    import lsgp

    from ...jobs.tasks.solving import Progress

AMOUNTS: Choices = {
    "COUNT": (None, "Count", "About this many quads on each object"),
    "SIZE": (None, "Size", "Quads of this size on the surface, before rounding"),
}
ROWS: Choices = {
    "AUTO": (None, "Automatic", "Rows run along what is drawn or marked as Texture Up on the mesh; without that, up"),
    "FREE": (None, "As They Fit", "Rows run where quads are distorted least"),
    "X": (None, "World X", "Rows run along the world's X axis, as far as the irregular vertices permit"),
    "Y": (None, "World Y", "Rows run along the world's Y axis, as far as the irregular vertices permit"),
    "Z": (None, "World Z", "Rows run up, along the world's Z axis, as far as the irregular vertices permit"),
}
COARSE_GRIDS: Choices = {
    "REFINE": ("refine", "Smaller Quads", "Use more quads than requested"),
    "MERGE": ("merge", "Merge Cones", "Merge cones that are less than a quad apart"),
}


class OBJECT_OT_cone_remesh_to_quads(ConeGroupProperty, BackgroundOperator, bpy.types.Operator):
    """Remesh to Quads."""

    bl_idname = identifiers.REMESH_TO_QUADS
    bl_label = "Remesh to Quads"
    bl_description = (
        "Cover each selected object, whose mesh has to be closed, with quads, as a new object beside it. Irregular "
        "vertices are at the marked cones; missing ones are placed"
    )
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    activity = "Remeshing to quads"
    nothing_selected = "No mesh object is selected; select those to remesh"

    amount: bpy.props.EnumProperty(
        name="Quads", description="How the number of quads is chosen", items=enum_items(AMOUNTS)
    )
    count: bpy.props.IntProperty(
        name="Count",
        description="Approximate number of quads on each object; more if so few do not fit between its cones",
        default=2000,
        min=1,
        max=2**24,
        soft_min=100,
        soft_max=100_000,
    )
    size: bpy.props.FloatProperty(
        name="Side",
        description="Side of a quad on the surface, including the object's scale",
        default=0.1,
        min=1e-6,
        soft_min=0.001,
        soft_max=10.0,
        precision=3,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    rows: bpy.props.EnumProperty(
        name="Rows Along", description="Where rows of quads run", items=enum_items(ROWS), default="AUTO"
    )
    even_sizes: bpy.props.BoolProperty(
        name="Even Sizes",
        description="Keep quads alike in size, at the cost of their right angles",
        default=False,
    )
    follow_creases: bpy.props.BoolProperty(
        name="Follow Creases",
        description="Let rows of quads run along the creases of hard surfaces, wherever that costs little distortion. "
        f'Edges with the attribute "{identifiers.FEATURE_ATTRIBUTE}" are followed anyway',
        default=True,
    )
    polish: bpy.props.BoolProperty(
        name="Polish",
        description="Move vertices over the surface, but for irregular ones and those on creases, so that edges are "
        "more equal, with corners about as square as before",
        default=False,
    )
    coarse_grid: bpy.props.EnumProperty(
        name="Too Large",
        description="What to do if the quads are too large for the cones",
        items=enum_items(COARSE_GRIDS),
    )
    density_group: bpy.props.StringProperty(
        name="Density Group",
        description="Vertex group of the density of quads: where its weight is 1 their sides are a quarter as long as "
        "where it is 0, on the way between them accordingly. Without it they are alike in size",
        default=identifiers.QUAD_DENSITY_GROUP,
    )
    hide_original: bpy.props.BoolProperty(
        name="Hide Original", description="Hide the objects that the quads were made from", default=False
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation_on_objects(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.row().prop(self, "amount", expand=True)
        layout.prop(self, "count" if self.amount == "COUNT" else "size")
        for name in ("rows", "follow_creases", "even_sizes", "polish", "coarse_grid", "hide_original"):
            layout.prop(self, name)
        if context.object is None:
            layout.prop(self, "density_group")
        else:
            layout.prop_search(self, "density_group", context.object, "vertex_groups", results_are_suggestions=True)
        self.draw_vertex_group(layout, context)

    def sources(self, context: bpy.types.Context) -> tuple[list[bpy.types.Object], Faces]:
        # Objects with one mesh may differ in size, and each gets quads of its own.
        return selected_meshes(context), Faces.ALL

    def plan(self) -> tuple[Groups, Callable[[bpy.types.Object, Region], QuadTask]]:
        lsgp = native.lsgp
        settings = QuadSettings(
            options=lsgp.Options(
                seamless=lsgp.Seamless(coarse_grid=COARSE_GRIDS[self.coarse_grid][0]),
                mode="low-stretch" if self.even_sizes else "conformal",
                straighten=self.follow_creases,
            ),
            target=self.count if self.amount == "COUNT" else None,
            size=self.size if self.amount == "SIZE" else None,
            direction=chosen_direction(self.rows, tiles=True),
            polish=self.polish,
        )
        return Groups(self.vertex_group, self.density_group), lambda _obj, region: quad_task(region, settings)

    @staticmethod
    def solve(tasks: list[QuadTask], progress: Progress | None = None) -> list[lsgp.QuadRemesh | Exception]:
        return remesh_all(tasks, progress)

    def write(self, solved: Solved) -> list[str]:
        done = []
        for obj, task, remesh in solved:
            made, across = add_quad_object(obj, task.region, remesh.mesh, self.vertex_group)
            findings.keep(made, None, uv_findings(across))
            obj.select_set(False)
            obj.hide_set(self.hide_original)
            done.append(quad_summary(remesh.mesh, len(across)))
        return done
