# SPDX-License-Identifier: GPL-3.0-or-later
"""Subdivision Surface: the map is that of the surface that the modifier makes."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_cone_cube, add_cube, changed, edit, snapshot, uv_key


def swollen(name="Swollen"):
    """A box that the modifier rounds, most at its ends."""
    cube = add_cone_cube(name, cuts=1)
    for vertex in cube.data.vertices:
        vertex.co.z *= 3
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
    return cube


def with_waist(obj):
    """The object, made thin where x is 0."""
    for vertex in obj.data.vertices:
        if abs(vertex.co.x) < 0.01:
            vertex.co.y *= 0.4
            vertex.co.z *= 0.4
    return obj


def applied(obj):
    """The same cage with its vertices where the modifier puts them, without it."""
    bpy.context.view_layer.update()
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    places = [tuple(vertex.co) for vertex in evaluated.vertices]
    copy = swollen("Applied")
    for vertex, place in zip(copy.data.vertices, places[: len(copy.data.vertices)], strict=True):
        vertex.co = place
    copy.modifiers.clear()
    return copy


def unwrapped_alone(obj, call, **options):
    """Its `UvMap.edge_shares`, of a map of this object alone."""
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    assert call(**options) == {"FINISHED"}
    return UvMap(obj).edge_shares()


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_map_is_that_of_the_subdivided_surface(in_edit_mode):
    cube = swollen()
    twin = applied(cube)
    wanted = unwrapped_alone(twin, bpy.ops.uv.cone_unwrap)
    bpy.ops.object.select_all(action="DESELECT")
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    found = {}
    for use in (False, True):
        assert bpy.ops.uv.cone_unwrap(use_subsurf_data=use) == {"FINISHED"}
        found[use] = UvMap(cube).edge_shares()
    assert changed(before, snapshot(cube)) == {uv_key()}
    assert found[True] == pytest.approx(wanted, abs=1e-4)
    assert np.abs(found[False] - wanted).max() > 0.01


def test_auto_unwrap_takes_the_modifier_that_is_shown():
    cube, hidden, plain = swollen(), swollen("Hidden"), swollen("Plain")
    hidden.modifiers[0].show_viewport = False
    plain.modifiers.clear()
    twin = applied(cube)
    lengths = {obj: unwrapped_alone(obj, bpy.ops.uv.cone_auto_unwrap) for obj in (cube, hidden, plain, twin)}
    assert np.array_equal(lengths[hidden], lengths[plain])
    assert lengths[cube] == pytest.approx(lengths[twin], abs=1e-4)
    assert np.abs(lengths[cube] - lengths[plain]).max() > 0.01


def right_half(obj):
    """The object without its vertices at negative x."""
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bmesh.ops.delete(bm, geom=[vertex for vertex in bm.verts if vertex.co.x < -0.01], context="VERTS")
    bm.to_mesh(obj.data)
    bm.free()
    return obj


def test_half_a_figure_is_subdivided_together_with_the_other_half():
    """By itself it would shrink at its rim, where the mirror plane is."""
    twin = right_half(applied(with_waist(swollen())))
    mirrored, alone = (right_half(with_waist(swollen(name))) for name in ("Mirrored", "Alone"))
    mirrored.modifiers.clear()
    mirrored.modifiers.new("Mirror", "MIRROR")
    mirrored.modifiers.new("Subdivision", "SUBSURF").levels = 2
    lengths = {obj: unwrapped_alone(obj, bpy.ops.uv.cone_auto_unwrap) for obj in (twin, mirrored, alone)}
    assert lengths[mirrored] == pytest.approx(lengths[twin], abs=1e-4)
    assert np.abs(lengths[alone] - lengths[twin]).max() > 0.01


def test_a_face_that_mirror_drops_counts_as_nothing():
    """Of two faces between the same vertices it keeps one where vertices are merged, at its plane."""
    half = right_half(swollen())
    half.modifiers.clear()
    half.modifiers.new("Mirror", "MIRROR")
    half.modifiers.new("Subdivision", "SUBSURF").levels = 2
    mesh = half.data
    places = [tuple(vertex.co) for vertex in mesh.vertices]
    faces = [tuple(face.vertices) for face in mesh.polygons]
    at_plane = next(face for face in faces if min(abs(places[vertex][0]) for vertex in face) < 0.01)
    mesh.clear_geometry()
    mesh.from_pydata(places, [], [*faces, at_plane])
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}


def test_other_modifiers_and_shape_keys_have_no_say():
    first, second = swollen("First"), swollen("Second")
    second.modifiers.new("Mirror", "MIRROR")
    second.modifiers.new("Array", "ARRAY").count = 3
    second.shape_key_add(name="Basis")
    bent = second.shape_key_add(name="Bent")
    bent.data[0].co.z += 0.5
    bent.value = 0.7
    assert bpy.ops.uv.cone_unwrap(use_subsurf_data=True, pack=False) == {"FINISHED"}
    assert UvMap(first).uv.tobytes() == UvMap(second).uv.tobytes()


def test_without_the_modifier_nothing_differs():
    cube = add_cube()
    assert bpy.ops.uv.cone_auto_unwrap(use_subsurf_data=False) == {"FINISHED"}
    without = UvMap(cube).uv
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    assert np.array_equal(UvMap(cube).uv, without)


@pytest.mark.parametrize(("kind", "is_round"), [("CATMULL_CLARK", True), ("SIMPLE", False)])
def test_edges_of_a_cage_that_is_made_round_are_no_creases(kind, is_round):
    cube = add_cube("Cage")
    modifier = cube.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.subdivision_type = 2, kind
    assert bpy.ops.uv.cone_auto_unwrap(preset="BAKE") == {"FINISHED"}
    assert bool(addon.mesh.reports.find(cube.data).cones) == is_round
