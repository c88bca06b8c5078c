# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of an edit that is not finished, which can be undone and redone one by one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

MOST_STEPS = 256


class EditHistory(Generic[T]):
    """Names of steps with the state before each; steps after which the state was equal are none."""

    def __init__(self, take: Callable[[], T], put: Callable[[T], None]) -> None:
        """take: returns the current state, which nothing changes afterward. put: goes to such a state."""
        self._take, self._put = take, put
        self._done: list[tuple[str, T]] = []
        self._undone: list[tuple[str, T]] = []

    @property
    def undoes(self) -> str | None:
        """The step that `undo` reverts."""
        # One that has begun stays, though nothing may have changed yet.
        now = self._take()
        return next((name for name, state in reversed(self._done) if state != now), None)

    @property
    def redoes(self) -> str | None:
        """The step that `redo` repeats."""
        return self._undone[-1][0] if self._undone else None

    def begin(self, name: str) -> None:
        """To be called before the changes of a step."""
        self._drop_idle()
        self._done.append((name, self._take()))
        del self._done[:-MOST_STEPS]
        self._undone.clear()

    def undo(self) -> bool:
        """Returns whether there was a step."""
        self._drop_idle()
        return self._step(self._done, self._undone)

    def redo(self) -> bool:
        """Returns whether there was a step."""
        return self._step(self._undone, self._done)

    def _step(self, source: list[tuple[str, T]], other: list[tuple[str, T]]) -> bool:
        if not source:
            return False
        name, state = source.pop()
        other.append((name, self._take()))
        self._put(state)
        return True

    def _drop_idle(self) -> None:
        while self._done and self._done[-1][1] == self._take():
            self._done.pop()
