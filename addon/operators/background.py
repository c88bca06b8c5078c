# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that compute in the background: Blender goes on drawing, progress is shown, Esc stops."""

from collections.abc import Callable
from typing import Any

import bpy

from ..computation import Computation

# Seconds: what takes less shows no progress, which would only flicker; and how often progress is shown.
UNNOTICED = 0.2
INTERVAL = 0.05


class BackgroundComputation:
    """Mix-in: ``start`` begins what ``conclude_computation`` ends, which the operator defines.

    In between nothing else can be done in the window. Stopped, the operator ends at once and concludes nothing.
    """

    # "Unwrapping from cones", for the status bar.
    activity: str

    def start(self, context: bpy.types.Context, compute: Callable[[Callable[[float], bool]], Any]) -> set[str]:
        """The operator's status; ``compute`` as for a `Computation`."""
        self._computation = Computation(compute)
        if self._computation.finished(UNNOTICED):
            return self.conclude_computation(context, self._computation.outcome())
        manager = context.window_manager
        self._timer = manager.event_timer_add(INTERVAL, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        self._percent = None
        self._show_progress(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"{self.activity} was stopped; nothing was changed")
            return {"CANCELLED"}
        if event.type == "TIMER":
            if self._computation.finished():
                self._end_progress(context)
                return self.conclude_computation(context, self._computation.outcome())
            self._show_progress(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender where it ends the operator, as before another file is opened."""
        self._computation.stop()
        self._end_progress(context)

    def _show_progress(self, context: bpy.types.Context) -> None:
        percent = int(100 * self._computation.done)
        if percent != self._percent:
            self._percent = percent
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"{self.activity}... {percent} %, Esc to cancel")

    def _end_progress(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
