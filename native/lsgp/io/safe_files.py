# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files may be read and overwritten: regular ones, and the input only on request."""

from __future__ import annotations

import errno
import filecmp
import os
import stat
import sys
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from .side_files import UsageError, read_regular

STANDARD_STREAM = "-"
# What is added to the name of a file while it is replaced in place.
BACKUP = ".lsgp-backup"


def is_standard_stream(path: str | os.PathLike[str] | None) -> bool:
    """Whether the path stands for standard input or output."""
    return path is not None and os.fspath(path) == STANDARD_STREAM


def read_input(path: Path) -> bytes:
    """The content of a regular file or of standard input, "-".  Raises OSError."""
    if not is_standard_stream(path):
        return read_regular(path)
    if sys.stdin is None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF), "standard input")
    return sys.stdin.buffer.read()


def is_same_file(one: str | os.PathLike[str], other: str | os.PathLike[str]) -> bool:
    """Whether two paths lead to one file, by links of either kind or another spelling; also where it is not there
    yet."""
    if is_standard_stream(one) or is_standard_stream(other):
        return False
    try:
        return os.path.samefile(one, other)
    except OSError:
        return _place(one) == _place(other)


def name_by_case(name: str, *, ignores_case: bool) -> str:
    """The same for names of one file, of folders that ignore case or do not; the former compose accents as well."""
    return unicodedata.normalize("NFC", name).casefold() if ignores_case else os.path.normcase(name)


def ignores_case(folder: Path) -> bool:
    """Whether names that differ in case alone are one file in a folder, judged by the names that lead to it."""
    for place in (folder, *folder.parents):
        swapped = place.name.swapcase()
        if swapped != place.name and place.exists():
            try:
                return os.path.samefile(place, place.with_name(swapped))
            except OSError:
                return False
    return False


def _place(path: str | os.PathLike[str]) -> tuple[str, str]:
    """Folder and name, the same for all paths to one file."""
    whole = Path(os.path.realpath(path))
    return os.path.normcase(whole.parent), name_by_case(whole.name, ignores_case=ignores_case(whole.parent))


def require_separate(source: Path, target: Path, *, in_place: bool) -> None:
    """Raise UsageError where the output would overwrite the input without a request, while there is a backup with
    other content, or where it is one of several hard links, the others of which would keep the old content."""
    if not is_same_file(source, target):
        return
    if not in_place:
        raise UsageError(
            f"the output '{target}' is the input '{source}' itself; name another file, or write over it with --in-place"
        )
    backup = backup_of(Path(os.path.realpath(target)))
    if backup.exists() and not is_spent_backup(backup, target):
        raise UsageError(
            f"there is a backup '{backup}' of a run that was killed; compare it with the file, and remove it"
        )
    links = os.stat(target).st_nlink - is_same_file(backup, target)
    if links > 1:
        raise UsageError(
            f"'{target}' is one of {links} hard links to a file; it is replaced as a whole, so the others would keep "
            "the old content. Name another file, or replace the link by a copy first"
        )


def backup_of(path: Path) -> Path:
    """Where a file is kept while it is replaced in place."""
    return path.with_name(path.name + BACKUP)


def is_spent_backup(backup: Path, target: Path) -> bool:
    """Whether a backup, which exists, is of a run that was killed before it replaced the file."""
    try:
        return os.path.samefile(backup, target) or filecmp.cmp(backup, target, shallow=False)
    except OSError:
        return False


def require_inputs_kept(
    results: Iterable[tuple[Path, Path]], read: Iterable[Path], written: Iterable[Path], *, in_place: bool
) -> None:
    """Raise UsageError where a result would be written over an input: over its own without having been asked to, or
    over that of another; and where anything would be written over a file that is read.

    results: the input and the output of each asset. read, written: the other files, which need not be there.
    """
    pairs = list(results)
    owners = {}
    for path in [*read, *(source for source, _ in pairs)]:
        identity = _identity(path)
        if identity is not None:
            owners[identity] = path
    for source, target in pairs:
        identity = _identity(target)
        owner = None if identity is None else owners.get(identity)
        if owner is None:
            continue
        if _identity(source) != identity:
            raise UsageError(f"the result of '{source}' would be written over '{owner}'; name another folder")
        require_separate(source, target, in_place=in_place)
    for path in written:
        identity = _identity(path)
        if identity in owners:
            raise UsageError(f"'{path}' would be written over '{owners[identity]}', which is read; name another folder")


def require_no_links(folder: Path, names: Iterable[str]) -> None:
    """Raise UsageError where a file or folder of these relative names is a link, through which something elsewhere
    would be written; the folder itself may be one."""
    root = os.path.realpath(folder)
    seen = {root}
    for name in names:
        whole = os.path.join(root, os.path.normpath(name))
        parent = os.path.dirname(whole)
        if parent not in seen and os.path.normcase(os.path.realpath(parent)) != os.path.normcase(parent):
            whole = parent
        elif not os.path.islink(whole):
            seen.add(parent)
            continue
        raise UsageError(
            f"'{folder / os.path.relpath(whole, root)}' is or lies in a link, through which results would be written "
            "elsewhere; remove the link, or name another folder"
        )


def require_writable_kind(path: str | os.PathLike[str]) -> None:
    """Raise OSError for a pipe, a socket or a block device; character devices, as /dev/null, are written to."""
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        return
    if stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode) or stat.S_ISBLK(mode):
        raise OSError(
            errno.EINVAL,
            "Not a regular file (to write to a pipe, let the output be - and redirect it)",
            os.fspath(path),
        )


def _identity(path: Path) -> tuple[int, int] | None:
    """The same for all paths to one file; None where there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_dev, found.st_ino
