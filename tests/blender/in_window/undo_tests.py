# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo and redo bring every attribute of a mesh back exactly.  Run by run_in_window.py, not by pytest."""

from functools import partial

import bpy
import pytest
from installed import addon
from scenes import add_ball, add_cone_cube, add_grid, add_ramp, add_sphere, add_tube, changed, edit, mark, snapshot

reports = addon.mesh.reports
# Taken in turn, so that most runs change the map; complete, because a run with undo goes on with what was chosen last.
PLAIN = {"seamless": False, "mode": "CONFORMAL", "prescription": "AUTOMATIC", "pack": False}
OPTIONS = (
    PLAIN,
    PLAIN | {"seamless": True},
    PLAIN | {"mode": "LOW_STRETCH"},
    PLAIN | {"prescription": "HARMONIC"},
    PLAIN | {"pack": True, "margin": 0.02},
)


def add_marked_sphere():
    sphere = add_sphere()
    mark(sphere, [0, 20, 40, 60])
    return sphere


def add_marked_tube():
    tube = add_tube()
    mark(tube, [])
    return tube


def state(names):
    return {name: snapshot(bpy.data.objects[name]) for name in names}


def differences(first, second):
    return {(name, key) for name in first for key in changed(first[name], second[name])}


def told(names):
    """Cuts and cones as told of the maps, nothing where no report is on the map as it is."""
    found = [reports.find(bpy.data.objects[name].data) for name in names]
    return [report and (report.paths, report.cones) for report in found]


def run_undo_redo(names, call):
    """One round, which must leave everything in its expected state.  Returns whether the run changed anything."""
    before, told_before = state(names), told(names)
    assert call() == {"FINISHED"}
    after, told_after = state(names), told(names)
    wrong = set()
    bpy.ops.ed.undo()
    yield 0.02
    wrong |= differences(before, state(names))
    if told(names) != told_before:
        wrong.add("report after undo")
    bpy.ops.ed.redo()
    yield 0.02
    wrong |= differences(after, state(names))
    if told(names) != told_after:
        wrong.add("report after redo")
    assert not wrong, wrong
    return bool(differences(before, after))


def in_rounds(names, in_edit_mode):
    if in_edit_mode:
        edit(*[bpy.data.objects[name] for name in names])
    bpy.ops.ed.undo_push(message="before")
    changes = 0
    for options in OPTIONS:
        changes += yield from run_undo_redo(names, partial(bpy.ops.uv.cone_unwrap, "EXEC_DEFAULT", True, **options))
    assert changes > len(OPTIONS) // 2, f"only {changes} runs had anything to undo"
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.ed.undo_push(message="after")


def ten_rounds(build):
    name = build().name
    for in_edit_mode in (False, True):
        yield from in_rounds([name], in_edit_mode)


def test_ten_unwraps_of_a_cube_are_undone_and_redone_exactly():
    yield from ten_rounds(add_cone_cube)


@pytest.mark.nightly
def test_ten_unwraps_of_a_ball_are_undone_and_redone_exactly():
    yield from ten_rounds(add_ball)


@pytest.mark.nightly
def test_ten_unwraps_of_a_sphere_are_undone_and_redone_exactly():
    yield from ten_rounds(add_marked_sphere)


@pytest.mark.nightly
def test_ten_unwraps_of_a_tube_are_undone_and_redone_exactly():
    yield from ten_rounds(add_marked_tube)


@pytest.mark.nightly
def test_ten_unwraps_of_a_ramp_are_undone_and_redone_exactly():
    yield from ten_rounds(add_ramp)


@pytest.mark.nightly
def test_unwraps_of_several_meshes_in_edit_mode_are_one_step():
    names = [add_cone_cube("First").name, add_ball("Second").name, add_marked_tube().name]
    yield from in_rounds(names, True)


def test_distortion_is_undone_and_redone_exactly():
    for in_edit_mode in (False, True):
        name = add_ball().name
        if in_edit_mode:
            edit(bpy.data.objects[name])
        bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
        for clear in (False, True):
            yield from run_undo_redo(
                [name], lambda clear=clear: bpy.ops.uv.cone_measure("EXEC_DEFAULT", True, clear=clear)
            )
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(bpy.data.objects[name])


def materials():
    return sorted(material.name for material in bpy.data.materials), sorted(image.name for image in bpy.data.images)


def test_the_texture_is_undone_and_redone_exactly():
    name = add_grid().name
    bpy.data.objects[name].data.materials.append(bpy.data.materials.new("Red"))
    bpy.ops.ed.undo_push(message="before")
    for clear in (False, True):
        slots = [slot.material.name for slot in bpy.data.objects[name].material_slots], materials()
        bpy.ops.uv.cone_texture("EXEC_DEFAULT", True, clear=clear)
        changed_slots = [slot.material.name for slot in bpy.data.objects[name].material_slots], materials()
        assert changed_slots != slots
        for step, expected in ((bpy.ops.ed.undo, slots), (bpy.ops.ed.redo, changed_slots)):
            step()
            yield 0.05
            assert ([slot.material.name for slot in bpy.data.objects[name].material_slots], materials()) == expected
    assert materials() == (["Red"], [])


def test_marks_are_undone_and_redone_exactly():
    name = add_sphere().name
    edit(bpy.data.objects[name])
    bpy.ops.ed.undo_push(message="before")
    for options in ({}, {"clear": True}):
        yield from run_undo_redo([name], partial(bpy.ops.mesh.cone_mark, "EXEC_DEFAULT", True, **options))


def test_seams_from_cuts_and_their_selection_are_undone_and_redone_exactly():
    name = add_ball().name
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
    edit(bpy.data.objects[name])
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="before")
    for operator in (bpy.ops.mesh.cone_select_cuts, bpy.ops.mesh.cone_seams_from_cuts):
        assert (yield from run_undo_redo([name], partial(operator, "EXEC_DEFAULT", True)))
