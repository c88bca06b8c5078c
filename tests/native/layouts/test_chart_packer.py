# SPDX-License-Identifier: GPL-3.0-or-later
"""The packer waits for threads before it frees what they belong to."""

from __future__ import annotations

import hashlib
import sys
import threading

import pytest
from lsgp.layouts import chart_packer


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells what threads do")
def test_threads_that_run_are_waited_for_and_those_that_sleep_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chart_packer, "_MOST_SETTLING", 60.0)
    others = chart_packer._threads()
    is_running, is_done, may_end = threading.Event(), threading.Event(), threading.Event()

    def work() -> None:
        is_running.set()
        hashlib.pbkdf2_hmac("sha256", b"", b"", 100_000)  # without the interpreter's lock
        is_done.set()
        may_end.wait()

    thread = threading.Thread(target=work)
    thread.start()
    is_running.wait()
    chart_packer._settle(others)
    assert is_done.is_set()
    assert thread.is_alive()
    may_end.set()
    thread.join()
