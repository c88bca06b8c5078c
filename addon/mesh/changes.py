# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts changes of meshes, so that results derived from a mesh are recomputed only when it has changed."""

from __future__ import annotations

from collections import Counter

import bpy
from bpy.app.handlers import persistent

from ..core import redraw

# By session_uid, which undo does not change; and how often everything may have changed.
_changes: Counter[int] = Counter()
_all_changed = 0
# Meshes whose changes do not count for now.
_suspended: set[int] = set()


def version(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """A value that differs from an earlier one if the mesh may have changed in between."""
    return _all_changed, _changes[mesh.session_uid]


def era() -> int:
    """Another number after undo, redo and the opening of a file, by which references into Blender's data end."""
    return _all_changed


def mark_changed(mesh: bpy.types.Mesh) -> None:
    """To be called after a change that Blender does not notice, such as one of the add-on's properties."""
    _changes[mesh.session_uid] += 1
    redraw.views()


def suspend(mesh: bpy.types.Mesh) -> None:
    """Treat the mesh as unchanged until `resume`, so that nothing is recomputed while its cones are dragged."""
    _suspended.add(mesh.session_uid)


def is_suspended(mesh: bpy.types.Mesh) -> bool:
    """Whether the cones of the mesh are being edited."""
    return mesh.session_uid in _suspended


def resume(uid: int) -> None:
    """Count the changes of a mesh, named by its session_uid, again, and that it has changed."""
    _suspended.discard(uid)
    _changes[uid] += 1
    redraw.views()


@persistent
def _note_updates(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        if update.is_updated_geometry:
            block = update.id.original
            mesh = block.data if isinstance(block, bpy.types.Object) else block
            if isinstance(mesh, bpy.types.Mesh) and mesh.session_uid not in _suspended:
                _changes[mesh.session_uid] += 1


@persistent
def _note_everything(*_arguments: object) -> None:
    global _all_changed
    _all_changed += 1
    _changes.clear()
    _suspended.clear()


HANDLERS = (
    ("depsgraph_update_post", _note_updates),
    ("undo_post", _note_everything),
    ("redo_post", _note_everything),
    ("load_post", _note_everything),
)


def register() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
