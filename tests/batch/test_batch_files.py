# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch writes into its own folder alone, and over no file that it reads."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest
from batch_meshes import off_text
from lsgp.batch.assets import Shard, require_distinct_files
from lsgp.batch.journal import Journal
from lsgp.io import safe_files
from lsgp.io.side_files import UsageError
from lsgp.io.whole_files import ABANDONED_SECONDS, remove_partials, whole_file
from meshes import grid
from nightly import nightly
from systems import make_link

CONTENT = b"of the user\n"
CONES = '{"cones": []}'


@pytest.fixture
def assets(tmp_path: Path) -> Path:
    folder = tmp_path / "assets"
    (folder / "deep").mkdir(parents=True)
    for name in ("a.off", "deep/b.off"):
        (folder / name).write_text(off_text(grid()))
        (folder / name).with_suffix(".json").write_text(CONES)
    (folder / "list.txt").write_text("a.off\ndeep/b.off\n")
    return folder


def tree(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


WRITTEN = [
    *["deep/b.off.obj", "pictures/a.off.png", "journal.jsonl"],
    *["a.off.obj", "a.off.obj.report.json", "deep/b.off.obj.report.json"],
    *["pictures/deep/b.off.png", "summary.txt", "contact-sheet.html"],
]


@pytest.mark.slow
@pytest.mark.parametrize("name", [*WRITTEN[:3], *nightly(*WRITTEN[3:])])
def test_nothing_is_written_through_links_in_the_folder_of_the_results(
    batch, assets: Path, tmp_path: Path, name: str
) -> None:
    """Be it a link to a file, to one that is not there, or to a folder."""
    other = tmp_path / "other"
    for is_file, target in ((True, "mine"), (True, "gone"), (False, "folder")):
        (other / "folder").mkdir(parents=True, exist_ok=True)
        (other / "mine").write_bytes(CONTENT)
        out = tmp_path / f"out {target}"
        link = out / name if is_file else out / Path(name).parts[0]
        if link == out / name and not is_file:
            continue  # in no folder
        link.parent.mkdir(parents=True)
        make_link(link, other / target)
        done = batch("assets", "--out", out.name, "--reports")
        assert done.returncode == 2
        assert "would be written elsewhere" in done.stderr and link.name in done.stderr
        assert tree(other) == {"mine": CONTENT} and not list((other / "folder").iterdir())
        assert os.path.islink(link)
        link.unlink()
        assert batch("assets", "--out", out.name, "--reports").returncode == 0
        assert set(WRITTEN) == set(tree(out))


def test_the_folder_of_the_results_may_be_a_link(batch, assets: Path, tmp_path: Path) -> None:
    (tmp_path / "large disk").mkdir()
    make_link(tmp_path / "out", tmp_path / "large disk")
    assert batch("assets", "--out", "out", "--reports").returncode == 0
    assert set(WRITTEN) == set(tree(tmp_path / "large disk"))


def test_other_hard_links_to_a_result_keep_what_they_had(batch, assets: Path, tmp_path: Path) -> None:
    """A result replaces the file of its name as a whole; a journal, which is written where it is, is refused."""
    (tmp_path / "mine").write_bytes(CONTENT)
    (tmp_path / "out").mkdir()
    os.link(tmp_path / "mine", tmp_path / "out" / "a.off.obj")
    assert batch("assets", "--out", "out").returncode == 0
    (tmp_path / "out" / "journal.jsonl").unlink()
    os.link(tmp_path / "mine", tmp_path / "out" / "journal.jsonl")
    done = batch("assets", "--out", "out")
    assert (done.returncode, "journal.jsonl' has several hard links" in done.stderr) == (2, True)
    assert (tmp_path / "mine").read_bytes() == CONTENT


def test_hard_links_are_not_parted_in_place(batch, assets: Path) -> None:
    (assets / "c.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    os.link(assets / "c.obj", assets / "twin")
    before = tree(assets)
    done = batch("assets", "--out", "assets", "--in-place", "--no-pictures")
    assert (done.returncode, "c.obj' is one of 2 hard links" in done.stderr) == (2, True)
    assert tree(assets) == before


@pytest.mark.parametrize(
    ("own", "options"),
    [
        ("list.txt", ["--no-pictures"]),
        ("a.json", ["--cones", "{}.json"]),
        ("deep/b.json", ["--cones", "{}.json"]),
        ("a.json", ["--seam-edges", "assets/a.json"]),
        ("a.json", ["--tls-ca-file", "assets/a.json", "--scheduler", "tls://h:1", "--tls-cert", "assets/a.json"]),
        ("a.off", []),
    ],
)
@pytest.mark.parametrize("written", [WRITTEN[0], WRITTEN[3], "summary.txt", "journal.jsonl"])
def test_nothing_is_written_over_a_file_that_is_read(
    batch, assets: Path, tmp_path: Path, own: str, options: list[str], written: str
) -> None:
    target = tmp_path / "out" / written
    target.parent.mkdir(parents=True)
    os.link(assets / own, target)
    before = tree(assets)
    done = batch("assets/list.txt", "--out", "out", "--reports", *options)
    assert done.returncode == 2
    assert "would be written over" in done.stderr or "is the input" in done.stderr
    assert os.path.join(*Path(own).parts) in done.stderr
    assert tree(assets) == before


def test_reports_are_not_written_over_the_cones_that_they_serve_as(batch, tmp_path: Path) -> None:
    """A report of an earlier run is a file of cones."""
    folder = tmp_path / "models"
    folder.mkdir()
    (folder / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "a.obj.report.json").write_text(CONES)
    options = ["--cones", "{}.obj.report.json", "--in-place", "--reports"]
    done = batch("models", "--out", "models", *options)
    assert (done.returncode, "which is read" in done.stderr) == (2, True)
    assert (folder / "a.obj.report.json").read_text() == CONES
    assert batch("models", "--out", "models", *options[:-1]).returncode == 0


def test_results_that_differ_in_case_alone_need_a_folder_that_heeds_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = [(name, name) for name in ("A.obj", "a.obj")]
    monkeypatch.setattr("lsgp.batch.assets.ignores_case", lambda folder: True)
    with pytest.raises(UsageError, match=r"'A\.obj' and 'a\.obj' would both be written"):
        require_distinct_files(tmp_path, files, [])
    monkeypatch.setattr("lsgp.batch.assets.ignores_case", lambda folder: False)
    if os.name == "posix":
        require_distinct_files(tmp_path, files, [])


@pytest.mark.parametrize(
    "further",
    [
        *["a.off.obj/b.off", "a.off.obj.report.json/b.off", "summary.txt/b.off", "journal.jsonl/b.off"],
        *["pictures/a.off.png/b.off", "contact-sheet.html/b.off"],
    ],
)
def test_no_file_of_a_run_is_a_folder_of_another(batch, assets: Path, tmp_path: Path, further: str) -> None:
    (assets / further).parent.mkdir(parents=True)
    (assets / further).write_text(off_text(grid()))
    done = batch("assets", "--out", "out", "--reports")
    assert (done.returncode, "name of one of its folders" in done.stderr) == (2, True)
    assert repr(further) in done.stderr and not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", WRITTEN[2:])
def test_a_folder_in_the_place_of_a_file_is_told_before_the_work(
    batch, assets: Path, tmp_path: Path, name: str
) -> None:
    (tmp_path / "out" / name).mkdir(parents=True)
    done = batch("assets", "--out", "out", "--reports")
    assert (done.returncode, "is a folder; name another" in done.stderr) == (2, True)
    assert tree(tmp_path / "out") == {}


def test_a_whole_run_waits_for_shards(batch, assets: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    shard = tmp_path / "out" / "journal-1-of-2.jsonl"
    with Journal(tmp_path / "out", Shard(1, 2), keep=True):
        for options in ([], ["--only-missing"]):
            done = batch("assets", "--out", "out", *options)
            assert (done.returncode, "another run is writing" in done.stderr) == (2, True)
    assert shard.exists()
    assert batch("assets", "--out", "out", "--only-missing").returncode == 0


def abandoned(target: Path) -> Path:
    """A temporary file of a process that was killed while it wrote the target."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with pytest.raises(KeyboardInterrupt), whole_file(target) as partial:
        partial.write_bytes(b"half")
        kept = partial.read_bytes()
        raise KeyboardInterrupt
    partial.write_bytes(kept)
    return partial


def test_temporary_files_of_own_results_are_removed_at_once_and_of_others_when_they_are_old(
    batch, assets: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    own = [abandoned(out / name) for name in WRITTEN if not name.startswith("journal")]
    others = [abandoned(out / name) for name in ("other.obj", "deep/other.obj")]
    old = abandoned(out / "deep" / "older.obj")
    past = time.time() - ABANDONED_SECONDS - 1
    os.utime(old, (past, past))
    assert batch("assets", "--out", "out", "--reports").returncode == 0
    assert not any(path.exists() for path in [*own, old])
    assert all(path.exists() for path in others)


def test_a_shard_that_is_resumed_removes_its_own(batch, assets: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    shards = [["--shard", f"{i}/2", "--only-missing", "--no-pictures"] for i in (1, 2)]
    codes = [batch("assets", "--out", "out", *shard).returncode for shard in shards]
    assert set(codes) <= {0}
    left = {name: abandoned(out / name) for name in ("a.off.obj", "deep/b.off.obj")}
    for shard in shards:
        lines = (out / f"journal-{shard[1].replace('/', '-of-')}.jsonl").read_text().splitlines()
        own = {json.loads(line)["output"] for line in lines}
        before = {name for name, path in left.items() if path.exists()}
        assert batch("assets", "--out", "out", *shard).returncode == 0
        assert {name for name, path in left.items() if path.exists()} == before - own
    assert not any(path.exists() for path in left.values())


def test_without_locks_only_old_files_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_locks(descriptor: int) -> None:
        raise OSError(38, "Function not implemented")

    with Journal(tmp_path, None, keep=True) as journal:
        assert journal.is_alone
    monkeypatch.setattr("lsgp.batch.journal._lock", no_locks)
    with Journal(tmp_path, None, keep=True) as journal:
        assert not journal.is_alone
    left = abandoned(tmp_path / "a.obj")
    remove_partials(tmp_path)
    assert left.exists()
    remove_partials(tmp_path, [tmp_path / "a.obj"])
    assert not left.exists()


@pytest.mark.parametrize("how", ["link", "copy", "other"])
def test_a_backup_of_a_run_that_replaced_nothing_is_no_obstacle(batch, tmp_path: Path, how: str) -> None:
    """It was killed between the backup and the replacement."""
    folder = tmp_path / "models"
    folder.mkdir()
    mesh = folder / "a.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    backup = safe_files.backup_of(mesh)
    os.link(mesh, backup) if how == "link" else backup.write_bytes(mesh.read_bytes())
    if how == "other":
        backup.write_bytes(CONTENT)
    done = batch("models", "--out", "models", "--in-place", "--no-pictures")
    assert done.returncode == (2 if how == "other" else 0)
    assert backup.exists() == (how == "other")
    assert (b"vt" in mesh.read_bytes()) == (how != "other")
