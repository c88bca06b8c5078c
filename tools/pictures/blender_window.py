# SPDX-License-Identifier: GPL-3.0-or-later
"""Helpers of programs in Blender's window: its areas, and steps between which Blender draws."""

from __future__ import annotations

import os
import subprocess
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path

import bpy

WAIT = 0.6  # seconds for Blender to draw


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def areas(kind: str) -> list[bpy.types.Area]:
    return [area for area in window().screen.areas if area.type == kind]


def region_of(area: bpy.types.Area) -> bpy.types.Region:
    return next(region for region in area.regions if region.type == "WINDOW")


def inside(area: bpy.types.Area):
    """The context of an area, which timers lack."""
    return bpy.context.temp_override(window=window(), area=area, region=region_of(area))


def close_areas(*kinds: str) -> None:
    for area in [area for kind in kinds for area in areas(kind)]:
        with inside(area):
            bpy.ops.screen.area_close()


def arrange(uv_share: float) -> Iterator[float]:
    """A UV editor on the left, as wide as this share, a 3D view beside it; yields seconds to wait."""
    close_areas("TIMELINE", "DOPESHEET_EDITOR")
    yield WAIT
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=uv_share)
    yield WAIT
    editor = min(areas("VIEW_3D"), key=lambda area: area.x)
    editor.ui_type = "UV"
    bpy.context.tool_settings.use_uv_select_sync = False
    yield WAIT


def open_tab(view: bpy.types.Area) -> None:
    """That of the extension in the sidebar, which has to have been drawn before."""
    for region in view.regions:
        if region.type == "UI":
            region.active_panel_category = "Cone Unwrap"


def look_from_a_side() -> None:
    """The whole mesh from the front, somewhat to the right and above; in the context of a 3D view."""
    bpy.ops.view3d.view_axis(type="FRONT")
    bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
    bpy.ops.view3d.view_orbit(angle=0.4, type="ORBITUP")
    bpy.ops.view3d.view_all()


def take_picture(path: Path) -> None:
    """Write what the screen shows: Blender's own screenshot is black on a virtual one."""
    palette = ["+dither", "-colors", "255"]  # makes a third of the file
    subprocess.run(["import", "-window", "root", *palette, f"PNG8:{path}"], check=True)


def run(steps: Iterator[float]) -> None:
    """Run these steps, which yield seconds to wait, and quit Blender after the last one."""

    def step() -> float:
        status = 0
        try:
            return next(steps)
        except StopIteration:
            pass
        except Exception:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        os._exit(status)

    bpy.app.timers.register(step, first_interval=2 * WAIT, persistent=True)
