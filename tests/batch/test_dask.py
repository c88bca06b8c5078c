# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch on a Dask cluster: a real scheduler and worker processes, one of which is killed in the middle."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from batch_meshes import off_text
from dask_cluster import Cluster
from lsgp.cli import main
from meshes import bumpy_sphere, moebius_strip, renumber

pytest.importorskip("distributed")

COUNT = 20


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    started = Cluster(tmp_path_factory.mktemp("cluster"))
    yield started
    started.stop()


@pytest.fixture
def many(tmp_path: Path) -> Path:
    folder = tmp_path / "many"
    folder.mkdir()
    for i in range(COUNT):
        mesh = moebius_strip() if i % 10 == 9 else renumber(bumpy_sphere(3), i)[0]
        (folder / f"{i:02}.off").write_text(off_text(mesh))
    return folder


@pytest.mark.slow
def test_a_worker_killed_in_the_middle_loses_nothing(cluster: Cluster, lines_in, many: Path) -> None:
    out = many.parent / "out"
    journal = out / "journal.jsonl"
    arguments = ["-m", "lsgp", "batch", "many", "--out", "out", "--scheduler", cluster.address, "--no-pictures"]
    process = subprocess.Popen([sys.executable, *arguments], cwd=many.parent, stdout=subprocess.DEVNULL)
    while not journal.exists() or journal.read_bytes().count(b"\n") < 3:
        assert process.poll() is None
        time.sleep(0.01)
    assert journal.read_bytes().count(b"\n") < COUNT
    os.kill(cluster.workers[0].pid, signal.SIGKILL)
    assert process.wait(300) == 4
    lines = lines_in(journal)
    assert sorted(line["asset"] for line in lines) == sorted(f"{i:02}.off" for i in range(COUNT))
    assert {line["status"] for line in lines} == {"ok", "refused"}
    assert main(["batch", str(many), "--out", str(many.parent / "local"), "--no-pictures"]) == 4
    alone = {path.name: path.read_bytes() for path in (many.parent / "local").glob("*.obj")}
    assert len(alone) == COUNT - COUNT // 10
    assert {path.name: path.read_bytes() for path in out.glob("*.obj")} == alone


@pytest.mark.slow
def test_wrong_usage(library: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("lsgp.batch.dask_engine.CONNECT_SECONDS", 1)
    arguments = ["batch", str(library), "--out", str(library.parent / "out")]
    assert main([*arguments, "--scheduler", "tcp://127.0.0.1:1"]) == 2
    assert "no Dask scheduler answers at 'tcp://127.0.0.1:1'" in capsys.readouterr().err
    assert main([*arguments, "--scheduler", "tcp://127.0.0.1:1", "--jobs", "2"]) == 2
    assert "--jobs is for this machine" in capsys.readouterr().err
