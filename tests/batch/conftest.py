# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from batch_meshes import off_text
from lsgp.batch.records import Record
from meshes import bumpy_sphere, cube, grid, moebius_strip


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A folder of five meshes at two depths: four can be unwrapped, a Moebius strip cannot."""
    folder = tmp_path / "library"
    (folder / "deep").mkdir(parents=True)
    for name, mesh in {
        "cube.off": cube(4),
        "deep/ball.off": bumpy_sphere(2),
        "deep/ball two.off": bumpy_sphere(1),
        "patch.off": grid(),
        "moebius.off": moebius_strip(),
    }.items():
        (folder / name).write_text(off_text(mesh))
    return folder


@pytest.fixture
def batch(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs `python -m lsgp batch` with the given arguments in the test's folder."""

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "lsgp", "batch", *map(str, arguments)]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)

    return run


@pytest.fixture
def lines_in() -> Callable[[Path], list[Record]]:
    """The lines of a journal."""
    return lambda path: [json.loads(line) for line in path.read_text().splitlines()]
