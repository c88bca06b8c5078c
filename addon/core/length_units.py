# SPDX-License-Identifier: GPL-3.0-or-later
"""The unit in which a scene shows lengths."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

# Short name and meters by Blender's name. What is adaptive is shown in meters or feet.
_UNITS = {
    "KILOMETERS": ("km", 1000.0),
    "METERS": ("m", 1.0),
    "CENTIMETERS": ("cm", 0.01),
    "MILLIMETERS": ("mm", 0.001),
    "MICROMETERS": ("µm", 1e-6),
    "MILES": ("mi", 1609.344),
    "FEET": ("ft", 0.3048),
    "INCHES": ("in", 0.0254),
    "THOU": ("thou", 0.0254e-3),
}


@dataclass(frozen=True, slots=True)
class LengthUnit:
    """name: short, as in "px/m". size: in Blender's own units of length."""

    name: str
    size: float


def length_unit(scene: bpy.types.Scene) -> LengthUnit:
    """The unit that the scene's settings ask for; Blender's own where they ask for none."""
    settings = scene.unit_settings
    if settings.system == "NONE":
        return LengthUnit("unit", 1.0)
    usual = "FEET" if settings.system == "IMPERIAL" else "METERS"
    name, meters = _UNITS.get(settings.length_unit, _UNITS[usual])
    return LengthUnit(name, meters / settings.scale_length)
