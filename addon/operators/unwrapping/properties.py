# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of Unwrap from Cones that belong to no other operator, and what is computed from all of them."""

import bpy

from ...core import native
from ...core.choices import Choices, DirectionProperty, StrokesProperty, enum_items
from ...core.preferences import chosen_threads
from ...jobs.layouts.maps import PackSettings
from ...jobs.tasks.unwrapping import UnwrapSettings
from ..shared.cut_choices import chosen_cuts
from ..shared.packing import EFFORTS
from ..shared.properties import BORDERS, SEAMS
from .direction_choices import chosen_direction
from .features import PLACES, FeatureProperties
from .low_stretch import MODES
from .seamless import SeamlessProperties

# "Automatic" leaves the rule to the library.
PRESCRIPTIONS: Choices = {
    "AUTOMATIC": (None, "Automatic", "Keep the angles given to cones; choose the others for the least distortion"),
    "LEAST_DISTORTION": ("least-distortion", "Least Distortion", "Choose all angles for the least distortion"),
    "HARMONIC": ("harmonic", "Harmonic", "Choose all angles by the amount of curvature around each cone"),
    "STRAIGHTNESS": ("straightness", "Straight Seams", "Choose all angles so that seams become straight lines"),
}
UNFOLDINGS: Choices = {
    "POISSON": ("poisson", "Direct", "One linear solve; robust on every surface"),
    "SPECTRAL": ("spectral", "Spectral", "The least conformal energy by an eigenvalue solve; slower"),
}
OVERLAPS: Choices = {
    "KEEP": ("keep", "Keep", "Leave islands that overlap themselves as they are, and report where they do"),
    "SPLIT": (
        "split",
        "Split",
        "Cut islands further until none overlaps itself; both sides of every cut still match",
    ),
}


class UnwrapProperties(DirectionProperty, StrokesProperty):
    """Mix-in: how to unwrap and where to put the islands."""

    prescription: bpy.props.EnumProperty(
        name="Cone Angles", description="How the angle of each cone is chosen", items=enum_items(PRESCRIPTIONS)
    )
    unfold: bpy.props.EnumProperty(
        name="Unfold", description="How the surface is flattened", items=enum_items(UNFOLDINGS)
    )
    repair: bpy.props.BoolProperty(
        name="Repair Flips",
        description="Turn flipped faces over, and correct angles that are off by a full turn",
        default=True,
    )
    overlaps: bpy.props.EnumProperty(
        name="Overlaps",
        description="What to do with islands that overlap themselves",
        items=enum_items(OVERLAPS),
        default="SPLIT",
    )
    use_subsurf_data: bpy.props.BoolProperty(
        name="Subdivision Surface",
        description="Map UVs taking vertex position after Subdivision Surface modifier has been applied",
        default=False,
    )
    use_pins: bpy.props.BoolProperty(
        name="Use Pins",
        description="Pinned UVs of the active layer stay where they are; two or more determine the place, size and "
        "rotation of their island",
        default=True,
    )
    keep_placement: bpy.props.BoolProperty(
        name="Keep Placement",
        description="Move, rotate and scale each island to where its faces were, instead of into the UV square; "
        "in a seamless layout islands are only moved by whole tiles",
        default=False,
    )
    correct_aspect: bpy.props.BoolProperty(
        name="Correct Aspect",
        description="Map UVs taking aspect ratio of the image associated with the material into account; "
        "not in a seamless layout, whose tiles would no longer match",
        default=True,
    )
    pack: bpy.props.BoolProperty(
        name="Pack Islands",
        description="Pack the islands of all objects together; islands with pins stay. "
        "In a seamless layout islands are only moved side by side by whole tiles",
        default=True,
    )
    margin: bpy.props.FloatProperty(
        name="Margin",
        description="Around each island and along the edges of the UV square, of its side; narrower where that leaves "
        "no room",
        default=0.001,
        min=0.0,
        soft_max=0.1,
        max=0.5,
        precision=3,
    )

    def draw_placement(self, layout: bpy.types.UILayout) -> None:
        """The properties that place islands, as far as they have an effect."""
        layout.prop(self, "direction")
        layout.prop(self, "follow_strokes")
        layout.prop(self, "use_pins")
        if not self.seamless:
            layout.prop(self, "correct_aspect")
        layout.prop(self, "keep_placement")
        if self.keep_placement:
            return
        layout.prop(self, "pack")
        if self.pack and not self.seamless:
            layout.prop(self, "margin")
            layout.prop(self, "effort")
            layout.prop(self, "in_place")


def unwrap_settings(chosen: bpy.types.OperatorProperties) -> UnwrapSettings:
    """What these properties of the operator, present or last used, ask for.  Raises InputError."""
    options = native.lsgp.Options(
        prescription=PRESCRIPTIONS[chosen.prescription][0],
        unfold=UNFOLDINGS[chosen.unfold][0],
        seams=SEAMS[chosen.seams][0],
        border=BORDERS[chosen.border][0],
        seamless=SeamlessProperties.seamless_options(chosen, feature_places=PLACES[chosen.straight_places][0]),
        mode=MODES[chosen.mode][0],
        stretch=chosen.stretch,
        repair=chosen.repair,
        overlaps=OVERLAPS[chosen.overlaps][0],
        follow_strokes=chosen.follow_strokes,
        threads=chosen_threads(),
    )
    return UnwrapSettings(
        options=options,
        cone_group=chosen.vertex_group,
        weight_group=chosen.weight_group if chosen.use_weights else None,
        weight_factor=chosen.weight_factor,
        use_pins=chosen.use_pins,
        keep_placement=chosen.keep_placement,
        correct_aspect=chosen.correct_aspect and not chosen.seamless,
        cuts=chosen_cuts(chosen.cuts),
        direction=chosen_direction(chosen.direction, tiles=chosen.seamless),
        features=FeatureProperties.feature_kinds(chosen),
        subdivided=chosen.use_subsurf_data,
    )


def pack_settings(chosen: bpy.types.OperatorProperties) -> PackSettings:
    """How these properties ask islands to be placed."""
    pack = chosen.pack and not chosen.keep_placement
    return PackSettings(pack, chosen.seamless, chosen.margin, effort=EFFORTS[chosen.effort][0])
