# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay shows; kept per session, not per file, so that undo does not change it."""

import bpy

from ..core import redraw

MEASURES = (
    ("NONE", "None", "Show no distortion"),
    ("CONFORMAL", "Angles", "How much the UV map distorts angles: 1 is not at all"),
    ("AREA", "Area", "How much of the texture a face gets, relative to the whole mesh: 1 is its fair share"),
    ("STRETCH", "Stretch", "How lengths change between the texture and the mesh: 1 is not at all"),
)


CUT_COLORS = (
    ("MATCHING", "Matching", "Both sides of a cut have one color, so that you see where each edge continues"),
    (
        "KIND",
        "By Kind",
        "Seams, cuts that cones and handles need, further cuts and those moved by hand differ in color",
    ),
)


def _redraw(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    redraw.views()


class ConeUnwrapOverlay(bpy.types.PropertyGroup):
    """Which cones, cuts and problems are shown."""

    show: bpy.props.BoolProperty(
        name="Cones and Cuts",
        description="Show cones, cuts and problems of the UV map on meshes in edit mode and on selected ones",
        default=True,
        update=_redraw,
    )
    cones: bpy.props.BoolProperty(
        name="Cones", description="Show cones, colored by their curvature", default=True, update=_redraw
    )
    angles: bpy.props.BoolProperty(
        name="Angles", description="Show the angle of each cone", default=False, update=_redraw
    )
    cuts: bpy.props.BoolProperty(
        name="Cuts",
        description="Show both sides of every cut in the same color, on the mesh, also in Texture Paint, and in the UV "
        "editor",
        default=True,
        update=_redraw,
    )
    cut_colors: bpy.props.EnumProperty(
        name="Cut Colors", description="What the colors of cuts tell", items=CUT_COLORS, update=_redraw
    )
    up: bpy.props.BoolProperty(
        name="Texture Up",
        description="Show arrows where the texture's upward direction was drawn or marked, and by how much the UV map "
        "misses it, in degrees",
        default=True,
        update=_redraw,
    )
    axes: bpy.props.BoolProperty(
        name="Texture Axes",
        description="Show on the mesh which way u and v increase in the UV map, in the colors of the X and Y axes; on "
        "every so many faces of large meshes",
        default=False,
        update=_redraw,
    )
    flipped: bpy.props.BoolProperty(
        name="Flipped Faces", description="Show faces that are upside down in the UV map", default=True, update=_redraw
    )
    overlapping: bpy.props.BoolProperty(
        name="Overlapping Faces",
        description="Show faces that overlap others in the UV map",
        default=True,
        update=_redraw,
    )
    distortion: bpy.props.EnumProperty(
        name="Distortion", description="Show the measured distortion on faces", items=MEASURES, update=_redraw
    )


def settings(context: bpy.types.Context) -> ConeUnwrapOverlay:
    return context.window_manager.cone_unwrap_overlay


def register() -> None:
    bpy.utils.register_class(ConeUnwrapOverlay)
    bpy.types.WindowManager.cone_unwrap_overlay = bpy.props.PointerProperty(type=ConeUnwrapOverlay)


def unregister() -> None:
    del bpy.types.WindowManager.cone_unwrap_overlay
    bpy.utils.unregister_class(ConeUnwrapOverlay)
