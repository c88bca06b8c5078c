# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of the guide that shows Blender's window: a head with its overlay, its UV map and the sidebar.

    blender --factory-startup --window-geometry 0 0 1500 860 --python tools/guide_window.py -- --extension ZIP --out OUT

BLENDER_USER_RESOURCES must name a throw-away profile. Leaves OUT/guide-window.png; without a screen run it under
xvfb-run with LIBGL_ALWAYS_SOFTWARE=1.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import demo_scene

WAIT = 0.6  # seconds for Blender to draw


def areas(kind: str) -> list[bpy.types.Area]:
    screen = bpy.context.window_manager.windows[0].screen
    return [area for area in screen.areas if area.type == kind]


def inside(area: bpy.types.Area, region: str = "WINDOW"):
    """The context of an area, which Blender's timers do not have."""
    window = bpy.context.window_manager.windows[0]
    return bpy.context.temp_override(window=window, area=area, region=next(r for r in area.regions if r.type == region))


def show(out: Path) -> Iterator[float]:
    """Unwrap, arrange the window, write the picture; yields seconds to wait."""
    view = areas("VIEW_3D")[0]
    with inside(view):
        head = demo_scene.add_suzanne(subdivisions=1)
        demo_scene.run_in_edit_mode(head, bpy.ops.mesh.cone_place, automatic=False, count=8)
        demo_scene.run_in_edit_mode(head, bpy.ops.uv.cone_unwrap)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.42)
    yield WAIT
    for area in areas("TIMELINE") + areas("DOPESHEET_EDITOR"):
        with inside(area):
            bpy.ops.screen.area_close()
    yield WAIT
    editor, view = sorted(areas("VIEW_3D"), key=lambda area: area.x)
    editor.ui_type = "UV"
    bpy.context.tool_settings.use_uv_select_sync = False
    for space in view.spaces:
        space.show_region_ui, space.show_region_toolbar, space.overlay.show_floor = True, False, False
    yield WAIT
    for region in view.regions:
        if region.type == "UI":
            region.active_panel_category = "Cone Unwrap"
    with inside(view):
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
        bpy.ops.view3d.view_all()
    for space in editor.spaces:
        space.show_region_toolbar = False
    with inside(editor):
        bpy.ops.image.view_all(fit_view=True)
    yield 2 * WAIT
    with inside(view):
        bpy.ops.screen.screenshot(filepath=str(out / "guide-window.png"))


def main() -> None:
    arguments = demo_scene.parse_arguments()
    bpy.context.preferences.view.show_splash = False
    demo_scene.install_extension(arguments.extension)
    showing = show(arguments.out)

    def step() -> float:
        status = 0
        try:
            return next(showing)
        except StopIteration:
            pass
        except Exception:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        os._exit(status)

    bpy.app.timers.register(step, first_interval=2 * WAIT, persistent=True)


if __name__ == "__main__":
    main()
