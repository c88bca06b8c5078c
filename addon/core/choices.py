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
        "As drawn or marked on the mesh, otherwise world Z where the UV map is for tiles, otherwise as it fits",
    ),
    "FIT": (None, "As It Fits", "Islands are rotated so that they take little room"),
    "X": (None, "World X", "The texture's upward direction is the world's X axis, as far as the surface permits"),
    "Y": (None, "World Y", "The texture's upward direction is the world's Y axis, as far as the surface permits"),
    "Z": (None, "World Z", "The texture's upward direction is the world's Z axis: bricks lie level"),
    "EDGE": (None, "Active Edge", "The texture's upward direction is that of the active edge, on the island beside it"),
}

TILE_FITS: Choices = {
    "AUTO": (None, "Automatic", "The largest tiles that add at most a tenth to the distortion"),
    "TILES": (None, "Count", "This many tiles along the longer side of the layout, before rounding"),
    "SIZE": (None, "Size", "Tiles of this size on the surface, before rounding"),
    "DENSITY": (None, "Texel Density", "Tiles that are a whole texture at this texel density, before rounding"),
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


class StrokesProperty:
    """Mix-in: whether automatic angles are chosen for what is drawn."""

    follow_strokes: bpy.props.BoolProperty(
        name="Follow Strokes",
        description="Choose automatic cone angles so that the texture follows what is drawn for Texture Up, at up to a "
        "tenth of stretch",
        default=True,
    )


class TileProperties:
    """Mix-in: how large the tiles of a seamless layout are."""

    tile_fit: bpy.props.EnumProperty(
        name="Tile Size", description="How the size of the tiles on the surface is chosen", items=enum_items(TILE_FITS)
    )
    tiles: bpy.props.FloatProperty(
        name="Tile Count",
        description="Tiles along the longer side of the layout, before rounding",
        default=16.0,
        min=1.0,
        soft_max=256.0,
        precision=1,
    )
    tile_size: bpy.props.FloatProperty(
        name="Side",
        description="Side of a tile on the surface, including the object's scale",
        default=0.25,
        min=1e-6,
        soft_min=0.01,
        soft_max=10.0,
        precision=3,
        subtype="DISTANCE",
        unit="LENGTH",
    )


class TextureProperties:
    """Mix-in: the texture that islands are for."""

    texture_size: bpy.props.EnumProperty(
        name="Texture Size", description="Side of the texture in texels", items=TEXTURE_SIZES, default="1024"
    )
    margin: bpy.props.IntProperty(
        name="Margin",
        description="Texels to keep free around each island in a texture of this size",
        default=4,
        min=0,
        soft_max=64,
        subtype="PIXEL",
    )


class PresetProperty:
    """Mix-in: the preset of Auto Unwrap."""

    preset: bpy.props.EnumProperty(name="Preset", description="What the UV map is for", items=enum_items(PRESETS))


OF_TEXTURE = ("texture_size", "margin", "direction")
DEFAULTS: dict[str, tuple[str, ...]] = {
    "PAINT": OF_TEXTURE,
    "TILE": ("tile_fit", "tiles", "tile_size", "texture_size", "direction"),
    "BAKE": OF_TEXTURE,
}
"""The properties of Auto Unwrap whose defaults are preferences, by preset."""


class ConeUnwrapPresetDefaults(TileProperties, TextureProperties, DirectionProperty, bpy.types.PropertyGroup):
    """Those of one preset."""
