# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker process: reads tasks from its standard input, line by line, and writes records to its standard output.

    python -m lsgp.batch.worker

It ends, even in the middle of an asset, when its input ends: the process that started it has ended or stopped it.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from ..base.progress import Progress
from ..run.report import finite
from .records import FAILED, Record, ending
from .tasks import Settings, Task

# Prefix of the protocol's lines; host programs print lines of their own.
MARK = "\x1elsgp "
# Key of a message that is no answer yet.
SHARE = "share"
# Between two messages of how far an asset is.
SHARE_SECONDS = 0.5


def serve(work: Callable[..., Record], *, tells: bool = False) -> None:
    """Answer tasks until the input ends, then end the process.

    work: on a task, with the settings. tells: whether it also takes a function to be told its progress.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is handled by the process that started this one
    # Any other output is redirected to standard error.
    answers = os.dup(1)
    os.dup2(2, 1)
    # Windows waits for the reader of a pipe when a DLL is loaded that asks for the kind of standard input.
    tasks = os.dup(0)
    nowhere = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nowhere, 0)
    os.close(nowhere)
    lines: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read_lines, args=(tasks, lines), daemon=True).start()
    settings = Settings(**json.loads(lines.get()))
    name = f"{socket.gethostname()}:{os.getpid()}"
    if settings.memory_limit is not None:
        _limit_memory(settings.memory_limit)
    digest = settings.digest()
    _send(answers, {"ready": name})
    further = (_teller(answers),) if tells else ()
    while True:
        task = Task(**json.loads(lines.get()))
        begin, cpu = time.perf_counter(), time.process_time()
        _forget_peak_memory()
        try:
            record = work(task, settings, *further)
        except Exception as error:  # any error fails this asset only
            message = f"{type(error).__name__}: {error}. This is a fault of the program; please report it."
            record = ending(FAILED, "INTERNAL_ERROR", message)
        figures = {
            "asset": task.asset,
            "input_bytes": _size(task.input),
            "seconds": round(time.perf_counter() - begin, 6),
            "cpu_seconds": round(time.process_time() - cpu, 6),
            "peak_memory_mb": _peak_memory_mb(),
            "worker": name,
            "options": digest,
        }
        _send(answers, record | figures)


def _teller(answers: int) -> Progress:
    """What sends the progress of an asset, now and then."""
    told = -math.inf

    def tell(done: float) -> None:
        nonlocal told
        now = time.monotonic()
        if now - told >= SHARE_SECONDS:
            told = now
            _send(answers, {SHARE: done})

    return tell


def _read_lines(descriptor: int, lines: SimpleQueue[bytes]) -> None:
    with open(descriptor, "rb") as tasks:
        for line in tasks:
            lines.put(line)
    os._exit(0)


def _send(descriptor: int, value: Any) -> None:
    data = (MARK + json.dumps(finite(value)) + "\n").encode("ascii")
    try:
        while data:
            data = data[os.write(descriptor, data) :]
    except OSError:  # the reader has gone
        os._exit(1)


def _limit_memory(megabytes: int) -> None:
    """Limit the memory that the process may allocate beyond what it has now."""
    import resource

    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + megabytes * 1_000_000
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


def _forget_peak_memory() -> None:
    """Reset the peak, so that it is that of one asset; elsewhere it remains that of all assets so far."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def _peak_memory_mb() -> float | None:
    """None if the system does not report it."""
    peak = _peak_on_windows() if sys.platform == "win32" else _peak_on_mac() if sys.platform == "darwin" else _peak()
    return None if peak is None else round(peak / 1e6, 3)


def _peak() -> int | None:
    """In bytes, as the others."""
    try:
        status = Path("/proc/self/status").read_text()
    except OSError:
        return None
    peak = next((line for line in status.splitlines() if line.startswith("VmHWM:")), None)
    return None if peak is None else int(peak.split()[1]) * 1024


def _peak_on_mac() -> int:
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # elsewhere in kilobytes


def _peak_on_windows() -> int | None:
    import ctypes
    from ctypes import wintypes

    class Counters(ctypes.Structure):
        """PROCESS_MEMORY_COUNTERS."""

        _fields_ = (
            ("size", wintypes.DWORD),
            ("page_faults", wintypes.DWORD),
            ("peak", ctypes.c_size_t),
            ("others", ctypes.c_size_t * 7),
        )

    counters = Counters(size=ctypes.sizeof(Counters))
    kernel = ctypes.WinDLL("kernel32")
    kernel.GetCurrentProcess.restype = wintypes.HANDLE
    ask = kernel.K32GetProcessMemoryInfo
    ask.argtypes = (wintypes.HANDLE, ctypes.POINTER(Counters), wintypes.DWORD)
    return counters.peak if ask(kernel.GetCurrentProcess(), ctypes.byref(counters), counters.size) else None


def _size(path: str) -> int | None:
    try:
        return os.stat(path).st_size
    except OSError:
        return None


if __name__ == "__main__":
    from .work import unwrap_asset

    serve(unwrap_asset, tells=True)
