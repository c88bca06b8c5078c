# SPDX-License-Identifier: GPL-3.0-or-later
"""What a worker process reports about its exit and its memory."""

from __future__ import annotations

import subprocess
import sys

import pytest
from lsgp.batch.worker_process import way_of_ending

MEGABYTES = 200
# The worker's figure before and after it has filled some memory; what was freed still counts.
PROGRAM = f"""
from lsgp.batch.worker import _peak_memory_mb
before = _peak_memory_mb()
filled = bytearray(b"x") * {MEGABYTES * 1_000_000}
del filled
print(_peak_memory_mb() - before)
"""


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (3, "ended with exit code 3"),
        (3221225477, "was ended by Windows: access violation (0xC0000005)"),
        (3221225725, "was ended by Windows: stack overflow (0xC00000FD)"),
        (0xC0000FFF, "was ended by Windows: exception (0xC0000FFF)"),
    ],
)
def test_ends_have_names(code: int, said: str) -> None:
    assert way_of_ending(code) == said


@pytest.mark.skipif(sys.platform != "win32", reason="exit codes of Windows")
def test_a_crash_on_windows_has_its_name() -> None:
    crash = "import ctypes; ctypes.windll.kernel32.TerminateProcess(ctypes.c_void_p(-1), 0xC0000005)"
    done = subprocess.run([sys.executable, "-c", crash], capture_output=True, timeout=60)
    assert "access violation" in way_of_ending(done.returncode)


@pytest.mark.skipif(sys.platform not in ("linux", "win32", "darwin"), reason="the system is not asked for memory")
def test_peak_memory_is_what_was_filled() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=60)
    assert 0.95 * MEGABYTES < float(done.stdout) < 1.5 * MEGABYTES, done.stderr
