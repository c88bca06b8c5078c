# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay shows; of the session, not of the file, so that it is no part of undo."""

import bpy

from .. import redraw

MEASURES = (
    ("NONE", "None", "Show no distortion"),
    ("CONFORMAL", "Angles", "How far from keeping angles the UV map is: 1 is none"),
    ("AREA", "Area", "How much of the texture a face gets, compared with the whole mesh: 1 is its share"),
    ("STRETCH", "Stretch", "How lengths change between the texture and the mesh: 1 is none"),
)


def _redraw(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    redraw.views()


class ConeUnwrapOverlay(bpy.types.PropertyGroup):
    """What is shown of cones, cuts and problems."""

    show: bpy.props.BoolProperty(
        name="Cones and Cuts",
        description="Show cones, cuts and problems of the UV map over meshes in edit mode and selected ones",
        default=True,
        update=_redraw,
    )
    cones: bpy.props.BoolProperty(
        name="Cones", description="Show cones, coloured by their curvature", default=True, update=_redraw
    )
    angles: bpy.props.BoolProperty(
        name="Angles", description="Show the angle left at each cone", default=True, update=_redraw
    )
    cuts: bpy.props.BoolProperty(
        name="Cuts",
        description="Show both sides of every cut in one colour, on the mesh and in the UV editor",
        default=True,
        update=_redraw,
    )
    flipped: bpy.props.BoolProperty(
        name="Flipped Faces", description="Show faces that lie upside down in the UV map", default=True, update=_redraw
    )
    overlapping: bpy.props.BoolProperty(
        name="Overlapping Faces",
        description="Show faces that lie on others in the UV map",
        default=True,
        update=_redraw,
    )
    distortion: bpy.props.EnumProperty(
        name="Distortion", description="Show measured distortion on faces", items=MEASURES, update=_redraw
    )


def settings(context: bpy.types.Context) -> ConeUnwrapOverlay:
    return context.window_manager.cone_unwrap_overlay


def register() -> None:
    bpy.utils.register_class(ConeUnwrapOverlay)
    bpy.types.WindowManager.cone_unwrap_overlay = bpy.props.PointerProperty(type=ConeUnwrapOverlay)


def unregister() -> None:
    del bpy.types.WindowManager.cone_unwrap_overlay
    bpy.utils.unregister_class(ConeUnwrapOverlay)
