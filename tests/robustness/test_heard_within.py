# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever is computed, and of whatever: progress is told at least once a second, and a request to stop, by its answer
or by Ctrl-C, ends the call within a second and leaves no trace.

Continuous integration runs a selection; LSGP_FULL_SWEEP=1 runs every job on every family, at three sizes up to 30,000
triangles. As a script this module runs the cells whose names contain all words that it is given, or all, and prints a
table:

    python tests/robustness/test_heard_within.py 30000 quads
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # as a script

from heard_within import JOBS, Measured
from large_meshes import FAMILIES
from nightly import EVERYTHING

SECOND = 1.0
SIZES = (300, 3_000, 30_000)
# Of the clock, for what takes minutes of a processor on a machine that does much else.
GIVEN_UP = 3_600

Cell = tuple[str, int, str]
EVERY: list[Cell] = [(family, count, job) for count in SIZES for family in FAMILIES for job in JOBS]
# One cell of each way that progress goes, of those that take a few seconds with all their repetitions.
SELECTED: list[Cell] = [
    ("strip", 3_000, "pack"),
    ("strip", 300, "tiles"),
    ("boxes", 300, "find stacks"),
    ("strip", 300, "gutters"),
    ("handles", 300, "quads"),
    ("bumpy", 300, "quads"),
    ("pinched", 300, "tile"),
]
CELLS = EVERY if EVERYTHING else SELECTED

pytestmark = pytest.mark.skipif(os.name != "posix", reason="processor time is limited as on POSIX")


def in_its_own_process(cell: Cell) -> Measured:
    family, count, job = cell
    seed = zlib.crc32(repr(cell).encode())
    command = [sys.executable, "-m", "heard_within", family, str(count), job, str(seed)]
    paths = os.pathsep.join(filter(None, sys.path))
    # One thread each, so that processor time is that of the call.
    environment = {**os.environ, "PYTHONPATH": paths, "LSGP_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, timeout=GIVEN_UP, env=environment, check=False)
    if done.returncode:
        return Measured(faults=[done.stderr])
    return Measured(**json.loads(done.stdout))


@pytest.mark.slow
@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: "-".join(map(str, cell)))
def test_a_call_is_heard_of_and_hears_within_a_second(cell: Cell) -> None:
    found = in_its_own_process(cell)
    assert found.faults == []
    assert found.silence < SECOND, f"nothing was told from {found.silent[0]:.3f} to {found.silent[1]:.3f}"
    assert found.stopped < SECOND
    assert found.interrupted < SECOND


def test_every_family_and_job_occur() -> None:
    assert {family for family, _, _ in EVERY} == set(FAMILIES)
    assert all(family in FAMILIES and job in JOBS for family, _, job in SELECTED)


if __name__ == "__main__":
    for cell in EVERY:
        name = " ".join(map(str, cell))
        if all(word in name for word in sys.argv[1:]):
            found = in_its_own_process(cell)
            worst = max(found.silence, found.stopped, found.interrupted)
            mark = "*" if worst >= SECOND or found.faults else " "
            print(
                f"{mark} {name:30} {found.seconds:7.2f} s, {found.calls:6} calls, silent {found.silence:.2f} s "
                f"({found.silent[0]:.3f} to {found.silent[1]:.3f}), stopped in {found.stopped:.2f}, interrupted in "
                f"{found.interrupted:.2f}  {found.ended} {found.faults or ''}",
                flush=True,
            )
