# SPDX-License-Identifier: GPL-3.0-or-later
"""The latest maps are cached, and anything that affects a map invalidates its entry."""

import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_cone_cube, add_cube, edit, mark, mark_seams, pin, set_uv

remembered, lsgp = addon.jobs.layouts.remembered, addon.core.native.lsgp


@pytest.fixture
def made(monkeypatch):
    """How many maps the library has made since it was last asked."""
    calls = []
    for verb in ("auto_unwrap", "parameterize"):
        work = getattr(lsgp, verb)
        monkeypatch.setattr(lsgp, verb, lambda *a, work=work, **k: calls.append(1) or work(*a, **k))

    def since() -> int:
        count = len(calls)
        calls.clear()
        return count

    return since


def uv_after(**options):
    assert bpy.ops.uv.cone_auto_unwrap(**options) == {"FINISHED"}
    return UvMap(bpy.context.object).uv


@pytest.mark.one_blender
def test_margins_and_presets_chosen_again_make_no_map(made):
    ball = add_ball()
    ball.vertex_groups.clear()
    first = {preset: uv_after(preset=preset) for preset in ("PAINT", "BAKE", "TILE")}
    assert made() == 3
    for preset, uv in first.items():
        assert np.array_equal(uv_after(preset=preset), uv)
    narrow = uv_after(margin=16, texture_size="256")
    uv_after(scale="DENSITY", density=20)
    assert made() == 0
    remembered.forget()
    assert np.array_equal(uv_after(margin=16, texture_size="256"), narrow) and made() == 1
    assert not np.array_equal(narrow, first["PAINT"])


def move(ball):
    ball.data.vertices[0].co.x += 0.125


def flip(ball):
    edit(ball)
    bpy.ops.mesh.flip_normals()
    bpy.ops.object.mode_set(mode="OBJECT")


def add_seam(ball):
    mark_seams(ball, [tuple(sorted(ball.data.edges[0].vertices))])


def sharpen(ball):
    ball.data.edges[0].use_edge_sharp = True


def add_cone(ball):
    mark(ball, [len(ball.data.vertices) - 1])


def prescribe(ball):
    cone = next(v.index for v in ball.data.vertices if v.groups)
    addon.mesh.angles.write_angles(ball, [cone], [4.5], [addon.core.cone_angles.Kind.PRESCRIBED])


def pin_some(ball):
    pin(ball, [0, 50], np.array([[0.1, 0.2], [0.6, 0.7]]))


def paint(ball):
    ball.vertex_groups.new(name="uv_seam_cost").add([0, 1, 2], 1.0, "REPLACE")


def turn(ball):
    ball.rotation_euler.x = 0.5


def stretch(ball):
    ball.scale.x = 2.0


@pytest.mark.slow
@pytest.mark.parametrize("change", [move, flip, add_seam, sharpen, add_cone, prescribe, pin_some, paint, turn, stretch])
def test_what_decides_the_map_makes_it_new(change, made):
    ball = add_ball()
    uv_after()
    assert made() == 1
    change(ball)
    bpy.context.view_layer.update()
    new = uv_after()
    assert made() == 1
    remembered.forget()
    assert np.array_equal(new, uv_after())


def test_the_present_map_decides_where_it_is_kept(made):
    ball = add_ball()
    uv_after()
    for options, maps in ({}, 1), ({"keep_placement": True}, 1):
        assert bpy.ops.uv.cone_unwrap(**options) == {"FINISHED"}
        assert made() >= maps
        set_uv(ball, 0.5 * UvMap(ball).uv + 3)
        assert bpy.ops.uv.cone_unwrap(**options) == {"FINISHED"}
        assert made() == (1 if options else 0)


def test_edits_in_edit_mode_count(made):
    cube = add_cone_cube()
    edit(cube)
    bpy.ops.uv.cone_auto_unwrap()
    bmesh.from_edit_mesh(cube.data).verts.ensure_lookup_table()
    bmesh.from_edit_mesh(cube.data).verts[0].co.z -= 0.5
    bmesh.update_edit_mesh(cube.data)
    bpy.ops.uv.cone_auto_unwrap()
    assert made() == 2


@pytest.mark.one_blender
def test_objects_alike_share_a_map_and_little_is_kept(made, monkeypatch):
    for name in "ABC":
        add_cube(name, cuts=1).location.x = 3.0 * ord(name)
    bpy.context.view_layer.update()
    uv_after()
    assert made() == 1
    monkeypatch.setattr(remembered, "MOST_TRIANGLES", 100)
    add_ball()
    uv_after()
    assert not remembered._kept
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not remembered._kept


@dataclass(frozen=True)
class Made:
    """What `remembered` takes for a task, and for its map."""

    number: int
    region: object


def test_maps_are_remembered_from_several_threads(monkeypatch):
    most = 50
    region = SimpleNamespace(surface=SimpleNamespace(triangles=range(remembered.MOST_TRIANGLES // most)))
    monkeypatch.setattr(remembered, "digest", lambda task: task.number)
    monkeypatch.setattr(remembered, "unwrap", lambda task, progress: task)
    remembered.forget()
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(4) as pool:
            found = list(pool.map(lambda number: remembered._unwrap_once(Made(number, region), None), range(4000)))
    finally:
        sys.setswitchinterval(interval)
    assert [made.number for made in found] == list(range(4000))
    assert len(remembered._kept) == most
    remembered.forget()
