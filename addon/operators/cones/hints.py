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


ALWAYS = (
    Hint("Click", ("MOUSE_LMB",), "Add"),
    Hint("Drag", ("MOUSE_LMB_DRAG",), "Move"),
    Hint("Ctrl-Click", ("EVENT_CTRL", "MOUSE_LMB"), "Remove"),
    Hint("Wheel", ("MOUSE_MMB_SCROLL",), "Angle"),
    Hint("Shift", ("EVENT_SHIFT",), "Fine"),
    Hint("Digits", ("EVENT_ZEROKEY", "EVENT_NINEKEY"), "Degrees"),
    Hint("A", ("EVENT_A",), "Automatic"),
)
ENDING = (
    Hint("Enter", ("EVENT_RETURN",), "Confirm"),
    Hint("Esc, Right Click", ("EVENT_ESC", "MOUSE_RMB"), "Cancel"),
)
UNDO, REDO = ("EVENT_CTRL", "EVENT_Z"), ("EVENT_CTRL", "EVENT_SHIFT", "EVENT_Z")


def hints(undoes: str | None, redoes: str | None) -> list[Hint]:
    """Those for Edit Cones.  undoes, redoes: names of the steps that can be; None for none."""
    steps = []
    if undoes is not None:
        steps.append(Hint("Ctrl-Z", UNDO, f"Undo {undoes}"))
    if redoes is not None:
        steps.append(Hint("Ctrl-Shift-Z", REDO, f"Redo {redoes}"))
    return [*ALWAYS, *steps, *ENDING]


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
