# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the changes of meshes, so that what is derived from one is derived again only when it has changed."""

from __future__ import annotations

from collections import Counter

import bpy
from bpy.app.handlers import persistent

from . import redraw

# By session_uid, which stays the same through undo; and the times that anything may have changed.
_changes: Counter[int] = Counter()
_all_changed = 0
# Meshes whose changes are not told for now.
_held: set[int] = set()


def version(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Differs from an earlier answer where the mesh may have changed since."""
    return _all_changed, _changes[mesh.session_uid]


def mark_changed(mesh: bpy.types.Mesh) -> None:
    """To be called where something was changed that Blender does not notice, as a property of ours."""
    _changes[mesh.session_uid] += 1
    redraw.views()


def hold(mesh: bpy.types.Mesh) -> None:
    """Take the mesh for unchanged until it is released, so that nothing is derived from it while it is dragged."""
    _held.add(mesh.session_uid)


def release(uid: int) -> None:
    """Tell changes of a mesh that was held, by its identifier, again; it has changed."""
    _held.discard(uid)
    _changes[uid] += 1
    redraw.views()


@persistent
def _note_updates(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        if update.is_updated_geometry:
            block = update.id.original
            mesh = block.data if isinstance(block, bpy.types.Object) else block
            if isinstance(mesh, bpy.types.Mesh) and mesh.session_uid not in _held:
                _changes[mesh.session_uid] += 1


@persistent
def _note_everything(*_arguments: object) -> None:
    global _all_changed
    _all_changed += 1
    _changes.clear()
    _held.clear()


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
