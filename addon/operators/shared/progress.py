# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation's progress beside the mouse pointer and in the status bar."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from .status_bar import clear_status

if TYPE_CHECKING:
    from ...jobs.tasks.computation import Computation

# Seconds: how often progress is shown.
INTERVAL = 0.05


class ShownProgress:
    """Shown until `end`; meanwhile timer events tell when to `update`."""

    def __init__(self, context: bpy.types.Context, activity: str, computation: Computation[Any]) -> None:
        """activity: such as "Placing cones"."""
        self._activity, self._computation = activity, computation
        self._percent: int | None = None
        manager = context.window_manager
        self._timer = manager.event_timer_add(INTERVAL, window=context.window)
        manager.progress_begin(0, 100)
        self.update(context)

    def update(self, context: bpy.types.Context) -> None:
        percent = int(100 * self._computation.done)
        if percent != self._percent:
            self._percent = percent
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"{self._activity}... {percent} %, Esc to cancel")

    def end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        clear_status(context)
