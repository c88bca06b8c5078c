# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cuts."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ...core import findings, identifiers
from ...core.errors import object_errors
from ...core.text import counted
from ...jobs.sessions.edited_cuts import CutObject, CutObjects, Pick
from ...mesh.targets import target_objects
from ...overlay import cache
from ...overlay.content import cuts_content
from ..shared.conclusion import conclude
from ..shared.cut_choices import chosen_cuts
from ..shared.modal_edit import ModalEdit
from ..shared.status_bar import Hint, with_steps

HINTS = (Hint("Drag", ("MOUSE_LMB_DRAG",), "Move Cut"),)


class MESH_OT_cone_edit_cuts(ModalEdit, bpy.types.Operator):
    """Passes events on to `CutObjects`."""

    bl_idname = identifiers.EDIT_CUTS
    bl_label = "Edit Cuts"
    bl_description = (
        "Drag cuts of the UV map with the mouse: faces that a cut passes move to its other side without changing their "
        "shape. Cuts run as preferred by Cuts of the last Unwrap from Cones and by painted costs, in front as well"
    )
    bl_options = {"UNDO"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        objects = target_objects(context)
        try:
            chosen = context.window_manager.operator_properties_last(identifiers.UNWRAP)
            edited = CutObjects(objects, chosen_cuts(chosen.cuts))
        except object_errors() as error:
            return conclude(self, [], {}, {objects[0].name: error})
        return self._start(context, event, edited)

    def _click(self, event: bpy.types.Event) -> set[str]:
        if event.value == "RELEASE":
            if not self._dragging:
                # A button was pressed elsewhere.
                return {"PASS_THROUGH"}
            held = self._objects.held
            self._drag(False)
            self._draw([] if held is None else [held])
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            pick = self._cut()
            if pick is not None:
                self._grab(pick)
        return {"RUNNING_MODAL"}

    def _grab(self, pick: Pick) -> None:
        self._objects.history.begin("Move Cut")
        try:
            self._objects.grab(pick)
            self._refusal = ""
            self._drag(True)
        except object_errors() as error:
            self._refusal = f"{pick[0].name}: {findings.explain(error)}"
        self._draw([pick[0]])

    def _drag(self, dragging: bool) -> None:
        super()._drag(dragging)
        if not dragging:
            self._refusal = ""
            self._objects.drop()

    def _follow(self) -> None:
        """Move the cut that is held to the cursor, or show which one would be held."""
        if not self._moved:
            return
        self._moved = False
        if not self._dragging:
            shown = self._objects.highlight(self._cut())
            if shown:
                self._draw(shown)
            return
        seen, held = self._cursor.sight(), self._objects.held
        pick = None if seen is None else self._objects.vertex_at(seen[0], *seen[1])
        if pick is None or pick[0] is not held:
            return
        before = self._refusal
        try:
            moved = held.session.drag(pick[1].vertex)
            if moved:
                self._refusal = ""
        except object_errors() as error:
            moved, self._refusal = False, findings.explain(error)
        if moved or self._refusal != before:
            self._draw([held] if moved else [])

    def _cut(self) -> Pick | None:
        """The visible cut at the cursor, and its object; None where there is none."""
        seen = self._cursor.sight()
        return None if seen is None else self._objects.cut_at(*seen, self._cursor.radius())

    # What is shown

    def _draw(self, objects: Iterable[CutObject] = ()) -> None:
        """objects: those whose cuts have changed."""
        for edited in objects:
            cache.show(edited.obj, cuts_content(edited.obj, edited.session, edited.drawn))
        history = self._objects.history
        self._show(self._header(), with_steps(HINTS, history.undoes, history.redoes))

    def _header(self) -> str:
        sessions = [edited.session for edited in self._objects.begun]
        texts = [f"Edit Cuts: {counted(sum(len(session.paths) for session in sessions), 'cut')}"]
        overlapping = sum(len(session.overlapping) for session in sessions)
        if overlapping:
            texts.append(f"{counted(overlapping, 'overlapping face')} in the UV map")
        if any(session.leaves_tile for session in sessions):
            texts.append("The UV map leaves its tile; pack it afterward")
        texts += [f"{name}: {findings.explain(error)}" for name, error in self._objects.failures.items()]
        return "  |  ".join(text for text in (*texts, self._refusal) if text)

    # Ending

    def _finish(self, context: bpy.types.Context) -> set[str]:
        self._drag(False)
        changed = self._objects.changed
        if not changed:
            self.cancel(context)
            return {"CANCELLED"}
        self._objects.store()
        done = [f"{edited.name}: moved {counted(edited.session.moved_count, 'cut')}" for edited in changed]
        self._end(context)
        return conclude(self, done, {}, {})
