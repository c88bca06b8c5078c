# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands packed as an artist does it, with a UV editor beside: locked ones, and a selection in its place.

Run by run_in_window.py; no pytest.
"""

import bpy
import numpy as np
from scenes import UvMap, add_cube, covered_twice, edit, pin, select_elements
from windows import region, running, take_picture, until, window


def beside():
    """The 3D view with a UV editor at its right that shows the layout."""
    bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    right = max((one for one in window().screen.areas if one.type == "VIEW_3D"), key=lambda one: one.x)
    right.type = "IMAGE_EDITOR"
    right.ui_type = "UV"
    yield 0.5


def faces_towards(obj, axis, sign):
    return [face.index for face in obj.data.polygons if sign * face.normal[axis] > 0.9]


def uv_of(obj, faces):
    uv_map = UvMap(obj)
    return uv_map.uv[[loop for face in faces for loop in uv_map.loops_of_face[face]]]


def cut_cube():
    """With a seam along every edge: six islands."""
    cube = add_cube("Cube", cuts=3)
    for edge in cube.data.edges:
        ends = [np.abs(cube.data.vertices[vertex].co) for vertex in edge.vertices]
        edge.use_seam = all(np.isclose(end, 1).sum() >= 2 for end in ends)
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True, seams="BOUNDARY")
    assert UvMap(cube).islands() == 6
    return cube


def test_two_locked_islands_stay_and_others_leave_them_their_room():
    yield from beside()
    cube = cut_cube()
    locked = [faces_towards(cube, axis, 1) for axis in (0, 1)]
    places = UvMap(cube)
    for faces, low in zip(locked, ([0.3, 0.3], [0.62, 0.55]), strict=True):
        loops = [loop for face in faces for loop in places.loops_of_face[face]]
        uv = places.uv[loops]
        pin(cube, loops, 0.25 * (uv - uv.min(axis=0)) / np.ptp(uv, axis=0) + low)
    edit(cube)
    bpy.ops.ed.undo_push(message="before")
    kept = [uv_of(cube, faces) for faces in locked]
    yield 0.5
    take_picture("locked_before")
    assert bpy.ops.uv.cone_pack("INVOKE_DEFAULT", True) <= {"FINISHED", "RUNNING_MODAL"}
    yield from until(lambda: not running("UV_OT_cone_pack"))
    yield 0.5
    take_picture("locked_after")
    for faces, uv in zip(locked, kept, strict=True):
        assert np.array_equal(uv_of(cube, faces), uv)
    assert covered_twice([UvMap(cube)]) == 0
    after = UvMap(cube).uv
    assert after.min() >= 0 and after.max() <= 1
    bpy.ops.ed.undo()
    yield 0.2


def test_a_selection_is_unwrapped_again_in_its_place():
    yield from beside()
    cube = cut_cube()
    chosen = [*faces_towards(cube, 0, 1), *faces_towards(cube, 2, 1)]
    edit(cube)
    select_elements(cube, "faces", chosen)
    bpy.context.tool_settings.use_uv_select_sync = True
    bpy.ops.ed.undo_push(message="before")
    before, old = UvMap(cube).uv, uv_of(cube, chosen)
    yield 0.5
    take_picture("selection_before")
    for work in (bpy.ops.uv.cone_auto_unwrap, bpy.ops.uv.cone_pack):
        assert work("INVOKE_DEFAULT", True) <= {"FINISHED", "RUNNING_MODAL"}
        yield from until(lambda: not running("UV_OT_cone_pack") and not running("UV_OT_cone_auto_unwrap"), 60)
        yield 0.5
        take_picture(f"selection_after_{work.idname_py().split('.')[1]}")
        others = np.setdiff1d(range(len(before)), [loop for face in chosen for loop in UvMap(cube).loops_of_face[face]])
        assert np.array_equal(UvMap(cube).uv[others], before[others])
        assert covered_twice([UvMap(cube)]) == 0
    assert np.ptp(uv_of(cube, chosen), axis=0).max() <= 1.01 * np.ptp(old, axis=0).max()


def test_the_best_layout_shows_its_progress_and_is_stopped_by_esc():
    cube = cut_cube()
    before = UvMap(cube).uv
    assert bpy.ops.uv.cone_pack("INVOKE_DEFAULT", True, effort="BEST") == {"RUNNING_MODAL"}
    yield 1.0
    take_picture("packing_progress")
    assert running("UV_OT_cone_pack")
    window().event_simulate(type="ESC", value="PRESS")
    yield from until(lambda: not running("UV_OT_cone_pack"), 5)
    assert np.array_equal(UvMap(cube).uv, before)


def test_the_uv_editor_shows_all_of_a_layout_in_tiles():
    yield from beside()
    cube = add_cube("Cube", cuts=3)
    edit(cube)
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True, preset="TILE") <= {"FINISHED", "RUNNING_MODAL"}
    yield from until(lambda: not running("UV_OT_cone_auto_unwrap"), 60)
    yield 0.5
    take_picture("tiles_in_uv_editor")
    uv = UvMap(cube).uv
    assert uv.min() >= 0 and uv.min() < 1.01 and uv.max() > 1.5
    editor = region(within="IMAGE_EDITOR")
    for corner in (uv.min(axis=0), uv.max(axis=0)):
        across, up = editor.view2d.view_to_region(*corner, clip=False)
        assert 0 <= across <= editor.width and 0 <= up <= editor.height
