# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from command import Ended


@pytest.fixture
def lsgp(tmp_path: Path) -> Callable[..., Ended]:
    """Runs `python -m lsgp` with the given arguments in the test's folder, as a process of its own."""

    def run(*arguments: object) -> Ended:
        command = [sys.executable, "-m", "lsgp", *map(str, arguments)]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
        return Ended(done.returncode, done.stdout, done.stderr, tmp_path)

    return run
