# SPDX-License-Identifier: GPL-3.0-or-later
"""Disabled, nothing of the add-on is left in Blender; enabled again, all of it is back.

What is ended in a window is in in_window/reload_tests.py.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import addon_utils
import bpy
import pytest
from installed import EXTENSION, addon
from scenes import UvMap, add_cone_cube


def is_ours(thing: object) -> bool:
    return str(getattr(thing, "__module__", None)).startswith(EXTENSION)


def in_blender() -> list[str]:
    """What of the add-on Blender has: classes, properties, handlers, entries of menus, timers, threads."""
    found = [f"class {name}" for name in dir(bpy.types) if is_ours(getattr(bpy.types, name))]
    for name in dir(bpy.types):
        rna = getattr(getattr(bpy.types, name), "bl_rna", None)
        found += [f"property {name}.{key}" for key in (rna.properties.keys() if rna else ()) if "cone_unwrap" in key]
        draw = getattr(getattr(bpy.types, name), "draw", None)
        found += [f"entry of {name}" for entry in getattr(draw, "_draw_funcs", ()) if is_ours(entry)]
    for name in dir(bpy.app.handlers):
        handlers = getattr(bpy.app.handlers, name)
        found += [f"handler {name}" for entry in (handlers if isinstance(handlers, list) else ()) if is_ours(entry)]
    found += [f"manual {entry.__name__}" for entry in bpy.utils._manual_map if is_ours(entry)]
    found += ["timer"] * bpy.app.timers.is_registered(addon.operators.shared.redo._forget_undo)
    found += [thread.name for thread in threading.enumerate() if "Cone Unwrap" in thread.name]
    return sorted(found)


@pytest.fixture
def enabled_again() -> Iterator[None]:
    yield
    addon_utils.enable(EXTENSION)


def test_nothing_is_left_of_it_and_all_of_it_comes_back(enabled_again: None) -> None:
    before = in_blender()
    assert {text.split()[0] for text in before} == {"class", "property", "entry", "handler", "manual"}
    for _ in range(3):
        # What it notes of undo, until the next event.
        add_cone_cube()
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
        bpy.ops.ed.undo()
        assert "timer" in in_blender()
        addon_utils.disable(EXTENSION)
        assert in_blender() == []
        addon_utils.enable(EXTENSION)
        assert in_blender() == before
    cube = add_cone_cube()
    old = UvMap(cube).uv
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    assert (UvMap(cube).uv != old).any()


def test_disabling_ends_what_is_computed(enabled_again: None) -> None:
    def compute(tell: object) -> None:
        while tell(0.5):
            time.sleep(0.01)

    running = addon.jobs.tasks.computation.Computation(compute)
    assert not running.finished()
    addon_utils.disable(EXTENSION)
    assert running.finished()
    assert in_blender() == []


def test_nothing_of_a_file_is_kept_once_another_is_open() -> None:
    cube = add_cone_cube()
    cube.data.vertices.add(1)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.mesh.cone_select_one(vertex=0) == {"FINISHED"}
    assert bpy.ops.mesh.cone_update_table() == {"FINISHED"}
    kept = addon.core.per_mesh._all
    assert all(list(one) == [cube.data.session_uid] for one in kept)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not any(kept)
