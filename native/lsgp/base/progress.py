# SPDX-License-Identifier: GPL-3.0-or-later
"""How callers are told of the progress of a computation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import Cancelled

Progress = Callable[[float], bool | None]

# Of what is left, what a step takes whose number is not known.
_SHARE = 0.1


def share_of(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """The progress of one stage, as the share of the whole from begin to end."""
    return None if progress is None else lambda done: progress(begin + (end - begin) * done)


def tell(progress: Progress | None, done: float) -> None:
    """Tell the fraction done.  Raises Cancelled if the answer is False, also as a bool of numpy."""
    answer = None if progress is None else progress(done)
    if isinstance(answer, bool | np.bool_) and not answer:
        raise Cancelled("CANCELLED", "Stopped as asked; nothing was changed.")


class Steps:
    """The progress of a stage whose number of steps is not known: each takes the same part of what is left."""

    def __init__(self, progress: Progress | None) -> None:
        self._progress, self._done = progress, 0.0

    def tell(self) -> None:
        """Tell of a step.  Raises Cancelled."""
        tell(self.next(), 1.0)

    def next(self) -> Progress | None:
        """The progress of the next step, which is a stage itself."""
        begin = self._done
        self._done += (1 - begin) * _SHARE
        return share_of(self._progress, begin, self._done)


UNTOLD = Steps(None)
