# SPDX-License-Identifier: GPL-3.0-or-later
"""How the overlay looks: properties of the add-on's preferences."""

import bpy

from ..core import cut_kinds, redraw
from ..core.preferences import preferences
from . import cache

CUT_COLORS = ("#d6336c", "#2b9348", "#7b4fc9", "#e3b505", "#12a0a0", "#c23fb5", "#87991a", "#3c9be0", "#c2703d")
# Size of the active cone relative to the others.
ACTIVE_SIZE = 1.5
CUT_NAMES = [f"cut_{number}" for number in range(1, len(CUT_COLORS) + 1)]


def _redraw(_preferences: bpy.types.AddonPreferences, _context: bpy.types.Context) -> None:
    # Cached drawings contain colors.
    cache.clear()
    redraw.views()


def _color(name: str, description: str, default: tuple[float, ...]) -> bpy.props.FloatVectorProperty:
    return bpy.props.FloatVectorProperty(
        name=name,
        description=description,
        default=default,
        size=4,
        min=0.0,
        max=1.0,
        subtype="COLOR_GAMMA",
        update=_redraw,
    )


def _from_hex(color: str) -> tuple[float, ...]:
    return (*(int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)), 1.0)


# A property for each color. Since Python 3.14 the body of a class cannot add to its annotations.
_CutColors = type(
    "_CutColors",
    (),
    {
        "__annotations__": {
            name: _color(f"Cut {number}", "Both sides of a cut; cuts take these colors in turn", _from_hex(value))
            for number, (name, value) in enumerate(zip(CUT_NAMES, CUT_COLORS, strict=True), 1)
        }
    },
)


class OverlayLook(_CutColors):
    """Mix-in for preferences."""

    tip: _color("Tips", "Cones of less than a full turn, as on tips and corners", (1.0, 0.50, 0.10, 1.0))
    saddle: _color("Saddles", "Cones of more than a full turn, as between fingers", (0.20, 0.55, 1.0, 1.0))
    flat: _color("Flat", "Cones of exactly a full turn, which are flat; others fade to this", (0.75, 0.75, 0.75, 1.0))
    automatic: _color("Automatic", "Cones whose angle is chosen on unwrapping", (1.0, 1.0, 1.0, 1.0))
    seam_cut: _color("Seams", cut_kinds.KINDS["seam"][1], (0.90, 0.20, 0.20, 1.0))
    required_cut: _color("Required", cut_kinds.KINDS["required"][1], (0.20, 0.55, 1.0, 1.0))
    added_cut: _color("Added", cut_kinds.KINDS["added"][1], (1.0, 0.75, 0.10, 1.0))
    moved_cut: _color("By Hand", cut_kinds.KINDS["moved"][1], (0.25, 0.80, 0.35, 1.0))
    flipped: _color("Flipped", "Faces that are upside down in the UV map", (1.0, 0.05, 0.05, 0.6))
    overlapping: _color("Overlapping", "Faces that overlap others in the UV map", (0.85, 0.10, 0.95, 0.35))
    up: _color("Texture Up", "Arrows along the drawn upward direction of the texture", (0.10, 0.85, 0.45, 1.0))
    text: _color("Text", "Angles next to cones", (1.0, 1.0, 1.0, 1.0))
    line_width: bpy.props.FloatProperty(
        name="Line Width", description="Width of cuts", default=3.0, min=1.0, max=10.0, subtype="PIXEL", update=_redraw
    )
    cone_size: bpy.props.FloatProperty(
        name="Cone Size", description="Size of cones", default=13.0, min=4.0, max=40.0, subtype="PIXEL", update=_redraw
    )
    text_size: bpy.props.IntProperty(
        name="Text Size", description="Size of the angles next to cones", default=12, min=6, max=40, update=_redraw
    )

    def cut_colors(self) -> list[bpy.types.bpy_prop_array]:
        """The colors that cuts take in turn."""
        return [getattr(self, name) for name in CUT_NAMES]


class _DefaultLook(OverlayLook):
    """The defaults of the properties as plain values."""

    def __init__(self) -> None:
        for properties in (OverlayLook, _CutColors):
            for name, deferred in properties.__annotations__.items():
                setattr(self, name, deferred.keywords["default"])


def overlay_look() -> OverlayLook:
    return preferences() or _DefaultLook()
