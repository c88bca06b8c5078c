# SPDX-License-Identifier: GPL-3.0-or-later
"""The journal of a run: a JSON line for each asset, written when the asset has ended.

It is the only record of progress. Only complete lines count, so that a run may be killed at any moment and resumed; an
asset with a damaged line counts as not done.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from ..io.json_text import JsonError, parse_json
from ..io.side_files import UsageError
from ..run.report import finite
from .assets import Shard
from .records import Record, is_record

if os.name == "nt":
    import msvcrt
else:
    import fcntl

# Windows keeps others from reading what is locked: far behind the end of any journal, and within what all file systems
# have, which Wine asks for.
_LOCKED_BYTE = 1 << 40
_OWN_FILE = getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)


def journal_path(out: Path, shard: Shard | None) -> Path:
    return out / ("journal.jsonl" if shard is None else f"journal-{shard}.jsonl")


@dataclass
class Ended:
    """The content of journals.

    records: by name how each asset ended last; none where its last line is damaged. damaged: how many lines of each
    journal are, by its name.
    """

    records: dict[str, Record] = field(default_factory=dict)
    damaged: dict[str, int] = field(default_factory=dict)


def read_records(out: Path, shard: Shard | None = None) -> Ended:
    """How assets ended, by the shard's journal or by all journals of the folder.  Raises OSError."""
    ended = Ended()
    for path in [journal_path(out, shard)] if shard is not None else sorted(out.glob("journal*.jsonl")):
        if path.is_file():
            _read_journal(path, ended)
    return ended


class Journal:
    """Open for writing, locked against other runs.

    keep: go on with what is there; otherwise begin anew, and where this is no shard without the shards' journals too.
    is_alone: whether no other run writes the same results, which storage without locks does not tell.
    Raises OSError, UsageError.
    """

    def __init__(self, out: Path, shard: Shard | None, keep: bool) -> None:
        self.is_alone = True
        if shard is None:
            for path in out.glob("journal-*-of-*.jsonl"):
                os.close(self._open_locked(path))
                if not keep:
                    path.unlink()
        self._path = journal_path(out, shard)
        self._descriptor = self._open_locked(self._path)
        os.ftruncate(self._descriptor, _end_of_whole_lines(self._descriptor) if keep else 0)
        os.lseek(self._descriptor, 0, os.SEEK_END)

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._descriptor)

    def _open_locked(self, path: Path) -> int:
        """A journal is written where it is, so it must not be a file that has another name elsewhere."""
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | _OWN_FILE, 0o666)
        try:
            if os.fstat(descriptor).st_nlink > 1:
                raise UsageError(f"'{path}' has several hard links; replace it by a copy, or name another folder")
            _lock(descriptor)
        except OSError as error:
            if not _is_taken(error):
                self.is_alone = False  # storage that knows no locks
                return descriptor
            os.close(descriptor)
            raise UsageError(f"another run is writing to '{path}'; wait for its end or name another folder") from error
        except UsageError:
            os.close(descriptor)
            raise
        return descriptor

    def write(self, record: Record) -> None:
        """Raises OSError that names the journal, when the disk is full for one."""
        line = (json.dumps(finite(record), allow_nan=False) + "\n").encode("ascii")
        try:
            while line:
                line = line[os.write(self._descriptor, line) :]
        except OSError as error:
            raise OSError(error.errno, error.strerror, os.fspath(self._path)) from error


def _is_taken(error: OSError) -> bool:
    """Whether there is no lock because another run has it; Wine 8 does not tell why."""
    return isinstance(error, BlockingIOError | PermissionError) or (os.name == "nt" and error.errno == 0)


def _lock(descriptor: int) -> None:
    """Raises BlockingIOError or, on Windows, PermissionError where another process has locked it; other OSError where
    there are no locks."""
    if os.name == "nt":
        os.lseek(descriptor, _LOCKED_BYTE, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _end_of_whole_lines(descriptor: int) -> int:
    """The length of the file without a last line that was not finished."""
    end = os.lseek(descriptor, 0, os.SEEK_END)
    while end:
        begin = max(0, end - 4096)
        os.lseek(descriptor, begin, os.SEEK_SET)
        newline = os.read(descriptor, end - begin).rfind(b"\n")
        if newline >= 0:
            return begin + newline + 1
        end = begin
    return 0


def _read_journal(path: Path, ended: Ended) -> None:
    with path.open("rb") as lines:
        for line in lines:
            if not line.endswith(b"\n"):
                continue  # it was being written when the run was killed
            value = _parsed(line)
            name = value.get("asset") if isinstance(value, dict) else None
            if is_record(value):
                ended.records[name] = value
            else:
                ended.damaged[path.name] = ended.damaged.get(path.name, 0) + 1
                if isinstance(name, str):
                    ended.records.pop(name, None)


def _parsed(line: bytes) -> Any:
    """None for a damaged line, as after a power failure."""
    try:
        return parse_json(line)
    except JsonError:
        return None
