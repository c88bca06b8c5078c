# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds and removes the draw handlers of the overlay."""

from __future__ import annotations

import bpy

from . import cache, settings, uv_editor, view3d

_handlers: list[tuple[type[bpy.types.Space], object]] = []


def register() -> None:
    settings.register()
    # There is nothing to draw on without a window.
    if bpy.app.background:
        return
    for space, draw, when in (
        (bpy.types.SpaceView3D, view3d.draw_in_scene, "POST_VIEW"),
        (bpy.types.SpaceView3D, view3d.draw_on_top, "POST_PIXEL"),
        (bpy.types.SpaceImageEditor, uv_editor.draw, "POST_PIXEL"),
    ):
        _handlers.append((space, space.draw_handler_add(draw, (), "WINDOW", when)))


def unregister() -> None:
    for space, handler in _handlers:
        space.draw_handler_remove(handler, "WINDOW")
    _handlers.clear()
    cache.clear()
    settings.unregister()
