# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones."""

from __future__ import annotations

import math
from collections.abc import Iterator

import bpy

from ...core import findings, identifiers
from ...core.errors import object_errors
from ...core.text import counted, degrees
from ...jobs import angle_table
from ...jobs.cone_session import ConeSession
from ...jobs.edit_history import EditHistory
from ...jobs.following import Follower
from ...mesh import changes
from ...overlay import cache
from ...overlay.content import session_content
from ..shared.conclusion import conclude
from ..shared.polling import poll_computation, poll_edit_mesh
from ..unwrapping.properties import pack_settings, unwrap_settings
from .cursor import Cursor
from .typed_number import TypedNumber

INTERVAL = 1 / 60
WHEEL_STEP, FINE_STEP = math.radians(15.0), math.radians(1.0)
NAVIGATION = {"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION"}
BUTTONS = {"LEFTMOUSE", "RIGHTMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE"}
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
            chosen = context.window_manager.operator_properties_last(identifiers.UNWRAP)
            self._session, self._placing = ConeSession(obj, unwrap_settings(chosen)), pack_settings(chosen)
        except object_errors() as error:
            return conclude(self, [], {}, {obj.name: error})
        self._obj, self._uid = obj, obj.data.session_uid
        self._cursor = Cursor(obj)
        self._cursor.follow(event)
        self._follower = Follower(self._session)
        self._typed = TypedNumber()
        self._history = EditHistory(self._session.cones.state, self._session.cones.put)
        self._dragging = self._moved = False
        self._last_operator = _last_operator(context)
        changes.suspend(obj.data)
        angle_table.follow(self._uid, self._session.table())
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._draw()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._cursor.follow(event)
        if not self._is_intact(context):
            return self._give_up(context)
        if event.type == "TIMER":
            self._follow()
            return {"PASS_THROUGH"}
        if event.type in {"RET", "NUMPAD_ENTER"} and event.value == "PRESS" and not self._typed.text:
            return self._finish(context)
        if event.type in NAVIGATION or event.alt:
            return {"PASS_THROUGH"}
        if event.type in BUTTONS and not self._dragging and self._cursor.view() is None:
            # It may change anything.
            self._session.doubt()
            return {"PASS_THROUGH"}
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        return self._handle(event)

    def _handle(self, event: bpy.types.Event) -> set[str]:
        if event.type == "MOUSEMOVE":
            self._moved = True
            # What is beside the view lights up under the mouse.
            return {"RUNNING_MODAL"} if self._dragging else {"PASS_THROUGH"}
        if event.type in WHEEL:
            return self._turn(event)
        if event.type == "LEFTMOUSE":
            return self._click(event)
        if event.type in {"RET", "NUMPAD_ENTER"} and event.value == "PRESS":
            self._typed.clear()
            self._draw()
        elif event.value == "PRESS":
            self._type(event)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender where it ends the operator, for example before another file is opened."""
        self._follower.stop()
        self._session.restore()
        self._end(context)

    # Events

    def _is_intact(self, context: bpy.types.Context) -> bool:
        """Whether no other operator has changed the mesh, as those do that are started from panels and menus."""
        last = _last_operator(context)
        if last != self._last_operator:
            self._last_operator = last
            self._session.doubt()
        return self._session.is_intact()

    def _click(self, event: bpy.types.Event) -> set[str]:
        if event.value == "RELEASE":
            if not self._dragging:
                # A button was pressed elsewhere.
                return {"PASS_THROUGH"}
            self._dragging = False
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            self._press(event)
        return {"RUNNING_MODAL"}

    def _press(self, event: bpy.types.Event) -> None:
        self._typed.clear()
        cone = self._cursor.cone(self._session)
        if event.ctrl:
            if cone is not None:
                self._history.begin("Remove Cone")
                self._session.cones.remove(cone)
                self._changed()
            return
        vertex = self._cursor.vertex(self._session) if cone is None else cone
        if vertex is None:
            return
        self._dragging = True
        self._history.begin("Add Cone" if cone is None else "Move Cone")
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
        self._history.begin("Turn Angle")
        self._session.turn_angle(FINE_STEP if event.shift else WHEEL_STEP, WHEEL[event.type])
        self._changed()
        return {"RUNNING_MODAL"}

    def _type(self, event: bpy.types.Event) -> None:
        if event.ctrl or event.oskey:
            self._go_back(event)
        elif self._session.cones.active is None:
            return
        elif event.type == "A":
            self._typed.clear()
            self._history.begin("Automatic Angle")
            self._session.cones.set_angle(None)
            self._changed()
        else:
            self._type_angle(event)

    def _type_angle(self, event: bpy.types.Event) -> None:
        begins = not self._typed.text
        if not self._typed.press(event.type, event.unicode):
            return
        if begins:
            self._history.begin("Set Angle")
        angle = self._typed.value
        if angle:
            self._session.cones.set_angle(math.radians(angle))
            self._changed()
        self._draw()

    def _go_back(self, event: bpy.types.Event) -> None:
        """Undo or redo one step."""
        redo = (event.type == "Z" and event.shift) or event.type == "Y"
        if not redo and event.type != "Z":
            return
        self._typed.clear()
        self._dragging = False
        if self._history.redo() if redo else self._history.undo():
            self._changed()

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
        self._show_header(self._header())
        bpy.context.workspace.status_text_set(self._status())

    def _status(self) -> str:
        texts = [STATUS]
        for key, step in (("Ctrl-Z: undo", self._history.undoes), ("Ctrl-Shift-Z: redo", self._history.redoes)):
            if step is not None:
                texts.append(f"{key} {step}")
        return "  |  ".join(texts)

    def _show_header(self, text: str | None) -> None:
        for area in _view_areas():
            area.header_text_set(text)

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
            unwrapped = self._session.finish(self._placing)
            region, warnings = unwrapped.region, unwrapped.warnings
        except object_errors() as error:
            region, warnings = None, [error]
        self._end(context)
        findings.keep(self._obj, region, warnings)
        done = f"{name}: {counted(len(self._session.cones.vertices), 'cone')}"
        return conclude(self, [done], {name: warnings}, {})

    def _give_up(self, context: bpy.types.Context) -> set[str]:
        """End where another operator has changed the mesh."""
        self.cancel(context)
        self.report({"WARNING"}, "Edit Cones has ended, since something else changed the mesh")
        # Blender's last step of undo has the map as it was meanwhile.
        return {"FINISHED"}

    def _end(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        for workspace in bpy.data.workspaces:
            with context.temp_override(workspace=workspace):
                workspace.status_text_set(None)
        self._show_header(None)
        angle_table.unfollow(self._uid)
        changes.resume(self._uid)


def _last_operator(context: bpy.types.Context) -> int:
    """Identifies the operator that ran last; 0 for none."""
    operators = context.window_manager.operators
    return operators[-1].as_pointer() if operators else 0


def _view_areas() -> Iterator[bpy.types.Area]:
    """Of all screens, also those that are not shown."""
    return (area for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D")
