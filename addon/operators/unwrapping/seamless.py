# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that make a layout seamless, as properties and as the library's options."""

from typing import TYPE_CHECKING

import bpy

from ...core import native
from ...core.choices import TEXTURE_SIZES, Choices, enum_items
from ..shared.density import DensityProperty, density_in_world
from ..shared.properties import LATTICES, LatticeProperty
from .sections import section

if TYPE_CHECKING:
    import lsgp

TILE_FITS: Choices = {
    "AUTO": (None, "Automatic", "The largest tiles that add at most a tenth to the distortion"),
    "TILES": (None, "Count", "This many tiles along the longer side of the layout, before rounding"),
    "SIZE": (None, "Size", "Tiles of this size on the surface, before rounding"),
    "DENSITY": (None, "Texel Density", "Tiles that are a whole texture at this texel density, before rounding"),
}
COARSE_GRIDS: Choices = {
    "REFINE": ("refine", "Smaller Tiles", "Take the next smaller tiles that fit"),
    "MERGE": ("merge", "Merge Cones", "Merge cones that are less than a tile apart"),
    "RELAX": ("relax", "Leave Cones", "Leave cones without a place on the grid off it; their cuts show a seam"),
}


class TileSizeProperties(DensityProperty):
    """Mix-in: how large the tiles of a seamless layout are.  Needs a property `texture_size`."""

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

    def draw_tile_size(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """How it is chosen and, where it is given, the number."""
        layout.prop(self, "tile_fit")
        if self.tile_fit == "TILES":
            layout.prop(self, "tiles")
        elif self.tile_fit == "SIZE":
            layout.prop(self, "tile_size")
        elif self.tile_fit == "DENSITY":
            self.draw_density(layout, context)
            layout.prop(self, "texture_size")

    def tile_size_options(self) -> dict[str, float | None]:
        """The fields of the library's options for it."""
        tile_size = self.tile_size if self.tile_fit == "SIZE" else None
        if self.tile_fit == "DENSITY":
            tile_size = int(self.texture_size) / density_in_world(self, bpy.context)
        return {"tiles": self.tiles if self.tile_fit == "TILES" else None, "tile_size": tile_size}


class SeamlessProperties(TileSizeProperties, LatticeProperty):
    """Mix-in: layouts in which a tileable texture shows no seam."""

    seamless: bpy.props.BoolProperty(
        name="Seamless",
        description="Round angles and translations to whole tiles, so that a tileable texture shows no seam; "
        "one tile is one UV unit, and the texture has to repeat",
        default=False,
    )
    parity: bpy.props.BoolProperty(
        name="Checker Parity",
        description="Make the black and white squares of a checker match as well; requires squares with quarter turns",
        default=False,
    )
    coarse_grid: bpy.props.EnumProperty(
        name="Too Large",
        description="What to do if the tiles are too large for the surface",
        items=enum_items(COARSE_GRIDS),
    )
    mip_safe: bpy.props.BoolProperty(
        name="Mip-Safe",
        description="For a texture that contains its pattern several times: translations are multiples of a power of "
        "two in texels, so that mipmaps match too, instead of whole textures",
        default=False,
    )
    texture_size: bpy.props.EnumProperty(
        name="Texture Size", description="Side of the texture in texels", items=TEXTURE_SIZES, default="1024"
    )
    mip_levels: bpy.props.IntProperty(
        name="Mip Levels",
        description="Side of a tile in texels as a power of two, which is how many mipmaps match",
        default=6,
        min=0,
        max=14,
    )

    def draw_seamless(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """The switch and, while it is on, the other properties."""
        layout.prop(self, "seamless")
        body = section(layout, "cone_unwrap_seamless", "Tiles", is_open=True) if self.seamless else None
        if body is None:
            return
        column = body.column()
        column.prop(self, "lattice")
        self.draw_tile_size(column, context)
        column.prop(self, "coarse_grid")
        row = column.row()
        row.active = self.lattice == "SQUARE"
        row.prop(self, "parity")
        column.prop(self, "mip_safe")
        if self.mip_safe:
            if self.tile_fit != "DENSITY":
                column.prop(self, "texture_size")
            column.prop(self, "mip_levels")

    def seamless_options(self) -> "lsgp.Seamless | None":
        """The library's options; None if the layout is not seamless.  Raises InputError."""
        if not self.seamless:
            return None
        cell = 1.0
        if self.mip_safe:
            # A whole texture matches on all of its mipmaps.
            cell = min(2.0**self.mip_levels / int(self.texture_size), 1.0)
        return native.lsgp.Seamless(
            lattice=LATTICES[self.lattice][0],
            **TileSizeProperties.tile_size_options(self),
            parity=self.parity and self.lattice == "SQUARE",
            coarse_grid=COARSE_GRIDS[self.coarse_grid][0],
            cell=cell,
        )
