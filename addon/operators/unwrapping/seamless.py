# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that make a layout seamless, as properties and as the library's options."""

from typing import TYPE_CHECKING

import bpy

from ...core import native
from ...core.choices import TEXTURE_SIZES, Choices, TileProperties, enum_items
from ..shared.density import DensityProperty, density_in_world
from ..shared.properties import LATTICES, LatticeProperty
from .sections import section

if TYPE_CHECKING:
    import lsgp

COARSE_GRIDS: Choices = {
    "REFINE": ("refine", "Smaller Tiles", "Take the next smaller tiles that fit"),
    "MERGE": ("merge", "Merge Cones", "Merge cones that are less than a tile apart"),
    "RELAX": ("relax", "Leave Cones", "Leave cones without a place on the grid off it; their cuts show a seam"),
}


class TileSizeProperties(DensityProperty, TileProperties):
    """Mix-in: how large the tiles of a seamless layout are.  Needs a property `texture_size`."""

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

    def seamless_options(self, *, feature_places: str) -> "lsgp.Seamless | None":
        """The library's options; None if the layout is not seamless.  feature_places: as there.  Raises InputError."""
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
            feature_places=feature_places,
        )
