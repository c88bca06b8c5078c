# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones."""

from __future__ import annotations

import math

import bpy
import numpy as np

from .. import changes, findings, identifiers, native, reporting
from ..angle_table import degrees
from ..computation import Computation
from ..cone_session import ConeSession, Step
from ..overlay import cache
from ..screen import Screen
from ..typed_number import TypedNumber
from .common import poll_computation, poll_edit_mesh, require_all
from .cone_unwrap import chosen_settings

INTERVAL = 1 / 60
# Seconds: steps that take less are waited for, so that they are drawn with the cursor that asked for them.
SOON = 0.1
# Pixels, at a scale of 1.
RADIUS = 14
WHEEL_STEP, FINE_STEP = math.radians(15.0), math.radians(1.0)
NAVIGATION = {"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION"}
WHEEL = {"WHEELUPMOUSE": 1, "WHEELDOWNMOUSE": -1}
STATUS = (
    "Click: add, drag: move, Ctrl-click: remove  |  Wheel over a cone or while dragging: angle, Shift: finely  |  "
    "Digits: angle in degrees, A: automatic  |  Enter: finish  |  Esc, right click: leave all as it was"
)


class MESH_OT_cone_edit(bpy.types.Operator):
    """A thin shell of events around a `ConeSession`."""

    bl_idname = identifiers.EDIT
    bl_label = "Edit Cones"
    bl_description = (
        "Add, drag and remove cones with the mouse and give them angles, while the UV map follows. "
        "It is unwrapped as Unwrap from Cones did it last, each island where it was"
    )
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not (poll_computation(cls, context) and poll_edit_mesh(cls, context)):
            return False
        if context.area is None or context.area.type != "VIEW_3D":
            cls.poll_message_set("Point at a 3D view first")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        obj = context.edit_object
        try:
            settings = chosen_settings(context.window_manager.operator_properties_last(identifiers.UNWRAP))
            self._session = ConeSession(obj, require_all(obj), settings)
        except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
            return reporting.conclude(self, [], {}, {obj.name: error})
        self._obj, self._uid, self._area = obj, obj.data.session_uid, context.area
        self._region = next(region for region in context.area.regions if region.type == "WINDOW")
        self._cursor = event.mouse_x, event.mouse_y
        self._typed = TypedNumber()
        self._dragging = self._moved = self._outdated = False
        self._computation: Computation | None = None
        self._step: Step | None = None
        self._problem = ""
        changes.hold(obj.data)
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(STATUS)
        self._draw()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type in {"RET", "NUMPAD_ENTER"} and event.value == "PRESS":
            if not self._typed.text:
                return self._finish(context)
            self._typed.clear()
            self._draw()
        elif event.type == "TIMER":
            self._follow()
        elif event.type == "MOUSEMOVE":
            self._cursor = event.mouse_x, event.mouse_y
            self._moved = True
        elif event.type in NAVIGATION or event.alt:
            return {"PASS_THROUGH"}
        elif event.type in WHEEL:
            return self._turn(event)
        elif event.type == "LEFTMOUSE":
            self._click(event)
        elif event.value == "PRESS":
            self._type(event)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender where it ends the operator, as before another file is opened."""
        self._stop()
        self._session.put_back()
        self._end(context)

    # Events

    def _click(self, event: bpy.types.Event) -> None:
        self._cursor = event.mouse_x, event.mouse_y
        if event.value == "RELEASE":
            self._dragging = False
            return
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return
        self._typed.clear()
        cone = self._cone_under_cursor()
        if event.ctrl:
            if cone is not None:
                self._session.remove(cone)
                self._changed()
            return
        vertex = self._vertex_under_cursor() if cone is None else cone
        if vertex is None:
            return
        self._dragging = True
        known = cone is not None
        self._session.add(vertex)
        if known:
            self._draw()
        else:
            self._changed()

    def _turn(self, event: bpy.types.Event) -> set[str]:
        """The wheel zooms where it is not over a cone."""
        if not self._dragging:
            cone = self._cone_under_cursor()
            if cone is None:
                return {"PASS_THROUGH"}
            self._session.active = cone
        self._typed.clear()
        self._session.turn_angle(FINE_STEP if event.shift else WHEEL_STEP, WHEEL[event.type])
        self._changed()
        return {"RUNNING_MODAL"}

    def _type(self, event: bpy.types.Event) -> None:
        if self._session.active is None:
            return
        if event.type == "A":
            self._typed.clear()
            self._session.set_angle(None)
            self._changed()
        elif self._typed.press(event.type, event.unicode):
            angle = self._typed.value
            if angle:
                self._session.set_angle(math.radians(angle))
                self._changed()
            self._draw()

    # What is under the cursor

    def _screen(self) -> Screen:
        matrix = self._area.spaces.active.region_3d.perspective_matrix @ self._obj.matrix_world
        return Screen(np.array(matrix, np.float64), self._region.width, self._region.height)

    def _place(self) -> tuple[int, int]:
        return self._cursor[0] - self._region.x, self._cursor[1] - self._region.y

    def _is_inside(self) -> bool:
        x, y = self._place()
        return 0 <= x < self._region.width and 0 <= y < self._region.height

    def _vertex_under_cursor(self) -> int | None:
        return self._session.vertex_at(self._screen(), *self._place()) if self._is_inside() else None

    def _cone_under_cursor(self) -> int | None:
        radius = RADIUS * bpy.context.preferences.system.pixel_size
        return self._session.cone_at(self._screen(), *self._place(), radius) if self._is_inside() else None

    # Following

    def _changed(self) -> None:
        self._outdated = True
        self._draw()

    def _follow(self) -> None:
        """Move the dragged cone to where the cursor is now, and have the map follow the newest state."""
        moved = False
        if self._dragging and self._moved:
            vertex = self._vertex_under_cursor()
            moved = vertex is not None and self._session.move(vertex)
        self._moved = False
        self._outdated = self._outdated or moved
        if self._computation is None and self._outdated:
            self._outdated = False
            self._step = self._session.draft()
            self._computation = Computation(self._step.solve)
            self._take(SOON)
        elif self._computation is not None:
            self._take()
        if moved and self._computation is not None:
            # The map is late; the cone at least is where the cursor is.
            self._draw()

    def _take(self, seconds: float = 0.0) -> None:
        """Show the outcome of the computation if it ends within so long."""
        if not self._computation.finished(seconds):
            return
        computation, self._computation = self._computation, None
        try:
            self._session.show(self._step, computation.outcome())
            self._problem = ""
        except (native.lsgp.LsgpError, MemoryError) as error:
            self._problem = reporting.explain(error)
        self._draw()

    def _draw(self) -> None:
        cache.show(self._obj, self._session.content())
        self._area.header_text_set(self._header())

    def _header(self) -> str:
        session = self._session
        texts = [f"Edit Cones: {reporting.counted(len(session.cones), 'cone')}"]
        if session.active is not None:
            angle = session.angle(session.active)
            shown = "automatic" if angle is None else degrees(angle)
            if angle is not None and session.is_automatic(session.active):
                shown += " (automatic)"
            texts.append(f"Angle: [{self._typed.text}|]°" if self._typed.text else f"Angle: {shown}")
        if session.stretch is not None:
            texts.append(f"Stretch: {session.stretch:.3f} (1 is none)")
        if self._problem:
            texts.append(self._problem)
        return "  |  ".join(texts)

    # Ending

    def _finish(self, context: bpy.types.Context) -> set[str]:
        self._stop()
        if not self._session.changed:
            self.cancel(context)
            return {"CANCELLED"}
        name = self._obj.name
        try:
            unwrapped = self._session.finish()
            region, warnings = unwrapped.region, unwrapped.result.warnings
        except (native.lsgp.LsgpError, MemoryError) as error:
            region, warnings = None, [error]
        self._end(context)
        findings.keep(self._obj, region, warnings)
        done = f"{name}: {reporting.counted(len(self._session.cones), 'cone')}"
        return reporting.conclude(self, [done], {name: warnings}, {})

    def _stop(self) -> None:
        """Wait for the computation, which is told to end; two of them cannot use the same solver."""
        if self._computation is not None:
            self._computation.stop()
            self._computation.finished(None)
            self._computation = None

    def _end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        self._area.header_text_set(None)
        changes.release(self._uid)
