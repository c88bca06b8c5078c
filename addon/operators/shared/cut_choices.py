# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist's choice of cuts means in the present scene and view."""

from __future__ import annotations

import bpy
from mathutils import Vector

from ...jobs.tasks.cuts import FRONT, CutChoice


def chosen_cuts(identifier: str) -> CutChoice:
    """identifier: of the property of `CutsProperty`."""
    if identifier == "VIEW":
        return CutChoice(front=_towards_viewer())
    return CutChoice(by_cost=identifier != "SHORTEST", front=FRONT if identifier == "FRONT" else None)


def _towards_viewer() -> tuple[float, float, float]:
    """From the scene to the viewer of the 3D view; the scene's front where no 3D view is open."""
    context = bpy.context
    region = context.region_data if context.area and context.area.type == "VIEW_3D" else None
    if region is None and context.screen is not None:
        views = [area.spaces.active.region_3d for area in context.screen.areas if area.type == "VIEW_3D"]
        region = views[0] if views else None
    return FRONT if region is None else tuple(region.view_rotation @ Vector((0.0, 0.0, 1.0)))
