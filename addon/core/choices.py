# SPDX-License-Identifier: GPL-3.0-or-later
"""Choices that operators offer, and those of Auto Unwrap whose defaults are preferences."""

import bpy

Choices = dict[str, tuple[str | None, str, str]]
"""Value for the library, label and description by identifier."""

PRESETS: Choices = {
    "PAINT": ("paint", "Paint", "For texture painting: even sizes, few islands, nothing overlaps"),
    "TILE": ("tile", "Tile", "For tileable textures: squares match across every cut, so that no seam shows"),
    "BAKE": (
        "bake",
        "Bake",
        "For baking: even sizes, nothing overlaps, islands fill the square, and the margin is exact",
    ),
}

TEXTURE_SIZES = [(str(2**level), str(2**level), f"{2**level} texels per side") for level in range(6, 15)]
DIRECTIONS: Choices = {
    "AUTO": (
        None,
        "Automatic",
        "As drawn on the mesh, otherwise world Z where the UV map is for tiles, otherwise as it fits",
    ),
    "FIT": (None, "As It Fits", "Islands are rotated so that they take little room"),
    "X": (None, "World X", "The texture's upward direction is the world's X axis, as far as the surface permits"),
    "Y": (None, "World Y", "The texture's upward direction is the world's Y axis, as far as the surface permits"),
    "Z": (None, "World Z", "The texture's upward direction is the world's Z axis: bricks lie level"),
    "EDGE": (None, "Active Edge", "The texture's upward direction is that of the active edge, on the island beside it"),
}


def enum_items(choices: Choices) -> list[tuple[str, str, str]]:
    """The choices as items of an enum property."""
    return [(identifier, label, description) for identifier, (_, label, description) in choices.items()]


class DirectionProperty:
    """Mix-in: where the texture runs."""

    direction: bpy.props.EnumProperty(
        name="Texture Up",
        description="What the texture's upward direction follows; islands are rotated for it, not deformed",
        items=enum_items(DIRECTIONS),
    )


class FirstPressProperties(DirectionProperty):
    """Mix-in: the properties of Auto Unwrap whose defaults are preferences."""

    NAMES = ("preset", "texture_size", "margin", "direction")

    preset: bpy.props.EnumProperty(name="Preset", description="What the UV map is for", items=enum_items(PRESETS))
    texture_size: bpy.props.EnumProperty(
        name="Texture Size", description="Side of the texture in texels", items=TEXTURE_SIZES, default="1024"
    )
    margin: bpy.props.IntProperty(
        name="Margin",
        description="Texels to keep free around each island in a texture of this size; approximate for Paint if "
        "Blender's packer is used",
        default=4,
        min=0,
        soft_max=64,
        subtype="PIXEL",
    )
