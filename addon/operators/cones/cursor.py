# SPDX-License-Identifier: GPL-3.0-or-later
"""What is under the cursor in a window."""

from __future__ import annotations

from functools import partial

import bpy
import numpy as np

from ...core.screen import Screen
from ...jobs.edited_objects import EditedObjects, Pick
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

    def vertex(self, objects: EditedObjects) -> Pick | None:
        """The vertex under the cursor, and its object; None where there is no face."""
        view = self.view()
        return None if view is None else objects.vertex_at(partial(_screen, view), *view.place)

    def cone(self, objects: EditedObjects) -> Pick | None:
        """The visible cone at the cursor, and its object; None where there is none."""
        view = self.view()
        radius = RADIUS * bpy.context.preferences.system.pixel_size
        return None if view is None else objects.cone_at(partial(_screen, view), *view.place, radius)


def _screen(view: View, obj: bpy.types.Object) -> Screen | None:
    """The projection of an object; None where the view does not show it, as outside a local view."""
    if not obj.visible_in_viewport_get(view.area.spaces.active):
        return None
    matrix = view.region.data.perspective_matrix @ obj.matrix_world
    return Screen(np.array(matrix, np.float64), view.region.width, view.region.height)
