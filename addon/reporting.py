# SPDX-License-Identifier: GPL-3.0-or-later
"""What happened to several objects, told in Blender's reports: counts, the reason, and what to do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

if TYPE_CHECKING:
    import lsgp


class Refused(Exception):
    """An object that cannot be worked on; the message ends with what to do."""


def counted(number: int, noun: str, several: str | None = None) -> str:
    """Number and noun: "1 cone", "8 cones", "2 meshes"."""
    return f"{number} {noun}" if number == 1 else f"{number} {several or noun + 's'}"


def explain(error: lsgp.LsgpError | lsgp.Finding | Refused | MemoryError) -> str:
    """The library's sentence, its code, and how many elements it concerns."""
    if isinstance(error, MemoryError):
        return "there is not enough memory; unwrap fewer faces at once"
    if isinstance(error, Refused):
        return str(error)
    size = len(error.elements.indices)
    noun = {"vertices": "vertex"}.get(error.elements.kind, error.elements.kind.removesuffix("s"))
    concerned = f", {counted(size, noun, error.elements.kind)}" if size else ""
    return f"{error.message} [{error.code}{concerned}]"


def conclude(
    operator: bpy.types.Operator,
    done: list[str],
    warnings: dict[str, list[Any]],
    failures: dict[str, Any],
) -> set[str]:
    """Report and return the operator's status: FINISHED where at least one object was done, CANCELLED otherwise.

    done: one phrase for each object that was changed. warnings, failures: by object name.
    A failure beside successes is a warning, because an error report makes Python callers believe that nothing was done.
    """
    if done:
        operator.report({"INFO"}, "; ".join(done))
    # The status bar shows the last report: the most important comes last.
    for name, findings in warnings.items():
        for finding in findings:
            operator.report({"WARNING"}, f"{name}: {explain(finding)}")
    for name, error in failures.items():
        operator.report({"WARNING"} if done else {"ERROR"}, f"{name}: {explain(error)}")
    return {"FINISHED"} if done else {"CANCELLED"}
