# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import bpy

from ...core import findings, identifiers
from ...core.errors import object_errors
from ...core.text import counted, degrees
from ...jobs.edited_objects import EditedObject, EditedObjects
from ...mesh.targets import target_objects
from ...overlay import cache
from ...overlay.content import session_content
from ..shared.conclusion import conclude
from ..shared.polling import poll_computation, poll_edit_mesh
from ..unwrapping.properties import pack_settings, unwrap_settings
from . import hints
from .cursor import Cursor
from .typed_number import TypedNumber
from .views import shows_meshes

if TYPE_CHECKING:
    from ...jobs.cone_session import ConeSession

INTERVAL = 1 / 60
WHEEL_STEP, FINE_STEP = math.radians(15.0), math.radians(1.0)
NAVIGATION = {"MIDDLEMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "MOUSEROTATE", "MOUSESMARTZOOM", "NDOF_MOTION"}
BUTTONS = {"LEFTMOUSE", "RIGHTMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE"}
WHEEL = {"WHEELUPMOUSE": 1, "WHEELDOWNMOUSE": -1}


class MESH_OT_cone_edit(bpy.types.Operator):
    """Passes events on to `EditedObjects`."""

    bl_idname = identifiers.EDIT
    bl_label = "Edit Cones"
    bl_description = (
        "Add, drag and remove cones with the mouse and give them angles, while the UV map follows. "
        "Meshes are unwrapped with the settings of the last Unwrap from Cones, and each island keeps its place"
    )
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not (poll_computation(cls, context) and poll_edit_mesh(cls, context)):
            return False
        if context.space_data is None or not shows_meshes(context.space_data):
            cls.poll_message_set("Move the mouse over a 3D view or UV editor first")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        objects = target_objects(context)
        try:
            chosen = context.window_manager.operator_properties_last(identifiers.UNWRAP)
            self._objects, self._placing = EditedObjects(objects, unwrap_settings(chosen)), pack_settings(chosen)
        except object_errors() as error:
            return conclude(self, [], {}, {objects[0].name: error})
        self._cursor = Cursor()
        self._cursor.follow(event)
        self._typed = TypedNumber()
        self._dragging = self._moved = False
        self._refusal = ""
        self._last_operator = _last_operator(context)
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        self._draw(self._objects.begun)
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
            self._objects.doubt()
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
        self._objects.restore()
        self._end(context)

    # Events

    def _is_intact(self, context: bpy.types.Context) -> bool:
        """Whether no other operator has changed the mesh, as those do that are started from panels and menus."""
        last = _last_operator(context)
        if last != self._last_operator:
            self._last_operator = last
            self._objects.doubt()
        return self._objects.is_intact()

    def _click(self, event: bpy.types.Event) -> set[str]:
        if event.value == "RELEASE":
            if not self._dragging:
                # A button was pressed elsewhere.
                return {"PASS_THROUGH"}
            self._drag(False)
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            self._press(event)
        return {"RUNNING_MODAL"}

    def _press(self, event: bpy.types.Event) -> None:
        self._typed.clear()
        cone = self._cursor.cone(self._objects)
        pick = cone if cone is not None or event.ctrl else self._cursor.vertex(self._objects)
        if pick is None or not self._begin(pick[0]):
            return
        edited, hit = pick
        if event.ctrl:
            self._objects.history.begin("Remove Cone")
            edited.session.cones.remove(hit.vertex)
        else:
            self._drag(True)
            self._objects.history.begin("Add Cone" if cone is None else "Move Cone")
            edited.session.cones.add(hit.vertex)
        if cone is None or event.ctrl:
            self._changed()
        else:
            self._draw([edited])

    def _drag(self, dragging: bool) -> None:
        self._dragging = dragging
        self._objects.hold_layouts(dragging)

    def _begin(self, edited: EditedObject) -> bool:
        """Make an object the active one.  Returns whether its cones can be edited."""
        try:
            before = self._objects.activate(edited)
        except object_errors() as error:
            self._refusal = f"{edited.name}: {findings.explain(error)}"
            self._draw()
            return False
        self._refusal = ""
        if before is not None:
            self._draw([before])
        return True

    def _turn(self, event: bpy.types.Event) -> set[str]:
        """Away from cones, the wheel zooms."""
        if not self._dragging:
            pick = self._cursor.cone(self._objects)
            if pick is None or not self._begin(pick[0]):
                return {"PASS_THROUGH"}
            pick[0].session.cones.active = pick[1].vertex
        self._typed.clear()
        self._objects.history.begin("Turn Angle")
        self._objects.active.session.turn_angle(FINE_STEP if event.shift else WHEEL_STEP, WHEEL[event.type])
        self._changed()
        return {"RUNNING_MODAL"}

    def _type(self, event: bpy.types.Event) -> None:
        if event.ctrl or event.oskey:
            self._go_back(event)
            return
        cones = self._objects.active_cones
        if cones is None:
            return
        if event.type == "A":
            self._typed.clear()
            self._objects.history.begin("Automatic Angle")
            cones.set_angle(None)
            self._changed()
            return
        begins = not self._typed.text
        if not self._typed.press(event.type, event.unicode):
            return
        if begins:
            self._objects.history.begin("Set Angle")
        angle = self._typed.value
        if angle:
            cones.set_angle(math.radians(angle))
            self._changed()
        self._draw()

    def _go_back(self, event: bpy.types.Event) -> None:
        """Undo or redo one step."""
        redo = (event.type == "Z" and event.shift) or event.type == "Y"
        if not redo and event.type != "Z":
            return
        self._typed.clear()
        self._drag(False)
        history = self._objects.history
        if history.redo() if redo else history.undo():
            self._draw(self._objects.begun)

    def _changed(self) -> None:
        """To be called after a change of the active object's cones."""
        self._objects.active.follower.outdated = True
        self._draw([self._objects.active])

    def _follow(self) -> None:
        """Move the dragged cone to the cursor, and let the map follow."""
        active, moved = self._objects.active, False
        if self._dragging and self._moved:
            pick = self._cursor.vertex(self._objects)
            moved = pick is not None and pick[0] is active and active.session.cones.move(pick[1].vertex)
            active.follower.outdated |= moved
        self._moved = False
        shown = self._objects.follow()
        # While the map is late, at least the cone is drawn at the cursor.
        if moved and active.follower.is_busy:
            shown.append(active)
        if shown:
            self._draw(shown)

    # What is shown

    def _draw(self, objects: Iterable[EditedObject] = ()) -> None:
        """objects: those whose cones or maps have changed."""
        for edited in objects:
            cache.show(edited.obj, session_content(edited.obj, edited.session))
        self._show_header(self._header())
        history = self._objects.history
        bpy.context.workspace.status_text_set(hints.status(hints.hints(history.undoes, history.redoes)))

    def _show_header(self, text: str | None) -> None:
        for area in _view_areas():
            area.header_text_set(text)

    def _header(self) -> str:
        texts = [f"Edit Cones: {counted(self._objects.count(), 'cone')}"]
        active = self._objects.active or next(iter(self._objects.begun), None)
        if active is not None:
            texts += self._figures(active.session)
            texts.append(active.follower.problem)
        return "  |  ".join(text for text in (*texts, self._refusal) if text)

    def _figures(self, session: ConeSession) -> Iterator[str]:
        """The angle of the active cone, and the stretch of the map."""
        active = session.cones.active
        if active is not None:
            angle = session.angle(active)
            shown = "automatic" if angle is None else degrees(angle)
            if angle is not None and session.cones.is_automatic(active):
                shown += " (automatic)"
            yield f"Angle: [{self._typed.text}|]°" if self._typed.text else f"Angle: {shown}"
        if session.stretch is not None:
            yield f"Stretch: {session.stretch:.3f} (1 is none)"

    # Ending

    def _finish(self, context: bpy.types.Context) -> set[str]:
        self._objects.stop()
        if not self._objects.changed:
            self.cancel(context)
            return {"CANCELLED"}
        finished = self._objects.finish(self._placing)
        self._end(context)
        done, warnings = [], {}
        for edited, outcome in finished:
            failed = isinstance(outcome, Exception)
            warnings[edited.name] = [outcome] if failed else outcome.warnings
            findings.keep(edited.obj, None if failed else outcome.region, warnings[edited.name])
            done.append(f"{edited.name}: {counted(len(edited.cones), 'cone')}")
        return conclude(self, done, warnings, {})

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
        self._objects.end()


def _last_operator(context: bpy.types.Context) -> int:
    """Identifies the operator that ran last; 0 for none."""
    operators = context.window_manager.operators
    return operators[-1].as_pointer() if operators else 0


def _view_areas() -> Iterator[bpy.types.Area]:
    """Of all screens, also those that are not shown."""
    return (area for screen in bpy.data.screens for area in screen.areas if area.type in {"VIEW_3D", "IMAGE_EDITOR"})
