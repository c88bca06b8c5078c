# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker that fails on assets with certain names and works normally on others."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

from lsgp.base.progress import Progress
from lsgp.batch.records import Record
from lsgp.batch.tasks import Settings, Task
from lsgp.batch.work import unwrap_asset
from lsgp.batch.worker import serve

# The exit code of a process that Windows has ended for one, as a signed number.
ACCESS_VIOLATION = 0xC0000005 - (1 << 32)


def work(task: Task, settings: Settings, progress: Progress) -> Record:
    if "segfault" in task.asset and os.name == "nt":
        os._exit(ACCESS_VIOLATION)
    if "segfault" in task.asset:
        os.kill(os.getpid(), signal.SIGSEGV)
    if "kill" in task.asset:
        os.kill(os.getpid(), 9)
    if "exit" in task.asset:
        print("the disk of dreams is full", file=sys.stderr, flush=True)
        os._exit(7)
    if "hang" in task.asset:
        Path(f"{task.input}.pid").write_text(str(os.getpid()))
        time.sleep(600)
    for tenth in range(10 if "slow" in task.asset else 0):
        progress(tenth / 10)
        time.sleep(0.3)
    if "fault" in task.asset:
        raise ZeroDivisionError("by nought")
    if "chatty" in task.asset:
        print("a line of its own", flush=True)
        os.write(1, b"and another\n")
    return unwrap_asset(task, settings)


if __name__ == "__main__":
    if "does-not-start" in sys.argv:
        sys.exit("there is no library here")
    serve(work, tells=True)
