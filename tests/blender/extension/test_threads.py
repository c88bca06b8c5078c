# SPDX-License-Identifier: GPL-3.0-or-later
"""The number of threads in the preferences: every computation takes it, and the UV map is the same for any."""

import bpy
import numpy as np
import pytest
from installed import EXTENSION, addon
from scenes import add_ball, add_cone_cube, edit, snapshot, uv_key

lsgp = addon.core.native.lsgp
cone_session, properties = addon.jobs.cone_session, addon.operators.unwrapping.properties


@pytest.fixture
def preferences():
    """Those of the extension, put back after the test."""
    preferences = bpy.context.preferences.addons[EXTENSION].preferences
    yield preferences
    preferences.property_unset("threads")


@pytest.fixture
def threads_taken(monkeypatch):
    """By each call of the library, as it is told."""
    told = []

    def record(name, threads_of):
        real = getattr(lsgp, name)

        def call(*args, **more):
            told.append((name, threads_of(args, more)))
            return real(*args, **more)

        monkeypatch.setattr(lsgp, name, call)

    def of_options(args, more):
        given = [value for value in (*args, *more.values()) if isinstance(value, lsgp.Options)]
        return given[0].threads

    for name in ("parameterize", "auto_unwrap", "prescribe_curvature"):
        record(name, of_options)
    record("place_cones", lambda _args, more: more["threads"])
    return told


def test_it_is_left_to_the_library_unless_chosen(preferences, threads_taken):
    assert preferences.threads == 0
    add_cone_cube()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert threads_taken == [("parameterize", 0)]


def test_every_operator_that_computes_takes_it(preferences, threads_taken):
    preferences.threads = 3
    cube = add_cone_cube()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    assert bpy.ops.mesh.cone_place(keep=False) == {"FINISHED"}
    edit(cube)
    assert bpy.ops.mesh.cone_snap_angles() == {"FINISHED"}
    assert bpy.ops.mesh.cone_preview() == {"FINISHED"}
    assert {name for name, _ in threads_taken} == {"parameterize", "auto_unwrap", "place_cones", "prescribe_curvature"}
    assert {threads for _, threads in threads_taken} == {3}


def test_edit_cones_takes_it(preferences):
    preferences.threads = 3
    cube = add_cone_cube()
    edit(cube, select="DESELECT")
    chosen = bpy.context.window_manager.operator_properties_last("uv.cone_unwrap")
    session = cone_session.ConeSession(cube, properties.unwrap_settings(chosen))
    assert session.draft().task.options.threads == 3


def test_the_map_is_the_same_for_any_number(preferences):
    ball = add_ball()
    maps = []
    for preferences.threads in (1, 4):
        assert bpy.ops.uv.cone_auto_unwrap(preset="TILE") == {"FINISHED"}
        maps.append(snapshot(ball)[uv_key()])
    assert np.array_equal(maps[0], maps[1])
