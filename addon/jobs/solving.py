# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves the tasks of several objects one after the other, with one progress for all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

from ..core import native

if TYPE_CHECKING:
    from ..core.region import Region

Progress = Callable[[float], bool | None]
"""Called with the completed fraction, 0 to 1; computing stops where it returns False."""


class Task(Protocol):
    """Everything that is computed for one object; a `region` says how much work it is."""

    region: Region


T = TypeVar("T", bound=Task)
R = TypeVar("R")


def solve_all(
    tasks: Sequence[T], solve: Callable[[T, Progress | None], R], progress: Progress | None = None
) -> list[R | Exception]:
    """The result of solve(task, progress) for each task, or the error that it raised.  Raises Cancelled.

    progress: over all tasks.
    """
    sizes = [len(task.region.surface.triangles) for task in tasks]
    outcomes: list[R | Exception] = []
    for i, task in enumerate(tasks):
        try:
            outcomes.append(solve(task, _share_of(progress, sum(sizes[:i]) / sum(sizes), sizes[i] / sum(sizes))))
        except native.lsgp.Cancelled:
            raise
        except (native.lsgp.LsgpError, MemoryError) as error:
            outcomes.append(error)
    return outcomes


def _share_of(progress: Progress | None, begin: float, share: float) -> Progress | None:
    return None if progress is None else lambda done: progress(begin + share * done)
