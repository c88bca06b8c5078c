# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets of operators that the extension brings; they are listed with the artist's own."""

from pathlib import Path

import bpy

FOLDER = str(Path(__file__).resolve().parents[1])

# Blender has it since 4.3; in 4.2 only the artist's own presets are listed.
AVAILABLE = hasattr(bpy.utils, "register_preset_path")


def register() -> None:
    if AVAILABLE:
        bpy.utils.register_preset_path(FOLDER)


def unregister() -> None:
    if AVAILABLE:
        bpy.utils.unregister_preset_path(FOLDER)
