# SPDX-License-Identifier: GPL-3.0-or-later
"""Recent maps, by a digest of everything that they were computed from.

With them a change of the margin in the redo panel only packs again, and so does a preset that is chosen again.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ...core.digest import digest_of
from ..tasks.unwrapped import Unwrapped
from ..tasks.unwrapping import UnwrapTask, unwrap, unwrap_all

if TYPE_CHECKING:
    from ..tasks.solving import Progress

MOST_TRIANGLES = 300_000
"""Limit of all cached maps together, about a hundred megabytes."""

_kept: OrderedDict[bytes, Unwrapped] = OrderedDict()
# Objects that are unwrapped side by side, each in a thread, share them.
_lock = Lock()


def unwrap_all_once(tasks: Sequence[UnwrapTask], progress: Progress | None = None) -> list[Unwrapped | Exception]:
    """As `unwrap_all`, but kept maps are not computed again."""
    return unwrap_all(tasks, progress, _unwrap_once)


def _unwrap_once(task: UnwrapTask, progress: Progress | None) -> Unwrapped:
    key = digest(task)
    with _lock:
        found = _kept.pop(key, None)
    if found is None:
        found = unwrap(task, progress)
    with _lock:
        _kept[key] = found
        while sum(len(kept.region.surface.triangles) for kept in _kept.values()) > MOST_TRIANGLES:
            _kept.popitem(last=False)
    return replace(found, region=task.region)


def digest(task: UnwrapTask) -> bytes:
    """Of everything that the map depends on.

    It depends on the present UVs if some are pinned or islands keep their places.
    """
    if not task.keep_placement and not task.pinned.any():
        task = replace(task, region=replace(task.region, corner_uv=np.empty((0, 3, 2))))
    return digest_of(task)


@bpy.app.handlers.persistent
def forget(*_: Any) -> None:
    """Called by Blender when another file is opened."""
    with _lock:
        _kept.clear()


def register() -> None:
    bpy.app.handlers.load_post.append(forget)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(forget)
    forget()
