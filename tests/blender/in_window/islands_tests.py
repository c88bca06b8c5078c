# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools on islands by what is selected in a UV editor, with undo by its key."""

import bpy
import numpy as np
from scenes import UvMap, add_grid, edit, set_uv
from windows import DRAWN, done, press, split_off_uv_editor, take_picture, until, window


def uv_context(view):
    return bpy.context.temp_override(
        window=window(), area=view, region=next(part for part in view.regions if part.type == "WINDOW")
    )


def bent_grid():
    grid = add_grid()
    for vertex in grid.data.vertices:
        x, y, _ = vertex.co
        vertex.co = (x + 0.1 * np.sin(3 * y), y + 0.15 * np.sin(2 * x), 0.2 * np.cos(2 * x))
    places = np.array([vertex.co[:2] for vertex in grid.data.vertices])
    set_uv(grid, (places / 4 + 0.5)[[loop.vertex_index for loop in grid.data.loops]])
    return grid


def test_tools_take_what_is_selected_in_the_uv_editor_and_are_undone_by_a_key():
    grid = bent_grid()
    name = grid.name
    edit(grid)
    view = split_off_uv_editor()
    bpy.context.tool_settings.use_uv_select_sync = False
    try:
        yield DRAWN
        with uv_context(view):
            bpy.ops.image.view_all(fit_view=True)
            bpy.ops.uv.select_all(action="SELECT")
        bpy.ops.ed.undo_push(message="before")
        take_picture("grid_before")
        before = UvMap(grid).uv.copy()
        with uv_context(view):
            assert bpy.ops.uv.cone_grid("INVOKE_DEFAULT", True, spacing="EVEN") == {"FINISHED"}
        yield from until(lambda: done("UV_OT_cone_grid"))
        yield DRAWN
        take_picture("grid_after")
        after = UvMap(grid).uv.copy()
        assert [len(np.unique(after[:, axis].round(5))) for axis in range(2)] == [7, 7]
        place = view.x + view.width / 2, view.y + view.height / 2
        yield from press("Z", place, ctrl=True)
        yield DRAWN
        assert np.allclose(UvMap(bpy.data.objects[name]).uv, before, atol=1e-6)
        with uv_context(view):
            bpy.ops.uv.select_all(action="DESELECT")
            try:
                bpy.ops.uv.cone_grid()
            except RuntimeError as error:
                assert "No face is selected" in str(error)
            else:
                raise AssertionError("nothing was selected")
    finally:
        bpy.context.tool_settings.use_uv_select_sync = True
    yield DRAWN
