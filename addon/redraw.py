# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks Blender to draw what shows our state, where it would not by itself."""

import bpy


def views() -> None:
    """All 3D views and UV editors, with their sidebars."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "IMAGE_EDITOR"}:
                area.tag_redraw()
