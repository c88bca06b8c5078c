# SPDX-License-Identifier: GPL-3.0-or-later
"""Every name the add-on leaves in Blender or on a mesh, in one place."""

CONE_GROUP = "uv_cones"
"""Default vertex group; a weight above zero marks a cone."""

CONE_ANGLE_ATTRIBUTE = "uv_cone_angle"
"""Float attribute on points: total angle of a cone in radians, 0 for automatic."""

NEW_UV_LAYER = "UVMap"
"""UV layer created on a mesh that has none; Blender's own name for it."""

DISTORTION_ATTRIBUTES = {
    "conformal": "uv_distortion_conformal",
    "area": "uv_distortion_area",
    "stretch": "uv_distortion_stretch",
}
"""Float attributes on faces, by the library's name of the measure."""

TEXTURE = "Cone Unwrap Texture"
"""Material and image that show the UV map while they stand in for a mesh's materials."""

UNWRAP = "uv.cone_unwrap"
MARK = "mesh.cone_mark"
SELECT = "mesh.cone_select"
PLACE = "mesh.cone_place"
SELECT_REPORTED = "mesh.cone_select_reported"
MEASURE = "uv.cone_measure"
TEXTURE_SHOW = "uv.cone_texture"
