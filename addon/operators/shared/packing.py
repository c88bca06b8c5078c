# SPDX-License-Identifier: GPL-3.0-or-later
"""How operators pack: how long they try, and where the islands of a selection go."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ...core.choices import Choices, enum_items
from ...mesh.region_read import Faces, read_surroundings

if TYPE_CHECKING:
    from ...jobs.layouts.maps import PackSettings

EFFORTS: Choices = {
    "QUICK": ("quick", "Quick", "The first layout, at once"),
    "GOOD": ("good", "Good", "The best of some hundred layouts, in a fraction of a second"),
    "BEST": ("best", "Best", "The best of many thousand layouts, in ten seconds or more"),
}


class PackingProperties:
    """Mix-in: how long islands are packed, and whether a selection keeps to its place."""

    effort: bpy.props.EnumProperty(
        name="Packing",
        description="How long fuller layouts are looked for",
        items=enum_items(EFFORTS),
        default="GOOD",
    )
    in_place: bpy.props.BoolProperty(
        name="Selection in Its Place",
        description="Where only some faces are selected, put their islands where these were, at the density that they "
        "had, and not over other islands; or elsewhere in the tile where that place has no room. Faces without a UV "
        "map so far go where there is room, at the density of the others. Otherwise the selection fills the UV square",
        default=True,
    )


def with_surroundings(
    settings: PackSettings, objects: list[bpy.types.Object], faces: Faces, *, in_place: bool
) -> PackSettings:
    """The settings for these faces of the objects: a selection is packed in its place, if it is to be."""
    if not in_place or not settings.pack or settings.by_cells:
        return settings
    return replace(settings, surroundings=read_surroundings(objects, faces))
