# SPDX-License-Identifier: GPL-3.0-or-later
"""Which view is under the mouse, and what lies over views: headers, sidebars, the redo panel, the navigation gizmo."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

# Sizes in Blender's sources, at a scale of 1.
BALL_MARGIN = 10
BUTTON, BUTTON_GAP = 28, 2
WIDGET_UNIT = 20
# Zoom, pan, camera, perspective.
BUTTONS = 4
LOCKED_BUTTONS = 2
# How far two borders may be apart and still count as one.
SAME_BORDER = 2


@dataclass(frozen=True, slots=True)
class View:
    """A view under the mouse.  place: of the mouse, in pixels from the view's lower left corner."""

    area: bpy.types.Area
    region: bpy.types.Region
    place: tuple[int, int]


def view_at(window: bpy.types.Window, x: int, y: int) -> View | None:
    """The 3D view or UV editor under a pixel of a window; None where that shows anything else."""
    area = next((area for area in window.screen.areas if _is_inside(area, x, y)), None)
    if area is None or not shows_meshes(area.spaces.active):
        return None
    under = [region for region in area.regions if _is_inside(region, x, y)]
    if len(under) != 1 or under[0].type != "WINDOW" or _is_on_gizmo(area, under[0], x, y):
        return None
    return View(area, under[0], (x - under[0].x, y - under[0].y))


def shows_meshes(space: bpy.types.Space) -> bool:
    """Whether it is a 3D view, or a UV editor."""
    return space.type == "VIEW_3D" or (space.type == "IMAGE_EDITOR" and space.show_uvedit)


def show_layouts(context: bpy.types.Context) -> None:
    """Have the UV editors of the window show all that is selected in them."""
    if bpy.app.background or context.window is None:
        return
    for area in context.window.screen.areas:
        if area.type != "IMAGE_EDITOR" or not area.spaces.active.show_uvedit:
            continue
        region = next(region for region in area.regions if region.type == "WINDOW")
        with context.temp_override(window=context.window, area=area, region=region):
            if bpy.ops.image.view_selected.poll():
                bpy.ops.image.view_selected()


def view_areas() -> Iterator[bpy.types.Area]:
    """The 3D views and image editors of all screens, also those that are not shown."""
    return (area for screen in bpy.data.screens for area in screen.areas if area.type in {"VIEW_3D", "IMAGE_EDITOR"})


def _is_inside(part: bpy.types.Area | bpy.types.Region, x: int, y: int) -> bool:
    # Hidden regions are one pixel wide or high.
    return min(part.width, part.height) > 1 and 0 <= x - part.x < part.width and 0 <= y - part.y < part.height


def _is_on_gizmo(area: bpy.types.Area, region: bpy.types.Region, x: int, y: int) -> bool:
    """Whether a pixel of a view is on the ball or one of the buttons that turn and move it."""
    space, look = area.spaces.active, bpy.context.preferences.view
    if not (space.show_gizmo and space.show_gizmo_navigate):
        return False
    system = bpy.context.preferences.system
    # UV editors and other views, as those of a quad view, can only be zoomed and panned.
    turns = space.type == "VIEW_3D" and not region.data.lock_rotation
    right, top = _free_corner(area, region)
    ball = (look.gizmo_size_navigate_v3d + 2 * BALL_MARGIN) * system.ui_scale
    shown = look.mini_axis_type if turns else "NONE"
    if shown == "GIZMO" and x >= right - ball and y >= top - ball:
        return True
    side = (BUTTON + BUTTON_GAP) * system.ui_scale
    # Down to the middle of the first button.
    above = {
        "GIZMO": 1.05 * ball,
        "MINIMAL": 2.5 * WIDGET_UNIT * system.ui_scale + 2 * look.mini_axis_size * system.pixel_size,
        "NONE": 0.75 * side,
    }[shown]
    lowest = top - above - ((BUTTONS if turns else LOCKED_BUTTONS) - 0.25) * side
    return look.show_navigate_ui and x >= right - 1.25 * side and lowest <= y <= top - above + 0.5 * side


def _free_corner(area: bpy.types.Area, region: bpy.types.Region) -> tuple[int, int]:
    """Right and top of the part of a view that no sidebar or header at its borders is over."""
    right, top = region.x + region.width, region.y + region.height
    for over in area.regions:
        if min(over.width, over.height) <= 1:
            continue
        if over.alignment == "RIGHT" and abs(over.x + over.width - right) < SAME_BORDER:
            right = over.x
        elif over.alignment == "TOP" and abs(over.y + over.height - top) < SAME_BORDER:
            top = over.y
    return right, top
