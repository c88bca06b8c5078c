# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist starts with: Blender's own primitives, one triangle, and objects in every state."""

import bpy
import numpy as np
import pytest
from mathutils import Vector
from scenes import UV_ROUNDING, UvMap, add_ball, add_object, changed, edit, marked, snapshot, uv_key

PRIMITIVES = ["cube", "monkey", "uv_sphere", "ico_sphere", "torus", "grid", "cylinder", "cone", "plane"]


def add_primitive(name):
    if name == "triangle":

        def build(bm):
            bm.faces.new([bm.verts.new(place) for place in ((0, 0, 0), (2, 0, 0), (0.3, 1, 0.5))])
            bm.loops.layers.uv.new("UVMap")

        return add_object("Triangle", build)
    getattr(bpy.ops.mesh, f"primitive_{name}_add")()
    return bpy.context.object


@pytest.mark.slow
@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("primitive", [*PRIMITIVES, "triangle"])
def test_primitive_through_placed_cones_twice_in_a_row(primitive, in_edit_mode):
    obj = add_primitive(primitive)
    if in_edit_mode:
        edit(obj)
    assert bpy.ops.mesh.cone_place() == {"FINISHED"}
    before = snapshot(obj)
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP") == {"FINISHED"}
    once = snapshot(obj)
    assert changed(before, once) == {uv_key()}
    uv_map = UvMap(obj)
    assert uv_map.islands() == {"monkey": 3}.get(primitive, 1)
    assert uv_map.uv.min() >= 0.0 and uv_map.uv.max() <= 1.0
    assert np.ptp(uv_map.uv, axis=0).max() > 0.9
    assert uv_map.sister_difference() <= UV_ROUNDING
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP") == {"FINISHED"}
    assert changed(once, snapshot(obj)) == set()


@pytest.mark.slow
@pytest.mark.parametrize("primitive", [*PRIMITIVES, "triangle"])
def test_edit_mode_and_object_mode_agree_on_primitives(primitive):
    obj = add_primitive(primitive)
    bpy.ops.mesh.cone_place()
    bpy.ops.uv.cone_unwrap()
    cones, uv = marked(obj), UvMap(obj).uv
    layer = obj.data.uv_layers.active
    layer.uv.foreach_set("vector", np.zeros(2 * len(obj.data.loops), np.float32))
    edit(obj)
    bpy.ops.mesh.cone_place(keep=False)
    bpy.ops.uv.cone_unwrap()
    assert marked(obj) == cones
    assert UvMap(obj).uv.tobytes() == uv.tobytes()


def test_one_triangle_keeps_its_shape():
    triangle = add_primitive("triangle")
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert UvMap(triangle).scale_spread() < 1 + 1e-6


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (-2.5, -2.5, -2.5), (40.0, 40.0, 40.0)])
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_size_mirroring_and_place_of_the_object_do_not_matter(scale, in_edit_mode):
    first, second = add_ball("First"), add_ball("Second")
    second.scale = scale
    second.location = (1e5, 0.0, 0.0)
    second.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    if in_edit_mode:
        edit(first, second)
    before = [snapshot(obj) for obj in (first, second)]
    # Packed, they would lie beside each other, and the front of the scene sees each from another side.
    assert bpy.ops.uv.cone_unwrap(pack=False, cuts="SHORTEST") == {"FINISHED"}
    assert UvMap(first).uv.tobytes() == UvMap(second).uv.tobytes()
    for state, obj in zip(before, (first, second), strict=True):
        assert changed(state, snapshot(obj)) == {uv_key()}


def edge_lengths(obj):
    uv_map = UvMap(obj)
    ends = uv_map.uv[np.array([uv_map.sides[edge][0] for edge in sorted(uv_map.sides)])]
    return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)


@pytest.mark.parametrize("scale", [(4.0, 1.0, 1.0), (-1.0, -2.0, 3.0), (1.0, 1.0, 40.0)])
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_an_object_is_unwrapped_in_the_shape_that_its_scale_gives_it(scale, in_edit_mode):
    scaled, applied = add_ball("Scaled"), add_ball("Applied")
    scaled.scale = scale
    scaled.rotation_euler = (0.3, 0.2, 0.1)
    for vertex in applied.data.vertices:
        vertex.co *= Vector(map(abs, scale))
    bpy.context.view_layer.update()
    if in_edit_mode:
        edit(scaled, applied)
    before = snapshot(scaled)
    assert bpy.ops.uv.cone_unwrap(pack=False, cuts="SHORTEST") == {"FINISHED"}
    assert changed(before, snapshot(scaled)) == {uv_key()}
    # Symmetric shapes may lie turned.
    assert edge_lengths(scaled) == pytest.approx(edge_lengths(applied), abs=1e-4)


def test_a_flattened_object_is_unwrapped_in_the_shape_of_its_mesh():
    flat, plain = add_ball("Flat"), add_ball("Plain")
    flat.scale = (1.0, 0.0, 1.0)
    bpy.context.view_layer.update()
    assert bpy.ops.uv.cone_unwrap(pack=False) == {"FINISHED"}
    assert UvMap(flat).uv.tobytes() == UvMap(plain).uv.tobytes()
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_modifiers_and_shape_keys_do_not_matter(in_edit_mode):
    plain, decorated = add_ball("Plain"), add_ball("Decorated")
    decorated.modifiers.new("Subdivision", "SUBSURF")
    mirror = decorated.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (False, True, False)
    decorated.modifiers.new("Array", "ARRAY").count = 3
    decorated.shape_key_add(name="Basis")
    bent = decorated.shape_key_add(name="Bent")
    bent.data[0].co.z += 0.5
    bent.value = 0.7
    if in_edit_mode:
        edit(plain, decorated)
    before = snapshot(decorated)
    # Packed, they would lie beside each other.
    assert bpy.ops.uv.cone_unwrap(pack=False) == {"FINISHED"}
    assert changed(before, snapshot(decorated)) == {uv_key()}
    assert UvMap(plain).uv.tobytes() == UvMap(decorated).uv.tobytes()


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_objects_that_share_a_mesh_show_the_same_map(in_edit_mode):
    ball = add_ball()
    twin = bpy.data.objects.new("Twin", ball.data)
    bpy.context.collection.objects.link(twin)
    twin.scale = (-1.0, 1.0, 2.0)
    twin.select_set(True)
    if in_edit_mode:
        edit(ball, twin)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    once = snapshot(ball)
    assert twin.data == ball.data
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert changed(once, snapshot(ball)) == set()


def test_object_linked_from_a_library_is_refused_and_stays(tmp_path):
    ball = add_ball()
    bpy.data.libraries.write(str(tmp_path / "source.blend"), {ball})
    bpy.data.objects.remove(ball)
    with bpy.data.libraries.load(str(tmp_path / "source.blend"), link=True) as (source, target):
        target.objects = source.objects
    (linked,) = target.objects
    bpy.context.collection.objects.link(linked)
    linked.select_set(True)
    local = add_ball("Local")
    linked.select_set(True)
    before = snapshot(linked)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    # The other object is unwrapped all the same.
    assert np.ptp(UvMap(local).uv, axis=0).max() > 0.9
    assert changed(before, snapshot(linked)) == set()
    local.select_set(False)
    before = snapshot(linked)
    with pytest.raises(RuntimeError, match=r"Ball: .*make it local"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(linked)) == set()
