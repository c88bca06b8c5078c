# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that make a layout seamless, and what the library makes of them."""

from typing import TYPE_CHECKING

import bpy

from .. import native
from .common import enum_items

if TYPE_CHECKING:
    import lsgp

# Identifier: (value for the library, label, description).
LATTICES = {
    "SQUARE": (
        "square",
        "Squares (quarter turns)",
        "For textures that look the same turned by a quarter, as checkers, dots or an even grain",
    ),
    "STRIPE": (
        "stripe",
        "Stripes (half turns)",
        "For textures that look the same upside down, as stripes or a plain weave",
    ),
    "TRIANGLE": (
        "triangle",
        "Triangles",
        "For textures of equilateral triangles that look the same turned by a third",
    ),
    "HEXAGON": (
        "hexagon",
        "Hexagons",
        "For textures that look the same turned by a sixth, as honeycombs, tiled by equilateral triangles",
    ),
    "TRANSLATION": (
        "translation",
        "No Turns",
        "For every tileable texture, but only on surfaces that allow it, as a torus or a tube",
    ),
}
TILE_FITS = {
    "AUTO": (None, "Automatic", "The largest tiles that cost at most a tenth in distortion"),
    "TILES": (None, "Count", "So many tiles along the longer side of the layout, before rounding"),
    "SIZE": (None, "Size", "Tiles of this size on the surface, before rounding"),
}
COARSE_GRIDS = {
    "REFINE": ("refine", "Smaller Tiles", "Take the next smaller tiles that fit"),
    "MERGE": ("merge", "Merge Cones", "Merge cones that are less than a tile apart"),
    "RELAX": ("relax", "Leave Cones", "Leave cones off the grid that find no place on it; their cuts show a seam"),
}
TEXTURE_SIZES = [(str(2**level), str(2**level), f"{2**level} texels a side") for level in range(6, 15)]


class SeamlessProperties:
    """Mix-in: a layout in which a tileable texture shows no seam."""

    seamless: bpy.props.BoolProperty(
        name="Seamless",
        description="Round angles and translations to whole tiles, so that a tileable texture shows no seam; "
        "one tile is one UV unit, and the texture has to repeat",
        default=False,
    )
    lattice: bpy.props.EnumProperty(
        name="Pattern", description="Which turns leave the texture as it is", items=enum_items(LATTICES)
    )
    tile_fit: bpy.props.EnumProperty(
        name="Tile Size", description="How large the tiles are on the surface", items=enum_items(TILE_FITS)
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
        description="Side of a tile on the surface, with the object's scale",
        default=0.25,
        min=1e-6,
        soft_min=0.01,
        soft_max=10.0,
        precision=3,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    parity: bpy.props.BoolProperty(
        name="Checker Parity",
        description="The black and white squares of a checker match as well; needs squares with quarter turns",
        default=False,
    )
    coarse_grid: bpy.props.EnumProperty(
        name="Too Large",
        description="What to do where the tiles are too large for the surface",
        items=enum_items(COARSE_GRIDS),
    )
    mip_safe: bpy.props.BoolProperty(
        name="Mip-Safe",
        description="For a texture whose pattern repeats several times in it, every so many texels: translations are "
        "multiples of a power of two of texels, so that mipmaps match too, instead of whole textures",
        default=False,
    )
    texture_size: bpy.props.EnumProperty(
        name="Texture Size", description="Texels of the texture's side", items=TEXTURE_SIZES, default="1024"
    )
    mip_levels: bpy.props.IntProperty(
        name="Mip Levels",
        description="Tiles have a side of 2 to this power in texels, so that this many mipmaps match",
        default=6,
        min=0,
        max=14,
    )

    def draw_seamless(self, layout: bpy.types.UILayout) -> None:
        """The switch, and the other properties while it is on."""
        layout.prop(self, "seamless")
        if not self.seamless:
            return
        column = layout.box().column()
        column.use_property_split = True
        column.prop(self, "lattice")
        column.prop(self, "tile_fit")
        if self.tile_fit == "TILES":
            column.prop(self, "tiles")
        elif self.tile_fit == "SIZE":
            column.prop(self, "tile_size")
        column.prop(self, "coarse_grid")
        row = column.row()
        row.active = self.lattice == "SQUARE"
        row.prop(self, "parity")
        column.prop(self, "mip_safe")
        if self.mip_safe:
            column.prop(self, "texture_size")
            column.prop(self, "mip_levels")

    def seamless_options(self) -> "lsgp.Seamless | None":
        """What the library is to do; None without seamless.  Raises InputError."""
        if not self.seamless:
            return None
        cell = 1.0
        if self.mip_safe:
            # A whole texture is safe on all its mipmaps.
            cell = min(2.0**self.mip_levels / int(self.texture_size), 1.0)
        return native.lsgp.Seamless(
            lattice=LATTICES[self.lattice][0],
            tiles=self.tiles if self.tile_fit == "TILES" else None,
            tile_size=self.tile_size if self.tile_fit == "SIZE" else None,
            parity=self.parity and self.lattice == "SQUARE",
            coarse_grid=COARSE_GRIDS[self.coarse_grid][0],
            cell=cell,
        )
