# SPDX-License-Identifier: GPL-3.0-or-later
"""The same input gives the same bytes: in the 50th run, after failures, among threads, in a locale with decimal commas.

`native/api/test_determinism.py` compares two runs and two processes with other numbers of threads.
"""

from __future__ import annotations

import contextlib
import json
import shutil
import subprocess
import threading
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import digest, surface, unwrap
from meshes import Mesh
from other_process import in_another_process

RUNS = 50
# A quick input of each kind of way through the library: cones chosen and placed, seams, borders, handles, leftovers,
# lattices.
BALL = meshes.bumpy_sphere(2)
HOLES = meshes.disk_with_holes(12, 2)
HANDLE = meshes.torus(14, 8)._replace(cones=np.array([0, 5, 60, 90], np.int32))
PATCH = meshes.saddle(8)._replace(cones=np.array([0, 8, 72, 80], np.int32))


def answers() -> dict[str, str]:
    """A digest of each input's result."""
    placed = lsgp.place_cones(surface(BALL), count=9).cones
    seamed = lsgp.Surface(BALL.positions, BALL.triangles, None, BALL.triangles[:40, :2])
    mixed = meshes.merge([meshes.with_fin(meshes.cube(3))[0], meshes.moebius_strip(), HOLES])
    return {
        "chosen": digest(unwrap(BALL)),
        "placed": digest(lsgp.parameterize(surface(BALL), placed)),
        "spectral": digest(unwrap(BALL, unfold="spectral")),
        "seams": digest(lsgp.parameterize(seamed, BALL.cones)),
        "handles": digest(unwrap(meshes.torus(14, 8))),
        "straight": digest(unwrap(PATCH, border="straight")),
        "leftovers": digest(unwrap(mixed)),
        "seamless": digest(unwrap(BALL, seamless=lsgp.Seamless())),
        "seamless handles": digest(unwrap(HANDLE, seamless=lsgp.Seamless("hexagon", tiles=12))),
        "seamless parts": digest(unwrap(meshes.merge([BALL, HOLES]), seamless=lsgp.Seamless(tiles=20, parity=True))),
    }


def fail() -> None:
    """Calls that end in errors, some late."""
    for cones, angles in (([0], None), ([0, 0], None), (BALL.cones, [1.0] * 6), (BALL.cones, [np.nan] + [None] * 5)):
        with contextlib.suppress(lsgp.LsgpError):
            lsgp.parameterize(surface(BALL), cones, angles)
    broken = Mesh(BALL.positions * [1, 1e-14, 1e14], BALL.triangles, BALL.cones)
    with contextlib.suppress(lsgp.LsgpError):
        unwrap(broken, unfold="spectral")


@pytest.mark.slow
def test_the_fiftieth_run_and_failures_between() -> None:
    first = answers()
    for _ in range(RUNS - 1):
        fail()
        assert answers() == first


@pytest.mark.parametrize("count", [2, 4])
def test_threads_at_once(count: int) -> None:
    alone = answers()
    found: list[list[dict[str, str]]] = [[] for _ in range(count)]
    start = threading.Barrier(count)

    def work(i: int) -> None:
        start.wait()
        for _ in range(4):
            if i % 2:
                fail()
            found[i].append(answers())

    threads = [threading.Thread(target=work, args=(i,)) for i in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [[alone] * 4] * count


PRINT_ANSWERS = "import json, test_repeatability as t; print(json.dumps(t.answers()))"


@pytest.mark.slow
@pytest.mark.parametrize("threads", ["1", "2", "4"])
def test_processes_with_any_number_of_threads(threads: str) -> None:
    numbers = {name: threads for name in ("LSGP_THREADS", "OPENBLAS_NUM_THREADS")}
    assert json.loads(in_another_process(PRINT_ANSWERS, **numbers)) == answers()


# By name: Windows does not ask the environment.
SET_LOCALE = "import locale, os; locale.setlocale(locale.LC_ALL, os.environ.get('LC_ALL', '')); "


@pytest.fixture(scope="session")
def decimal_comma(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of a locale that writes 1,5 for 1.5; made where the system has the means, else skipped."""
    folder = tmp_path_factory.mktemp("locales")
    localedef = shutil.which("localedef")
    if localedef is not None:
        subprocess.run([localedef, "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True)
    environment = {"LC_ALL": "de_DE.UTF-8"} | ({"LOCPATH": str(folder)} if any(folder.iterdir()) else {})
    try:
        comma = in_another_process(SET_LOCALE + "print(locale.str(1.5))", **environment)
    except AssertionError:
        pytest.skip("no locale with decimal commas: install de_DE.UTF-8, or localedef and its sources")
    assert comma.strip() == "1,5"
    return environment


@pytest.mark.slow
def test_a_locale_with_decimal_commas(decimal_comma: dict[str, str]) -> None:
    script = SET_LOCALE + "assert locale.str(0.5) == '0,5'\n" + PRINT_ANSWERS
    assert json.loads(in_another_process(script, **decimal_comma)) == answers()


def test_files_and_reports_in_a_locale_with_decimal_commas(tmp_path: Path, decimal_comma: dict[str, str]) -> None:
    lines = ["v {!r} {!r} {!r}".format(*p) for p in BALL.positions.tolist()]
    lines += ["f {} {} {}".format(*f) for f in (BALL.triangles + 1).tolist()]
    (tmp_path / "in.obj").write_text("\n".join(lines))
    written = {}
    for name, environment in (("plain", {}), ("comma", decimal_comma)):
        script = SET_LOCALE + "import sys; from lsgp.cli import main; sys.exit(main())"
        out, report = tmp_path / f"{name}.obj", tmp_path / f"{name}.json"
        in_another_process(script, "unwrap", tmp_path / "in.obj", "-o", out, "--report", report, **environment)
        told = json.loads(report.read_text())
        written[name] = out.read_bytes(), {key: value for key, value in told.items() if key != "stage_seconds"}
    assert written["plain"] == written["comma"]
