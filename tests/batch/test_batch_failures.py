# SPDX-License-Identifier: GPL-3.0-or-later
"""Crashes, time-outs and a lack of memory only affect the asset on which they occur."""

from __future__ import annotations

import argparse
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from batch_meshes import off_text
from lsgp.batch import command
from lsgp.batch.assets import Asset, find_assets
from lsgp.batch.pool import PYTHON_WORKER, Pool
from lsgp.batch.records import Record
from lsgp.batch.tasks import Settings, Task
from lsgp.batch.worker_process import WorkersError
from lsgp.cli import main
from lsgp.run.unwrap_options import add_unwrap_options
from meshes import grid, icosphere
from systems import is_running

TROUBLED = [sys.executable, str(Path(__file__).with_name("troubled_worker.py"))]

# How processes that crash and are killed have ended.
CRASHED, KILLED = (
    (["access violation (0xC0000005)"], ["exit code 9"])
    if os.name == "nt"
    else (["SIGSEGV"], ["SIGKILL", "memory may have run out"])
)


def settings(**values: object) -> Settings:
    parser = argparse.ArgumentParser()
    add_unwrap_options(parser)
    return Settings(vars(parser.parse_args([])), pictures=False, **values)


def run_pool(folder: Path, names: list[str], jobs: int = 2, worker: list[str] = TROUBLED, **options) -> list[Record]:
    for name in names:
        (folder / f"{name}.off").write_text(off_text(grid(3, 3)))
    out = folder / "out"
    limits = {key: options.pop(key) for key in ("memory_limit",) if key in options}

    def task_of(asset: Asset) -> Task:
        return Task.of(asset, out, f"{asset.name}.obj")

    pool = Pool(jobs, settings(**limits), task_of, worker, **options)
    return list(pool.run(find_assets(folder, out, [".off"]).assets))


def by_name(records: list[Record]) -> dict[str, tuple[str, str | None]]:
    found = {record["asset"].removesuffix(".off"): (record["status"], record["code"]) for record in records}
    assert len(found) == len(records)
    return found


@pytest.mark.slow
def test_a_crash_costs_one_asset_and_is_named(tmp_path: Path) -> None:
    good = [f"good {i}" for i in range(12)]
    records = run_pool(tmp_path, [*good, "segfault", "kill", "exit", "fault", "chatty"])
    ended = by_name(records)
    assert {name: ended[name] for name in [*good, "chatty"]} == dict.fromkeys([*good, "chatty"], ("ok", None))
    assert ended["fault"] == ("failed", "INTERNAL_ERROR")
    assert {ended[name] for name in ("segfault", "kill", "exit")} == {("failed", "CRASHED")}
    said = {record["asset"]: record["message"] for record in records if record["status"] == "failed"}
    assert all(words in said["segfault.off"] for words in CRASHED)
    assert all(words in said["kill.off"] for words in KILLED)
    assert "exit code 7" in said["exit.off"] and "the disk of dreams is full" in said["exit.off"]
    assert "ZeroDivisionError: by nought" in said["fault.off"]


@pytest.mark.slow
def test_every_asset_crashing_is_told_of_every_asset(tmp_path: Path) -> None:
    names = [f"segfault {i}" for i in range(6)]
    assert by_name(run_pool(tmp_path, names)) == dict.fromkeys(names, ("failed", "CRASHED"))


def test_a_time_out_costs_one_asset(tmp_path: Path) -> None:
    good = [f"good {i}" for i in range(6)]
    records = run_pool(tmp_path, [*good, "hang"], seconds=2.0)
    ended = by_name(records)
    assert ended.pop("hang") == ("failed", "TIMED_OUT")
    assert ended == dict.fromkeys(good, ("ok", None))
    (late,) = (record for record in records if record["code"] == "TIMED_OUT")
    assert 2.0 <= late["seconds"] < 60
    assert "longer than 2 s" in late["message"]


@pytest.mark.slow
def test_an_asset_that_tells_how_far_it_is_has_no_longer_time(tmp_path: Path) -> None:
    told: list[dict[str, float]] = []
    (late,) = run_pool(tmp_path, ["slow"], seconds=2.0, tell=told.append)
    assert late["code"] == "TIMED_OUT"
    shares = [one["slow.off"] for one in told if one]
    assert shares == sorted(shares) and 0 < shares[-1] < 1 and len(set(shares)) > 2


def test_too_little_memory_costs_one_asset(tmp_path: Path) -> None:
    if not sys.platform.startswith("linux"):
        pytest.skip("memory is limited on Linux only")
    (tmp_path / "large.off").write_text(off_text(icosphere(6)))
    records = run_pool(tmp_path, ["small", "smaller"], 1, list(PYTHON_WORKER), memory_limit=40)
    ended = by_name(records)
    assert ended.pop("large") == ("failed", "OUT_OF_MEMORY")
    assert ended == dict.fromkeys(["small", "smaller"], ("ok", None))


@pytest.mark.slow
def test_workers_are_renewed(tmp_path: Path) -> None:
    names = [f"good {i:02}" for i in range(10)]
    records = run_pool(tmp_path, names, jobs=1, assets_per_worker=3)
    assert by_name(records) == dict.fromkeys(names, ("ok", None))
    per_worker = [sum(record["worker"] == worker for record in records) for worker in {r["worker"] for r in records}]
    assert len(per_worker) > 1


@pytest.mark.slow
def test_workers_that_do_not_start_end_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(WorkersError, match="exit code 1 at its start: there is no library here"):
        run_pool(tmp_path, ["good"], worker=[*TROUBLED, "does-not-start"])
    with pytest.raises(WorkersError, match="/no/such/program: "):
        run_pool(tmp_path, ["good"], worker=["/no/such/program"])
    kind = command.Kind((".off",), str, [*TROUBLED, "does-not-start"])
    monkeypatch.setattr("lsgp.cli.command.run_batch", lambda args: command.run_batch(args, kind))
    assert main(["batch", str(tmp_path), "--out", str(tmp_path / "out")]) == 2
    assert "no worker process can be started" in capsys.readouterr().err


def test_workers_end_with_the_run(tmp_path: Path) -> None:
    for name in ("hang 1", "hang 2", "hang 3"):
        (tmp_path / f"{name}.off").write_text(off_text(grid(3, 3)))
    pool = Pool(2, settings(), lambda asset: Task.of(asset, tmp_path / "out", asset.name), TROUBLED, 1.0)
    records = pool.run(find_assets(tmp_path, tmp_path / "out", [".off"]).assets)
    first = next(records)
    records.close()
    host_and_pid = re.fullmatch(r".*:(\d+)", first["worker"])
    assert not is_running(int(host_and_pid[1]))


@pytest.mark.slow
@pytest.mark.parametrize("stopped", ["killed", "interrupted"])
def test_workers_of_a_run_that_is_stopped_end_too(tmp_path: Path, stopped: str) -> None:
    """Also in the middle of an asset, whose result is not needed any more."""
    if stopped == "interrupted" and os.name == "nt":
        pytest.skip("Windows sends Ctrl-C to all processes of a console")
    for name in ("hang 1", "hang 2"):
        (tmp_path / f"{name}.off").write_text(off_text(grid(3, 3)))
    script = f"""
import sys
from lsgp.batch import command
from lsgp.cli import command as cli
kind = command.Kind((".off",), str, {TROUBLED!r})
cli.run_batch = lambda args: command.run_batch(args, kind)
sys.exit(cli.main(sys.argv[1:]))
"""
    arguments = [sys.executable, "-c", script, "batch", str(tmp_path), "--out", str(tmp_path / "out"), "--jobs", "2"]
    process = subprocess.Popen(arguments, stderr=subprocess.PIPE, text=True)
    workers = wait_for(lambda: [int(text) for path in tmp_path.glob("*.pid") if (text := path.read_text())], 2)
    assert all(map(is_running, workers))
    process.send_signal(signal.SIGINT) if stopped == "interrupted" else process.kill()
    _, said = process.communicate(timeout=30)
    assert process.returncode == (130 if stopped == "interrupted" else 1 if os.name == "nt" else -signal.SIGKILL)
    assert said == ("lsgp: interrupted\n" if stopped == "interrupted" else "")
    wait_for(lambda: [pid for pid in workers if not is_running(pid)], 2)


def wait_for(find: Callable[[], list[int]], count: int) -> list[int]:
    end = time.monotonic() + 30
    while time.monotonic() < end:
        found = find()
        if len(found) == count:
            return found
        time.sleep(0.05)
    raise AssertionError(f"{len(found)} instead of {count}")
