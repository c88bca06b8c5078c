# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture Up: which way v runs on the faces, in the UVs as Blender stores them."""

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Vector
from scenes import UvMap, add_ball, add_cone_cube, add_cube, add_tube, edit
from texture_ways import STORED, off, select_edge, way_of

UP = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}


@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_bricks_lie_level_on_a_tube_only_where_that_is_asked_for(preset):
    tube = add_tube(taper=0.0)
    tube.rotation_euler = (0.3, 0.2, 0.1)  # as the object stands in the world
    bpy.context.view_layer.update()
    axis = tube.matrix_world.to_3x3() @ Vector((0, 0, 1))
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset, direction="Z", compact=False) == {"FINISHED"}
    # Least squares all around the tube: nearly its own axis.
    assert off(way_of(tube, axis)) <= np.radians(20)
    tube.rotation_euler = (0, 0, 0)
    bpy.context.view_layer.update()
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset, direction="Z", compact=False) == {"FINISHED"}
    assert off(way_of(tube, UP["Z"])) <= STORED
    uv = UvMap(tube)
    assert uv.islands() == 1


def test_packing_keeps_the_direction_of_every_island_and_object():
    tubes = [add_tube(taper=0.0), add_tube(taper=0.0), add_tube(taper=0.0)]
    for i, tube in enumerate(tubes):
        tube.location.x = 4 * i
        tube.select_set(True)
    bpy.context.view_layer.update()
    assert bpy.ops.uv.cone_auto_unwrap(direction="Z") == {"FINISHED"}
    assert max(off(way_of(tube, UP["Z"])) for tube in tubes) <= STORED
    boxes = np.array([[uv.min(axis=0), uv.max(axis=0)] for uv in (UvMap(tube).uv for tube in tubes)])
    assert boxes.min() >= -1e-6 and boxes.max() <= 1 + 1e-6
    # As it fits, the packer turns what is gained by turning.
    assert bpy.ops.uv.cone_auto_unwrap(direction="FIT") == {"FINISHED"}


@pytest.mark.parametrize("axis", UP)
def test_tiles_on_a_cube_follow_every_axis(axis):
    cube = add_cone_cube()
    assert bpy.ops.uv.cone_unwrap(seamless=True, direction=axis) == {"FINISHED"}
    assert off(way_of(cube, UP[axis]), 4) <= STORED
    assert UvMap(cube).tile_error() == 0


def test_tiles_stand_upright_in_the_world_by_default():
    cube = add_cone_cube()
    cube.rotation_euler = (0, np.pi / 2, 0)
    bpy.context.view_layer.update()
    assert bpy.ops.uv.cone_auto_unwrap(preset="TILE") == {"FINISHED"}
    assert off(way_of(cube, UP["Z"]), 4) <= STORED


def test_the_active_edge_is_where_v_runs():
    cube = add_cube(cuts=2)
    edge = next(e for e in cube.data.edges if not e.use_seam)
    ends = tuple(edge.vertices)
    select_edge(cube, ends)
    assert bpy.ops.uv.cone_auto_unwrap(direction="EDGE") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    along = np.array(cube.data.vertices[ends[1]].co - cube.data.vertices[ends[0]].co)
    way = way_of(cube, along, in_world=False)
    beside = [set(ends) <= set(face.vertices) for face in cube.data.polygons]
    angles = np.abs(np.angle(way[beside] ** 2 / -1))  # up or down
    assert min(angles) <= 10 * STORED


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_without_an_active_edge_it_says_what_to_do(in_edit_mode):
    cube = add_cube()
    if in_edit_mode:
        edit(cube)
        bpy.ops.mesh.select_all(action="SELECT")
        bmesh.from_edit_mesh(cube.data).select_history.clear()
    with pytest.raises(RuntimeError, match="select one last in edit mode, or choose an axis"):
        bpy.ops.uv.cone_auto_unwrap(direction="EDGE")


def test_what_is_missed_is_told(capfd):
    add_ball()
    assert bpy.ops.uv.cone_auto_unwrap(direction="Z") == {"FINISHED"}
    assert "texture up missed by" in capfd.readouterr().out
