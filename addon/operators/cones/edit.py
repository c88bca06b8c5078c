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
from ...jobs.sessions.edited_objects import EditedObject, EditedObjects, Pick
from ...mesh.targets import target_objects
from ...overlay import cache
from ...overlay.content import session_content
from ..shared.conclusion import conclude
from ..shared.modal_edit import ENTER, ModalEdit
from ..unwrapping.properties import pack_settings, unwrap_settings
from . import hints
from .typed_number import TypedNumber

if TYPE_CHECKING:
    from ...jobs.sessions.cone_session import ConeSession

WHEEL_STEP, FINE_STEP = math.radians(15.0), math.radians(1.0)
WHEEL = {"WHEELUPMOUSE": 1, "WHEELDOWNMOUSE": -1}


class MESH_OT_cone_edit(ModalEdit, bpy.types.Operator):
    """Passes events on to `EditedObjects`."""

    bl_idname = identifiers.EDIT
    bl_label = "Edit Cones"
    bl_description = (
        "Add, drag and remove cones with the mouse and give them angles, while the UV map follows. "
        "Meshes are unwrapped with the settings of the last Unwrap from Cones, and each island keeps its place"
    )
    bl_options = {"UNDO"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        objects = target_objects(context)
        try:
            chosen = context.window_manager.operator_properties_last(identifiers.UNWRAP)
            edited, self._placing = EditedObjects(objects, unwrap_settings(chosen)), pack_settings(chosen)
        except object_errors() as error:
            return conclude(self, [], {}, {objects[0].name: error})
        self._typed = TypedNumber()
        return self._start(context, event, edited)

    def _handle(self, event: bpy.types.Event) -> set[str]:
        if event.type in WHEEL:
            return self._turn(event)
        if event.type == "LEFTMOUSE":
            return self._click(event)
        if event.type in ENTER and event.value == "PRESS":
            self._typed.clear()
            self._draw()
        elif event.value == "PRESS":
            self._type(event)
        return {"RUNNING_MODAL"}

    def _may_finish(self) -> bool:
        # It ends the typing first.
        return not self._typed.text

    # Events

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
        cone = self._cone()
        pick = cone if cone is not None or event.ctrl else self._vertex()
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
        super()._drag(dragging)
        if self._objects.active is not None:
            self._objects.active.follower.drag(dragging)

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
            pick = self._cone()
            if pick is None or not self._begin(pick[0]):
                return {"PASS_THROUGH"}
            pick[0].session.cones.active = pick[1].vertex
        self._typed.clear()
        self._objects.history.begin("Change Angle")
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
        if event.type in {"Z", "Y"}:
            self._typed.clear()
        super()._go_back(event)

    def _changed(self) -> None:
        """To be called after a change of the active object's cones."""
        self._objects.active.follower.outdated = True
        self._draw([self._objects.active])

    def _follow(self) -> None:
        """Move the dragged cone to the cursor, and let the map follow."""
        active, moved = self._objects.active, False
        if self._dragging and self._moved:
            pick = self._vertex()
            moved = pick is not None and pick[0] is active and active.session.cones.move(pick[1].vertex)
            active.follower.outdated |= moved
        self._moved = False
        shown = self._objects.follow()
        # While the map is late, at least the cone is drawn at the cursor.
        if moved and active not in shown:
            shown.append(active)
        if shown:
            self._draw(shown)

    def _vertex(self) -> Pick | None:
        """The vertex under the cursor, and its object; None where there is no face."""
        seen = self._cursor.sight()
        return None if seen is None else self._objects.vertex_at(seen[0], *seen[1])

    def _cone(self) -> Pick | None:
        """The visible cone at the cursor, and its object; None where there is none."""
        seen = self._cursor.sight()
        return None if seen is None else self._objects.cone_at(seen[0], *seen[1], self._cursor.radius())

    # What is shown

    def _draw(self, objects: Iterable[EditedObject] = ()) -> None:
        """objects: those whose cones or maps have changed."""
        for edited in objects:
            cache.show(edited.obj, session_content(edited.obj, edited.session))
        history = self._objects.history
        self._show(self._header(), hints.hints(history.undoes, history.redoes))

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
