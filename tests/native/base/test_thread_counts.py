# SPDX-License-Identifier: GPL-3.0-or-later
"""Factorizations on several threads: the same bytes for any number of them, and progress told to the caller alone."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import lsgp
import meshes
import pytest
from map_checks import digest, surface
from nightly import nightly
from other_process import in_another_process
from sanitized_run import many_solves

# Large enough for threads: more than 20,000 rows in one of their linear systems.
CUBE = meshes.cube(58)  # 20,186 vertices
HILL = meshes.hill(102)  # 10,609 vertices; two rows a vertex while lengths are kept
TORUS = meshes.torus(202, 100)
RUNS: dict[str, Callable[[int], lsgp.Result]] = {
    "conformal": lambda n: run(CUBE, threads=n),
    "sparse": lambda n: run(CUBE, threads=n, factorization="sparse"),
    "lscm": lambda n: run(CUBE, threads=n, method="lscm"),
    "low stretch": lambda n: run(HILL, threads=n, mode="low-stretch"),
    "seamless": lambda n: run(CUBE, threads=n, seamless=lsgp.Seamless(tiles=24)),
    "handle": lambda n: run(TORUS, threads=n),
}
TASKS = Path("/proc/self/task")
# Under Wine the folder is there, too, but that of another process.
counts_threads = pytest.mark.skipif(
    sys.platform != "linux", reason="only Linux tells the threads of a process in a folder"
)


def run(mesh: meshes.Mesh, progress: Callable[[float], object] | None = None, **options: object) -> lsgp.Result:
    return lsgp.parameterize(surface(mesh), mesh.cones, None, lsgp.Options(**options), progress=progress)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        *("sparse", "lscm", "low stretch"),
        *many_solves("conformal", "seamless", "handle"),
    ],
)
def test_any_number_of_threads_gives_the_same_bytes(name: str) -> None:
    alone = RUNS[name](1)
    assert alone.solved.all()
    for threads in (2, 3, 8):
        assert digest(RUNS[name](threads)) == digest(alone)


@pytest.mark.many_solves
def test_cones_are_placed_alike() -> None:
    one, three = (lsgp.place_cones(surface(CUBE), count=8, threads=threads) for threads in (1, 3))
    assert one == three


def test_a_solver_answers_alike() -> None:
    alone, solver = run(CUBE, threads=1), lsgp.Solver(surface(CUBE))
    for threads in (3, 1):
        again = solver.parameterize(CUBE.cones, None, lsgp.Options(threads=threads))
        assert again.corner_uv.tobytes() == alone.corner_uv.tobytes()


def test_progress_is_told_by_the_caller_alone_and_rises() -> None:
    told: list[tuple[int, float]] = []
    run(HILL, lambda done: told.append((threading.get_ident(), done)), threads=3, mode="low-stretch")
    assert {thread for thread, _ in told} == {threading.get_ident()}
    assert [done for _, done in told] == sorted(done for _, done in told)


@counts_threads
@pytest.mark.parametrize("threads", [1, 3])
def test_there_are_as_many_threads_as_asked_for_and_none_is_left(threads: int) -> None:
    before = len(list(TASKS.iterdir()))
    most = before

    def count(done: float) -> None:
        nonlocal most
        most = max(most, len(list(TASKS.iterdir())))

    run(HILL, count, threads=threads, mode="low-stretch")
    assert most - before == threads - 1
    assert len(list(TASKS.iterdir())) == before


class Stop(Exception):
    pass


@pytest.mark.parametrize("how", ["False", "raise"])
def test_a_run_on_threads_can_be_stopped_at_any_time(how: str) -> None:
    for last in (1, 4, 7, 10):
        told: list[float] = []

        def stop(done: float, told: list[float] = told, last: int = last) -> bool:
            told.append(done)
            if len(told) == last and how == "raise":
                raise Stop
            return len(told) < last

        with pytest.raises(Stop if how == "raise" else lsgp.Cancelled):
            run(HILL, stop, threads=3, mode="low-stretch")
        assert len(told) == last


@pytest.mark.parametrize("threads", [-1, 1025, True, 1.5, "2", None, 2**40])
def test_other_numbers_are_refused(threads: object) -> None:
    mesh = meshes.cube(2)
    with pytest.raises(lsgp.InputError, match="threads") as refused:
        run(mesh, threads=threads)
    assert refused.value.code == "WRONG_PARAMETER"
    with pytest.raises(lsgp.InputError, match="threads") as refused:
        lsgp.place_cones(surface(mesh), threads=threads)
    assert refused.value.code == "WRONG_PARAMETER"


@pytest.mark.slow
@counts_threads
@pytest.mark.parametrize(
    ("variable", "option", "expected"),
    [
        *(("3", 0, 3), ("many", 0, os.cpu_count())),
        *many_solves(("3", 2, 2)),
        *nightly(("1", 0, 1), ("0", 0, os.cpu_count()), marks=[pytest.mark.many_solves]),
    ],
)
def test_in_another_process_the_environment_has_the_default(variable: str, option: int, expected: int) -> None:
    script = (
        "import os, test_thread_counts as t\n"
        "counts = []\n"
        f"t.run(t.HILL, lambda done: counts.append(len(os.listdir(t.TASKS))), threads={option}, mode='low-stretch')\n"
        "print(max(counts) - min(counts) + 1)\n"
    )
    assert in_another_process(script, LSGP_THREADS=variable).strip() == str(expected)
