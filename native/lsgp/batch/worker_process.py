# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker process, seen from the process that started it: it is given assets and answers with their records."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from queue import SimpleQueue

from .assets import Asset
from .records import Record
from .tasks import Settings, Task
from .worker import MARK, SHARE

START_SECONDS = 120.0
END_SECONDS = 10.0
STDERR_SHOWN = 400

WINDOWS_ENDINGS = {
    0xC0000005: "access violation",
    0xC0000017: "no memory",
    0xC000001D: "illegal instruction",
    0xC00000FD: "stack overflow",
    0xC000013A: "Ctrl-C",
    0xC0000374: "damaged heap",
    0xC0000409: "abort",
}


class WorkersError(Exception):
    """Workers cannot be started."""


class WorkerProcess:
    """name: None until it is ready. waiting: the assets it has not answered on; it works on the first of them, of which
    it has done the part `share`, as far as it says so.

    answered: number of answers. Its output goes into the queue `said`, None for its end.
    """

    def __init__(
        self, command: Sequence[str], settings: Settings, said: SimpleQueue[tuple[WorkerProcess, Record | None]]
    ) -> None:
        """Raises WorkersError."""
        self.name: str | None = None
        self.waiting: deque[Asset] = deque()
        self.answered = 0
        self.share = 0.0
        self._since = time.monotonic()
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process
        # As many processes as there are cores leave none for threads.
        environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} | os.environ | {"LSGP_THREADS": "1"}
        try:
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, env=environment
            )
        except OSError as error:
            self._errors.close()
            raise WorkersError(f"no worker process can be started: {command[0]}: {error.strerror}") from error
        self._send(asdict(settings))
        threading.Thread(target=self._listen, args=(said,), daemon=True).start()

    def give(self, assets: Iterable[Asset], task_of: Callable[[Asset], Task]) -> None:
        """Give assets to an idle worker."""
        self._since = time.monotonic()
        for asset in assets:
            self.waiting.append(asset)
            self._send(asdict(task_of(asset)))

    def take_in(self, said: Record) -> Record | None:
        """The record of an asset if that is what it said, None where it is ready now or told how far it is."""
        self.share = said.get(SHARE, 0.0)
        if SHARE in said:
            return None
        self._since = time.monotonic()
        if self.name is None:
            self.name = said["ready"]
            return None
        self.waiting.popleft()
        self.answered += 1
        return said

    def seconds(self) -> float:
        """Time since it was started, was given assets, or answered."""
        return time.monotonic() - self._since

    def seconds_left(self, seconds: float | None) -> float | None:
        """Time left to get ready, or to finish an asset whose limit is this many seconds; None for no limit."""
        allowed = START_SECONDS if self.name is None else seconds
        return None if allowed is None else allowed - self.seconds()

    def end(self, patience: float = END_SECONDS) -> tuple[str, str]:
        """End it, by force after `patience` seconds.  Returns how it ended, in words, and its last line of output."""
        with contextlib.suppress(OSError):  # unsent input
            self._process.stdin.close()
        try:
            code = self._process.wait(patience)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = self._process.wait()
        with self._errors as errors:
            errors.seek(0)
            printed = errors.read().decode("utf-8", "replace")
        return way_of_ending(code), " ".join(printed.split())[-STDERR_SHOWN:]

    def _send(self, value: object) -> None:
        with contextlib.suppress(OSError):  # it has died; the end of its output says so too
            self._process.stdin.write(json.dumps(value).encode("ascii") + b"\n")
            self._process.stdin.flush()

    def _listen(self, said: SimpleQueue[tuple[WorkerProcess, Record | None]]) -> None:
        mark = MARK.encode("ascii")
        with self._process.stdout as lines:
            for line in lines:
                if line.startswith(mark):
                    said.put((self, json.loads(line[len(mark) :])))
        said.put((self, None))


def way_of_ending(code: int) -> str:
    """How a process ended, by its exit code; Windows has codes from 0xC0000000 on for what elsewhere are signals."""
    if code >= 0xC0000000:
        return f"was ended by Windows: {WINDOWS_ENDINGS.get(code, 'exception')} (0x{code:08X})"
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        return f"was ended by signal {-code}"
    return f"was ended by {name}{' (memory may have run out)' if name == 'SIGKILL' else ''}"
