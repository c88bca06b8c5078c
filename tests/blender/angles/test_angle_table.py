# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles of cones: where they are stored, the table and its ledger, and the operators that change them."""

import re
from dataclasses import replace
from itertools import permutations
from math import pi, radians

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from logged import refused
from scenes import (
    ANGLES,
    UvMap,
    add_ball,
    add_cone_cube,
    add_cube,
    add_grid,
    add_tube,
    changed,
    corners,
    edit,
    mark,
    marked,
    plain_copy,
    select_elements,
    selected,
    snapshot,
)

angles = addon.mesh.angles
angle_table, angle_panel = addon.jobs.angles.angle_table, addon.ui.angle_panel
native = addon.core.native

lsgp = native.lsgp
Kind = addon.core.cone_angles.Kind
SETTINGS = angle_table.TableSettings("uv_cones", "follow", "free")
BOTH = {"attribute uv_cone_angle POINT FLOAT", "attribute uv_cone_angle_kind POINT INT"}


def table(obj, settings=SETTINGS):
    bpy.context.view_layer.update()
    return angle_table.current_table(obj, settings)


def rows(obj):
    return {row.vertex: row for part in table(obj) for row in part.rows}


def stored(obj):
    """Cones, their angles and kinds as read by the add-on."""
    found = angles.read_angles(obj, "uv_cones")
    return dict(zip(found.cones.tolist(), zip(found.angles, found.kinds, strict=True), strict=True))


def set_angle(obj, vertices, degrees):
    select_elements(obj, "verts", vertices)
    return bpy.ops.mesh.cone_set_angle(angle=radians(degrees))


# --- where angles are kept ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_angles_are_read_as_they_were_written(in_edit_mode):
    cube = add_cone_cube()
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    three = corners(cube)[:3] if not in_edit_mode else marked(cube)[:3]
    angles.write_angles(cube, three, [1.25, 1.5 * pi, None], [Kind.FOUND, Kind.SNAPPED, Kind.SNAPPED])
    found = stored(cube)
    assert found[three[0]] == (pytest.approx(1.25, abs=1e-7), Kind.FOUND)
    # Whole degrees do not lose by single precision; without an angle there is no kind.
    assert found[three[1]] == (1.5 * pi, Kind.SNAPPED)
    assert found[three[2]] == (None, Kind.PRESCRIBED)
    assert changed(before, snapshot(cube)) == BOTH


def test_angles_survive_a_file_a_copy_and_joining(tmp_path):
    cube = add_cone_cube()
    wanted = corners(cube)[:2]
    angles.write_angles(cube, wanted, [pi, 1.25], [Kind.PRESCRIBED, Kind.SNAPPED])
    before = stored(cube)
    path = str(tmp_path / "cube.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    cube = bpy.data.objects["Cube"]
    assert stored(cube) == before
    bpy.ops.object.duplicate()
    twin = bpy.context.object
    assert twin != cube and stored(twin) == before
    twin.location.x = 5
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.join()
    half = len(cube.data.vertices) // 2
    assert stored(cube) == before | {vertex + half: value for vertex, value in before.items()}


def test_subdividing_and_beveling_leave_angles_to_the_cones_that_had_them():
    cube = add_cone_cube(cuts=0)
    mark(cube, [])
    first = corners(cube)[0]
    cube.vertex_groups["uv_cones"].remove([v for v in range(8) if v != first])
    angles.write_angles(cube, [first], [pi], [Kind.SNAPPED])
    edit(cube)
    bpy.ops.mesh.subdivide(number_cuts=3)
    found = stored(cube)
    # Blender shares out the weight to the new vertices around; where they get most of it, they are cones of no angle.
    assert found[first] == (pi, Kind.SNAPPED)
    assert len(found) > 1 and {value for vertex, value in found.items() if vertex != first} == {
        (None, kind) for _, kind in found.values() if (None, kind) in found.values()
    }
    assert [angle for angle, _ in found.values() if angle is not None] == [pi]


def test_edits_elsewhere_keep_every_angle_at_its_place():
    ball = add_ball()
    where = {tuple(ball.data.vertices[v].co): v for v in marked(ball)}
    wanted = dict(zip(where, np.linspace(1, 5, len(where)).tolist(), strict=True))
    angles.write_angles(ball, where.values(), wanted.values(), [Kind.PRESCRIBED] * len(where))
    edit(ball, select="DESELECT")
    bm = bmesh.from_edit_mesh(ball.data)
    cones = set(marked(ball))
    far = next(f for f in bm.faces if not {v.index for v in f.verts} & cones)
    bmesh.ops.poke(bm, faces=[far])
    bmesh.update_edit_mesh(ball.data)
    bpy.ops.mesh.sort_elements(type="REVERSE", elements={"VERT"})
    bpy.ops.object.mode_set(mode="OBJECT")
    found = {tuple(ball.data.vertices[v].co): angle for v, (angle, _) in stored(ball).items()}
    assert found == pytest.approx(wanted, abs=1e-6)


def test_a_typed_attribute_alone_prescribes():
    cube = add_cone_cube()
    first = corners(cube)[0]
    cube.data.attributes.new(ANGLES, "FLOAT", "POINT").data[first].value = pi
    assert stored(cube)[first] == (pi, Kind.PRESCRIBED)
    assert rows(cube)[first].kind == Kind.PRESCRIBED


def test_attributes_of_another_make_are_left_alone_and_said():
    cube = add_cone_cube()
    cube.data.attributes.new(ANGLES, "INT", "FACE")
    edit(cube)
    before = snapshot(cube)
    with pytest.raises(RuntimeError, match='"uv_cone_angle" is not a float attribute on points; rename it'):
        bpy.ops.mesh.cone_set_angle(angle=pi)
    assert changed(before, snapshot(cube)) == set()


def test_clear_cone_gives_up_its_angle():
    cube = add_cone_cube()
    first = corners(cube)[0]
    angles.write_angles(cube, [first], [pi], [Kind.SNAPPED])
    edit(cube)
    select_elements(cube, "verts", [first])
    bpy.ops.mesh.cone_mark(clear=True)
    bpy.ops.mesh.cone_mark()
    assert stored(cube)[first] == (None, Kind.PRESCRIBED)


# --- the table and its ledger ---------------------------------------------------------------------------------------


def test_the_table_shows_every_cone_with_angle_kind_and_curvature():
    cube = add_cone_cube()
    a, b, *others = corners(cube)
    angles.write_angles(cube, [a, b], [pi, 1.5 * pi], [Kind.PRESCRIBED, Kind.SNAPPED])
    shown = {vertex: replace(row, place="") for vertex, row in rows(cube).items()}
    assert shown[a] == angle_table.Row(a, pi, Kind.PRESCRIBED, pi)
    assert shown[b] == angle_table.Row(b, 1.5 * pi, Kind.SNAPPED, 0.5 * pi)
    assert all(shown[v] == angle_table.Row(v, None, None, None) for v in others)
    (part,) = table(cube)
    assert part.ledger.assigned == pytest.approx(1.5 * pi)
    assert part.ledger.missing == pytest.approx(2.5 * pi)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_ledger_says_what_becomes_of_the_curvature(in_edit_mode):
    def said(obj):
        if in_edit_mode:
            edit(obj)
        text = [angle_table.verdict(part.ledger) for part in table(obj)]
        if in_edit_mode:
            bpy.ops.object.mode_set(mode="OBJECT")
        return text

    assert said(add_cube()) == ["No cone: mark some, or place them"]
    cube = add_cone_cube()
    assert said(cube) == ["Left to 8 automatic cones"]
    angles.write_angles(cube, corners(cube), [1.5 * pi] * 8, [Kind.PRESCRIBED] * 8)
    assert said(cube) == ["All curvature is assigned"]
    angles.write_angles(cube, corners(cube)[:1], [pi], [Kind.PRESCRIBED])
    assert said(cube) == ["Does not add up: spread the rest, or change an angle"]
    angles.write_angles(cube, corners(cube), [None, *[2 * pi] * 7], [Kind.PRESCRIBED] * 8)
    assert said(cube) == ["Too much for 1 automatic cone: mark more"]
    assert said(add_tube()) == ["The boundary takes up the rest"]


def test_parts_have_a_ledger_each():
    cube, grid = add_cone_cube(), add_grid()
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.join()
    first, second = table(cube)
    assert [len(part.rows) for part in (first, second)] == [8, 0]
    assert (first.ledger.borders, second.ledger.borders) == (0, 1)
    assert grid is not None


def test_the_table_is_read_again_when_the_mesh_has_changed():
    cube = add_cone_cube()
    before = table(cube)
    assert table(cube) is before
    edit(cube)
    again = table(cube)
    assert len(again[0].rows) == len(before[0].rows)
    select_elements(cube, "verts", marked(cube)[:1])
    bpy.ops.mesh.cone_mark(clear=True)
    assert len(rows(cube)) == 7
    bpy.ops.mesh.cone_set_angle(vertex=marked(cube)[0], angle=pi)
    assert rows(cube)[marked(cube)[0]].angle == pi
    assert len(rows(cube)) == 7


def test_large_meshes_are_read_when_asked(monkeypatch):
    monkeypatch.setattr(angle_table, "LARGEST_UNASKED", 10)
    cube = add_cone_cube()
    assert table(cube) is None
    assert bpy.ops.mesh.cone_update_table() == {"FINISHED"}
    assert len(rows(cube)) == 8


class Drawn:
    """Stands for a panel's layout and keeps the text and operators drawn."""

    def __init__(self, lines):
        self.lines = lines

    def _part(self, **_options):
        return Drawn(self.lines)

    row = column = box = split = _part

    def label(self, text="", icon="NONE"):
        self.lines.append(text)

    def operator(self, name, text="", icon="NONE", **_options):
        self.lines.append((text or name) + (f" {icon}" if icon != "NONE" else ""))
        return type("Properties", (), {})()


def drawn_lines():
    panel = type("Panel", (), {k: v for k, v in vars(angle_panel.VIEW3D_PT_cone_angles).items() if callable(v)})()
    panel.layout = Drawn([])
    panel.draw(bpy.context)
    return panel.layout.lines


def place_of(corner):
    """The name of a corner of the active cube."""
    x, y, z = (at > 0 for at in bpy.context.object.data.vertices[corner].co)
    return f"{('Low', 'Top')[z]} {('Front', 'Back')[y]} {('Left', 'Right')[x]}"


def test_cones_are_named_by_where_they_are_seen():
    box = [(-1, -2, -3), (1, 2, 3)]
    points = [(-1, -2, 3), (0, 0, 0), (0.9, 0, -3), (0.8, 0.1, -2.9), (0, 2, 0)]
    names = addon.core.places.place_names(points, box)
    assert names == ["Top Front Left", "Middle", "Low Right 1", "Low Right 2", "Back"]
    # A flat model has no front and back.
    assert addon.core.places.place_names([(1, 0, 1)], [(0, 0, 0), (1, 0, 1)]) == ["Top Right"]


def test_automatic_cones_have_the_angle_of_the_last_unwrap():
    first = corners(add_cone_cube())[0]
    before = drawn_lines()
    at = before.index(place_of(first))
    assert before[at : at + 3] == [place_of(first), "—", ""]
    bpy.ops.uv.cone_unwrap()
    bpy.context.view_layer.update()
    assert drawn_lines()[at : at + 3] == [place_of(first), "~270.0°", "+90.0°"]


def test_the_panel_draws_the_table_and_the_fixes():
    cube = add_cone_cube()
    first = corners(cube)[0]
    angles.write_angles(cube, [first], [pi], [Kind.SNAPPED])
    bpy.context.view_layer.update()
    lines = drawn_lines()
    assert lines[:3] == ["Assigned 180.0° of 720.0°", "Missing 540.0°", "Left to 7 automatic cones"]
    assert lines[3:6] == ["Cone", "Angle", "Curvature"]
    at = lines.index(place_of(first))
    assert lines[at : at + 3] == [place_of(first), "180.0° SNAP_ON", "+180.0°"]
    assert [line for line in lines if line.startswith("mesh.")] == [
        "mesh.cone_spread_rest",
        "mesh.cone_snap_angles",
        "mesh.cone_suggest",
        "mesh.cone_preview",
    ]
    assert angle_panel.VIEW3D_PT_cone_angles.poll(bpy.context)


def test_a_click_selects_the_cone():
    cube = add_cone_cube()
    first, second = corners(cube)[:2]
    edit(cube, select="DESELECT")
    assert bpy.ops.mesh.cone_select_one(vertex=first) == {"FINISHED"}
    assert selected(cube) == [first]
    bpy.ops.mesh.cone_select_one(vertex=second, extend=True)
    assert selected(cube) == sorted([first, second])
    assert bpy.ops.mesh.cone_select_one(vertex=10**6) == {"CANCELLED"}


def test_a_click_in_object_mode_selects_the_cone_and_draws_it_larger():
    cube = add_cone_cube()
    first, second = corners(cube)[:2]
    cache = addon.overlay.cache
    assert bpy.ops.mesh.cone_select_one(vertex=first) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert cache.entry(cube).content.active == first
    assert bpy.ops.mesh.cone_select_one(vertex=second, extend=True) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert cache.entry(cube).content.active == second
    bpy.ops.object.mode_set(mode="EDIT")
    assert selected(cube) == sorted([first, second])
    # There the selection shows it.
    assert cache.entry(cube).content.active is None


# --- setting angles -------------------------------------------------------------------------------------------------


def test_an_angle_is_set_on_the_selected_cones_and_kept_by_the_unwrap(reports):
    ball = add_ball()
    cone, other = marked(ball)[:2]
    edit(ball)
    before = snapshot(ball)
    assert set_angle(ball, [cone, len(ball.data.vertices) - 1], 200) == {"FINISHED"}
    assert "1 cone set to 200.0°" in reports()
    assert {name for name in changed(before, snapshot(ball)) if "select" not in name} == BOTH
    assert stored(ball)[cone] == (radians(200), Kind.PRESCRIBED)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    assert UvMap(ball).angle_sum(cone) == pytest.approx(radians(200), abs=1e-4)
    bpy.ops.mesh.cone_set_angle(vertex=cone, automatic=True)
    assert stored(ball)[cone][0] is None
    assert stored(ball)[other][0] is None


def test_setting_an_angle_gives_a_cone_full_weight():
    cube = add_cone_cube()
    first = corners(cube)[0]
    cube.vertex_groups["uv_cones"].add([first], 0.6, "REPLACE")
    edit(cube)
    set_angle(cube, [first], 180)
    assert stored(cube)[first] == (pi, Kind.PRESCRIBED)


def test_what_is_missing_after_setting_is_said(reports):
    cube = add_cone_cube()
    edit(cube)
    set_angle(cube, marked(cube), 270)
    assert "8 cones set to 270.0°" in reports() and angle_table.verdict(table(cube)[0].ledger).startswith("All")
    set_angle(cube, marked(cube)[:1], 180)
    assert "-90.0° of curvature is missing now" in reports()
    select_elements(cube, "verts", range(len(cube.data.vertices)))
    with refused("GAUSS_BONNET"):
        bpy.ops.uv.cone_unwrap()


def test_angles_that_no_map_has_are_refused_and_not_kept():
    cube = add_cone_cube()
    edit(cube)
    first = marked(cube)[0]
    before = snapshot(cube)
    with refused("CONE_ANGLE_RANGE"):
        bpy.ops.mesh.cone_set_angle(vertex=first, angle=radians(2000))
    assert changed(before, snapshot(cube)) == set()
    bpy.ops.mesh.cone_select_reported()
    assert selected(cube) == [first]


def test_angles_that_are_impossible_together_are_refused():
    ball = add_ball()
    triangles = addon.mesh.reader.reader(ball.data).all_triangles()
    valence = np.bincount(triangles.ravel())
    pairs = [pair for triangle in triangles.tolist() for pair in permutations(triangle, 2)]
    first, second = min(pairs, key=lambda pair: valence[list(pair)].sum())
    mark(ball, [first, second])
    edit(ball)
    # Each by itself has room; but two of their triangles are the same.
    bpy.ops.mesh.cone_set_angle(vertex=first, angle=(valence[first] - 0.9) * pi)
    before = snapshot(ball)
    with refused("ANGLES_IMPOSSIBLE"):
        bpy.ops.mesh.cone_set_angle(vertex=second, angle=(valence[second] - 0.9) * pi)
    assert changed(before, snapshot(ball)) == set()


def test_setting_without_a_selected_cone_is_refused():
    cube = add_cone_cube()
    edit(cube, select="DESELECT")
    with pytest.raises(RuntimeError, match="no selected vertex is a cone"):
        bpy.ops.mesh.cone_set_angle(angle=pi)


# --- the fixes ------------------------------------------------------------------------------------------------------


def test_the_rest_is_spread_over_automatic_cones(reports):
    ball = add_ball()
    fixed, *others = marked(ball)
    edit(ball)
    set_angle(ball, [fixed], 200)
    assert bpy.ops.mesh.cone_spread_rest() == {"FINISHED"}
    assert "spread over 7 cones, expected stretch 1." in reports()
    (part,) = table(ball)
    assert part.ledger.complete and part.ledger.missing == pytest.approx(0, abs=1e-9)
    shown = rows(ball)
    assert shown[fixed].kind == Kind.PRESCRIBED
    assert all(shown[v].kind == Kind.FOUND for v in others)
    # The same as the unwrap would have found.
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(ball)
    for vertex in (fixed, *others):
        assert uv_map.angle_sum(vertex) == pytest.approx(shown[vertex].angle, abs=1e-4)


def test_the_rest_is_spread_over_selected_cones():
    ball = add_ball()
    cones = marked(ball)
    edit(ball)
    set_angle(ball, cones, 250)
    select_elements(ball, "verts", cones[:3])
    assert bpy.ops.mesh.cone_spread_rest(selected=True) == {"FINISHED"}
    found = stored(ball)
    assert all(found[v] == (radians(250), Kind.PRESCRIBED) for v in cones[3:])
    assert sum(2 * pi - found[v][0] for v in cones) == pytest.approx(4 * pi, abs=1e-5)
    assert table(ball)[0].ledger.complete


def test_spreading_over_no_cone_is_refused():
    cube = add_cone_cube()
    edit(cube)
    set_angle(cube, marked(cube), 250)
    for options, reason in (({}, "no cone is automatic"), ({"selected": True}, "no cone is selected")):
        bpy.ops.mesh.select_all(action="DESELECT")
        before = snapshot(cube)
        with pytest.raises(RuntimeError, match=reason):
            bpy.ops.mesh.cone_spread_rest(**options)
        assert changed(before, snapshot(cube)) == set()
    bpy.ops.object.mode_set(mode="OBJECT")
    add_cube("Bare")
    with pytest.raises(RuntimeError, match="no cone is marked"):
        bpy.ops.mesh.cone_spread_rest()


def test_a_rest_that_nobody_can_take_up_is_refused_with_the_sums():
    cube = add_cone_cube()
    first, *others = corners(cube)
    angles.write_angles(cube, others, [2 * pi] * 7, [Kind.PRESCRIBED] * 7)
    before = snapshot(cube)
    with refused("GAUSS_BONNET"):
        bpy.ops.mesh.cone_spread_rest()
    assert changed(before, snapshot(cube)) == set()
    assert first not in [v for v, (angle, _) in stored(cube).items() if angle]


@pytest.mark.parametrize(("lattice", "turn"), [("SQUARE", 90), ("STRIPE", 180), ("HEXAGON", 60)])
def test_snapped_angles_are_turns_that_add_up(lattice, turn):
    ball = add_ball()
    assert bpy.ops.mesh.cone_snap_angles(lattice=lattice) == {"FINISHED"}
    found = stored(ball)
    turns = np.array([angle for angle, _ in found.values()]) / radians(turn)
    assert np.abs(turns - turns.round()).max() < 1e-12
    assert {kind for _, kind in found.values()} == {Kind.SNAPPED}
    assert table(ball)[0].ledger.complete


def test_snapping_keeps_prescribed_turns_and_rounds_the_others():
    ball = add_ball()
    first, second, *_ = marked(ball)
    angles.write_angles(ball, [first, second], [1.5 * pi, radians(200)], [Kind.PRESCRIBED] * 2)
    bpy.ops.mesh.cone_snap_angles()
    found = stored(ball)
    assert found[first] == (1.5 * pi, Kind.PRESCRIBED)
    assert found[second][1] == Kind.SNAPPED and (found[second][0] / (pi / 2)) % 1 == 0


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_next_cone_is_where_the_library_says(reports, in_edit_mode):
    cube = add_cube()
    mark(cube, corners(cube)[:7])
    wanted = corners(cube)[7]
    if in_edit_mode:
        edit(cube)
    assert bpy.ops.mesh.cone_suggest() == {"FINISHED"}
    assert f"vertex {wanted}, expected stretch 1." in reports()
    assert wanted in marked(cube)
    if in_edit_mode:
        assert selected(cube) == [wanted]
    # On a cube nothing is left to gain.
    with pytest.raises(RuntimeError, match="no further cone lowers the stretch"):
        bpy.ops.mesh.cone_suggest()


def test_what_a_suggestion_gains_is_told_of_its_part(reports):
    cube, ball = add_cube(), add_cone_cube("Ball", cuts=4)
    mark(cube, corners(cube)[:7])
    ball.location.x = 5
    bpy.context.view_layer.objects.active = cube
    bpy.ops.mesh.cone_preview()
    alone = reports().split("Cube: expected stretch ")[1].split(" ")[0]
    bpy.ops.object.join()
    assert bpy.ops.mesh.cone_suggest() == {"FINISHED"}
    assert f"vertex {corners(cube)[7]}, expected stretch 1.000, {alone} without it" in reports()


def test_a_suggestion_need_not_be_marked():
    cube = add_cube()
    mark(cube, corners(cube)[:7])
    edit(cube)
    assert bpy.ops.mesh.cone_suggest(mark=False) == {"FINISHED"}
    assert marked(cube) == corners(cube)[:7] if cube.mode == "OBJECT" else len(marked(cube)) == 7


# --- placed cones ---------------------------------------------------------------------------------------------------


def test_placed_angles_are_those_unwrapped_with():
    ball = add_ball()
    ball.vertex_groups.clear()
    assert bpy.ops.mesh.cone_place(automatic=False, count=10) == {"FINISHED"}
    shown = rows(ball)
    assert len(shown) == 10 and all(row.kind == Kind.FOUND for row in shown.values())
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(ball)
    for vertex, row in shown.items():
        assert uv_map.angle_sum(vertex) == pytest.approx(row.angle, abs=1e-4)


def test_placed_angles_are_automatic_again_once_the_cones_change():
    ball = add_ball()
    ball.vertex_groups.clear()
    bpy.ops.mesh.cone_place(automatic=False, count=10)
    edit(ball)
    gone = marked(ball)[4]
    select_elements(ball, "verts", [gone])
    bpy.ops.mesh.cone_mark(clear=True)
    assert [row.angle for row in rows(ball).values()] == [None] * 9
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    # With one of them prescribed too.
    other = marked(ball)[0]
    bpy.ops.mesh.cone_set_angle(vertex=other, angle=radians(300))
    assert [row.angle for row in rows(ball).values()] == [radians(300), *[None] * 8]


def test_placing_keeps_prescribed_angles_of_kept_cones():
    ball = add_ball()
    first, second = marked(ball)[:2]
    ball.vertex_groups["uv_cones"].remove([v for v in marked(ball) if v not in (first, second)])
    angles.write_angles(ball, [first], [radians(240)], [Kind.PRESCRIBED])
    bpy.ops.mesh.cone_place(automatic=False, count=9)
    found = stored(ball)
    assert len(found) == 9 and {first, second} <= found.keys()
    assert found[first] == (radians(240), Kind.PRESCRIBED)
    assert all(kind == Kind.FOUND for vertex, (_, kind) in found.items() if vertex != first)
    assert table(ball)[0].ledger.complete
    # Not kept, they give way with their angles.
    bpy.ops.mesh.cone_place(automatic=False, count=8, keep=False)
    gone = plain_copy(ball)
    values = {v: gone.attributes["uv_cone_angle"].data[v].value for v in range(len(gone.vertices))}
    bpy.data.meshes.remove(gone)
    assert {vertex for vertex, value in values.items() if value} == set(marked(ball))


def test_placing_for_a_seamless_layout_gives_quarter_turns():
    ball = add_ball()
    ball.vertex_groups.clear()
    assert bpy.ops.mesh.cone_place(automatic=False, count=8, seamless=True) == {"FINISHED"}
    turns = [angle / (pi / 2) for angle, _ in stored(ball).values()]
    assert turns == [round(turn) for turn in turns]
    assert bpy.ops.uv.cone_unwrap(seamless=True) == {"FINISHED"}


def test_placing_within_a_stretch_that_is_told(reports):
    ball = add_ball(cuts=5)
    ball.vertex_groups.clear()
    bpy.ops.mesh.cone_place(target=1.2)
    few = len(marked(ball))
    assert re.search(r", \d+\.\d % stretch", reports())
    ball.vertex_groups.clear()
    bpy.ops.mesh.cone_place(target=1.005)
    assert few < len(marked(ball))


def test_symmetric_cones_have_their_mirror_images():
    ball = add_cube(cuts=5)
    for vertex in ball.data.vertices:
        x, y, z = vertex.co.normalized()
        vertex.co = vertex.co.normalized() * (1.0 + 0.2 * np.cos(3 * x) * np.sin(2 * y + 1) * np.cos(z - 0.4))
    bpy.ops.mesh.cone_place(automatic=False, count=9, symmetric=True, mirror="X")
    found = stored(ball)
    places = {tuple(np.round(ball.data.vertices[v].co, 5) + 0.0): angle for v, (angle, _) in found.items()}
    assert len(places) >= 8
    for (x, y, z), angle in places.items():
        assert places[(-x + 0.0, y, z)] == pytest.approx(angle, abs=1e-5)


# --- the preview ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_preview_is_the_scale_of_the_map_to_come(reports, in_edit_mode):
    ball = add_ball(cuts=7)
    if in_edit_mode:
        edit(ball)
    before = snapshot(ball)
    assert bpy.ops.mesh.cone_preview() == {"FINISHED"}
    assert changed(before, snapshot(ball)) == {"attribute uv_cone_log_scale POINT FLOAT"}
    expected = float(reports().split("stretch ")[1].split(" ")[0])
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(ball)
    assert uv_map.l2_stretch() == pytest.approx(expected, rel=0.02)
    copy = plain_copy(ball)
    scale = np.array([value.value for value in copy.attributes["uv_cone_log_scale"].data])
    bpy.data.meshes.remove(copy)
    ends = np.array([sides[0] for sides in uv_map.sides.values()])
    vertices = uv_map.vertex[ends]
    flat = np.linalg.norm(np.diff(uv_map.uv[ends], axis=1)[:, 0], axis=1)
    measured = np.log(flat / np.linalg.norm(np.diff(uv_map.positions[vertices], axis=1)[:, 0], axis=1))
    predicted = scale[vertices].mean(axis=1)
    assert np.corrcoef(measured, predicted)[0, 1] > 0.95
    assert bpy.ops.mesh.cone_preview() == {"FINISHED"}


def test_the_gain_of_one_more_cone_is_largest_where_it_is_suggested():
    cube = add_cube()
    mark(cube, corners(cube)[:7])
    assert bpy.ops.mesh.cone_preview(gains=True) == {"FINISHED"}
    gain = np.array([value.value for value in cube.data.attributes["uv_cone_gain"].data])
    assert np.isfinite(gain).all() and gain.min() >= 0
    assert gain.argmax() == corners(cube)[7]
    assert not gain[corners(cube)[:7]].any()


def test_the_preview_of_an_impossible_set_is_refused_and_writes_nothing():
    cube = add_cone_cube()
    angles.write_angles(cube, corners(cube), [pi] * 8, [Kind.PRESCRIBED] * 8)
    before = snapshot(cube)
    with refused("GAUSS_BONNET"):
        bpy.ops.mesh.cone_preview(gains=True)
    assert changed(before, snapshot(cube)) == set()


@pytest.mark.parametrize("name", ["set_angle", "spread_rest", "snap_angles", "suggest", "preview"])
def test_properties_have_tooltips_and_operators_ask_for_a_mesh(name):
    operator = getattr(bpy.ops.mesh, f"cone_{name}")
    assert not operator.poll()
    for prop in operator.get_rna_type().properties:
        if prop.identifier not in {"rna_type", "bl_idname", "bl_label"}:
            assert prop.name and prop.description and not prop.description.endswith(".")
