# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that run until an event ends them.

Blender drops those of a class that is unregistered without telling them: the add-on ends them before.
"""

from __future__ import annotations

from contextlib import suppress

import bpy

_running: list[bpy.types.Operator] = []


def began(operator: bpy.types.Operator) -> None:
    _running.append(operator)


def ended(operator: bpy.types.Operator) -> None:
    _running[:] = [other for other in _running if other is not operator]


def end_all(context: bpy.types.Context) -> None:
    """As Esc does."""
    for operator in list(_running):
        # One that ended with an exception is no longer there.
        with suppress(ReferenceError):
            operator.cancel(context)
    _running.clear()
