# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a run in the background: reading, solving in a thread, finding what is to be written to again.

What needs a window is in in_window/invoke_tests.py.
"""

import threading

import bmesh
import bpy
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_cone_cube, add_sphere, changed, edit, snapshot

computation, unwrapping = addon.jobs.tasks.computation, addon.jobs.tasks.unwrapping
region_read, targets = addon.mesh.region_read, addon.mesh.targets
Refused = addon.core.errors.Refused

lsgp = addon.core.native.lsgp


def task(obj, **options):
    settings = unwrapping.UnwrapSettings(
        options=lsgp.Options(**options),
        cone_group="uv_cones",
        weight_group=None,
        weight_factor=1.0,
        use_pins=True,
        keep_placement=False,
        correct_aspect=True,
        cuts=addon.jobs.tasks.cuts.CutChoice(),
    )
    groups = region_read.Groups(settings.cone_group, settings.weight_group)
    return unwrapping.unwrap_task(region_read.read_region(obj, region_read.Faces.SELECTED, groups), settings)


# --- the computation ------------------------------------------------------------------------------------------------


def test_a_computation_runs_in_a_thread_of_its_own_and_returns_its_outcome():
    def compute(tell):
        assert tell(0.25)
        return threading.current_thread()

    running = computation.Computation(compute)
    assert running.finished(10)
    assert running.done == 0.25
    assert running.outcome() is not threading.current_thread()


def test_a_computation_is_told_to_stop():
    asked = threading.Event()

    def compute(tell):
        assert tell(0.0)
        asked.wait(10)
        return tell(0.5)

    running = computation.Computation(compute)
    assert not running.finished()
    running.stop()
    asked.set()
    assert running.finished(10)
    assert running.outcome() is False


def test_a_computation_raises_what_was_raised_in_it():
    def compute(tell):
        raise MemoryError("too much")

    running = computation.Computation(compute)
    assert running.finished(10)
    with pytest.raises(MemoryError, match="too much"):
        running.outcome()


# --- the tasks ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_stopping_at_any_time_leaves_everything_as_it_was(in_edit_mode):
    ball = add_ball()
    if in_edit_mode:
        edit(ball)
    before = snapshot(ball)
    gathered = task(ball, mode="low-stretch", overlaps="split")
    told = []
    unwrapping.unwrap_all([gathered], told.append)
    for limit in range(0, len(told), max(1, len(told) // 5)):
        calls = iter(range(limit))
        with pytest.raises(lsgp.Cancelled):
            unwrapping.unwrap_all([gathered], lambda done, calls=calls: next(calls, None) is not None)
    assert changed(before, snapshot(ball)) == set()


def test_progress_is_that_of_all_objects_together():
    tasks = [task(add_cone_cube("Small")), task(add_sphere("Refused")), task(add_ball("Large", cuts=9))]
    told = []
    small, refused, large = unwrapping.unwrap_all(tasks, told.append)
    assert isinstance(small, unwrapping.Unwrapped) and isinstance(large, unwrapping.Unwrapped)
    assert isinstance(refused, lsgp.TopologyError)
    assert told == sorted(told)
    assert told[0] < 0.1 and told[-1] == pytest.approx(1.0)


def test_progress_changes_nothing_in_the_map():
    gathered = task(add_ball())
    (told,), (untold,) = unwrapping.unwrap_all([gathered], lambda done: None), unwrapping.unwrap_all([gathered])
    assert told.corner_uv.tobytes() == untold.corner_uv.tobytes()


def test_invoked_without_a_window_it_runs_at_once():
    cube = add_cone_cube()
    before = UvMap(cube).uv
    assert bpy.ops.uv.cone_unwrap("INVOKE_DEFAULT") == {"FINISHED"}
    assert (UvMap(cube).uv != before).any()


# --- what is written to ---------------------------------------------------------------------------------------------


def move_vertex(obj):
    obj.data.vertices[3].co.z += 1e-3


def remove(obj):
    bpy.data.objects.remove(obj)


def add_face(obj):
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bm.faces.new([bm.verts.new(place) for place in ((0, 0, 0), (1, 0, 0), (0, 1, 0))])
    bm.to_mesh(obj.data)
    bm.free()


def turn_faces(obj):
    obj.data.flip_normals()


def other_layer(obj):
    obj.data.uv_layers.active = obj.data.uv_layers.new(name="Other")


def other_mesh(obj):
    obj.data = obj.data.copy()


CHANGES = (move_vertex, remove, add_face, turn_faces, other_layer, other_mesh, edit)


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_a_changed_mesh_is_not_written_to(change):
    cube = add_cone_cube()
    target = targets.target(cube)
    assert target.find() == cube
    change(cube)
    with pytest.raises(Refused, match="changed since this began"):
        target.find()


def test_a_mesh_changed_in_edit_mode_is_not_written_to():
    cube = add_cone_cube()
    edit(cube)
    target = targets.target(cube)
    bpy.ops.mesh.select_all(action="DESELECT")
    assert target.find() == cube
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 0.1))
    with pytest.raises(Refused):
        target.find()


def test_a_renamed_object_is_found_again():
    cube = add_cone_cube()
    target = targets.target(cube)
    cube.name = "Renamed"
    add_cone_cube("Cube")
    assert target.find() == cube
