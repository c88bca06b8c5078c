# SPDX-License-Identifier: GPL-3.0-or-later
"""Long computations of an operator that is redone with other properties, with progress and Esc.

Blender redoes an operator in one go: it undoes it, executes it with its new properties, and brings back what it undid
where the operator does not finish. So an operator that would take long starts its computation and does not finish.
Blender has the earlier result and goes on; when the computation is over, the operator is redone once more and finishes
with what was computed. Whatever else is done meanwhile stops the computation.
"""

from __future__ import annotations

from typing import Any

import bpy

from ...core import identifiers
from ...jobs.tasks.computation import Computation
from .progress import ShownProgress


class _Waiting:
    """A redone operator whose computation goes on.

    work: as the operator gave it to `wait`. last: identifies it among Blender's operators.
    """

    def __init__(
        self, context: bpy.types.Context, operator: bpy.types.Operator, computation: Computation[Any], work: Any
    ) -> None:
        self.idname, self.activity = operator.bl_idname, operator.activity
        self.computation, self.work = computation, work
        self.last = last_operator(context)
        self.shown = ShownProgress(context, operator.activity, computation)


_waiting: _Waiting | None = None
# What the next redo takes instead of computing it.
_computed: Any = None
# Whether Blender has undone something and done nothing since.
_just_undone = False
# Properties that each operator last finished with, by its identifier.
_finished: dict[str, dict[str, Any]] = {}


def is_redone(operator: bpy.types.Operator) -> bool:
    """Whether it is executed because its properties were changed, and not only repeated, before which nothing is
    undone."""
    return _just_undone and operator.options.is_repeat and bpy.context.window is not None


def take_computed() -> Any | None:
    """The work given to `wait` by the operator that is now redone once more; None where it is redone at first."""
    return _computed


def wait(operator: bpy.types.Operator, computation: Computation[Any], work: Any) -> None:
    """Show progress, and have the operator redone when the computation is over."""
    global _waiting
    _waiting = _Waiting(bpy.context, operator, computation, work)
    namespace, name = identifiers.WAIT_FOR_REDO.split(".")
    getattr(getattr(bpy.ops, namespace), name)("INVOKE_DEFAULT")


def remember_finished(operator: bpy.types.Operator) -> None:
    """Keep its properties, which are those of the result until another redo has finished."""
    properties = operator.properties
    names = [prop.identifier for prop in properties.bl_rna.properties if not prop.is_readonly]
    _finished[operator.bl_idname] = {name: getattr(properties, name) for name in names}


def last_operator(context: bpy.types.Context) -> int:
    """Identifies the operator that ran last; 0 for none."""
    operators = context.window_manager.operators
    return operators[-1].as_pointer() if operators else 0


class UV_OT_cone_wait_for_redo(bpy.types.Operator):
    """Lets all events through but Esc."""

    bl_idname = identifiers.WAIT_FOR_REDO
    bl_label = "Wait for Redo"
    bl_description = "Show the progress of an operator that is redone, and let Esc stop it"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        return _waiting is not None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self._waiting = _waiting
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        waiting = self._waiting
        if waiting is not _waiting:
            return {"CANCELLED", "PASS_THROUGH"}
        if last_operator(context) != waiting.last:
            _stop()
            return {"CANCELLED", "PASS_THROUGH"}
        if event.type == "ESC" and event.value == "PRESS":
            _stop()
            _restore_properties(context, waiting)
            self.report({"INFO"}, f"{waiting.activity} was stopped; nothing was changed")
            return {"CANCELLED"}
        if event.type == "TIMER":
            if waiting.computation.finished():
                _stop()
                _redo_with(waiting.work)
                return {"FINISHED"}
            waiting.shown.update(context)
        return {"PASS_THROUGH"}

    def cancel(self, _context: bpy.types.Context) -> None:
        """Called by Blender, for example before another file is opened."""
        if self._waiting is _waiting:
            _stop()


def _stop() -> None:
    global _waiting
    if _waiting is not None:
        _waiting.computation.stop()
        _waiting.shown.end(bpy.context)
        _waiting = None


def _redo_with(work: Any) -> None:
    global _computed
    _computed = work
    try:
        # With undo: otherwise Blender would keep the result without a step for it.
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    finally:
        _computed = None


def _restore_properties(context: bpy.types.Context, waiting: _Waiting) -> None:
    """Let the panel show what the present result was made with."""
    operator = context.window_manager.operators[-1]
    for name, value in _finished.get(waiting.idname, {}).items():
        if getattr(operator.properties, name) != value:
            setattr(operator.properties, name, value)
    for area in context.screen.areas:
        area.tag_redraw()


@bpy.app.handlers.persistent
def _notice_undo(*_: Any) -> None:
    global _just_undone
    _stop()
    _just_undone = True
    # Blender calls it before it handles the next event.
    bpy.app.timers.register(_forget_undo)


def _forget_undo() -> None:
    global _just_undone
    _just_undone = False


def register() -> None:
    bpy.utils.register_class(UV_OT_cone_wait_for_redo)
    bpy.app.handlers.undo_post.append(_notice_undo)


def unregister() -> None:
    bpy.app.handlers.undo_post.remove(_notice_undo)
    if bpy.app.timers.is_registered(_forget_undo):
        bpy.app.timers.unregister(_forget_undo)
    _forget_undo()
    _stop()
    _finished.clear()
    bpy.utils.unregister_class(UV_OT_cone_wait_for_redo)
