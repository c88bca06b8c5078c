# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of tools that edit meshes with the mouse until Enter or Esc, with steps of their own to undo."""

from __future__ import annotations

from typing import Any

import bpy

from . import running
from .cursor import Cursor
from .gizmos import HiddenGizmos
from .polling import poll_computation, poll_edit_mesh
from .redo import last_operator
from .status_bar import Hint, clear_status, status
from .views import shows_meshes, view_areas

INTERVAL = 1 / 60
NAVIGATION = {"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION"}
BUTTONS = {"LEFTMOUSE", "RIGHTMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE"}
ENTER = {"RET", "NUMPAD_ENTER"}


class ModalEdit:
    """Mix-in of operators.

    A tool calls `_start` when it is invoked, with the objects that it edits: these have doubt(), is_intact(),
    restore(), end(), hold_layouts() and a history. It has `_follow` for the timer, `_click` for the left mouse button,
    `_finish` for Enter and `_draw` to show everything.
    """

    _dragging = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not (poll_computation(cls, context) and poll_edit_mesh(cls, context)):
            return False
        if context.space_data is None or not shows_meshes(context.space_data):
            cls.poll_message_set("Move the mouse over a 3D view or UV editor first")
            return False
        return True

    def _start(self, context: bpy.types.Context, event: bpy.types.Event, objects: Any) -> set[str]:
        self._objects = objects
        self._cursor = Cursor()
        self._cursor.follow(event)
        self._dragging = self._moved = False
        self._refusal = ""
        self._last_operator = last_operator(context)
        self._gizmos = HiddenGizmos()
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        running.began(self)
        self._draw(self._objects.begun)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._cursor.follow(event)
        if not self._is_intact(context):
            return self._give_up(context)
        if event.type == "TIMER":
            self._follow()
            return {"PASS_THROUGH"}
        if event.type in ENTER and event.value == "PRESS" and self._may_finish():
            return self._finish(context)
        if event.type in NAVIGATION or event.alt:
            return {"PASS_THROUGH"}
        if event.type in BUTTONS and not self._dragging and self._cursor.view() is None:
            # It may change anything.
            self._objects.doubt()
            return {"PASS_THROUGH"}
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "MOUSEMOVE":
            self._moved = True
            # What is beside the view lights up under the mouse.
            return {"RUNNING_MODAL"} if self._dragging else {"PASS_THROUGH"}
        return self._handle(event)

    def _handle(self, event: bpy.types.Event) -> set[str]:
        """For events that nothing else takes; tools with more keys have their own."""
        if event.type == "LEFTMOUSE":
            return self._click(event)
        if event.type in {"WHEELUPMOUSE", "WHEELDOWNMOUSE"}:
            return {"PASS_THROUGH"}
        if event.value == "PRESS" and (event.ctrl or event.oskey):
            self._go_back(event)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender where it ends the operator, for example before another file is opened."""
        self._objects.restore()
        self._end(context)

    def _may_finish(self) -> bool:
        """Whether Enter ends the tool."""
        return True

    def _is_intact(self, context: bpy.types.Context) -> bool:
        """Whether no other operator has changed the mesh, as those do that are started from panels and menus."""
        last = last_operator(context)
        if last != self._last_operator:
            self._last_operator = last
            self._objects.doubt()
        return self._objects.is_intact()

    def _drag(self, dragging: bool) -> None:
        self._dragging = dragging
        self._objects.hold_layouts(dragging)

    def _go_back(self, event: bpy.types.Event) -> None:
        """Undo or redo one step, if that is what a key with Ctrl asks for."""
        redo = (event.type == "Z" and event.shift) or event.type == "Y"
        if not redo and event.type != "Z":
            return
        self._drag(False)
        history = self._objects.history
        if history.redo() if redo else history.undo():
            self._draw(self._objects.begun)

    def _show(self, header: str | None, hints: list[Hint]) -> None:
        """In the headers of views and in the status bar."""
        for area in view_areas():
            area.header_text_set(header)
        bpy.context.workspace.status_text_set(status(hints))

    def _give_up(self, context: bpy.types.Context) -> set[str]:
        """End where another operator has changed the mesh."""
        self.cancel(context)
        self.report({"WARNING"}, f"{self.bl_label} has ended, since something else changed the mesh")
        # Blender's last step of undo has the map as it was meanwhile.
        return {"FINISHED"}

    def _end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        self._gizmos.end()
        clear_status(context)
        for area in view_areas():
            area.header_text_set(None)
        self._objects.end()
        running.ended(self)
