# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that some systems lack."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

import pytest


def is_wine() -> bool:
    """Whether Windows is Wine."""
    if os.name != "nt":
        return False
    import ctypes

    return hasattr(ctypes.WinDLL("ntdll"), "wine_get_version")


def is_running(pid: int) -> bool:
    """Whether there is such a process that has not ended."""
    if os.name == "nt":
        return _is_running_on_windows(pid)
    status = Path(f"/proc/{pid}/stat")
    if status.exists():  # it tells those that have ended and that nobody has asked for
        with contextlib.suppress(OSError):
            return status.read_text().rsplit(")", 1)[1].split()[0] != "Z"
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def _is_running_on_windows(pid: int) -> bool:
    """There the signal 0 is Ctrl-C."""
    import ctypes

    synchronize, is_waiting = 0x00100000, 0x102
    kernel = ctypes.WinDLL("kernel32")
    kernel.OpenProcess.restype = ctypes.c_void_p
    process = ctypes.c_void_p(kernel.OpenProcess(synchronize, False, pid))
    if not process:
        return False
    ended = kernel.WaitForSingleObject(process, 0)
    kernel.CloseHandle(process)
    return ended == is_waiting


def make_link(link: Path, to: str | os.PathLike[str]) -> None:
    """A symbolic link; skips the test where there is none then: Windows asks for a privilege, and Wine 8 tells success
    but makes none."""
    try:
        link.symlink_to(to, target_is_directory=Path(link.parent, to).is_dir())
    except OSError as error:
        if os.name == "posix":
            raise
        pytest.skip(f"no symbolic links here: {error}")
    if os.name != "posix" and not link.is_symlink():
        pytest.skip("no symbolic links here")
