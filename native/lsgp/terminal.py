# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command line says while it runs and at the end."""

from __future__ import annotations

import contextlib
import math
import os
import time
from types import TracebackType
from typing import TextIO

SILENT_SECONDS = 0.5
BAR_WIDTH = 40


def say(stream: TextIO, text: str) -> None:
    """Print a line at once; characters the terminal has not are escaped."""
    encoding = stream.encoding or "utf-8"
    try:
        print(text.encode(encoding, "backslashreplace").decode(encoding), file=stream, flush=True)
    except BrokenPipeError:  # whoever read along has seen enough; files are still to be written
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


class ProgressLine:
    """How much is done, on one line of a terminal: from half a second after it was made until its context ends, which
    wipes it.  Elsewhere nothing is shown."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._shown_from = time.monotonic() + SILENT_SECONDS if stream.isatty() else math.inf
        self._line = ""

    def __call__(self, done: float, note: str = "") -> None:
        """done: 0 to 1. note: shown behind it."""
        if time.monotonic() >= self._shown_from:
            bar = "#" * int(BAR_WIDTH * done)
            line = f"lsgp: [{bar:<{BAR_WIDTH}}] {int(100 * done):3} %{note}"
            self._show(f"{line:<{len(self._line)}}")  # over all of the line before

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
        with contextlib.suppress(OSError):  # a terminal that has gone is no reason to stop
            self._stream.write("\r" + line)
            self._stream.flush()
