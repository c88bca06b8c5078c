# SPDX-License-Identifier: GPL-3.0-or-later
"""What is under the cursor in a window."""

from __future__ import annotations

from functools import partial

import bpy
import numpy as np

from ...core.screen import Screen
from ...jobs.sessions.picked_objects import Sight
from .views import View, view_at

# Pixels, at a scale of 1.
RADIUS = 14


class Cursor:
    """The cursor over objects in the views of a window."""

    def __init__(self) -> None:
        self._place = 0, 0

    def follow(self, event: bpy.types.Event) -> None:
        self._place = event.mouse_x, event.mouse_y

    def view(self) -> View | None:
        """The view at the cursor; None where there is something else."""
        # Areas may be gone by the next event.
        return view_at(bpy.context.window, *self._place)

    def sight(self) -> tuple[Sight, tuple[int, int]] | None:
        """What the view at the cursor shows, and the cursor's pixel in it; None where there is something else."""
        view = self.view()
        return None if view is None else (_sight(view), view.place)

    @staticmethod
    def radius() -> float:
        """How far, in pixels, what is picked may be from the cursor."""
        return RADIUS * bpy.context.preferences.system.pixel_size


def _sight(view: View) -> Sight:
    if view.area.type == "VIEW_3D":
        return Sight(partial(_in_scene, view))
    # Without synchronization a UV editor shows the selected faces.
    return Sight(partial(_in_layout, view), layout=True, selected=not bpy.context.tool_settings.use_uv_select_sync)


def _in_scene(view: View, obj: bpy.types.Object) -> Screen | None:
    """None outside a local view, for example."""
    if not obj.visible_get(viewport=view.area.spaces.active):
        return None
    matrix = view.region.data.perspective_matrix @ obj.matrix_world
    return Screen(np.array(matrix, np.float64), view.region.width, view.region.height)


def _in_layout(view: View, _obj: bpy.types.Object) -> Screen:
    """Of texture coordinates with z = 0."""
    width, height = view.region.width, view.region.height
    low, high = (np.array(view.region.view2d.region_to_view(*corner)) for corner in ((0, 0), (width, height)))
    matrix = np.diag([*(2 / (high - low)), -0.5, 1.0])
    matrix[:2, 3] = -(high + low) / (high - low)
    return Screen(matrix, width, height)
