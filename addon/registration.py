# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers classes and menu entries; works whether or not the computing library could be loaded."""

import bpy

from . import changes, distortion, reports, texture
from .operators.cone_mark import MESH_OT_cone_mark
from .operators.cone_place import MESH_OT_cone_place
from .operators.cone_select import MESH_OT_cone_select
from .operators.cone_select_reported import MESH_OT_cone_select_reported
from .operators.cone_unwrap import UV_OT_cone_unwrap
from .operators.measure import UV_OT_cone_measure
from .operators.texture import UV_OT_cone_texture
from .overlay import handlers
from .preferences import ConeUnwrapPreferences
from .ui import menus
from .ui.panels import PANELS

CLASSES = (
    ConeUnwrapPreferences,
    MESH_OT_cone_mark,
    MESH_OT_cone_select,
    MESH_OT_cone_place,
    MESH_OT_cone_select_reported,
    UV_OT_cone_unwrap,
    UV_OT_cone_measure,
    UV_OT_cone_texture,
    *PANELS,
)
PARTS = (changes, reports, distortion, texture, handlers)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for part in PARTS:
        part.register()
    menus.append()


def unregister() -> None:
    menus.remove()
    for part in reversed(PARTS):
        part.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
