# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the state of the computing library, its threads, the defaults of Auto Unwrap, and how the
overlay looks."""

import bpy

from ..core import native
from ..core.choices import DEFAULTS, PRESETS, ConeUnwrapPresetDefaults, PresetProperty
from ..core.cut_kinds import KINDS
from ..core.identifiers import EXTENSION
from ..overlay.look import CUT_NAMES, OverlayLook


class ConeUnwrapPreferences(PresetProperty, OverlayLook, bpy.types.AddonPreferences):
    bl_idname = EXTENSION

    threads: bpy.props.IntProperty(
        name="Threads",
        description="Threads that unwrapping and placing cones may take; 0: all cores but one, which is left to "
        "Blender. The UV map is the same for any number",
        default=0,
        min=0,
        max=native.MOST_THREADS,
        soft_max=64,
    )

    paint: bpy.props.PointerProperty(type=ConeUnwrapPresetDefaults)
    tile: bpy.props.PointerProperty(type=ConeUnwrapPresetDefaults)
    bake: bpy.props.PointerProperty(type=ConeUnwrapPresetDefaults)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.label(text=native.library_state(), icon="ERROR" if native.PROBLEM else "CHECKMARK")
        if native.REASON:
            layout.label(text=native.REASON)
        row = layout.row()
        row.alignment = "LEFT"
        row.prop(self, "threads")
        layout.separator()
        layout.label(text="Auto Unwrap, until something else is chosen")
        row = layout.row()
        row.alignment = "LEFT"
        row.prop(self, "preset")
        row = layout.row()
        for preset, (_, label, _) in PRESETS.items():
            column = row.column()
            column.label(text=label)
            # Otherwise the longest names are cut off.
            column.use_property_split, column.use_property_decorate = True, False
            self._draw_defaults(column, preset)
        layout.separator()
        split = layout.row()
        for heading, names in (
            ("Cones", ("tip", "saddle", "flat", "automatic")),
            ("Faces, Arrows and Text", ("flipped", "overlapping", "up", "text")),
            ("Sizes", ("line_width", "cone_size", "text_size")),
        ):
            column = split.column()
            column.label(text=heading)
            for name in names:
                column.prop(self, name)
        layout.label(text="Cuts, by kind")
        row = layout.row()
        for kind in KINDS:
            row.prop(self, f"{kind}_cut")
        layout.label(text="Cuts, in turn")
        row = layout.row(align=True)
        for name in CUT_NAMES:
            row.prop(self, name, text="")

    def _draw_defaults(self, layout: bpy.types.UILayout, preset: str) -> None:
        """Those of a preset, as far as they have an effect."""
        of_preset = getattr(self, preset.lower())
        of_tiles = {"TILES": "tiles", "SIZE": "tile_size", "DENSITY": "texture_size"}
        without = set(of_tiles.values()) - {of_tiles.get(of_preset.tile_fit)} if preset == "TILE" else set()
        for name in DEFAULTS[preset]:
            if name not in without:
                layout.prop(of_preset, name)
