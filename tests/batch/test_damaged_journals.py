# SPDX-License-Identifier: GPL-3.0-or-later
"""Any journal can be resumed: a damaged line counts as not done, which is reported."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from batch_meshes import off_text
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp.batch.contact_sheet import write_contact_sheet
from lsgp.batch.journal import read_records
from lsgp.batch.records import EMPTY, REFUSED, ending
from lsgp.batch.summary import summary_table
from lsgp.cli import main
from meshes import grid

RESULT = EMPTY | {
    **{"asset": "a.off", "output": "a.off.obj", "picture": "pictures/a.off.png", "options": "0a1b"},
    **{"triangles": 18, "cones": 0, "islands": 1, "distortion": {"l2_stretch": 1.25}, "warnings": {"SOME": 2}},
    **{"seconds": 0.5, "cpu_seconds": 0.5, "peak_memory_mb": 40.0, "worker": "host:1", "input_bytes": 100},
}
REFUSAL = ending(REFUSED, "EMPTY_MESH", "It has no faces.", asset="b.off", options="0a1b", seconds=0.1)
ODD = [
    None,
    True,
    -1,
    10**400,
    1e300,
    float("nan"),
    float("inf"),
    "",
    "x",
    "../../a",
    "\ud800",
    "\0",
    [],
    [1],
    {},
    {"x": {}},
]


def read(folder: Path, *lines: bytes):
    (folder / "journal.jsonl").write_bytes(b"".join(line + b"\n" for line in lines))
    return read_records(folder)


def as_line(value: object) -> bytes:
    return json.dumps(value).encode()


@pytest.mark.slow
@pytest.mark.parametrize("record", [RESULT, REFUSAL], ids=["result", "refusal"])
@pytest.mark.parametrize("key", EMPTY)
def test_what_counts_can_be_summed_up(tmp_path: Path, record: dict, key: str) -> None:
    lines = [{name: record[name] for name in record if name != key}]
    lines += [record | {key: odd} for odd in ODD]
    for line in lines:
        ended = read(tmp_path, as_line(line))
        assert len(ended.records) + sum(ended.damaged.values()) == 1
        summary_table(list(ended.records.values()))
        write_contact_sheet(tmp_path, list(ended.records.values()))
    assert read(tmp_path, as_line(lines[0])).damaged == {"journal.jsonl": 1}


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_bytes_that_were_changed(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    whole = b"".join(as_line(record) + b"\n" for record in (RESULT, REFUSAL, RESULT | {"asset": "c.off"}))
    begin = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(begin, min(len(whole), begin + 40)))
    changed = whole[:begin] + data.draw(st.binary(max_size=40)) + whole[end:]
    folder = tmp_path_factory.mktemp("journal")
    (folder / "journal.jsonl").write_bytes(changed)
    ended = read_records(folder)
    summary_table(list(ended.records.values()))
    write_contact_sheet(folder, list(ended.records.values()))
    untouched = [
        record
        for record, at in ((RESULT, 0), (REFUSAL, whole.index(b'{"asset": "b.off"')))
        if begin > at + len(as_line(record)) + 1
    ]
    names = {record["asset"] for record in untouched}
    assert names <= ended.records.keys() | {name for name in names if changed.count(name.encode()) > 2}


@pytest.mark.parametrize(
    "damage",
    [
        b"",
        b"{}",
        b"[" * 100_000,
        b"\xff\xfe\0",
        b'{"asset": "a.off"}',
        b'{"asset": ["a.off"], "status": "ok"}',
        b"1e999",
    ],
)
def test_the_last_line_of_an_asset_counts_even_if_it_is_damaged(tmp_path: Path, damage: bytes) -> None:
    ended = read(tmp_path, as_line(RESULT), as_line(REFUSAL), damage)
    assert ended.damaged == {"journal.jsonl": 1}
    assert ended.records.keys() == ({"b.off"} if b'"asset": "a.off"' in damage else {"a.off", "b.off"})


@pytest.mark.slow
def test_a_run_says_so_and_does_them_again(tmp_path: Path, capsys: pytest.CaptureFixture[str], lines_in) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    for name in "abcd":
        (folder / f"{name}.off").write_text(off_text(grid(3, 3)))
    arguments = ["batch", str(folder), "--out", str(out), "--no-pictures", "--only-missing"]
    assert main(arguments) == 0
    journal = out / "journal.jsonl"
    lines = journal.read_bytes().splitlines()
    lines[0] = lines[0][:50]
    lines[1] = as_line({name: value for name, value in json.loads(lines[1]).items() if name != "output"})
    lines[2] = as_line(json.loads(lines[2]) | {"output": "../elsewhere.obj"})
    journal.write_bytes(b"\n".join(lines) + b"\n")
    capsys.readouterr()
    assert main(arguments) == 0
    said = capsys.readouterr()
    assert f"2 lines are damaged in '{journal}'; those assets count as not done" in said.err
    assert "3 of them in this run" in said.out
    assert main(arguments) == 0
    assert "0 of them in this run" in capsys.readouterr().out
