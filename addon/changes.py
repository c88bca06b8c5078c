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


def version(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Differs from an earlier answer where the mesh may have changed since."""
    return _all_changed, _changes[mesh.session_uid]


def mark_changed(mesh: bpy.types.Mesh) -> None:
    """To be called where something was changed that Blender does not notice, as a property of ours."""
    _changes[mesh.session_uid] += 1
    redraw.views()


@persistent
def _note_updates(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        if update.is_updated_geometry:
            block = update.id.original
            mesh = block.data if isinstance(block, bpy.types.Object) else block
            if isinstance(mesh, bpy.types.Mesh):
                _changes[mesh.session_uid] += 1


@persistent
def _note_everything(*_arguments: object) -> None:
    global _all_changed
    _all_changed += 1
    _changes.clear()


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
