# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the first steps, in Blender's window: one press, a checker, cones, an unwrap from them, tiles.

    export LIBGL_ALWAYS_SOFTWARE=1
    xvfb-run --auto-servernum "--server-args=-screen 0 1200x640x24" blender --factory-startup \
        --window-geometry 0 0 1200 640 --python tools/pictures/guide_steps.py -- --extension ZIP --out OUT

BLENDER_USER_RESOURCES must name a throw-away profile, and ImageMagick has to be installed. Leaves OUT/step-NAME.png.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import bmesh
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

# Of the distance that the view moves, so that the sidebar covers neither the model nor the angles beside its cones.
SIDEBAR = 0.22
SIDEBAR_BESIDE_EAR = 0.33
TILE = 85  # pixels of a tile in the UV editor
CORNERS = 8  # of a cube, the first of its vertices


def prepare() -> Iterator[float]:
    """A UV editor and a 3D view, with the tab of the extension."""
    close_areas("PROPERTIES", "OUTLINER")
    yield WAIT
    yield from arrange(0.36)
    bpy.context.tool_settings.use_uv_select_sync = True  # the UV editor also shows faces that are not selected
    for area in areas("VIEW_3D"):
        space = area.spaces.active
        space.show_region_ui, space.show_region_toolbar = True, False
        space.show_gizmo_navigate = False  # its buttons would cover cones
        space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    for area in areas("IMAGE_EDITOR"):
        area.spaces.active.show_region_toolbar = False
    yield WAIT
    open_tab(areas("VIEW_3D")[0])


def show_all(distance: float, aside: float = SIDEBAR) -> Iterator[float]:
    """The whole model from a side, beside the sidebar, and the whole layout, nothing selected.

    distance: in units of the one at which Blender shows all. aside: how much of it the view moves.
    """
    view, editor = areas("VIEW_3D")[0], areas("IMAGE_EDITOR")[0]
    with inside(view):
        bpy.ops.mesh.select_all(action="SELECT")
        look_from_a_side()
    with inside(editor):
        bpy.ops.image.view_selected()
    yield WAIT
    with inside(view):
        bpy.ops.mesh.select_all(action="DESELECT")
    seen = view.spaces.active.region_3d
    seen.view_distance *= distance
    seen.view_location = seen.view_rotation @ Vector((aside * seen.view_distance, 0, 0))
    yield 2 * WAIT


def show_tiles(cube: bpy.types.Object) -> Iterator[float]:
    """A layout of several tiles, which Blender does not zoom out to by itself."""
    mesh = bmesh.from_edit_mesh(cube.data)
    uv = mesh.loops.layers.uv.active
    places = [loop[uv].uv for face in mesh.faces for loop in face.loops]
    editor = areas("IMAGE_EDITOR")[0]
    space = editor.spaces.active
    space.cursor_location = [(min(axis) + max(axis)) / 2 for axis in zip(*places, strict=True)]
    with inside(editor):
        bpy.ops.image.view_zoom_ratio(ratio=TILE / space.image.size[0])
        bpy.ops.image.view_center_cursor()
    space.cursor_location = (0, 0)
    yield WAIT


def unwrapped(operator, **options: object) -> Iterator[float]:
    """All of the mesh in edit mode."""
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.mesh.select_all(action="SELECT")
        assert operator("EXEC_DEFAULT", True, **options) == {"FINISHED"}
    yield WAIT


def select_corners(cube: bpy.types.Object) -> None:
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    mesh = bmesh.from_edit_mesh(cube.data)
    for vertex in mesh.verts:
        vertex.select_set(vertex.index < CORNERS)
    bmesh.update_edit_mesh(cube.data)


def steps(out: Path) -> Iterator[float]:
    """Yields seconds to wait."""
    yield from prepare()
    with inside(areas("VIEW_3D")[0]):
        suzanne = demo_scene.add_suzanne(subdivisions=1)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
    yield from unwrapped(bpy.ops.uv.cone_auto_unwrap)
    yield from show_all(1.2, SIDEBAR_BESIDE_EAR)
    take_picture(out / "step-press.png")
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.uv.cone_texture(pattern="CHECKER", tiles=16)
    yield 2 * WAIT
    take_picture(out / "step-checker.png")

    with inside(areas("VIEW_3D")[0]):
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(suzanne)
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.object
        demo_scene.run_in_edit_mode(cube, bpy.ops.mesh.subdivide, number_cuts=7)
        demo_scene.run_in_edit_mode(cube, bpy.ops.transform.tosphere, value=0.4)
        bpy.ops.object.mode_set(mode="EDIT")
        select_corners(cube)
        bpy.ops.mesh.cone_mark("EXEC_DEFAULT", True)  # as a step of undo, which the panel at the lower left names
    yield from show_all(1.35)
    take_picture(out / "step-cones.png")
    yield from unwrapped(bpy.ops.uv.cone_unwrap)
    yield from show_all(1.35)
    take_picture(out / "step-unwrap.png")
    yield from unwrapped(bpy.ops.uv.cone_unwrap, seamless=True)
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.uv.cone_texture(pattern="ASYMMETRIC", tiles=1)
    yield from show_all(1.35)
    yield from show_tiles(cube)
    take_picture(out / "step-tiles.png")


def main() -> None:
    arguments = demo_scene.parse_arguments()
    bpy.context.preferences.view.show_splash = False
    demo_scene.install_extension(arguments.extension)
    run(steps(arguments.out))


if __name__ == "__main__":
    main()
