# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a process of its own, which may crash or take too long without harm to the others."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")


def in_own_process(work: Callable[[], T], limit: float, slow: T, crash: T) -> T:
    """What the work returns, or `slow` where that takes more than `limit` seconds, or `crash` where it ends before."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    child = context.Process(target=lambda: theirs.send(work()))
    child.start()
    theirs.close()
    try:
        return ours.recv() if ours.poll(limit) else slow
    except EOFError:
        return crash
    finally:
        child.kill()
        child.join()
