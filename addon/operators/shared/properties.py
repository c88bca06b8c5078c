# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that several operators have."""

from typing import Any

import bpy

from ...core.choices import Choices, enum_items
from ...core.identifiers import CONE_GROUP, SEAM_COST_GROUP

SEAMS: Choices = {
    "FOLLOW": (
        "follow",
        "Mine and Automatic",
        "Marked seams are cut, and other edges only where islands would be no disks, be stretched too much or overlap "
        "themselves, or where marked cones need it; across seams of parts with marked cones both sides match",
    ),
    "EXACT": (
        "exact",
        "Mine Only",
        "Marked seams are cut and nothing else; where that does not do, the edges that are missing are reported",
    ),
    "IGNORE": ("ignore", "Ignore", "Marked seams do not influence where cuts run"),
    # Of earlier versions, for scripts and presets; not offered.
    "BOUNDARY": ("boundary", "Open", "Marked seams are open boundaries, also of parts with marked cones"),
}
OFFERED_SEAMS = ("FOLLOW", "EXACT", "IGNORE")
# As keymaps hold them, also those made with earlier versions.
_SEAM_NUMBERS = {"FOLLOW": 0, "BOUNDARY": 1, "IGNORE": 2, "EXACT": 3}
CUTS: Choices = {
    "FRONT": (None, "No Cuts in Front", "Out of sight from the scene's front, and along creases and sharp edges"),
    "VIEW": (None, "No Cuts in View", "Out of sight from the 3D view, and along creases and sharp edges"),
    "SHARP": (None, "Creases", "Along creases and sharp edges"),
    "SHORTEST": (None, "Shortest", "The shortest way"),
}
BORDERS: Choices = {
    "FREE": (
        "free",
        "Free",
        "Boundaries take the shape with the least distortion; cones with an angle are corners there",
    ),
    "STRAIGHT": ("straight", "Straight", "Boundaries run straight from cone to cone: a cylinder becomes a strip"),
    "STRIPS": (
        "strips",
        "Strips",
        "A tube of about the same girth all along, without marked cones and seams, becomes a straight strip; other "
        "boundaries are free",
    ),
}
LATTICES: Choices = {
    "SQUARE": (
        "square",
        "Squares (quarter turns)",
        "For textures that look the same after a quarter turn, such as checkers, dots or even grain",
    ),
    "STRIPE": (
        "stripe",
        "Stripes (half turns)",
        "For textures that look the same upside down, such as stripes or a plain weave",
    ),
    "TRIANGLE": (
        "triangle",
        "Triangles",
        "For textures of equilateral triangles that look the same after a third of a turn",
    ),
    "HEXAGON": (
        "hexagon",
        "Hexagons",
        "For textures that look the same after a sixth of a turn, such as honeycombs, tiled by equilateral triangles",
    ),
    "TRANSLATION": (
        "translation",
        "No Rotation",
        "For every tileable texture, but only on surfaces that allow it, such as a torus or a tube",
    ),
}


# Where Blender has the option.
NOT_IN_PRESETS = {"SKIP_PRESET"} if "is_skip_preset" in bpy.types.Property.bl_rna.properties else set()


def max_stretch_property() -> Any:
    """The operator's target of L2 stretch, in percent."""

    def percent(operator: Any) -> float:
        return 100 * (operator.target - 1)

    def set_percent(operator: Any, value: float) -> None:
        operator.target = 1 + value / 100

    return bpy.props.FloatProperty(
        name="Max Stretch",
        description="How much lengths may be off on the average of any connected component, as far as possible; less "
        "takes more cones, and with them cuts",
        min=0.1,
        soft_max=50.0,
        max=1000.0,
        step=100,
        precision=1,
        subtype="PERCENTAGE",
        get=percent,
        set=set_percent,
        options={"SKIP_SAVE", *NOT_IN_PRESETS},
    )


class ConeGroupProperty:
    """Mix-in: the vertex group whose members are the cones."""

    vertex_group: bpy.props.StringProperty(
        name="Cone Group",
        description="Vertex group that holds the cones; a weight above 0.5 marks a vertex as a cone",
        default=CONE_GROUP,
    )

    def draw_vertex_group(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """The field, with a list of the active object's groups if there is an active object."""
        if context.object is None:
            layout.prop(self, "vertex_group")
        else:
            # It need not exist: that is no error.
            layout.prop_search(self, "vertex_group", context.object, "vertex_groups", results_are_suggestions=True)


class SeamsProperty:
    """Mix-in: what marked seams mean."""

    seams: bpy.props.EnumProperty(
        name="Seams",
        description="The effect of edges marked as seams on the cuts",
        items=[(*item, "NONE", _SEAM_NUMBERS[item[0]]) for item in enum_items(SEAMS)],
    )

    def draw_seams(self, layout: bpy.types.UILayout) -> None:
        column = layout.column(heading="Seams", align=True)
        for identifier in OFFERED_SEAMS:
            column.prop_enum(self, "seams", identifier)


class CutsProperty:
    """Mix-in: where cuts run."""

    cuts: bpy.props.EnumProperty(
        name="Cuts",
        description="Where cuts run. They do not change the shapes of faces in the UV map, which only depend on the "
        "cones; automatic cones are placed where such cuts reach them. Weights in the vertex group "
        f'"{SEAM_COST_GROUP}" keep cuts away where they are above 0.5, and attract them where they are below',
        items=enum_items(CUTS),
    )


class BorderProperty:
    """Mix-in: the shape of the mesh's own boundaries."""

    border: bpy.props.EnumProperty(
        name="Boundaries",
        description="The shape of the mesh's own boundaries in the UV map",
        items=enum_items(BORDERS),
    )


class LatticeProperty:
    """Mix-in: the pattern of the texture."""

    lattice: bpy.props.EnumProperty(
        name="Pattern", description="The rotations that leave the texture unchanged", items=enum_items(LATTICES)
    )
