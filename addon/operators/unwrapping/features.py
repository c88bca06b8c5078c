# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties for edges that run straight along u or v."""

import math
from typing import TYPE_CHECKING

import bpy

from ...core import native
from ...core.choices import Choices, enum_items
from ...core.identifiers import FEATURE_ATTRIBUTE
from .sections import section

if TYPE_CHECKING:
    from lsgp.run.feature_options import FeatureKinds

ALONG = f'run straight along u or v, as edges with the attribute "{FEATURE_ATTRIBUTE}" do: '

_COST = "Tiles may be smaller for it, and stretch a fifth higher instead of a tenth"
PLACES: Choices = {
    "ANYWHERE": ("anywhere", "Anywhere", "Straight edges lie where they cost least, at multiples of 1/256 of a tile"),
    "HALF": ("half", "Half Tiles", f"Straight edges lie at half tiles, as bricks of every other course end. {_COST}"),
    "WHOLE": (
        "whole",
        "Whole Tiles",
        f"Straight edges begin and end tiles, as bricks do at the edge of a wall. {_COST}",
    ),
}


class FeatureProperties:
    """Mix-in: which edges are features. They have an effect in seamless layouts and with low stretch."""

    straight_sharp: bpy.props.BoolProperty(
        name="Sharp Edges",
        description=f"Let edges marked sharp {ALONG}as far as "
        "they do not contradict each other and cost at most a tenth of stretch",
        default=False,
    )
    straight_seams: bpy.props.BoolProperty(
        name="Seams", description=f"Let edges marked as seams {ALONG}the same way", default=False
    )
    straight_borders: bpy.props.BoolProperty(
        name="Boundaries", description=f"Let the mesh's own boundaries {ALONG}the same way", default=False
    )
    straight_creases: bpy.props.BoolProperty(
        name="Creases", description=f"Let edges at which the surface bends {ALONG}the same way", default=False
    )
    straight_angle: bpy.props.FloatProperty(
        name="Crease Angle",
        description="The least angle between the normals of the faces at such an edge",
        default=math.radians(40),
        min=math.radians(0.1),
        max=math.pi,
        subtype="ANGLE",
    )

    straight_places: bpy.props.EnumProperty(
        name="Places",
        description="Where straight edges and creases along the tiles lie in seamless layouts",
        items=enum_items(PLACES),
        default="ANYWHERE",
    )

    def draw_features(self, layout: bpy.types.UILayout, identifier: str, *, in_tiles: bool) -> None:
        """in_tiles: whether the layout is seamless."""
        body = section(layout, identifier, "Straight Edges")
        if body is None:
            return
        for name in ("straight_sharp", "straight_seams", "straight_borders", "straight_creases"):
            body.prop(self, name)
        if self.straight_creases:
            body.prop(self, "straight_angle")
        if in_tiles:
            body.prop(self, "straight_places")

    def feature_kinds(self) -> "FeatureKinds | None":
        """None where none is chosen."""
        angle = self.straight_angle if self.straight_creases else None
        kinds = native.part("run.feature_options").FeatureKinds(
            angle, self.straight_sharp, self.straight_seams, self.straight_borders
        )
        return None if kinds == type(kinds)() else kinds
