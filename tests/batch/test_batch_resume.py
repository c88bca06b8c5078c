# SPDX-License-Identifier: GPL-3.0-or-later
"""A killed run is resumed where it ended: nothing finished is repeated, and nothing is lost."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from batch_meshes import off_text
from meshes import bumpy_sphere, moebius_strip, renumber
from nightly import nightly

COUNT = 24


@pytest.fixture
def many(tmp_path: Path) -> Path:
    folder = tmp_path / "many"
    folder.mkdir()
    for i in range(COUNT):
        mesh = moebius_strip() if i % 8 == 7 else renumber(bumpy_sphere(2), i)[0]
        (folder / f"{i:02}.off").write_text(off_text(mesh))
    return folder


def results(out: Path) -> dict[str, tuple[int, bytes]]:
    """The time of writing and the content of every result."""
    return {path.name: (path.stat().st_mtime_ns, path.read_bytes()) for path in out.glob("*.obj")}


@pytest.mark.slow
@pytest.mark.parametrize("lines", [0, 9, *nightly(1, COUNT - 1)])
def test_killed_after_so_many_lines(batch, lines_in, many: Path, lines: int) -> None:
    out = many.parent / "out"
    journal = out / "journal.jsonl"
    arguments = ["many", "--out", "out", "--jobs", "2", "--no-pictures"]
    command = [sys.executable, "-m", "lsgp", "batch", *arguments]
    process = subprocess.Popen(command, cwd=many.parent, stdout=subprocess.DEVNULL)
    while not journal.exists() or journal.read_bytes().count(b"\n") < lines:
        assert process.poll() is None or journal.read_bytes().count(b"\n") == COUNT
    process.kill()
    process.wait()
    ended = {line["asset"]: line for line in lines_in(journal)} if journal.read_bytes().endswith(b"\n") else {}
    assert len(ended) >= lines
    before = results(out)
    done = batch(*arguments, "--only-missing")
    assert done.returncode == 4
    assert f"\n{COUNT - len(ended)} of them in this run" in done.stdout
    after = lines_in(journal)
    assert sorted(line["asset"] for line in after) == sorted(f"{i:02}.off" for i in range(COUNT))
    assert {line["asset"]: line for line in after}.items() >= ended.items()
    kept = {f"{name}.obj" for name, line in ended.items() if line["status"] == "ok"}
    assert {name: before[name] for name in kept} == {name: results(out)[name] for name in kept}
    assert len(results(out)) == COUNT - COUNT // 8
