# SPDX-License-Identifier: GPL-3.0-or-later
"""Hides the gizmos that Blender shows for the active tool and the selection; navigation gizmos stay.

A tool that takes clicks on the model could not tell them from those on such a gizmo, which Python cannot ask for.
"""

from __future__ import annotations

from typing import Any

import bpy

from .views import view_areas


class HiddenGizmos:
    """Hidden in all views until `show`, but not in files that are saved meanwhile."""

    def __init__(self) -> None:
        # Names of settings that were on, by view.
        self._hidden: dict[int, list[str]] = {}
        self.hide()
        bpy.app.handlers.save_pre.append(self.show)
        bpy.app.handlers.save_post.append(self.hide)

    @bpy.app.handlers.persistent
    def hide(self, *_: Any) -> None:
        for space in (area.spaces.active for area in view_areas()):
            on = [name for name in _settings(space) if getattr(space, name)]
            self._hidden[space.as_pointer()] = on
            _switch(space, on, False)

    @bpy.app.handlers.persistent
    def show(self, *_: Any) -> None:
        for space in (area.spaces.active for area in view_areas()):
            # A view that was split off since is as the one that it was split off from.
            _switch(space, self._hidden.get(space.as_pointer(), _settings(space)), True)

    def end(self) -> None:
        self.show()
        bpy.app.handlers.save_pre.remove(self.show)
        bpy.app.handlers.save_post.remove(self.hide)


def _settings(space: bpy.types.Space) -> tuple[str, ...]:
    """The settings of a view that show them."""
    if space.type == "VIEW_3D":
        return "show_gizmo_tool", "show_gizmo_context"
    # UV editors have one for all, navigation included.
    # Files are also saved without a window, as from Blender's timers.
    window = bpy.context.window or bpy.context.window_manager.windows[0]
    tool = window.workspace.tools.from_space_image_mode("UV")
    return ("show_gizmo",) if tool is not None and tool.widget else ()


def _switch(space: bpy.types.Space, names: list[str] | tuple[str, ...], on: bool) -> None:
    for name in names:
        setattr(space, name, on)
