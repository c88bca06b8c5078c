# SPDX-License-Identifier: GPL-3.0-or-later
"""Caches what is drawn of each mesh until the mesh or the results on it change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from ..core import redraw
from ..core.identifiers import DISTORTION_ATTRIBUTES
from ..core.per_mesh import kept_by_mesh
from ..mesh import changes, reports
from .content import Content, build_content


@dataclass(slots=True)
class Entry:
    """The content for one version of a mesh, and the batches made from it."""

    version: tuple[int, int]
    mode: str
    content: Content
    drawn: dict[Any, Any] = field(default_factory=dict)

    def batch(self, key: Any, build: Callable[[], Any]) -> Any:
        """The result of the first call of ``build`` for this key."""
        if key not in self.drawn:
            self.drawn[key] = build()
        return self.drawn[key]


_entries: dict[int, Entry] = kept_by_mesh()

# The cone that is drawn larger.
_highlighted: dict[int, int] = kept_by_mesh()


def entry(obj: bpy.types.Object) -> Entry:
    """What is shown of the object's mesh, rebuilt only if the mesh has changed."""
    mesh = obj.data
    version = changes.version(mesh)
    kept = _entries.get(mesh.session_uid)
    if kept is None or kept.version != version or kept.mode != obj.mode:
        content = build_content(obj, reports.current(mesh))
        kept = Entry(version, obj.mode, replace(content, active=_active(obj)))
        _entries[mesh.session_uid] = kept
    return kept


def highlight(obj: bpy.types.Object, vertex: int) -> None:
    """Draw this cone larger in object mode, where no selection shows it."""
    _highlighted[obj.data.session_uid] = vertex
    kept = entry(obj)
    kept.content = replace(kept.content, active=_active(obj))
    redraw.views()


def _active(obj: bpy.types.Object) -> int | None:
    return None if obj.mode == "EDIT" else _highlighted.get(obj.data.session_uid)


def show(obj: bpy.types.Object, content: Content) -> None:
    """Show this content, without distortion, until a change of the mesh is noticed."""
    mesh = obj.data
    hidden = dict.fromkeys(DISTORTION_ATTRIBUTES)
    _entries[mesh.session_uid] = Entry(changes.version(mesh), obj.mode, content, hidden)
    redraw.views()


def clear() -> None:
    """Drop everything, including batches on the GPU."""
    _entries.clear()
    _highlighted.clear()
