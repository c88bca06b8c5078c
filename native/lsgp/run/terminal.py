# SPDX-License-Identifier: GPL-3.0-or-later
"""The progress line that a command shows in a terminal."""

from __future__ import annotations

import contextlib
import math
import time
from types import TracebackType
from typing import TextIO

SILENT_SECONDS = 0.5
BAR_WIDTH = 40


class ProgressLine:
    """Shows progress on one line of a terminal, from half a second after its creation until its context ends, which
    erases it.  Elsewhere nothing is shown."""

    def __init__(self, stream: TextIO | None) -> None:
        """stream: None where the process was started without it."""
        self._stream = stream
        is_shown = stream is not None and stream.isatty()
        self._shown_from = time.monotonic() + SILENT_SECONDS if is_shown else math.inf
        self._line = ""

    def __call__(self, done: float, note: str = "") -> None:
        """done: 0 to 1. note: shown behind it."""
        if time.monotonic() >= self._shown_from:
            bar = "#" * int(BAR_WIDTH * done)
            line = f"lsgp: [{bar:<{BAR_WIDTH}}] {int(100 * done):3} %{note}"
            self._show(f"{line:<{len(self._line)}}")  # covers the previous line

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._line:
            self._show(" " * (len(self._line) + len("^C")))  # which terminals echo behind it
            self._show("")

    def _show(self, line: str) -> None:
        if line == self._line:
            return
        self._line = line
        with contextlib.suppress(OSError):  # a closed terminal does not stop the run
            self._stream.write("\r" + line)
            self._stream.flush()
