# SPDX-License-Identifier: GPL-3.0-or-later
"""Atomic writing: a file is there as a whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import secrets
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from .safe_files import backup_of, is_spent_backup, is_standard_stream, require_writable_kind
from .standard_streams import write_to_standard_output

# Pattern of temporary files, which remain where a process is killed. A suffix may follow.
PARTIAL = ".lsgp-*.partial"
ABANDONED_SECONDS = 3600.0
IS_WINDOWS = os.name == "nt"
REPLACE_SECONDS = 2.0


def content_digest(data: bytes) -> bytes:
    """By which `whole_file` recognizes the content that a file had."""
    return hashlib.blake2b(data).digest()


def write_output(path: Path, data: bytes, *, keep_backup: bool = False, was: bytes | None = None) -> None:
    """Write a file as `write_whole` does, or for "-" to standard output.  Raises OSError."""
    if is_standard_stream(path):
        write_to_standard_output(data)
    else:
        write_whole(path, data, keep_backup=keep_backup, was=was)


def write_whole(
    path: str | os.PathLike[str], data: bytes, *, keep_backup: bool = False, was: bytes | None = None
) -> None:
    """Write a file so that it is there as a whole or not at all; a device, such as /dev/null, is written to.

    keep_backup, was: as for `whole_file`.  Raises OSError.
    """
    with _named_in_errors(path):
        target = _writable(path)
        if target.exists() and not target.is_file():
            target.write_bytes(data)
            return
        with whole_file(target, keep_backup=keep_backup, was=was) as partial:
            _write_new(partial, data)


def write_all_whole(contents: Sequence[tuple[Path, bytes]]) -> None:
    """Write files as `write_whole` does, and none of them before all are on the disk beside their places.

    Raises OSError.
    """
    with contextlib.ExitStack() as files:
        for path, data in reversed(contents):
            files.enter_context(_named_in_errors(path))
            target = _writable(path)
            if target.exists() and not target.is_file():
                target.write_bytes(data)
            else:
                _write_new(files.enter_context(whole_file(target)), data)


def _writable(path: str | os.PathLike[str]) -> Path:
    """Where a path leads.  Raises OSError where nothing can be written."""
    require_writable_kind(path)  # as a pipe has no other path than one that leads to it, /dev/stdout for one
    return Path(os.path.realpath(path))


def _write_new(path: Path, data: bytes) -> None:
    with path.open("xb") as file:
        file.write(data)


@contextlib.contextmanager
def _named_in_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """The error of a full disk names no file."""
    try:
        yield
    except OSError as error:
        if error.filename is None:
            raise OSError(error.errno, error.strerror or str(error), os.fspath(path)) from error
        raise


@contextlib.contextmanager
def whole_file(
    target: Path, suffix: str = "", *, keep_backup: bool = False, was: bytes | None = None
) -> Iterator[Path]:
    """The path of a temporary file, which replaces the target on success and is removed otherwise.

    suffix: of that path, for writers that tell the format by it.
    keep_backup: what was there stays as well, as `backup_of` it, until the new file is on the disk and in its place.
    was: the `content_digest` of what the target had when it was read; one that has changed since is not replaced.
    Raises OSError; FileExistsError where there is such a backup already.
    """
    partial = target.with_name(PARTIAL.replace("*", f"{_tag(target)}-{secrets.token_hex(6)}") + suffix)
    backup = None
    try:
        yield partial
        if target.exists():
            if IS_WINDOWS and not os.access(target, os.W_OK):  # it would keep the partial file from being removed too
                raise PermissionError(errno.EACCES, "The file is read-only", os.fspath(target))
            if was is not None and content_digest(target.read_bytes()) != was:
                raise OSError(None, "The file has changed since it was read; run the command again", os.fspath(target))
            shutil.copymode(target, partial)
            backup = _make_backup(target, partial) if keep_backup else None
        _replace(partial, target)
    except BaseException:
        with contextlib.suppress(OSError):
            partial.unlink()
        raise
    finally:
        if backup is not None:  # the target is the old file or the new one, as a whole
            backup.unlink()


def _tag(target: Path) -> str:
    """In the names of the temporary files of a target."""
    return hashlib.blake2b(os.fsencode(target.name), digest_size=6).hexdigest()


def _replace(partial: Path, target: Path) -> None:
    """Windows does not replace a file that is open; programs that index files or look for viruses open new ones
    briefly.  Raises OSError."""
    end = time.monotonic() + REPLACE_SECONDS
    while True:
        try:
            return os.replace(partial, target)
        except PermissionError as error:
            if not IS_WINDOWS:
                raise
            if time.monotonic() >= end:
                reason = "The file may be open in another program"
                raise PermissionError(error.errno, reason, os.fspath(target)) from error
        time.sleep(0.1)


def _make_backup(target: Path, partial: Path) -> Path:
    """Back the file up by a hard link, or a copy where there are no links, once the new file is on the disk."""
    _put_on_disk(partial)
    backup = backup_of(target)
    if backup.exists() and is_spent_backup(backup, target):
        backup.unlink()
    if backup.exists():
        raise FileExistsError(
            errno.EEXIST, "A backup of a run that was killed is there; compare it with the file and remove it", backup
        )
    if not IS_WINDOWS:  # where a link to a file that is open in another program cannot be removed
        with contextlib.suppress(OSError):  # a file system without links
            os.link(target, backup)
            return backup
    try:
        shutil.copy2(target, backup)
        _put_on_disk(backup)
    except BaseException:
        with contextlib.suppress(OSError):
            backup.unlink()
        raise
    return backup


def _put_on_disk(path: Path) -> None:
    """Windows does so only for what is open for writing; elsewhere the mode of the file may forbid that."""
    with path.open("r+b" if IS_WINDOWS else "rb") as file:
        os.fsync(file.fileno())


def remove_partials(folder: Path, own: Iterable[Path] = ()) -> None:
    """Remove, at any depth, temporary files of processes that were killed an hour ago or more, and all of certain
    targets.

    own: these targets, in the folder, which no other process writes any more.
    """
    tags = {(path.parent, _tag(path)) for path in own}
    for partial in folder.rglob(f"{PARTIAL}*"):
        with contextlib.suppress(OSError):
            is_own = (partial.parent, partial.name.split("-")[1]) in tags
            if is_own or time.time() - partial.stat().st_mtime > ABANDONED_SECONDS:
                partial.unlink()
