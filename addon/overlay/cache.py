# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what is drawn of each mesh until the mesh or what is known of it changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy

from .. import changes, redraw, reports
from ..identifiers import DISTORTION_ATTRIBUTES
from .content import Content, build_content


@dataclass(slots=True)
class Entry:
    """The content of a mesh in a version of it, and what drawing has made of that."""

    version: tuple[int, int]
    mode: str
    content: Content
    drawn: dict[Any, Any] = field(default_factory=dict)

    def batch(self, key: Any, build: Callable[[], Any]) -> Any:
        """What ``build`` returned the first time."""
        if key not in self.drawn:
            self.drawn[key] = build()
        return self.drawn[key]


_entries: dict[int, Entry] = {}


def entry(obj: bpy.types.Object) -> Entry:
    """What is shown of the object's mesh, made anew only where the mesh has changed."""
    mesh = obj.data
    version = changes.version(mesh)
    kept = _entries.get(mesh.session_uid)
    if kept is None or kept.version != version or kept.mode != obj.mode:
        kept = Entry(version, obj.mode, build_content(obj, reports.current(mesh)))
        _entries[mesh.session_uid] = kept
    return kept


def show(obj: bpy.types.Object, content: Content) -> None:
    """Show this of the object's mesh, and no distortion, until the mesh is seen to change."""
    mesh = obj.data
    hidden = dict.fromkeys(DISTORTION_ATTRIBUTES)
    _entries[mesh.session_uid] = Entry(changes.version(mesh), obj.mode, content, hidden)
    redraw.views()


def clear() -> None:
    """Forget everything, with the batches on the graphics card."""
    _entries.clear()
