# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the state of the computing library, and how the overlay looks."""

import bpy

from . import native, redraw

CUT_COLOURS = ("#d6336c", "#2b9348", "#7b4fc9", "#e3b505", "#12a0a0", "#c23fb5", "#87991a", "#3c9be0", "#c2703d")


def library_state() -> str:
    """One sentence: which version of the computing library was loaded from where, or that it is missing."""
    return native.PROBLEM or f"Computing library {native.lsgp.__version__} loaded from {native.lsgp.__file__}"


def preferences(context: bpy.types.Context) -> "ConeUnwrapPreferences":
    return context.preferences.addons[__package__].preferences


def _redraw(_preferences: bpy.types.AddonPreferences, _context: bpy.types.Context) -> None:
    # Colours are part of what is drawn.
    from .overlay import cache

    cache.clear()
    redraw.views()


def _colour(name: str, description: str, default: tuple[float, ...]) -> bpy.props.FloatVectorProperty:
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


def _from_hex(colour: str) -> tuple[float, ...]:
    return (*(int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)), 1.0)


# A property for each colour. Since Python 3.14 the body of a class cannot add to its annotations.
_CutColours = type(
    "_CutColours",
    (),
    {
        "__annotations__": {
            f"cut_{number}": _colour(
                f"Cut {number}", "Both sides of cuts; the colours are taken in turn", _from_hex(colour)
            )
            for number, colour in enumerate(CUT_COLOURS, 1)
        }
    },
)


class ConeUnwrapPreferences(_CutColours, bpy.types.AddonPreferences):
    bl_idname = __package__

    tip: _colour(
        "Tips",
        "Cones of less than a full turn, as on tips and corners",
        (1.0, 0.50, 0.10, 1.0),
    )
    saddle: _colour(
        "Saddles",
        "Cones of more than a full turn, as between fingers",
        (0.20, 0.55, 1.0, 1.0),
    )
    flat: _colour("Flat", "Cones of a full turn, which are none; others fade to this", (0.75, 0.75, 0.75, 1.0))
    automatic: _colour("Automatic", "Cones whose angle is left to the unwrap", (1.0, 1.0, 1.0, 1.0))
    flipped: _colour("Flipped", "Faces that lie upside down in the UV map", (1.0, 0.05, 0.05, 0.6))
    overlapping: _colour("Overlapping", "Faces that lie on others in the UV map", (0.85, 0.10, 0.95, 0.35))
    text: _colour("Text", "Angles beside cones", (1.0, 1.0, 1.0, 1.0))
    line_width: bpy.props.FloatProperty(
        name="Line Width", description="Width of cuts", default=3.0, min=1.0, max=10.0, subtype="PIXEL", update=_redraw
    )
    cone_size: bpy.props.FloatProperty(
        name="Cone Size", description="Size of cones", default=13.0, min=4.0, max=40.0, subtype="PIXEL", update=_redraw
    )
    text_size: bpy.props.IntProperty(
        name="Text Size", description="Size of the angles beside cones", default=12, min=6, max=40, update=_redraw
    )

    def cut_colours(self) -> list[bpy.types.bpy_prop_array]:
        """The colours that cuts have in turn."""
        return [getattr(self, f"cut_{number}") for number in range(1, len(CUT_COLOURS) + 1)]

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.label(text=library_state(), icon="ERROR" if native.PROBLEM else "CHECKMARK")
        if native.REASON:
            layout.label(text=native.REASON)
        layout.separator()
        split = layout.row()
        for heading, names in (
            ("Cones", ("tip", "saddle", "flat", "automatic")),
            ("Faces and Text", ("flipped", "overlapping", "text")),
            ("Sizes", ("line_width", "cone_size", "text_size")),
        ):
            column = split.column()
            column.label(text=heading)
            for name in names:
                column.prop(self, name)
        layout.label(text="Cuts, in turn")
        row = layout.row(align=True)
        for number in range(1, len(CUT_COLOURS) + 1):
            row.prop(self, f"cut_{number}", text="")
