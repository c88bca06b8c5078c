# SPDX-License-Identifier: GPL-3.0-or-later
"""What is under the cursor in a window."""

from __future__ import annotations

import bpy
import numpy as np

from ...core.screen import Screen
from ...jobs.cone_session import ConeSession
from .views import View, view_at

# Pixels, at a scale of 1.
RADIUS = 14


class Cursor:
    """The cursor over an object in the views of a window."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self._obj = obj
        self._place = 0, 0

    def follow(self, event: bpy.types.Event) -> None:
        self._place = event.mouse_x, event.mouse_y

    def view(self) -> View | None:
        """The view at the cursor; None where there is something else."""
        # Areas may be gone by the next event.
        return view_at(bpy.context.window, *self._place)

    def vertex(self, session: ConeSession) -> int | None:
        """The vertex under the cursor; None where there is no face."""
        view = self.view()
        return None if view is None else session.vertex_at(self._screen(view), *view.place)

    def cone(self, session: ConeSession) -> int | None:
        """The visible cone at the cursor; None where there is none."""
        view = self.view()
        radius = RADIUS * bpy.context.preferences.system.pixel_size
        return None if view is None else session.cone_at(self._screen(view), *view.place, radius)

    def _screen(self, view: View) -> Screen:
        matrix = view.region.data.perspective_matrix @ self._obj.matrix_world
        return Screen(np.array(matrix, np.float64), view.region.width, view.region.height)
