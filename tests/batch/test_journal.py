# SPDX-License-Identifier: GPL-3.0-or-later
"""The journal: whole lines count, broken ones do not, and one run at a time writes."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from lsgp.batch.assets import Shard
from lsgp.batch.journal import Journal, read_records
from lsgp.batch.records import EMPTY
from lsgp.io.side_files import UsageError


def record(name: str, **values: object) -> dict:
    """Of a result, as an unwrap leaves it."""
    figures = {"triangles": 12, "cones": 8, "distortion": {"l2_stretch": 1.25}, "seconds": 0.5}
    return EMPTY | figures | {"asset": name, "output": f"{name}.obj", "options": "0a1b", **values}


def test_every_line_is_there_at_once_and_is_json(tmp_path: Path) -> None:
    with Journal(tmp_path, None, keep=False) as journal:
        for i in range(3):
            journal.write(record(f"{i}", figure=math.nan, deep={"x": math.inf}))
            lines = (tmp_path / "journal.jsonl").read_text().splitlines()
            assert [json.loads(line)["asset"] for line in lines] == [f"{k}" for k in range(i + 1)]
    assert json.loads(lines[0]) == record("0", figure=None, deep={"x": None})


def test_journal_cut_anywhere_goes_on_after_its_last_whole_line(tmp_path: Path) -> None:
    with Journal(tmp_path, None, keep=False) as journal:
        for i in range(4):
            journal.write(record(f"{i}", text="x" * 3000))
    path = tmp_path / "journal.jsonl"
    whole = path.read_bytes()
    for length in (0, 1, 2990, 3050, len(whole) // 2, len(whole) - 1, len(whole)):
        path.write_bytes(whole[:length])
        with Journal(tmp_path, None, keep=True) as journal:
            kept = whole[:length].count(b"\n")
            assert sorted(read_records(tmp_path).records) == [f"{i}" for i in range(kept)]
            journal.write(record("new"))
        assert sorted(read_records(tmp_path).records) == sorted([*(f"{i}" for i in range(kept)), "new"])
        assert all(json.loads(line) for line in path.read_bytes().splitlines())


def test_broken_lines_are_left_out_and_the_last_word_counts(tmp_path: Path) -> None:
    lines = [json.dumps(record("a", n=1)), "\0" * 40, "[1, 2]", '{"asset": 5}', "{", json.dumps(record("a", n=2))]
    (tmp_path / "journal.jsonl").write_text("\n".join(lines) + "\n")
    assert read_records(tmp_path).records == {"a": record("a", n=2)}


def test_a_run_reads_all_journals_and_a_shard_its_own(tmp_path: Path) -> None:
    for shard, name in ((Shard(1, 2), "a"), (Shard(2, 2), "b"), (None, "c")):
        with Journal(tmp_path, shard, keep=True) as journal:
            journal.write(record(name))
    assert sorted(read_records(tmp_path).records) == ["a", "b", "c"]
    assert sorted(read_records(tmp_path, Shard(2, 2)).records) == ["b"]
    with Journal(tmp_path, None, keep=False):
        assert read_records(tmp_path).records == {}


def test_a_journal_is_read_while_it_is_written(tmp_path: Path) -> None:
    """Windows does not allow locked regions to be read."""
    with Journal(tmp_path, None, keep=False) as journal:
        for name in "ab":
            journal.write(record(name))
        assert sorted(read_records(tmp_path).records) == ["a", "b"]


def test_two_runs_cannot_write_to_one_journal(tmp_path: Path) -> None:
    with (
        Journal(tmp_path, Shard(1, 2), keep=False),
        pytest.raises(UsageError, match="another run is writing"),
    ):
        Journal(tmp_path, Shard(1, 2), keep=True)
    with Journal(tmp_path, Shard(2, 2), keep=False), pytest.raises(UsageError, match="another run is writing"):
        Journal(tmp_path, None, keep=False)
    with Journal(tmp_path, Shard(1, 2), keep=True):
        pass
