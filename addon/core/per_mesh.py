# SPDX-License-Identifier: GPL-3.0-or-later
"""What is kept in memory by mesh, until another file is opened or the add-on is disabled."""

from __future__ import annotations

from typing import Any

import bpy

_all: list[dict[int, Any]] = []


def kept_by_mesh() -> dict[int, Any]:
    """An empty one, by the session_uid of meshes, which undo does not change, and opening a file does."""
    kept: dict[int, Any] = {}
    _all.append(kept)
    return kept


@bpy.app.handlers.persistent
def forget(*_: Any) -> None:
    for kept in _all:
        kept.clear()


def register() -> None:
    bpy.app.handlers.load_post.append(forget)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(forget)
    forget()
