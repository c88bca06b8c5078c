# SPDX-License-Identifier: GPL-3.0-or-later
"""The number of threads in the preferences: every computation uses it, and all numbers give the same UV map."""

import threading
from dataclasses import dataclass, replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from installed import EXTENSION, addon
from scenes import add_ball, add_cone_cube, edit, snapshot, uv_key

lsgp = addon.core.native.lsgp
cone_session, properties = addon.jobs.sessions.cone_session, addon.operators.unwrapping.properties


@pytest.fixture
def preferences():
    """Those of the extension, put back after the test."""
    preferences = bpy.context.preferences.addons[EXTENSION].preferences
    yield preferences
    preferences.property_unset("threads")


@pytest.fixture
def threads_taken(monkeypatch):
    """The number passed in each call of the library."""
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


# --- several objects ------------------------------------------------------------------------------------------------

solving = addon.jobs.tasks.solving


@dataclass(frozen=True)
class Work:
    """A task of a number of triangles."""

    name: str
    triangles: int
    threads: int = 2

    @property
    def region(self):
        return SimpleNamespace(surface=SimpleNamespace(triangles=range(self.triangles)))

    def with_threads(self, count):
        return replace(self, threads=count)


def test_small_objects_are_solved_side_by_side_and_share_the_threads():
    both = threading.Barrier(2, timeout=10)

    def solve(task, progress):
        if task.triangles < solving.MOST_SIDE_BY_SIDE:
            both.wait()
            assert progress(0.5)
        return task.name, task.threads

    large = solving.MOST_SIDE_BY_SIDE + 1
    tasks = [Work("a", 10), Work("large", large), Work("b", 20), Work("c", 30), Work("d", 40)]
    expected = [("a", 1), ("large", 2), ("b", 1), ("c", 1), ("d", 1)]
    assert solving.solve_all(tasks, solve) == expected


def test_several_objects_have_one_progress_that_rises_to_the_end():
    told = []

    def solve(task, progress):
        for step in range(5):
            progress(step / 4)

    solving.solve_all([Work(str(i), 10 * i) for i in range(1, 9)], solve, told.append)
    assert told == sorted(told)
    assert len(told) == 40
    assert told[-1] == pytest.approx(1)


def test_errors_stay_with_their_object_and_a_stop_ends_all():
    started = threading.Barrier(2, timeout=10)

    def refuse(task, progress):
        if task.name == "b":
            raise lsgp.InputError("WRONG_PARAMETER", "no")
        return task.name

    told = []
    outcomes = solving.solve_all([Work("a", 1), Work("b", 1), Work("c", 1)], refuse, told.append)
    assert [outcomes[0], outcomes[2]] == ["a", "c"]
    assert isinstance(outcomes[1], lsgp.InputError)
    assert told == [pytest.approx(1 / 3)]

    solved = []

    def until_stopped(task, progress):
        started.wait()
        while progress(0.1):
            pass
        solved.append(task.name)
        raise lsgp.Cancelled("CANCELLED", "stopped")

    with pytest.raises(lsgp.Cancelled):
        solving.solve_all([Work(name, 1) for name in "abcd"], until_stopped, lambda done: len(solved) > 5)
    assert sorted(solved) == ["a", "b"]


def test_what_progress_raises_is_raised():
    def fail(done):
        raise RuntimeError("the window is gone")

    with pytest.raises(RuntimeError, match="the window is gone"):
        solving.solve_all([Work("a", 1), Work("b", 1)], lambda task, progress: progress(0.5), fail)


@pytest.mark.one_blender
def test_maps_of_several_objects_are_the_same_for_any_number(preferences):
    objects = [add_ball(), add_cone_cube(), add_ball()]
    for obj in objects:
        obj.select_set(True)
    maps = []
    for preferences.threads in (1, 3):
        assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
        maps.append([snapshot(obj)[uv_key()] for obj in objects])
    for one, several in zip(*maps, strict=True):
        assert np.array_equal(one, several)
