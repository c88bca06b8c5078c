# SPDX-License-Identifier: GPL-3.0-or-later
"""What mouse and keys do in Edit Cones."""

from __future__ import annotations

from ..shared.status_bar import Hint, with_steps

ALWAYS = (
    Hint("Click", ("MOUSE_LMB",), "Add"),
    Hint("Drag", ("MOUSE_LMB_DRAG",), "Move"),
    Hint("Ctrl-Click", ("EVENT_CTRL", "MOUSE_LMB"), "Remove"),
    Hint("Wheel", ("MOUSE_MMB_SCROLL",), "Angle"),
    Hint("Shift", ("EVENT_SHIFT",), "Fine"),
    Hint("Digits", ("EVENT_ZEROKEY", "EVENT_NINEKEY"), "Degrees"),
    Hint("A", ("EVENT_A",), "Automatic"),
)


def hints(undoes: str | None, redoes: str | None) -> list[Hint]:
    """undoes, redoes: names of the steps that can be; None for none."""
    return with_steps(ALWAYS, undoes, redoes)
