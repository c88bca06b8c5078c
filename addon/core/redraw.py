# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks Blender to redraw what shows the add-on's state, where Blender cannot know that it changed."""

import bpy


def views() -> None:
    """All 3D views and UV editors, including their sidebars."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "IMAGE_EDITOR"}:
                area.tag_redraw()
