# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of the guide that shows Blender's window: a rounded cube with its overlay, its UV map and the sidebar.

    export LIBGL_ALWAYS_SOFTWARE=1
    xvfb-run --auto-servernum "--server-args=-screen 0 1500x1000x24" blender --factory-startup \
        --window-geometry 0 0 1500 1000 --python tools/pictures/guide_window.py -- --extension ZIP --out OUT

BLENDER_USER_RESOURCES must name a throw-away profile, and ImageMagick has to be installed. Leaves OUT/guide-window.png.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import bpy
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).parent))
import demo_scene
from blender_window import (
    WAIT,
    areas,
    arrange,
    close_areas,
    inside,
    look_from_a_side,
    open_tab,
    run,
    take_picture,
)

OPEN = ("VIEW3D_PT_cone_angles", "VIEW3D_PT_cone_unwrap_quality")


def open_panels() -> None:
    """Open the panels that the page describes, as a click on each would."""
    for name in OPEN:
        panel = getattr(bpy.types, name)
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()
        bpy.utils.register_class(panel)


def show(out: Path) -> Iterator[float]:
    """Unwrap, arrange the window, write the picture; yields seconds to wait."""
    close_areas("PROPERTIES", "OUTLINER")
    yield WAIT
    yield from arrange(0.38)
    view, editor = areas("VIEW_3D")[0], areas("IMAGE_EDITOR")[0]
    with inside(view):
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.object
        corners = range(len(cube.data.vertices))
        demo_scene.run_in_edit_mode(cube, bpy.ops.mesh.subdivide, number_cuts=7)
        demo_scene.run_in_edit_mode(cube, bpy.ops.transform.tosphere, value=0.4)
        cube.vertex_groups.new(name=demo_scene.CONE_GROUP).add(corners, 1.0, "REPLACE")
        demo_scene.run_in_edit_mode(cube, bpy.ops.uv.cone_unwrap)
        bpy.ops.object.mode_set(mode="EDIT")
        # So that the UV editor also shows faces that are not selected.
        bpy.context.tool_settings.use_uv_select_sync = True
    for space in view.spaces:
        space.show_region_ui, space.show_region_toolbar, space.overlay.show_floor = True, False, False
        space.show_gizmo_navigate = False  # its buttons would cover cones
    yield WAIT
    open_tab(view)
    with inside(view):
        bpy.ops.mesh.select_all(action="DESELECT")
        look_from_a_side()
    for space in editor.spaces:
        space.show_region_toolbar = False
    with inside(editor):
        bpy.ops.image.view_all(fit_view=True)
    yield WAIT
    # Out from under the sidebar.
    seen = view.spaces.active.region_3d
    seen.view_distance *= 1.45
    seen.view_location = seen.view_rotation @ Vector((0.75, 0, 0))
    yield 2 * WAIT
    take_picture(out / "guide-window.png")


def main() -> None:
    arguments = demo_scene.parse_arguments()
    bpy.context.preferences.view.show_splash = False
    demo_scene.install_extension(arguments.extension)
    open_panels()
    run(show(arguments.out))


if __name__ == "__main__":
    main()
