# SPDX-License-Identifier: GPL-3.0-or-later
"""What test runs do: LSGP_TEST_JITTER to inputs, LSGP_TEST_COMMAND at the end, and which cases LSGP_FULL_SWEEP adds."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import lsgp
import meshes
import pytest
from map_checks import digest, surface
from other_process import in_another_process

TESTS = Path(__file__).parents[1]
JITTER = str(TESTS / "jitter")
SCRIPT = (
    "import jittered_inputs, lsgp, meshes, numpy as np, test_test_runs as t\n"
    "p = meshes.ellipsoid(2).positions\n"
    "for seed in '12':\n"
    "    found = jittered_inputs.moved(p, seed)\n"
    "    units = np.abs((found - p) / np.spacing(np.abs(p))).max()\n"
    "    print((found == p).all(), units, (found[::-1] == jittered_inputs.moved(p[::-1], seed)).all())\n"
    "print(t.answer(), lsgp.ledger.surface_arrays is lsgp.surface.surface_arrays)\n"
)


def answer() -> str:
    mesh = meshes.bumpy_sphere(2)
    return digest(lsgp.parameterize(surface(mesh), mesh.cones))


@pytest.mark.exact_input
def test_inputs_move_by_units_in_the_last_place() -> None:
    path = os.pathsep.join([JITTER, *filter(None, sys.path)])
    digests = set()
    for seed in ("", "1", "2"):
        *rows, last = in_another_process(SCRIPT, PYTHONPATH=path, LSGP_TEST_JITTER=seed).splitlines()
        assert rows == ["False 1.0 True"] * 2
        found, is_everywhere = last.split()
        assert is_everywhere == "True" and (found == answer()) == (not seed)
        digests.add(found)
    assert len(digests) == 3


def run_tests(tests: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Of a file in a folder of its own, with the conftest of all tests."""
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "conftest", "-p", "no:cacheprovider", Path(tests).name],
        cwd=Path(tests).parent,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(TESTS), *filter(None, sys.path)])} | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.mark.parametrize(("seed", "begin"), [("", ""), ("7", "LSGP_TEST_JITTER=7 ")])
def test_a_run_ends_with_the_command_for_what_failed(tmp_path: Path, seed: str, begin: str) -> None:
    some = tmp_path / "test_some.py"
    some.write_text(
        "import pytest\n@pytest.fixture\ndef broken(): raise ValueError\ndef test_passes(): pass\n"
        "@pytest.mark.parametrize('name', ['a b', 'c'])\ndef test_fails(name): assert name == 'c'\n"
        "def test_is_broken(broken): pass\n"
    )

    told = {"LSGP_TEST_COMMAND": "python -m pytest", "LSGP_TEST_JITTER": seed}
    failed, passed = run_tests(some, **told), run_tests(f"{some}::test_passes", **told)
    assert failed.stdout.splitlines()[-2:] == [
        "2 failed. To run them again:",
        f"{begin}python -m pytest 'test_some.py::test_fails[a b]' test_some.py::test_is_broken",
    ]
    assert (failed.returncode, passed.returncode) == (1, 0) and "again" not in passed.stdout


@pytest.mark.parametrize(("everything", "ended"), [("", "3 passed, 2 deselected"), ("1", "5 passed")])
def test_nightly_cases_run_where_everything_does(tmp_path: Path, everything: str, ended: str) -> None:
    some = tmp_path / "test_some.py"
    some.write_text(
        "import pytest\nfrom nightly import nightly, some_nightly\n"
        "@pytest.mark.parametrize(('a', 'b'), [(1, 2), *nightly((3, 4))])\ndef test_one(a, b): assert b == a + 1\n"
        "@pytest.mark.parametrize('name', some_nightly('abc', 'b'))\ndef test_other(name): pass\n"
    )
    done = run_tests(some, LSGP_FULL_SWEEP=everything)
    assert done.returncode == 0 and f" {ended}" in done.stdout.splitlines()[-1]
