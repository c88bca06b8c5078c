# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers classes and menu entries; works whether or not the computing library could be loaded."""

import bpy

from .operators.cone_mark import MESH_OT_cone_mark
from .operators.cone_place import MESH_OT_cone_place
from .operators.cone_select import MESH_OT_cone_select
from .operators.cone_select_reported import MESH_OT_cone_select_reported
from .operators.cone_unwrap import UV_OT_cone_unwrap
from .preferences import ConeUnwrapPreferences
from .ui import menus

CLASSES = (
    ConeUnwrapPreferences,
    MESH_OT_cone_mark,
    MESH_OT_cone_select,
    MESH_OT_cone_place,
    MESH_OT_cone_select_reported,
    UV_OT_cone_unwrap,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    menus.append()


def unregister() -> None:
    menus.remove()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
