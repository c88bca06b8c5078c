# SPDX-License-Identifier: GPL-3.0-or-later
"""Exit codes of commands, and the messages of those that fail."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from types import FrameType

from ..io.side_files import UsageError
from ..io.standard_streams import complain, has_no_reader, silence

OK, USAGE, REFUSED, SOME, INTERRUPTED, TERMINATED = 0, 2, 3, 4, 130, 143

# What they mean, to a run over one file and to a batch.
OF_A_RUN = {
    OK: "a result, with warnings or not",
    USAGE: "wrong usage, or a file that is missing or cannot be written",
    REFUSED: "the input was refused, or with --strict its result",
    SOME: "a result that leaves out faces that have an area",
    INTERRUPTED: "interrupted",
    TERMINATED: "asked to end, as by a scheduler",
}
OF_A_BATCH = {
    OK: "all assets have a whole result",
    USAGE: "wrong usage, or a list, folder, journal or summary that is missing or cannot be written",
    REFUSED: "no asset has a result",
    SOME: "some assets have a result, or a result leaves out faces that have an area",
    INTERRUPTED: "interrupted",
    TERMINATED: "asked to end, as by a scheduler",
}

# What asks a process to end: a scheduler or the system, and a terminal that is closed.
REQUESTS = ("SIGTERM", "SIGHUP")


class Terminated(KeyboardInterrupt):
    """The process was asked to end; whatever an interrupted run leaves as it was stays as it was."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.code = 128 + number  # as shells say it


def listed(meanings: dict[int, str]) -> str:
    """The sentence that ends a command's help."""
    return "Exit code: " + "; ".join(f"{code} {meaning}" for code, meaning in meanings.items()) + "."


def ended(run: Callable[[], int]) -> int:
    """Run a command and return its exit code; wrong usage, unusable files and interruptions are printed."""
    try:
        with _requests_heard():
            return run()
    except UsageError as error:
        complain(f"lsgp: error: {error}")
    except OSError as error:
        complain(f"lsgp: error: {describe(error)}")
    except Terminated as request:
        complain("lsgp: asked to end")
        return request.code
    except KeyboardInterrupt:
        complain("lsgp: interrupted")
        return INTERRUPTED
    return USAGE


@contextlib.contextmanager
def _requests_heard() -> Iterator[None]:
    """Requests to end are raised as Terminated, but for those that are ignored or that the program hears itself."""

    def end(number: int, frame: FrameType | None) -> None:
        raise Terminated(number)

    if threading.current_thread() is not threading.main_thread():  # in which alone Python hears signals
        yield
        return
    known = [getattr(signal, name) for name in REQUESTS if hasattr(signal, name)]
    heard = [request for request in known if signal.getsignal(request) == signal.SIG_DFL]
    for request in heard:
        signal.signal(request, end)
    try:
        yield
    finally:
        for request in heard:
            signal.signal(request, signal.SIG_DFL)


def flushed(code: int) -> int:
    """Flush the standard streams; returns the exit code, that of wrong usage where output cannot be written."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError as error:
        silence(sys.stdout)
        if not has_no_reader(error):
            complain(f"lsgp: error: {describe(error)}: 'standard output'")
            code = USAGE
    try:
        if sys.stderr is not None:
            sys.stderr.flush()
    except OSError:
        silence(sys.stderr)
    return code


def describe(error: OSError) -> str:
    """The system's message, the file it concerns, and what to do."""
    if error.filename is None:
        return str(error.strerror or error)
    path = os.fsdecode(error.filename)
    if isinstance(error, FileNotFoundError):
        remedy = "; check the path" + ("" if os.path.isabs(path) else f", which begins in '{_working_folder()}'")
    elif isinstance(error, IsADirectoryError):
        remedy = "; name a file in this folder, or unwrap all of them with lsgp batch"
    elif isinstance(error, PermissionError):
        remedy = "; change its permissions, or name another"
    else:
        remedy = ""
    return f"{error.strerror or error}: '{path}'{remedy}"


def _working_folder() -> str:
    try:
        return os.getcwd()
    except OSError:  # it has been deleted
        return "."
