# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of the guide that shows Blender's window: a head with its overlay, its UV map and the sidebar.

    blender --factory-startup --window-geometry 0 0 1500 860 --python tools/guide_window.py -- --extension ZIP --out OUT

BLENDER_USER_RESOURCES must name a throw-away profile. Leaves OUT/guide-window.png; without a screen run it under
xvfb-run with LIBGL_ALWAYS_SOFTWARE=1.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import demo_scene
from blender_window import WAIT, areas, arrange, inside, run


def show(out: Path) -> Iterator[float]:
    """Unwrap, arrange the window, write the picture; yields seconds to wait."""
    with inside(areas("VIEW_3D")[0]):
        head = demo_scene.add_suzanne(subdivisions=1)
        demo_scene.run_in_edit_mode(head, bpy.ops.mesh.cone_place, automatic=False, count=8)
        demo_scene.run_in_edit_mode(head, bpy.ops.uv.cone_unwrap)
        bpy.ops.object.mode_set(mode="EDIT")
    yield from arrange(0.42)
    view, editor = areas("VIEW_3D")[0], areas("IMAGE_EDITOR")[0]
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
    run(show(arguments.out))


if __name__ == "__main__":
    main()
