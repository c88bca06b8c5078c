# SPDX-License-Identifier: GPL-3.0-or-later
"""Manages the child process in which steps are performed, so that a crash or a hang is the outcome of a step."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass, field
from types import TracebackType
from typing import IO

from .steps import Step

SECONDS = 60.0  # that a step may take
SANITIZED_MEMORY = 6000  # megabytes
SHOWN = 4000  # characters of what a process that died has said


@dataclass
class Ended:
    """How a step ended: in a word, and what was wrong with that."""

    told: str
    faults: list[str] = field(default_factory=list)


class Host:
    """A context manager: the child process lives as long as it, and is started anew where it has died."""

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds = seconds
        self._child: subprocess.Popen[str] | None = None
        self._open = contextlib.ExitStack()

    def __enter__(self) -> Host:
        self._errors = self._open.enter_context(tempfile.TemporaryFile("w+"))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._end()
        self._open.close()

    def begin(self) -> None:
        """A new session, in the child process there is."""
        self.perform({"do": "begin"})

    def perform(self, step: Step) -> Ended:
        if self._child is None:
            self._start()
        child = self._child
        assert child is not None and child.stdin is not None
        with contextlib.suppress(OSError):  # a broken pipe, whatever the system calls it
            child.stdin.write(json.dumps(step) + "\n")
            child.stdin.flush()
        try:
            line = self._answers.get(timeout=self._seconds)
        except queue.Empty:
            os.kill(child.pid, signal.SIGABRT)  # faulthandler tells where it was
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(5)
            where = self._last_words()
            self._end()
            return Ended("hang", [f"no answer within {self._seconds:g} s\n{where}"])
        if not line:
            code = child.wait()
            where = self._last_words()
            self._end()
            return Ended("crash", [f"the process died with {_name(code)}\n{where}"])
        return Ended(*json.loads(line))

    def _start(self) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
        if "ASAN_OPTIONS" in environment:  # the child limits its address space, but not with this sanitizer's in it
            environment["ASAN_OPTIONS"] += f":hard_rss_limit_mb={SANITIZED_MEMORY}"
        self._errors.seek(0)
        self._errors.truncate()
        self._child = subprocess.Popen(
            [sys.executable, "-m", "explorer.child"],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )
        self._answers: queue.Queue[str] = queue.Queue()
        self._reader = threading.Thread(target=_read, args=(self._child.stdout, self._answers), daemon=True)
        self._reader.start()

    def _last_words(self) -> str:
        """What the process wrote to stderr: the beginning, where a sanitizer or the interpreter says why."""
        self._errors.seek(0)
        return self._errors.read().split("Extension modules:")[0][:SHOWN]

    def _end(self) -> None:
        if self._child is None:
            return
        self._child.kill()
        self._child.wait()
        self._reader.join()
        for pipe in (self._child.stdin, self._child.stdout):
            with contextlib.suppress(OSError):
                pipe.close()
        self._child = None


def _read(answers: IO[str], lines: queue.Queue[str]) -> None:
    """Passes on every line, then an empty one: Windows can wait for a queue with a time limit, but not for a pipe."""
    for line in answers:
        lines.put(line)
    lines.put("")


def _name(code: int) -> str:
    with contextlib.suppress(ValueError):
        return signal.Signals(-code).name
    return f"exit code {code}"
