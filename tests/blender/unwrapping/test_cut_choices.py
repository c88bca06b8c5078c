# SPDX-License-Identifier: GPL-3.0-or-later
"""Where cuts run, as chosen in the operators."""

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Euler
from scenes import UvMap, add_object, edit, mark

FRONT, BACK = np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0])


def places_of(obj: bpy.types.Object) -> np.ndarray:
    return np.array([vertex.co for vertex in obj.data.vertices])


def add_marked_ball() -> bpy.types.Object:
    """A sphere with a cone at each pole and two at its sides, whose shortest cuts may as well run in front."""

    def build(bm: bmesh.types.BMesh) -> None:
        bmesh.ops.create_uvsphere(bm, u_segments=32, v_segments=16, radius=1.0)
        bm.loops.layers.uv.new("UVMap")

    obj = add_object("Ball", build)
    places = places_of(obj)
    mark(obj, [int(v) for axis in (0, 2) for v in (places[:, axis].argmin(), places[:, axis].argmax())])
    return obj


def unwrap(obj: bpy.types.Object, **properties: str) -> np.ndarray:
    """The middles of the edges that are cut then, (k, 3) in the world."""
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP", **properties) == {"FINISHED"}
    cut = np.array(sorted(UvMap(obj).split_edges()))
    return places_of(obj)[cut].mean(axis=1) @ np.array(obj.matrix_world.to_3x3()).T


@pytest.mark.parametrize("turn", [(0, 0, 0), (0, 0, 3.0), (0.1, 0.2, 0.3)])
def test_cuts_hide_from_the_front_of_the_scene_however_the_object_is_turned(turn: tuple[float, ...]) -> None:
    obj = add_marked_ball()
    obj.rotation_euler = Euler(turn)
    bpy.context.view_layer.update()
    cut = unwrap(obj)
    shortest = unwrap(obj, cuts="SHORTEST")
    assert np.maximum(cut @ FRONT, 0).sum() < 0.7 * np.maximum(shortest @ FRONT, 0).sum()
    assert (cut @ BACK).mean() > 0.1


def test_where_nothing_bends_creases_are_the_shortest_cuts() -> None:
    lengths = {cuts: len(unwrap(add_marked_ball(), cuts=cuts)) for cuts in ("FRONT", "SHARP", "SHORTEST")}
    assert lengths["SHORTEST"] == lengths["SHARP"] <= lengths["FRONT"]


def test_cuts_follow_edges_marked_sharp() -> None:
    obj = add_marked_ball()
    places = places_of(obj)
    obj.vertex_groups.clear()
    mark(obj, [int(v) for axis in (0, 1) for v in (places[:, axis].argmin(), places[:, axis].argmax())])
    for edge in obj.data.edges:
        edge.use_edge_sharp = bool((np.abs(places[list(edge.vertices), 2]) < 1e-6).all())
    assert np.abs(unwrap(obj, cuts="SHARP")[:, 2]).max() < 1e-5


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_painted_weights_keep_cuts_away(side: float) -> None:
    obj = add_marked_ball()
    group = obj.vertex_groups.new(name="uv_seam_cost")
    group.add(np.flatnonzero(places_of(obj)[:, 1] * side > 0.05).tolist(), 1.0, "REPLACE")
    assert (unwrap(obj, cuts="SHARP")[:, 1] * side).max() < 0.3


def add_head() -> bpy.types.Object:
    """Blender's monkey, smoothed to thousands of faces."""
    bpy.ops.mesh.primitive_monkey_add()
    head = bpy.context.object
    head.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    return head


def length_of_cuts(obj: bpy.types.Object) -> tuple[float, float]:
    """Of all cuts, and as far as they face the front."""
    places, cut = places_of(obj), np.array(sorted(UvMap(obj).split_edges()))
    facing = np.array([vertex.normal for vertex in obj.data.vertices])[cut].mean(axis=1) @ FRONT
    length = np.linalg.norm(np.diff(places[cut], axis=1), axis=2).ravel()
    return float(length.sum()), float((length * np.maximum(facing, 0)).sum())


@pytest.mark.nightly
def test_a_press_keeps_the_face_of_a_head_free_of_cuts() -> None:
    """A fifth of what the shortest cuts show, and no more of them: of cuts found among coarse cells of faces to undo
    overlaps, it is half, and an eighth more."""
    lengths = {}
    for cuts in ("FRONT", "SHORTEST"):
        head = add_head()
        edit(head)
        assert bpy.ops.uv.cone_auto_unwrap(cuts=cuts) == {"FINISHED"}
        bpy.ops.object.mode_set(mode="OBJECT")
        lengths[cuts] = length_of_cuts(head)
    (length, in_sight), (shortest, shown) = lengths["FRONT"], lengths["SHORTEST"]
    assert in_sight < 0.3 * shown
    assert length < 1.06 * shortest
