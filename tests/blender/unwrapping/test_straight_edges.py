# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges that artists mark run straight along u or v."""

import math

import bpy
import numpy as np
import pytest
from scenes import UvMap, add_cube, add_tube, edges_where, edit, mark

SIZES = np.array([1.0, 1.37, 2.11])


def add_box() -> bpy.types.Object:
    """Its sides are no whole numbers of tiles."""
    box = add_cube("Box")
    for vertex in box.data.vertices:
        vertex.co = np.array(vertex.co) * SIZES
    return box


def half_way_up(obj: bpy.types.Object) -> set[tuple[int, int]]:
    """The loop around the middle of a box that is cut an odd number of times."""
    return edges_where(obj, lambda place: abs(place[2]) < 1e-6)


def off_axis(obj: bpy.types.Object, edges: set[tuple[int, int]]) -> float:
    """The most that one of these edges is off u and v, on any of its sides, in UV units."""
    uv, mesh, worst = UvMap(obj).uv, obj.data, 0.0
    assert edges
    for face in mesh.polygons:
        loops = list(face.loop_indices)
        for a, b in zip(loops, loops[1:] + loops[:1], strict=True):
            ends = (mesh.loops[a].vertex_index, mesh.loops[b].vertex_index)
            if tuple(sorted(ends)) in edges:
                worst = max(worst, float(np.abs(uv[a] - uv[b]).min()))
    return worst


def off_tiles(obj: bpy.types.Object, edges: set[tuple[int, int]], step: float) -> float:
    """The most that one of these edges is off the nearest multiple of a step in tiles, on any of its sides."""
    uv, mesh, worst = UvMap(obj).uv, obj.data, 0.0
    for face in mesh.polygons:
        loops = list(face.loop_indices)
        for a, b in zip(loops, loops[1:] + loops[:1], strict=True):
            if tuple(sorted((mesh.loops[a].vertex_index, mesh.loops[b].vertex_index))) in edges:
                along = int(np.abs(uv[a] - uv[b]).argmin())
                worst = max(worst, float(np.abs(uv[a] - step * np.round(uv[a] / step))[along]))
    return worst


def mark_attribute(obj: bpy.types.Object, edges: set[tuple[int, int]]) -> None:
    attribute = obj.data.attributes.new("uv_cone_feature", "BOOLEAN", "EDGE")
    attribute.data.foreach_set("value", [tuple(sorted(edge.vertices)) in edges for edge in obj.data.edges])


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("preset", ["PAINT", "TILE"])
def test_edges_with_the_attribute_are_straight(preset: str, in_edit_mode: bool) -> None:
    box = add_box()
    loop = half_way_up(box)
    mark_attribute(box, loop)
    if in_edit_mode:
        edit(box)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset, straighten=False) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    # Blender's packer moves and scales islands in single precision.
    rounding = 0 if preset == "TILE" else np.spacing(np.float32(1))
    assert off_axis(box, loop) <= rounding


@pytest.mark.parametrize("chosen", ["ANYWHERE", "HALF", "WHOLE"])
def test_they_are_at_whole_or_half_tiles_where_that_is_chosen(chosen: str) -> None:
    box = add_box()
    loop = edges_where(box, lambda place: abs(place[2] + SIZES[2] / 2) < 1e-6)
    mark_attribute(box, loop)
    options = {"preset": "TILE", "straighten": False, "straight_places": chosen}
    assert bpy.ops.uv.cone_auto_unwrap(**options) == {"FINISHED"}
    assert off_axis(box, loop) == 0
    assert (off_tiles(box, loop, 1) == 0) == (chosen == "WHOLE")
    assert (off_tiles(box, loop, 0.5) == 0) == (chosen != "ANYWHERE")
    if chosen == "WHOLE":
        places = np.array([vertex.co for vertex in box.data.vertices])
        mark(box, np.flatnonzero((np.abs(np.abs(places) / SIZES - 1) < 1e-6).all(axis=1)).tolist())
        assert bpy.ops.uv.cone_unwrap(seamless=True, straight_places="WHOLE") == {"FINISHED"}
        assert off_tiles(box, loop, 1) == 0


def test_without_marks_they_are_not() -> None:
    box = add_box()
    assert bpy.ops.uv.cone_auto_unwrap(preset="TILE", straighten=False) == {"FINISHED"}
    assert off_axis(box, half_way_up(box)) > 0


def test_sharp_edges_and_seams_are_straight_where_that_is_chosen() -> None:
    box = add_box()
    loop = half_way_up(box)
    for edge in box.data.edges:
        edge.use_edge_sharp = tuple(sorted(edge.vertices)) in loop
    options = {"preset": "TILE", "straighten": False}
    assert bpy.ops.uv.cone_auto_unwrap(**options) == {"FINISHED"}
    assert off_axis(box, loop) > 0
    assert bpy.ops.uv.cone_auto_unwrap(**options, straight_sharp=True) == {"FINISHED"}
    assert off_axis(box, loop) == 0


def test_creases_of_an_angle_are_straight() -> None:
    box = add_box()
    sides = edges_where(box, lambda place: (np.abs(np.abs(place) / SIZES - 1) < 1e-6).sum() >= 2)
    options = {"preset": "TILE", "straighten": False, "straight_creases": True}
    assert bpy.ops.uv.cone_auto_unwrap(**options, straight_angle=math.radians(91)) == {"FINISHED"}
    assert off_axis(box, sides) > 0
    assert bpy.ops.uv.cone_auto_unwrap(**options, straight_angle=math.radians(89)) == {"FINISHED"}
    assert off_axis(box, sides) == 0


def test_borders_of_a_tube_are_straight_in_unwrap_from_cones() -> None:
    tube = add_tube()
    faces_at = {}
    for face in tube.data.polygons:
        for key in face.edge_keys:
            faces_at[key] = faces_at.get(key, 0) + 1
    borders = {tuple(sorted(key)) for key, count in faces_at.items() if count == 1}
    assert bpy.ops.uv.cone_unwrap(mode="LOW_STRETCH", straight_borders=True, pack=False) == {"FINISHED"}
    straight = off_axis(tube, borders)
    assert bpy.ops.uv.cone_unwrap(mode="LOW_STRETCH", pack=False) == {"FINISHED"}
    assert straight == 0 < off_axis(tube, borders)
