# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves the tasks of several objects, small ones side by side, with one progress for all."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Protocol, TypeVar

from ...core import native

if TYPE_CHECKING:
    from ...core.region import Region

Progress = Callable[[float], bool | None]
"""Called with the completed fraction, 0 to 1; computing stops where it returns False."""

MOST_SIDE_BY_SIDE = 40_000
"""Triangles of an object that is solved beside others. The library takes several threads for larger ones, which need
memory that it sees to for one at a time."""


class Task(Protocol):
    """Everything that is computed for one object.

    region: says how much work it is. threads: that its computation takes, 0 for the library's default.
    """

    region: Region

    @property
    def threads(self) -> int: ...

    def with_threads(self, count: int) -> Task: ...


T = TypeVar("T", bound=Task)
R = TypeVar("R")


def solve_all(
    tasks: Sequence[T], solve: Callable[[T, Progress | None], R], progress: Progress | None = None
) -> list[R | Exception]:
    """The result of solve(task, progress) for each task, or the error that it raised.  Raises Cancelled.

    solve: is called for several tasks at once, which share the threads that they may take. progress: over all tasks,
    and for one of them at a time.
    """
    sizes = [len(task.region.surface.triangles) for task in tasks]
    shared = _SharedProgress(sizes, progress)
    outcomes: dict[int, R | Exception] = {}
    small = [i for i, size in enumerate(sizes) if size <= MOST_SIDE_BY_SIDE]
    threads = native.thread_count(tasks[0].threads) if tasks else 1
    if len(small) > 1 and threads > 1:
        workers = min(threads, len(small))
        beside = [tasks[i].with_threads(threads // workers) for i in small]
        outcomes.update(zip(small, _side_by_side(beside, solve, [shared.of(i) for i in small], workers), strict=True))
    for i, task in enumerate(tasks):
        if i not in outcomes:
            outcomes[i] = _outcome(task, solve, None if progress is None else shared.of(i))
    return [outcomes[i] for i in range(len(tasks))]


def _outcome(task: T, solve: Callable[[T, Progress | None], R], progress: Progress | None) -> R | Exception:
    try:
        return solve(task, progress)
    except native.lsgp.Cancelled:
        raise
    except (native.lsgp.LsgpError, MemoryError) as error:
        if progress is not None:
            progress(1.0)  # none of its work is left
        return error


def _side_by_side(
    tasks: Sequence[T], solve: Callable[[T, Progress | None], R], progresses: Sequence[Progress], workers: int
) -> list[R | Exception]:
    """If one task ends all, the others stop when they next report progress, and its exception is raised."""
    ended: list[BaseException] = []

    def solve_one(task: T, progress: Progress) -> R | Exception | None:
        def go_on(done: float) -> bool:
            return not ended and progress(done) is not False

        try:
            return None if ended else _outcome(task, solve, go_on)
        except BaseException as error:  # raised again below
            ended.append(error)
            return None

    with ThreadPoolExecutor(workers, thread_name_prefix="Cone Unwrap") as pool:
        running = [pool.submit(solve_one, *one) for one in zip(tasks, progresses, strict=True)]
        try:
            outcomes = [future.result() for future in running]
        except BaseException as error:  # Ctrl-C, which reaches the thread that waits
            ended.insert(0, error)
            raise
    if ended:
        raise ended[0]
    return outcomes


class _SharedProgress:
    """One progress from those of tasks of several sizes, told from any thread."""

    def __init__(self, sizes: Sequence[int], progress: Progress | None) -> None:
        self._share = [size / max(1, sum(sizes)) for size in sizes]
        self._done = [0.0] * len(sizes)
        self._progress = progress
        self._lock = threading.Lock()

    def of(self, i: int) -> Progress:
        def tell(done: float) -> bool | None:
            with self._lock:
                self._done[i] = self._share[i] * done
                return None if self._progress is None else self._progress(min(1.0, sum(self._done)))

        return tell
