# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

SHARED = Path(os.environ.get("LSGP_SHARED") or Path(__file__).resolve().parents[3] / "shared")


@dataclass
class Ended:
    """A command line that has ended."""

    code: int
    out: str
    err: str
    folder: Path

    def report(self, name: str = "report.json") -> dict:
        return json.loads((self.folder / name).read_text(), parse_constant=_no_constant)


def _no_constant(text: str) -> None:
    raise AssertionError(f"{text} is no JSON")


@pytest.fixture
def lsgp(tmp_path: Path) -> Callable[..., Ended]:
    """Runs `python -m lsgp` with the given arguments in the test's folder."""

    def run(*arguments: object) -> Ended:
        command = [sys.executable, "-m", "lsgp", *map(str, arguments)]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
        return Ended(done.returncode, done.stdout, done.stderr, tmp_path)

    return run


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder with meshes/ and bad/ beside the checkout; the tests that need it are skipped without it."""
    if not SHARED.is_dir():
        pytest.skip(f"no shared folder at {SHARED}")
    return SHARED
