# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation in a thread of its own, watched and stopped from Blender's main thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Generic, TypeVar
from weakref import WeakSet

T = TypeVar("T")

_begun: WeakSet[Computation[Any]] = WeakSet()


class Computation(Generic[T]):
    """Starts at once. ``compute`` gets a callable that takes the completed fraction, 0 to 1, and returns whether to
    continue.

    Blender waits for the thread before it quits.
    """

    def __init__(self, compute: Callable[[Callable[[float], bool]], T]) -> None:
        self.done = 0.0
        self._stopped = False
        self._outcome: T | None = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, args=(compute,), name="Cone Unwrap")
        self._thread.start()
        _begun.add(self)

    def stop(self) -> None:
        """Ask it to stop, which it does when it next reports progress.  Its outcome must not be used any more."""
        self._stopped = True

    def finished(self, seconds: float | None = 0.0) -> bool:
        """Whether it has ended, after waiting for that at most so long, without limit for None."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    @property
    def failed(self) -> bool:
        """Whether `outcome` raises an exception.  Only once it has finished."""
        return self._error is not None

    def outcome(self) -> T:
        """Its return value; raises the exception that it raised.  Only once it has finished."""
        if self._error is not None:
            raise self._error
        return self._outcome

    def _run(self, compute: Callable[[Callable[[float], bool]], T]) -> None:
        try:
            self._outcome = compute(self._progress)
        except BaseException as error:  # raised again by outcome()
            self._error = error

    def _progress(self, done: float) -> bool:
        self.done = done
        return not self._stopped


def end_all() -> None:
    """Stop all computations and wait for their ends, as the library may be removed or replaced next."""
    begun = list(_begun)
    for computation in begun:
        computation.stop()
    for computation in begun:
        computation.finished(None)
