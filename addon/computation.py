# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation in a thread of its own, watched and stopped from Blender's."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Computation(Generic[T]):
    """Starts at once. ``compute`` gets a callable to tell how much is done, 0 to 1, which answers whether to go on.

    Blender waits for the thread before it quits.
    """

    def __init__(self, compute: Callable[[Callable[[float], bool]], T]) -> None:
        self.done = 0.0
        self._stopped = False
        self._outcome: T | None = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, args=(compute,), name="Cone Unwrap")
        self._thread.start()

    def stop(self) -> None:
        """Ask it to end; it does so the next time it tells how much is done.  Its outcome is of no more use."""
        self._stopped = True

    def finished(self, seconds: float | None = 0.0) -> bool:
        """Whether it has ended, waiting for that at most so long, or with None as long as it takes."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def outcome(self) -> T:
        """What it returned; raises what it raised.  To be asked for once it has finished."""
        if self._error is not None:
            raise self._error
        return self._outcome

    def _run(self, compute: Callable[[Callable[[float], bool]], T]) -> None:
        try:
            self._outcome = compute(self._tell)
        except BaseException as error:  # raised again where the outcome is asked for
            self._error = error

    def _tell(self, done: float) -> bool:
        self.done = done
        return not self._stopped
