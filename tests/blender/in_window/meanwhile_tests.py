# SPDX-License-Identifier: GPL-3.0-or-later
"""What may happen while an operator computes or a tool edits: meshes change or go, files are saved, pictures rendered.

Run by run_in_window.py, not by pytest.
"""

import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path
from threading import Event

import bmesh
import bpy
import edit_tests
import numpy as np
import pytest
from installed import addon
from invoke_tests import computing, stored_uv, unwrap, unwrapping
from scenes import add_ball, add_cone_cube, changed, edit, snapshot, uv_key
from windows import STEP, click, place_of, press, running, until

background = addon.operators.shared.background
TOOLS = ("mesh.cone_edit", "mesh.cone_edit_cuts", "mesh.cone_draw_up")


@contextmanager
def held():
    """The library unwraps nothing until what is given is called."""
    addon.jobs.layouts.remembered.forget()
    lsgp, released = addon.core.native.lsgp, Event()
    work = lsgp.parameterize

    def waiting(*arguments, **options):
        progress = options["progress"] if "progress" in options else arguments[-1]
        while not released.wait(STEP):
            if progress(0.5) is False:
                raise lsgp.Cancelled("CANCELLED", "Stopped.")
        return work(*arguments, **options)

    lsgp.parameterize = waiting
    try:
        yield released.set
    finally:
        lsgp.parameterize = work


@contextmanager
def heard():
    """The errors by which runs that end in here are concluded, by the names of objects."""
    conclude, failed = background.conclude, {}

    def listening(operator, done, warnings, failures):
        failed.update({name: str(error) for name, error in failures.items()})
        return conclude(operator, done, warnings, failures)

    background.conclude = listening
    try:
        yield failed
    finally:
        background.conclude = conclude


def remove_object(obj):
    bpy.data.objects.remove(obj)


def remove_mesh(obj):
    bpy.data.meshes.remove(obj.data)


def remove_mesh_in_edit_mode(obj):
    edit(obj)
    remove_mesh(obj)


def add_vertices(obj):
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=1)
    bm.to_mesh(obj.data)
    bm.free()


def clear_mesh(obj):
    obj.data.clear_geometry()


def swap_mesh(obj):
    obj.data = obj.data.copy()


def enter_sculpt_mode(obj):
    bpy.ops.object.mode_set(mode="SCULPT")


def make_other_layer_active(obj):
    obj.data.uv_layers.active = obj.data.uv_layers.new(name="Other")


CHANGES = (
    remove_object,
    remove_mesh,
    remove_mesh_in_edit_mode,
    add_vertices,
    clear_mesh,
    swap_mesh,
    enter_sculpt_mode,
    make_other_layer_active,
)


def test_what_is_changed_meanwhile_is_told_and_left_alone():
    for change in CHANGES:
        cube = add_cone_cube()
        with held() as release, heard() as failed:
            assert unwrap() == {"RUNNING_MODAL"}
            yield 0.1
            change(cube)
            after = None if "Cube" not in bpy.data.objects else snapshot(cube)
            release()
            yield from until(lambda: not unwrapping())
        assert failed.keys() == {"Cube"} and "has changed since this began" in failed["Cube"], change.__name__
        if after is not None:
            assert changed(after, snapshot(cube)) == set(), change.__name__
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.data.objects.remove(cube)


def test_an_object_that_is_renamed_or_moved_meanwhile_gets_its_map():
    cube = add_cone_cube()
    before = stored_uv(cube)
    with held() as release, heard() as failed:
        assert unwrap() == {"RUNNING_MODAL"}
        yield 0.1
        cube.name, cube.location = "Renamed", (1, 2, 3)
        other = add_cone_cube()
        release()
        yield from until(lambda: not unwrapping())
    assert not failed
    assert stored_uv(cube) != before and stored_uv(other) == before


def saved_uv(path, name):
    """The map of a mesh in a file, as `stored_uv` has it."""
    # Blender crashes where it takes something from the file that is open.
    with bpy.data.libraries.load(str(shutil.copy(path, path.with_name("other.blend")))) as (_, wanted):
        wanted.meshes = [name]
    (mesh,) = wanted.meshes
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uv)
    bpy.data.meshes.remove(mesh)
    return uv.tobytes()


def test_a_file_that_is_saved_meanwhile_has_everything_as_it_was():
    for in_edit_mode in (False, True):
        for options in ({}, {"compress": True}, {"copy": True}):
            cube = add_cone_cube()
            if in_edit_mode:
                edit(cube)
            before = stored_uv(cube)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, "saved.blend")
                with held() as release, heard() as failed:
                    assert unwrap() == {"RUNNING_MODAL"}
                    yield 0.1
                    assert bpy.ops.wm.save_as_mainfile(filepath=str(path), **options) == {"FINISHED"}
                    assert unwrapping()
                    release()
                    yield from until(lambda: not unwrapping())
                assert not failed and stored_uv(cube) != before
                assert saved_uv(path, cube.data.name) == before
            yield from leave(cube)


def rendering():
    return bpy.app.is_job_running("RENDER")


def test_a_picture_may_be_rendered_meanwhile():
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location.z = 9
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x = scene.render.resolution_y = 64
    for how in ("EXEC_DEFAULT", "INVOKE_DEFAULT"):
        cube = add_cone_cube(cuts=8)
        before = stored_uv(cube)
        with held() as release, heard() as failed:
            assert unwrap() == {"RUNNING_MODAL"}
            yield 0.1
            assert bpy.ops.render.render(how, animation=False) <= {"FINISHED", "RUNNING_MODAL"}
            assert unwrapping()
            release()
            yield from until(lambda: not (unwrapping() or rendering()))
        assert not failed and stored_uv(cube) != before
        bpy.data.objects.remove(cube)


def remove_object_in_edit_mode(obj):
    bpy.data.objects.remove(obj)


def rename(obj):
    obj.name = obj.data.name = "Renamed"


def clear_edited_mesh(obj):
    bm = bmesh.from_edit_mesh(obj.data)
    bm.clear()
    bmesh.update_edit_mesh(obj.data)


@pytest.mark.nightly
def test_tools_end_where_their_mesh_goes_and_go_on_where_it_is_renamed():
    for tool in TOOLS:
        for change in (remove_object_in_edit_mode, remove_mesh, clear_edited_mesh, rename):
            ball = add_ball(cuts=1)
            bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
            edit(ball)
            bpy.ops.view3d.view_all()
            yield 0.1
            before = snapshot(ball)
            assert getattr(bpy.ops.mesh, tool.split(".")[1])("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
            yield from click(place_of(ball, 5))
            yield 0.2
            change(ball)
            # As after any other operator.
            bpy.ops.ed.undo_push(message=change.__name__)
            yield 0.2
            yield from press("Z", ctrl=True)
            if change is rename:
                assert running(kind_of(tool))
                yield from press("ESC")
                yield from until_ended(tool)
                assert changed(before, snapshot(ball)) <= {"data-blocks", "context", "selected objects"}
                yield from leave(ball)
                continue
            yield from press("RET")
            yield from until_ended(tool)
            assert not computing()
            if "Ball" in bpy.data.objects:
                yield from leave(ball)


def kind_of(tool):
    return tool.replace("mesh.", "MESH_OT_")


def until_ended(tool):
    yield from until(lambda: not running(kind_of(tool)))


def leave(obj):
    if obj.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(obj)
    yield 0.1


def test_a_file_that_is_saved_while_cones_are_edited_has_the_map_as_it_is_shown():
    ball = add_ball()
    edit(ball)
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from click(place_of(ball, 30))
    yield 0.5
    shown = stored_uv(ball)
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "saved.blend")), copy=True, compress=True)
        assert stored_uv(ball) == shown and running("MESH_OT_cone_edit")
        before = snapshot(ball)
        yield from press("ESC")
        yield from until(lambda: not running("MESH_OT_cone_edit"))
        assert changed(before, snapshot(ball)) <= {uv_key()}


def test_a_file_that_is_saved_without_a_window_has_the_gizmos_that_are_hidden():
    yield from edit_tests.begin()
    saved = []

    def note(*_):
        views = (area.spaces.active for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D")
        saved.extend(space.show_gizmo_tool for space in views)

    bpy.app.handlers.save_pre.append(note)
    with tempfile.TemporaryDirectory() as folder, bpy.context.temp_override(window=None, area=None, region=None):
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "saved.blend")), copy=True)
    bpy.app.handlers.save_pre.remove(note)
    assert len(saved) > 1 and all(saved)
    yield from press("ESC")
    yield from until_ended("mesh.cone_edit")
