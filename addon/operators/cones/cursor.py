# SPDX-License-Identifier: GPL-3.0-or-later
"""What is under the cursor in a 3D view."""

from __future__ import annotations

import bpy
import numpy as np

from ...core.screen import Screen
from ...jobs.cone_session import ConeSession

# Pixels, at a scale of 1.
RADIUS = 14


class Cursor:
    """The cursor over an object in the 3D view of an area."""

    def __init__(self, obj: bpy.types.Object, area: bpy.types.Area) -> None:
        self._obj, self._area = obj, area
        self._region = next(region for region in area.regions if region.type == "WINDOW")
        self._window_place = 0, 0

    def follow(self, event: bpy.types.Event) -> None:
        self._window_place = event.mouse_x, event.mouse_y

    def vertex(self, session: ConeSession) -> int | None:
        """The vertex under the cursor; None where there is no face."""
        return session.vertex_at(self._screen(), *self._place()) if self._is_inside() else None

    def cone(self, session: ConeSession) -> int | None:
        """The visible cone at the cursor; None where there is none."""
        radius = RADIUS * bpy.context.preferences.system.pixel_size
        return session.cone_at(self._screen(), *self._place(), radius) if self._is_inside() else None

    def _screen(self) -> Screen:
        matrix = self._area.spaces.active.region_3d.perspective_matrix @ self._obj.matrix_world
        return Screen(np.array(matrix, np.float64), self._region.width, self._region.height)

    def _place(self) -> tuple[int, int]:
        """In pixels from the lower left corner of the view."""
        return self._window_place[0] - self._region.x, self._window_place[1] - self._region.y

    def _is_inside(self) -> bool:
        x, y = self._place()
        return 0 <= x < self._region.width and 0 <= y < self._region.height
