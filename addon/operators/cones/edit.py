# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones."""

from __future__ import annotations

import math

import bpy

from ...core import findings, identifiers
from ...core.errors import object_errors
from ...core.text import counted, degrees
from ...jobs.cone_session import ConeSession
from ...jobs.following import Follower
from ...mesh import changes
from ...overlay import cache
from ...overlay.content import session_content
from ..shared.conclusion import conclude
from ..shared.polling import poll_computation, poll_edit_mesh
from ..unwrapping.properties import unwrap_settings
from .cursor import Cursor
from .typed_number import TypedNumber

INTERVAL = 1 / 60
WHEEL_STEP, FINE_STEP = math.radians(15.0), math.radians(1.0)
NAVIGATION = {"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION"}
WHEEL = {"WHEELUPMOUSE": 1, "WHEELDOWNMOUSE": -1}
STATUS = (
    "Click: add, drag: move, Ctrl-click: remove  |  Wheel over a cone or while dragging: angle, Shift: fine  |  "
    "Digits: angle in degrees, A: automatic  |  Enter: confirm  |  Esc, right click: cancel"
)


class MESH_OT_cone_edit(bpy.types.Operator):
    """Passes events on to a `ConeSession`."""

    bl_idname = identifiers.EDIT
    bl_label = "Edit Cones"
    bl_description = (
        "Add, drag and remove cones with the mouse and give them angles, while the UV map follows. "
        "The mesh is unwrapped with the settings of the last Unwrap from Cones, and each island keeps its place"
    )
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not (poll_computation(cls, context) and poll_edit_mesh(cls, context)):
            return False
        if context.area is None or context.area.type != "VIEW_3D":
            cls.poll_message_set("Move the mouse over a 3D view first")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        obj = context.edit_object
        try:
            settings = unwrap_settings(context.window_manager.operator_properties_last(identifiers.UNWRAP))
            self._session = ConeSession(obj, settings)
        except object_errors() as error:
            return conclude(self, [], {}, {obj.name: error})
        self._obj, self._uid, self._area = obj, obj.data.session_uid, context.area
        self._cursor = Cursor(obj, context.area)
        self._cursor.follow(event)
        self._follower = Follower(self._session)
        self._typed = TypedNumber()
        self._dragging = self._moved = False
        changes.suspend(obj.data)
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
            self._cursor.follow(event)
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
        """Also called by Blender where it ends the operator, for example before another file is opened."""
        self._follower.stop()
        self._session.restore()
        self._end(context)

    # Events

    def _click(self, event: bpy.types.Event) -> None:
        self._cursor.follow(event)
        if event.value == "RELEASE":
            self._dragging = False
            return
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return
        self._typed.clear()
        cone = self._cursor.cone(self._session)
        if event.ctrl:
            if cone is not None:
                self._session.cones.remove(cone)
                self._changed()
            return
        vertex = self._cursor.vertex(self._session) if cone is None else cone
        if vertex is None:
            return
        self._dragging = True
        self._session.cones.add(vertex)
        if cone is None:
            self._changed()
        else:
            self._draw()

    def _turn(self, event: bpy.types.Event) -> set[str]:
        """Away from cones, the wheel zooms."""
        if not self._dragging:
            cone = self._cursor.cone(self._session)
            if cone is None:
                return {"PASS_THROUGH"}
            self._session.cones.active = cone
        self._typed.clear()
        self._session.turn_angle(FINE_STEP if event.shift else WHEEL_STEP, WHEEL[event.type])
        self._changed()
        return {"RUNNING_MODAL"}

    def _type(self, event: bpy.types.Event) -> None:
        if self._session.cones.active is None:
            return
        if event.type == "A":
            self._typed.clear()
            self._session.cones.set_angle(None)
            self._changed()
        elif self._typed.press(event.type, event.unicode):
            angle = self._typed.value
            if angle:
                self._session.cones.set_angle(math.radians(angle))
                self._changed()
            self._draw()

    def _changed(self) -> None:
        self._follower.outdated = True
        self._draw()

    def _follow(self) -> None:
        """Move the dragged cone to the cursor, and let the map follow."""
        moved = False
        if self._dragging and self._moved:
            vertex = self._cursor.vertex(self._session)
            moved = vertex is not None and self._session.cones.move(vertex)
        self._moved = False
        self._follower.outdated |= moved
        # While the map is late, at least the cone is drawn at the cursor.
        if self._follower.follow() or (moved and self._follower.is_busy):
            self._draw()

    # What is shown

    def _draw(self) -> None:
        cache.show(self._obj, session_content(self._obj, self._session))
        self._area.header_text_set(self._header())

    def _header(self) -> str:
        session, active = self._session, self._session.cones.active
        texts = [f"Edit Cones: {counted(len(session.cones.vertices), 'cone')}"]
        if active is not None:
            angle = session.angle(active)
            shown = "automatic" if angle is None else degrees(angle)
            if angle is not None and session.cones.is_automatic(active):
                shown += " (automatic)"
            texts.append(f"Angle: [{self._typed.text}|]°" if self._typed.text else f"Angle: {shown}")
        if session.stretch is not None:
            texts.append(f"Stretch: {session.stretch:.3f} (1 is none)")
        if self._follower.problem:
            texts.append(self._follower.problem)
        return "  |  ".join(texts)

    # Ending

    def _finish(self, context: bpy.types.Context) -> set[str]:
        self._follower.stop()
        if not self._session.cones.changed:
            self.cancel(context)
            return {"CANCELLED"}
        name = self._obj.name
        try:
            unwrapped = self._session.finish()
            region, warnings = unwrapped.region, unwrapped.warnings
        except object_errors() as error:
            region, warnings = None, [error]
        self._end(context)
        findings.keep(self._obj, region, warnings)
        done = f"{name}: {counted(len(self._session.cones.vertices), 'cone')}"
        return conclude(self, [done], {name: warnings}, {})

    def _end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        self._area.header_text_set(None)
        changes.resume(self._uid)
