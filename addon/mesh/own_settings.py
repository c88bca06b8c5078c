# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist last chose for an object; saved with the file."""

from __future__ import annotations

import json
from typing import Any

import bpy


def own_settings(obj: bpy.types.Object) -> dict[str, Any]:
    """The properties of Auto Unwrap that were chosen when the object was unwrapped last; none before."""
    try:
        kept = json.loads(obj.cone_unwrap_settings or "{}")
    except ValueError:
        return {}
    return kept if isinstance(kept, dict) else {}


def keep_settings(obj: bpy.types.Object, chosen: dict[str, Any]) -> None:
    """Nothing on an object that belongs to another file."""
    if obj.is_editable:
        obj.cone_unwrap_settings = json.dumps(chosen)


def forget_settings(obj: bpy.types.Object) -> bool:
    """Returns whether there were any."""
    present = bool(obj.cone_unwrap_settings)
    obj.property_unset("cone_unwrap_settings")
    return present


def register() -> None:
    bpy.types.Object.cone_unwrap_settings = bpy.props.StringProperty(
        name="Cone Unwrap Settings", description="What was chosen for the last Auto Unwrap", options={"HIDDEN"}
    )


def unregister() -> None:
    del bpy.types.Object.cone_unwrap_settings
