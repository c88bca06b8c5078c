# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from batch_meshes import off_text
from lsgp.batch.records import Record
from meshes import bumpy_sphere, cube, grid, moebius_strip
from this_process import run_command


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
def batch(tmp_path: Path) -> Callable[..., CompletedProcess[str]]:
    """Runs `lsgp batch` with the given arguments in the test's folder, in this process; its workers are others."""
    return partial(run_command, tmp_path, "batch")


@pytest.fixture
def lines_in() -> Callable[[Path], list[Record]]:
    """The lines of a journal."""
    return lambda path: [json.loads(line) for line in path.read_text().splitlines()]
