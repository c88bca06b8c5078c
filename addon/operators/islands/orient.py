# SPDX-License-Identifier: GPL-3.0-or-later
"""Orient."""

from __future__ import annotations

import bpy
import numpy as np

from ...core import identifiers
from ...core.errors import Refused
from ...jobs.tasks.directions import UP
from ...jobs.uv_maps.islands import ChangedMap, Map, tiles_of, turned, turns_along, upright_turns
from ...mesh import reports
from .base import IslandOperator

UPRIGHT = (
    ("MODEL", "Model's Up", "The object's own z axis points up in the image, as far as it does on each island"),
    ("WORLD", "World's Up", "The world's z axis points up in the image"),
    ("EDGE", "Active Edge", "The islands at the active edge are turned until it is upright"),
)


class UV_OT_cone_orient(IslandOperator, bpy.types.Operator):
    """Orient."""

    bl_idname = identifiers.ORIENT
    bl_label = "Orient"
    bl_description = (
        "Turn the islands of the selected faces upright, each about its middle. Those of seamless layouts only so that "
        "tiles match as before; pinned ones stay"
    )

    by: bpy.props.EnumProperty(name="Upright", description="What is to point up in the image", items=UPRIGHT)

    def change(self, found: Map, obj: bpy.types.Object) -> ChangedMap:
        region = found.region
        if self.by == "EDGE":
            if region.active_edge is None:
                raise Refused("no edge is active; select one last in edit mode, or choose an axis")
            turns = turns_along(found, region.active_edge)
        else:
            turns = upright_turns(found, np.array(UP) if self.by == "MODEL" else np.array(UP) @ region.axes)
        return turned(found, turns, tiles_of(reports.find(obj.data)))
