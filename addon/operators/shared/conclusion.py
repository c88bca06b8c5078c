# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of several objects in Blender's reports: counts, reasons, and what to do."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import bpy

from ...core.errors import object_errors
from ...core.findings import Severity, in_groups

T = TypeVar("T")

NO_CUTS = "No visible edge is cut in the UV map; unwrap the mesh first"


def for_each(
    objects: Iterable[bpy.types.Object], work: Callable[[bpy.types.Object], T]
) -> tuple[list[tuple[bpy.types.Object, T]], dict[str, Exception]]:
    """Each object with the result of work(object); and by object name the errors of those without a result."""
    results, failures = [], {}
    for obj in objects:
        try:
            results.append((obj, work(obj)))
        except object_errors() as error:
            failures[obj.name] = error
    return results, failures


def conclude(
    operator: bpy.types.Operator,
    done: list[str],
    warnings: dict[str, list[Any]],
    failures: dict[str, Any],
) -> set[str]:
    """Report, and return the operator's status: FINISHED where at least one object was changed, else CANCELLED.

    done: one phrase for each changed object. warnings, failures: by object name. Where other objects were changed, a
    failure is reported as a warning, because an error report makes Python callers believe that nothing was done.
    """
    lines = in_groups({name: [*warnings.get(name, ()), *_listed(failures, name)] for name in {**warnings, **failures}})
    # The status bar shows the last report, so the most important ones come last.
    for severity, text in lines:
        if severity == Severity.INFORMATION:
            operator.report({"INFO"}, text)
    if done:
        operator.report({"INFO"}, "; ".join(done))
    for severity, text in lines:
        if severity != Severity.INFORMATION:
            operator.report({"ERROR"} if severity == Severity.BROKEN and not done else {"WARNING"}, text)
    return {"FINISHED"} if done else {"CANCELLED"}


def _listed(failures: dict[str, Any], name: str) -> list[Any]:
    return [failures[name]] if name in failures else []


def say_selected(operator: bpy.types.Operator, visible: int, total: int, what: str) -> None:
    """Report how many elements were selected and how many are hidden.  what: "1 cone", "8 cones"."""
    hidden = f"; {total - visible} more hidden" if visible < total else ""
    operator.report({"INFO"}, f"Selected {what}{hidden}")
