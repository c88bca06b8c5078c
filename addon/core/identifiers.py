# SPDX-License-Identifier: GPL-3.0-or-later
"""Every name that the add-on gives to something in Blender or on a mesh."""

EXTENSION = __package__.rpartition(".")[0]
"""The Python package of the add-on, by which Blender knows it."""

HOME_PAGE = "https://extensions.blender.org/add-ons/cone-unwrap/"
"""The website in the manifest."""

CONE_GROUP = "uv_cones"
"""Default vertex group; a weight above 0.5 marks a cone."""

CONE_ANGLE_ATTRIBUTE = "uv_cone_angle"
"""Float attribute on points: total angle of a cone in radians, 0 for automatic."""

CONE_ANGLE_KIND_ATTRIBUTE = "uv_cone_angle_kind"
"""Integer attribute on points: the origin of that angle, a `cone_angles.Kind`; prescribed where it is missing."""

SEAM_COST_GROUP = "uv_seam_cost"
"""Vertex group that keeps cuts away where its weights are high, and draws them near where they are low."""

IMPORTANCE_GROUP = "uv_importance"
"""Default vertex group of importance weights; Blender's own name for it."""

QUAD_DENSITY_GROUP = "uv_quad_density"
"""Default vertex group of the density of quads: their sides are halved, and halved again, where its weight is 1."""

LOG_SCALE_ATTRIBUTE = "uv_cone_log_scale"
"""Float attribute on points: predicted logarithm of the length scale, with mean 0 on every connected part."""

GAIN_ATTRIBUTE = "uv_cone_gain"
"""Float attribute on points: by how much one more cone there would lower the predicted L2 stretch of its part."""

UP_ATTRIBUTE = "uv_cone_up"
"""Vector attribute on faces: the drawn upward direction of the texture, of unit length; (0, 0, 0) for none."""

ALONG_ATTRIBUTE = "uv_cone_along"
"""Boolean attribute on edges: those along which the texture's upward direction is to run."""

FEATURE_ATTRIBUTE = "uv_cone_feature"
"""Boolean attribute on edges: those that are to run straight along u or v."""

NEW_UV_LAYER = "UVMap"
"""UV layer created on a mesh that has none; Blender's own name for it."""

DISTORTION_ATTRIBUTES = {
    "conformal": "uv_cone_distortion_conformal",
    "area": "uv_cone_distortion_area",
    "stretch": "uv_cone_distortion_stretch",
}
"""Float attributes on faces, by the library's name of the measure."""

TEXTURE = "Cone Unwrap Texture"
"""Material and image that show the UV map in place of a mesh's materials."""

AUTO_UNWRAP = "uv.cone_auto_unwrap"
UNWRAP = "uv.cone_unwrap"
PACK = "uv.cone_pack"
STRAIGHTEN = "uv.cone_straighten"
RECTIFY = "uv.cone_rectify"
GRID = "uv.cone_grid"
ALIGN = "uv.cone_align"
ORIENT = "uv.cone_orient"
STITCH = "uv.cone_stitch"
RIP = "uv.cone_rip"
REMESH_TO_QUADS = "object.cone_remesh_to_quads"
MARK = "mesh.cone_mark"
SELECT = "mesh.cone_select"
STEER_CUTS = "mesh.cone_steer_cuts"
SELECT_CUTS = "mesh.cone_select_cuts"
SEAMS_FROM_CUTS = "mesh.cone_seams_from_cuts"
EDIT = "mesh.cone_edit"
EDIT_CUTS = "mesh.cone_edit_cuts"
DRAW_UP = "mesh.cone_draw_up"
MARK_UP = "mesh.cone_mark_up"
PLACE = "mesh.cone_place"
SET_ANGLE = "mesh.cone_set_angle"
SPREAD_REST = "mesh.cone_spread_rest"
SNAP_ANGLES = "mesh.cone_snap_angles"
SUGGEST = "mesh.cone_suggest"
SELECT_ONE = "mesh.cone_select_one"
UPDATE_TABLE = "mesh.cone_update_table"
PREVIEW = "mesh.cone_preview"
SELECT_REPORTED = "mesh.cone_select_reported"
MEASURE = "uv.cone_measure"
TEXTURE_SHOW = "uv.cone_texture"
EXTEND_IMAGE = "uv.cone_extend_image"
TEXEL_GET = "uv.cone_texel_get"
TEXEL_SET = "uv.cone_texel_set"
TEXEL_SELECT = "mesh.cone_texel_select"
CLEAR_DATA = "mesh.cone_clear_data"
WAIT_FOR_REDO = "uv.cone_wait_for_redo"

COMMAND = "cone_unwrap"
"""Command of Blender's command line."""
