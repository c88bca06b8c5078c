# SPDX-License-Identifier: GPL-3.0-or-later
"""What mouse and keys do, for the status bar: with icons where this Blender has them all, and otherwise as a text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bpy


@dataclass(frozen=True, slots=True)
class Hint:
    """keys: in words. icons: the same keys as Blender's icons. text: what they do."""

    keys: str
    icons: tuple[str, ...]
    text: str


ENDING = (
    Hint("Enter", ("EVENT_RETURN",), "Confirm"),
    Hint("Esc, Right Click", ("EVENT_ESC", "MOUSE_RMB"), "Cancel"),
)
UNDO, REDO = ("EVENT_CTRL", "EVENT_Z"), ("EVENT_CTRL", "EVENT_SHIFT", "EVENT_Z")


def with_steps(always: Sequence[Hint], undoes: str | None, redoes: str | None) -> list[Hint]:
    """Those of a tool, the steps that can be undone and redone, None for none, and how the tool ends."""
    steps = []
    if undoes is not None:
        steps.append(Hint("Ctrl-Z", UNDO, f"Undo {undoes}"))
    if redoes is not None:
        steps.append(Hint("Ctrl-Shift-Z", REDO, f"Redo {redoes}"))
    return [*always, *steps, *ENDING]


def clear_status(context: bpy.types.Context) -> None:
    """Let the status bar be Blender's again, also where the context has no window."""
    for workspace in bpy.data.workspaces:
        with context.temp_override(workspace=workspace):
            workspace.status_text_set(None)


def status(shown: Sequence[Hint]) -> str | Callable[[bpy.types.Header, bpy.types.Context], None]:
    """The hints as `WorkSpace.status_text_set` takes them."""
    known = bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items
    if not all(icon in known for hint in shown for icon in hint.icons):
        return "  |  ".join(f"{hint.keys}: {hint.text}" for hint in shown)

    def draw(header: bpy.types.Header, _context: bpy.types.Context) -> None:
        layout = header.layout
        for hint in shown:
            for icon in hint.icons[:-1]:
                layout.label(text="", icon=icon)
            layout.label(text=hint.text, icon=hint.icons[-1])
        # The rest is as Blender has it.
        layout.separator_spacer()
        layout.template_reports_banner()
        layout.template_running_jobs()

    return draw
