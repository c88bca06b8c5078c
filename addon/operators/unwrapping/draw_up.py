# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw Texture Up."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ...core import identifiers
from ...core.errors import object_errors
from ...core.text import counted
from ...jobs.sessions.drawn_on import DrawnObject, DrawnObjects
from ...mesh.targets import target_objects
from ...overlay import cache
from ...overlay.content import Content, with_directions
from ..shared.conclusion import conclude
from ..shared.modal_edit import ModalEdit
from ..shared.status_bar import Hint, with_steps

HINTS = (
    Hint("Drag", ("MOUSE_LMB_DRAG",), "Draw"),
    Hint("Ctrl-Drag", ("EVENT_CTRL", "MOUSE_LMB_DRAG"), "Erase"),
)


class MESH_OT_cone_draw_up(ModalEdit, bpy.types.Operator):
    """Passes events on to `DrawnObjects`."""

    bl_idname = identifiers.DRAW_UP
    bl_label = "Draw Texture Up"
    bl_description = (
        "Draw strokes on the mesh along which the texture's upward direction is to run. Unwrapping with Texture Up at "
        "Automatic rotates islands accordingly"
    )
    bl_options = {"UNDO"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        objects = target_objects(context)
        try:
            edited = DrawnObjects(objects)
        except object_errors() as error:
            return conclude(self, [], {}, {objects[0].name: error})
        # What the strokes are drawn over stays the same.
        self._contents: dict[int, Content] = {}
        return self._start(context, event, edited)

    def _click(self, event: bpy.types.Event) -> set[str]:
        if event.value == "RELEASE":
            if not self._dragging:
                # A button was pressed elsewhere.
                return {"PASS_THROUGH"}
            self._follow()
            self._drag(False)
            self._draw()
        elif event.value in {"PRESS", "DOUBLE_CLICK"}:
            seen = self._cursor.sight()
            if seen is not None and not seen[0].layout:
                self._objects.begin_stroke(*seen, erases=event.ctrl or event.oskey)
                self._drag(True)
                self._draw(self._objects.begun)
        return {"RUNNING_MODAL"}

    def _follow(self) -> None:
        """Draw on to the cursor."""
        if not (self._moved and self._dragging):
            return
        self._moved = False
        seen = self._cursor.sight()
        if seen is not None and not seen[0].layout:
            self._objects.draw_to(*seen)
            self._draw(self._objects.begun)

    # What is shown

    def _draw(self, objects: Iterable[DrawnObject] = ()) -> None:
        """objects: those whose directions may have changed."""
        for edited in objects:
            session = edited.session
            if edited.uid not in self._contents:
                self._contents[edited.uid] = cache.entry(edited.obj).content
            content = self._contents[edited.uid]
            cache.show(edited.obj, with_directions(content, session.mesh, session.directions))
        history = self._objects.history
        faces = sum(len(edited.session.directions) for edited in self._objects.begun)
        header = f"Draw Texture Up: {counted(faces, 'face')} with a direction"
        self._show(header, with_steps(HINTS, history.undoes, history.redoes))

    # Ending

    def _finish(self, context: bpy.types.Context) -> set[str]:
        changed = self._objects.changed
        if not changed:
            self.cancel(context)
            return {"CANCELLED"}
        self._objects.store()
        done = [
            f"{edited.name}: {counted(len(edited.session.directions), 'face')} with a direction" for edited in changed
        ]
        self._end(context)
        return conclude(self, done, {}, {})
