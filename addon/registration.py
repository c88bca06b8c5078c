# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers classes and menu entries; works whether or not the computing library could be loaded."""

import bpy

from .core import per_mesh
from .core.choices import ConeUnwrapPresetDefaults
from .jobs.batch import command
from .jobs.layouts import remembered
from .jobs.tasks import computation
from .mesh import changes, distortion, own_settings, reports, texel_settings, texture
from .operators.angles.preview_stretch import MESH_OT_cone_preview
from .operators.angles.select_row import MESH_OT_cone_select_one
from .operators.angles.set_angle import MESH_OT_cone_set_angle
from .operators.angles.snap import MESH_OT_cone_snap_angles
from .operators.angles.spread_rest import MESH_OT_cone_spread_rest
from .operators.angles.suggest_cone import MESH_OT_cone_suggest
from .operators.angles.update_table import MESH_OT_cone_update_table
from .operators.cones.clear_data import MESH_OT_cone_clear_data
from .operators.cones.edit import MESH_OT_cone_edit
from .operators.cones.mark import MESH_OT_cone_mark
from .operators.cones.place import MESH_OT_cone_place
from .operators.cones.select import MESH_OT_cone_select
from .operators.cuts.edit import MESH_OT_cone_edit_cuts
from .operators.cuts.extend_image import UV_OT_cone_extend_image
from .operators.cuts.mark_seams import MESH_OT_cone_seams_from_cuts
from .operators.cuts.select import MESH_OT_cone_select_cuts
from .operators.cuts.steer import MESH_OT_cone_steer_cuts
from .operators.inspection.measure_distortion import UV_OT_cone_measure
from .operators.inspection.select_reported import MESH_OT_cone_select_reported
from .operators.inspection.show_texture import UV_OT_cone_texture
from .operators.islands.align import UV_OT_cone_align
from .operators.islands.grid import UV_OT_cone_grid
from .operators.islands.orient import UV_OT_cone_orient
from .operators.islands.rectify import UV_OT_cone_rectify
from .operators.islands.rip import UV_OT_cone_rip
from .operators.islands.stitch import UV_OT_cone_stitch
from .operators.islands.straighten import UV_OT_cone_straighten
from .operators.quads.remesh import OBJECT_OT_cone_remesh_to_quads
from .operators.shared import redo, running
from .operators.texels.get_density import UV_OT_cone_texel_get
from .operators.texels.select_by_density import MESH_OT_cone_texel_select
from .operators.texels.set_density import UV_OT_cone_texel_set
from .operators.unwrapping.auto import UV_OT_cone_auto_unwrap
from .operators.unwrapping.draw_up import MESH_OT_cone_draw_up
from .operators.unwrapping.from_cones import UV_OT_cone_unwrap
from .operators.unwrapping.mark_up import MESH_OT_cone_mark_up
from .operators.unwrapping.pack import UV_OT_cone_pack
from .overlay import handlers
from .ui import manual, menus, pie, presets
from .ui.angle_panel import VIEW3D_PT_cone_angles
from .ui.panels import PANELS, UV_EDITOR_PANELS
from .ui.preferences import ConeUnwrapPreferences

CLASSES = (
    ConeUnwrapPresetDefaults,
    ConeUnwrapPreferences,
    MESH_OT_cone_mark,
    MESH_OT_cone_edit,
    MESH_OT_cone_edit_cuts,
    MESH_OT_cone_draw_up,
    MESH_OT_cone_mark_up,
    MESH_OT_cone_select,
    MESH_OT_cone_place,
    MESH_OT_cone_steer_cuts,
    MESH_OT_cone_select_cuts,
    MESH_OT_cone_seams_from_cuts,
    MESH_OT_cone_select_reported,
    MESH_OT_cone_clear_data,
    UV_OT_cone_auto_unwrap,
    UV_OT_cone_unwrap,
    UV_OT_cone_pack,
    UV_OT_cone_straighten,
    UV_OT_cone_rectify,
    UV_OT_cone_grid,
    UV_OT_cone_align,
    UV_OT_cone_orient,
    UV_OT_cone_stitch,
    UV_OT_cone_rip,
    OBJECT_OT_cone_remesh_to_quads,
    UV_OT_cone_measure,
    UV_OT_cone_texture,
    UV_OT_cone_extend_image,
    UV_OT_cone_texel_get,
    UV_OT_cone_texel_set,
    MESH_OT_cone_texel_select,
    MESH_OT_cone_set_angle,
    MESH_OT_cone_spread_rest,
    MESH_OT_cone_snap_angles,
    MESH_OT_cone_suggest,
    MESH_OT_cone_select_one,
    MESH_OT_cone_update_table,
    MESH_OT_cone_preview,
    menus.VIEW3D_MT_cone_angles,
    menus.VIEW3D_MT_cone_seeing,
    menus.VIEW3D_MT_cone_texels,
    menus.VIEW3D_MT_cone_islands,
    menus.VIEW3D_MT_cone_unwrap,
    pie.VIEW3D_MT_cone_pie,
    *PANELS,
    *UV_EDITOR_PANELS,
    VIEW3D_PT_cone_angles,
)
MODULES = (
    per_mesh,
    changes,
    reports,
    distortion,
    texture,
    texel_settings,
    own_settings,
    handlers,
    command,
    remembered,
    redo,
    manual,
    presets,
    pie,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for module in MODULES:
        module.register()
    menus.append()


def unregister() -> None:
    running.end_all(bpy.context)
    menus.remove()
    for module in reversed(MODULES):
        module.unregister()
    computation.end_all()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
