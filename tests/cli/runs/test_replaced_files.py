# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are replaced while other programs have them open, or that cannot be replaced, as on Windows."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from lsgp.io import whole_files
from lsgp.io.whole_files import write_whole
from systems import is_wine

windows = pytest.mark.skipif(os.name != "nt", reason="other systems replace files that are open or read-only")


@pytest.fixture
def target(tmp_path: Path) -> Path:
    path = tmp_path / "out.obj"
    path.write_bytes(b"before")
    return path


@pytest.mark.parametrize("held", [1, 3])
def test_a_file_that_is_open_briefly_is_replaced(target: Path, monkeypatch: pytest.MonkeyPatch, held: int) -> None:
    """By a system that refuses it as often."""
    calls = []

    def replace(source: Path, to: Path) -> None:
        calls.append(source)
        if len(calls) <= held:
            raise PermissionError(errno.EACCES, "Permission denied", source, None, to)
        source.rename(to) if os.name != "nt" else (to.unlink(), source.rename(to))

    monkeypatch.setattr(whole_files, "IS_WINDOWS", True)
    monkeypatch.setattr(whole_files.os, "replace", replace)
    write_whole(target, b"after")
    assert (target.read_bytes(), len(calls)) == (b"after", held + 1)


def test_a_file_that_stays_open_is_named_and_kept(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def replace(source: Path, to: Path) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", source, None, to)

    monkeypatch.setattr(whole_files, "IS_WINDOWS", True)
    monkeypatch.setattr(whole_files, "REPLACE_SECONDS", 0.2)
    monkeypatch.setattr(whole_files.os, "replace", replace)
    with pytest.raises(PermissionError, match="open in another program") as caught:
        write_whole(target, b"after")
    assert caught.value.filename == os.path.realpath(target)
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {"out.obj": b"before"}


@pytest.mark.parametrize("fails", ["copy2", "fsync"])
def test_a_backup_that_cannot_be_finished_is_removed(target: Path, monkeypatch: pytest.MonkeyPatch, fails: str) -> None:
    """As on Windows, where backups are copies."""
    fsync, put = os.fsync, []

    def copy_half(source: Path, to: Path) -> None:
        to.write_bytes(source.read_bytes()[:3])
        if fails == "copy2":
            raise OSError(errno.ENOSPC, "No space left on device")

    def put_first(descriptor: int) -> None:
        put.append(descriptor)
        if len(put) > 1:
            raise OSError(errno.ENOSPC, "No space left on device")
        fsync(descriptor)

    monkeypatch.setattr(whole_files, "IS_WINDOWS", True)
    monkeypatch.setattr(whole_files.shutil, "copy2", copy_half)
    monkeypatch.setattr(whole_files.os, "fsync", put_first)
    with pytest.raises(OSError, match="No space left"):
        write_whole(target, b"after", keep_backup=True)
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {"out.obj": b"before"}


@pytest.mark.parametrize("as_on_windows", [False, True])
def test_the_new_file_is_on_the_disk_before_the_old_one_goes(
    target: Path, monkeypatch: pytest.MonkeyPatch, as_on_windows: bool
) -> None:
    """Windows refuses to put on the disk what is not open for writing."""
    fsync, put = os.fsync, []

    def put_on_disk(descriptor: int) -> None:
        if as_on_windows:
            os.write(descriptor, b"")  # nothing, but an error where writing is not allowed
        put.append(os.fstat(descriptor).st_size)
        fsync(descriptor)

    monkeypatch.setattr(whole_files, "IS_WINDOWS", as_on_windows or os.name == "nt")
    monkeypatch.setattr(whole_files.os, "fsync", put_on_disk)
    write_whole(target, b"after this", keep_backup=True)
    assert put[0] == len(b"after this")
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {"out.obj": b"after this"}


@pytest.mark.parametrize("fails", ["a", "b", "c"])
def test_of_several_files_none_is_replaced_before_all_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: str
) -> None:
    before = {name: f"{name} before".encode() for name in "abc"}
    for name, data in before.items():
        (tmp_path / name).write_bytes(data)
    contents = [(tmp_path / name, f"{name} after".encode()) for name in "abc"]
    write_new = whole_files._write_new

    def fail(path: Path, data: bytes) -> None:
        write_new(path, data[:3] if data.startswith(fails.encode()) else data)
        if data.startswith(fails.encode()):
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(whole_files, "_write_new", fail)
    with pytest.raises(OSError, match="No space left") as caught:
        whole_files.write_all_whole(contents)
    assert caught.value.filename == os.fspath(tmp_path / fails)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    monkeypatch.undo()
    whole_files.write_all_whole(contents)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {path.name: data for path, data in contents}


@pytest.mark.skipif(os.name != "posix", reason="limits on the size of files are a POSIX matter")
@pytest.mark.parametrize("options", [["-o", "out.obj"], ["--in-place"]])
def test_a_disk_that_is_full_leaves_what_was_there(cube_files: Path, options: list[str]) -> None:
    """The system refuses more bytes in the middle of the file."""
    (cube_files / "out.obj").write_bytes(b"before")
    before = {path.name: path.read_bytes() for path in cube_files.iterdir()}
    limited = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048)); from lsgp.cli import main"
    command = [sys.executable, "-c", f"{limited}; sys.exit(main())", "unwrap", "cube.obj", *options]
    done = subprocess.run(command, cwd=cube_files, capture_output=True, text=True, timeout=120)
    assert (done.returncode, "File too large" in done.stderr) == (2, True)
    assert "Traceback" not in done.stderr
    assert {path.name: path.read_bytes() for path in cube_files.iterdir()} == before


@windows
def test_windows_waits_for_a_reader(target: Path) -> None:
    reader = target.open("rb")
    threading.Timer(0.5, reader.close).start()
    write_whole(target, b"after")
    assert target.read_bytes() == b"after"


@windows
def test_windows_keeps_no_backup_of_a_file_that_stays_open(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(whole_files, "REPLACE_SECONDS", 0.2)
    with target.open("rb"), pytest.raises(PermissionError, match="open in another program"):
        write_whole(target, b"after", keep_backup=True)
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {"out.obj": b"before"}


@windows
def test_windows_keeps_a_file_that_is_read_only(target: Path) -> None:
    target.chmod(stat.S_IREAD)
    with pytest.raises(PermissionError, match="read-only"):
        write_whole(target, b"after")
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {"out.obj": b"before"}
    target.chmod(stat.S_IREAD | stat.S_IWRITE)


def test_long_paths(tmp_path: Path) -> None:
    """Windows' old limit is 260 characters; where its setting LongPathsEnabled is off, it still is."""
    target = tmp_path.joinpath(*(["folder of a library"] * 20), "würfel 立.obj")
    assert len(os.fspath(target)) > 400
    try:
        target.parent.mkdir(parents=True)
        os.path.realpath(target.parent)
    except FileNotFoundError:
        pytest.skip("this Windows takes no long paths")
    except OSError as error:
        if not is_wine():
            raise
        pytest.skip(f"Wine 8's GetFinalPathNameByHandle has room for 260 characters: {error.strerror}")
    write_whole(target, b"before")
    write_whole(target, b"after", keep_backup=True)
    assert {path.name: path.read_bytes() for path in target.parent.iterdir()} == {target.name: b"after"}
