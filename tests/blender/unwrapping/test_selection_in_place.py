# SPDX-License-Identifier: GPL-3.0-or-later
"""A selection that is unwrapped or packed keeps to its place, at its density, and off other islands; Pack Islands."""

import bpy
import numpy as np
import pytest
from scenes import UvMap, add_cube, add_grid, changed, covered_twice, edit, pin, select_elements, snapshot, uv_key

TEXELS = 512
MARGIN = 4
# Of a texel, by which islands that fill their place may leave it.
ROUNDING = 0.3 / TEXELS


def add_parts(count=4):
    """One object of `count` squares of 16 faces each, packed with room between them."""
    parts = [add_grid(f"Part {number}", segments=4) for number in range(count)]
    for number, part in enumerate(parts):
        part.location.x = 3.0 * number
        part.select_set(True)
    bpy.context.view_layer.update()
    bpy.ops.object.join()
    obj = bpy.context.object
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN, straighten=False) == {"FINISHED"}
    return obj


def faces_of(obj, number):
    left = min(vertex.co.x for vertex in obj.data.vertices)
    return [face.index for face in obj.data.polygons if int((face.center.x - left) / 3) == number]


def uv_of(obj, faces):
    uv_map = UvMap(obj)
    return uv_map.uv[[loop for face in faces for loop in uv_map.loops_of_face[face]]]


def area(obj, faces):
    uv_map = UvMap(obj)
    corners = uv_map.uv[uv_map.triangles][np.isin(uv_map.face_of_triangle, faces)] @ (1, 1j)
    return np.abs(((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag).sum() / 2


def box(uv):
    return uv.min(axis=0), uv.max(axis=0)


def begin(selected):
    """The object with some of its parts selected in edit mode, and the faces of these."""
    obj = add_parts()
    faces = [face for number in selected for face in faces_of(obj, number)]
    edit(obj)
    select_elements(obj, "faces", faces)
    return obj, faces


def require_in_place(obj, faces, before, old_area):
    others = [face.index for face in obj.data.polygons if face.index not in faces]
    loops = [loop for face in others for loop in UvMap(obj).loops_of_face[face]]
    assert UvMap(obj).uv[loops].tobytes() == before[loops].tobytes()
    (low, high), (old_low, old_high) = box(uv_of(obj, faces)), box(before[np.setdiff1d(range(len(before)), loops)])
    assert (low >= old_low - ROUNDING).all() and (high <= old_high + ROUNDING).all()
    assert area(obj, faces) == pytest.approx(old_area, rel=1e-4)
    assert covered_twice([UvMap(obj)]) == 0


@pytest.mark.parametrize("selected", [(1,), (0, 2)], ids=str)
@pytest.mark.parametrize(
    "work",
    [
        lambda: bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN),
        lambda: bpy.ops.uv.cone_unwrap(margin=MARGIN / TEXELS),
        lambda: bpy.ops.uv.cone_pack(texture_size=str(TEXELS), margin=MARGIN),
    ],
    ids=["auto", "from cones", "pack"],
)
def test_selected_islands_stay_in_their_place_at_their_density(work, selected):
    obj, faces = begin(selected)
    before, old_area = UvMap(obj).uv, area(obj, faces)
    assert work() == {"FINISHED"}
    require_in_place(obj, faces, before, old_area)


@pytest.mark.one_blender
def test_what_is_hidden_in_a_selection_gets_smaller_and_the_rest_keeps_its_density():
    """Of a ball in a ball, beside squares that are not selected; once more, too."""
    obj = add_parts(2)
    for radius in (1.0, 0.5):
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=radius, location=(20.0, 0.0, 0.0))
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.join()
    middle = np.array([20.0, 0.0, 0.0]) - np.array(obj.location)
    distance = np.array([np.linalg.norm(np.array(face.center) - middle) for face in obj.data.polygons])
    inner, outer = np.flatnonzero(distance < 0.7), np.flatnonzero((distance > 0.7) & (distance < 2))
    assert len(inner) == len(outer) > 0
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN) == {"FINISHED"}
    before = area(obj, outer), area(obj, inner)
    edit(obj)
    select_elements(obj, "faces", [*outer.tolist(), *inner.tolist()])
    for _ in range(2):
        assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN, inside=0.5) == {"FINISHED"}
        assert area(obj, outer) == pytest.approx(before[0], rel=1e-3)
        assert area(obj, inner) == pytest.approx(before[1] / 4, rel=1e-3)


def test_islands_of_half_the_size_stay_there_and_get_no_larger():
    obj, faces = begin((1,))
    bpy.ops.object.mode_set(mode="OBJECT")
    layer, uv = obj.data.uv_layers.active.uv, UvMap(obj).uv
    loops = [loop for face in faces for loop in UvMap(obj).loops_of_face[face]]
    uv[loops] = uv[loops].mean(axis=0) + 0.5 * (uv[loops] - uv[loops].mean(axis=0))
    layer.foreach_set("vector", uv.astype(np.float32).ravel())
    edit(obj)
    select_elements(obj, "faces", faces)
    before, old_area = UvMap(obj).uv, area(obj, faces)
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN) == {"FINISHED"}
    require_in_place(obj, faces, before, old_area)


def test_faces_without_a_layout_go_into_free_space_at_the_density_of_others(reports):
    obj, faces = begin((1,))
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = 0.4 * UvMap(obj).uv
    loops = [loop for face in faces for loop in UvMap(obj).loops_of_face[face]]
    uv[loops] = 0
    obj.data.uv_layers.active.uv.foreach_set("vector", uv.astype(np.float32).ravel())
    edit(obj)
    select_elements(obj, "faces", faces)
    others = [face.index for face in obj.data.polygons if face.index not in faces]
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN) == {"FINISHED"}
    assert area(obj, faces) / len(faces) == pytest.approx(area(obj, others) / len(others), rel=1e-3)
    low, high = box(uv_of(obj, faces))
    assert (low >= 0).all() and (high <= 1).all() and covered_twice([UvMap(obj)]) == 0


def test_where_others_leave_no_room_the_next_tile_is_taken(reports):
    obj, faces = begin((1,))
    bpy.ops.object.mode_set(mode="OBJECT")
    uv = UvMap(obj).uv
    for number in (0, 2, 3):
        part = [loop for face in faces_of(obj, number) for loop in UvMap(obj).loops_of_face[face]]
        low, high = box(uv[part])
        uv[part] = (uv[part] - low) / (high - low)
    obj.data.uv_layers.active.uv.foreach_set("vector", uv.astype(np.float32).ravel())
    edit(obj)
    select_elements(obj, "faces", faces)
    old_area = area(obj, faces)
    reports()
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN) == {"FINISHED"}
    assert "beside the tile" in reports()
    low, high = box(uv_of(obj, faces))
    assert low[0] >= 1 and high[0] <= 2 and low[1] >= 0 and high[1] <= 1
    assert area(obj, faces) == pytest.approx(old_area, rel=1e-4)


def test_a_selection_may_fill_the_square_instead():
    obj, faces = begin((1,))
    assert bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN, in_place=False) == {"FINISHED"}
    low, high = box(uv_of(obj, faces))
    assert (high - low).max() > 0.95


def test_pack_moves_two_objects_together_and_leaves_pinned_islands(reports):
    objects = [add_parts(3), add_cube(cuts=1)]
    reports()
    objects[0].select_set(True)
    bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), margin=MARGIN)
    covered = sum(area(obj, [face.index for face in obj.data.polygons]) for obj in objects)
    assert reports().count(f"{100 * covered:.0f} % of the square used") == 2
    locked = [faces_of(objects[0], number) for number in (0, 2)]
    for faces in locked:
        loops = [UvMap(objects[0]).loops_of_face[faces[0]][0]]
        pin(objects[0], loops, UvMap(objects[0]).uv[loops])
    kept = [uv_of(objects[0], faces) for faces in locked]
    before = [snapshot(obj) for obj in objects]
    assert bpy.ops.uv.cone_pack(texture_size=str(TEXELS), margin=2, effort="QUICK") == {"FINISHED"}
    for faces, uv in zip(locked, kept, strict=True):
        assert np.array_equal(uv_of(objects[0], faces), uv)
    assert covered_twice(map(UvMap, objects)) == 0
    for old, obj in zip(before, objects, strict=True):
        assert changed(old, snapshot(obj)) <= {uv_key(), "property cone_unwrap_report"}


def test_stacks_stay_stacks_if_they_are_to():
    obj = add_parts(2)
    first, second = faces_of(obj, 0), faces_of(obj, 1)
    uv = UvMap(obj).uv
    loops = [[loop for face in faces for loop in UvMap(obj).loops_of_face[face]] for faces in (first, second)]
    uv[loops[1]] = uv[loops[0]]
    obj.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    assert bpy.ops.uv.cone_pack() == {"FINISHED"}
    assert np.array_equal(uv_of(obj, first), uv_of(obj, second)) and area(obj, first) > 0.9
    assert bpy.ops.uv.cone_pack(keep_stacks=False) == {"FINISHED"}
    assert covered_twice([UvMap(obj)]) == 0


def test_what_cannot_be_packed_is_refused(reports):
    obj = add_parts(2)
    edit(obj, select="DESELECT")
    with pytest.raises(RuntimeError, match="No face is selected"):
        bpy.ops.uv.cone_pack()
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.uv_layers.remove(obj.data.uv_layers[0])
    with pytest.raises(RuntimeError, match="no UV map; unwrap it first"):
        bpy.ops.uv.cone_pack()
