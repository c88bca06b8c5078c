# SPDX-License-Identifier: GPL-3.0-or-later
"""What a batch accepts as assets, and what it reports about the rest: single meshes, invalid lists, kinds of files
that are not read, pipes, and output that nobody takes."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from batch_meshes import off_text
from lsgp.batch.assets import find_assets
from lsgp.io.mesh_files import MESH_SUFFIXES, read_mesh_file, write_mesh_file
from lsgp.io.mesh_formats import readable_suffixes
from meshes import grid

READABLE = readable_suffixes()
UNREADABLE = sorted(MESH_SUFFIXES - set(READABLE))
posix = pytest.mark.skipif(os.name != "posix", reason="pipes and descriptors as on POSIX")


def write_mesh(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(off_text(grid(3, 3)))
    return path


def test_a_single_mesh_is_an_asset(tmp_path: Path, batch, lines_in) -> None:
    write_mesh(tmp_path / "in" / "Patch.OFF")
    done = batch("in/Patch.OFF", "--out", "out")
    assert done.returncode == 0, done.stderr
    assert [line["asset"] for line in lines_in(tmp_path / "out" / "journal.jsonl")] == ["Patch.OFF"]
    assert (tmp_path / "out" / "Patch.OFF.obj").is_file()


@pytest.mark.parametrize("suffix", UNREADABLE)
def test_a_mesh_of_another_kind_is_no_list(tmp_path: Path, batch, suffix: str) -> None:
    (tmp_path / f"part{suffix}").write_text("solid part\nendsolid part\n")
    done = batch(f"part{suffix}", "--out", "out")
    assert (done.returncode, done.stdout) == (2, "")
    assert "is a mesh of a kind that is not read" in done.stderr and READABLE[0] in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("suffix", READABLE)
def test_a_folder_may_hold_every_kind_that_is_read(tmp_path: Path, batch, lines_in, suffix: str) -> None:
    plain = write_mesh(tmp_path / "in" / "a.off")
    if suffix == ".stl":
        trimesh = pytest.importorskip("trimesh")
        trimesh.load(plain, process=False).export(tmp_path / "in" / "b.stl")
    elif suffix != ".off":
        file = read_mesh_file(plain)
        write_mesh_file(tmp_path / "in" / f"b{suffix}", file, np.zeros((len(file.triangulation.triangles), 3, 2)))
    done = batch("in", "--out", "out")
    assert done.returncode == 0, done.stderr
    expected = {"a.off"} | ({f"b{suffix}"} if suffix != ".off" else set())
    assert {line["asset"] for line in lines_in(tmp_path / "out" / "journal.jsonl")} == expected


def test_other_kinds_in_a_folder_are_counted(tmp_path: Path, batch, lines_in) -> None:
    write_mesh(tmp_path / "in" / "a.off")
    other, another = UNREADABLE[0], UNREADABLE[-1]
    for name in (f"b{other}", f"deep/c{other.upper()}", f"d{another}", "readme.txt", "texture.png"):
        path = tmp_path / "in" / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"solid")
    done = batch("in", "--out", "out")
    assert done.returncode == 0
    assert f"3 files were left out, of kinds that are not read: 2 {other}, 1 {another}" in done.stderr
    assert len(lines_in(tmp_path / "out" / "journal.jsonl")) == 1
    (tmp_path / "in" / "a.off").unlink()
    done = batch("in", "--out", "out")
    assert done.returncode == 2
    assert "has no assets" in done.stderr and "3 files were left out" in done.stderr


@pytest.mark.parametrize(
    "content",
    [b"a.off\n\0\0\0\n", "a.off\nb.off\n".encode("utf-16-le"), bytes(range(256)) * 200, b"a.off\n" + b"v" * 40_000],
    ids=["NUL", "UTF-16", "binary", "endless line"],
)
def test_lists_that_are_none_are_refused_by_line(tmp_path: Path, batch, content: bytes) -> None:
    (tmp_path / "list.txt").write_bytes(content)
    done = batch("list.txt", "--out", "out")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("lsgp: error: 'list.txt' is not a list of files: line ")
    assert done.stderr.count("\n") == 1


def test_a_list_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.off")
    (tmp_path / "list.txt").write_text("a.off\n", encoding="utf-8-sig")
    (asset,) = find_assets(tmp_path / "list.txt", tmp_path / "out", READABLE).assets
    assert (asset.name, asset.size) == ("a.off", (tmp_path / "a.off").stat().st_size)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_lists_in_every_encoding_of_unicode(tmp_path: Path, encoding: str, ending: str) -> None:
    """UTF-16 with a byte order mark is what PowerShell writes."""
    name = "würfel 立 🙂.off"
    write_mesh(tmp_path / name)
    text = ("\ufeff" if encoding.startswith("utf-16") else "") + ending.join([name, "", "gone.off", ""])
    (tmp_path / "list.txt").write_bytes(text.encode(encoding))
    found = find_assets(tmp_path / "list.txt", tmp_path / "out", READABLE).assets
    assert {asset.name: asset.path.is_file() for asset in found} == {name: True, "gone.off": False}


def test_a_list_that_ends_in_half_a_character_has_no_file_of_that_name(tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_bytes("\ufeffa.off\nb".encode("utf-16-le")[:-1])
    found = find_assets(tmp_path / "list.txt", tmp_path / "out", READABLE).assets
    assert [(asset.name, asset.size) for asset in found] == [("a.off", 0), ("\ufffd", 0)]


@posix
def test_pipes_keep_nobody_waiting(tmp_path: Path, batch, lines_in) -> None:
    write_mesh(tmp_path / "in" / "a.off")
    os.mkfifo(tmp_path / "in" / "pipe.obj")
    done = batch("in", "--out", "out")
    assert done.returncode == 0
    assert "1 file was left out, of kinds that are not read: 1 device or pipe" in done.stderr
    (tmp_path / "list.txt").write_text("in/a.off\nin/pipe.obj\n")
    done = batch("list.txt", "--out", "listed")
    assert done.returncode == 4
    ended = {line["asset"]: line for line in lines_in(tmp_path / "listed" / "journal.jsonl")}
    assert (ended["in/pipe.obj"]["status"], ended["in/pipe.obj"]["code"]) == ("failed", "FILE_ERROR")
    assert "not a regular file" in ended["in/pipe.obj"]["message"]


@posix
def test_a_refused_mesh_is_told_by_its_code(tmp_path: Path, batch, lines_in) -> None:
    broken = {"a.obj": "v 0 0 0\nf 1 2 3\n", "b.obj": "v 0 0\n", "c.obj": "", "d.obj": "v 0 0 0\nv 1 0 0\nf 1 2\n"}
    (tmp_path / "in").mkdir()
    for name, text in broken.items():
        (tmp_path / "in" / name).write_text(text)
    assert batch("in", "--out", "out").returncode == 3
    ended = {line["asset"]: (line["status"], line["code"]) for line in lines_in(tmp_path / "out" / "journal.jsonl")}
    codes = {"a.obj": "INDEX_OUT_OF_RANGE", "b.obj": "MALFORMED_FILE", "c.obj": "EMPTY_MESH", "d.obj": "BAD_FACE"}
    assert ended == {name: ("refused", code) for name, code in codes.items()}


@posix
@pytest.mark.parametrize(("closed", "code"), [("1", 0), ("2", 0), ("0 1 2", 0)])
def test_closed_descriptors(tmp_path: Path, lines_in, closed: str, code: int) -> None:
    write_mesh(tmp_path / "in" / "a.off")
    command = f'"{sys.executable}" -m lsgp batch in --out out {" ".join(f"{number}>&-" for number in closed.split())}'
    done = subprocess.run(command, cwd=tmp_path, shell=True, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (code, "")
    assert [line["status"] for line in lines_in(tmp_path / "out" / "journal.jsonl")] == ["ok"]


@posix
def test_output_on_a_full_disk(tmp_path: Path, lines_in) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    write_mesh(tmp_path / "in" / "a.off")
    command = [sys.executable, "-m", "lsgp", "batch", "in", "--out", "out"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (2, "lsgp: error: No space left on device: 'standard output'\n")
    assert [line["status"] for line in lines_in(tmp_path / "out" / "journal.jsonl")] == ["ok"]
    assert (tmp_path / "out" / "contact-sheet.html").is_file()
    with open("/dev/full", "w") as full:
        done = subprocess.run([*command, "--jobs", "x"], cwd=tmp_path, stderr=full, timeout=60)
        assert done.returncode == 2
        done = subprocess.run([*command], cwd=tmp_path, stdout=full, stderr=full, timeout=60)
        assert done.returncode == 2


@posix
def test_a_journal_on_a_full_disk_is_named(tmp_path: Path) -> None:
    write_mesh(tmp_path / "in" / "a.off")
    program = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300)); "
        "from lsgp.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", program, "batch", "in", "--out", "out", "--no-pictures"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert done.stderr == f"lsgp: error: File too large: '{Path('out', 'journal.jsonl')}'\n"
