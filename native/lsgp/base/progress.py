# SPDX-License-Identifier: GPL-3.0-or-later
"""How callers are told of the progress of a computation."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float], bool | None]


def share_of(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """The progress of one stage, as the share of the whole from begin to end."""
    return None if progress is None else lambda done: progress(begin + (end - begin) * done)
