# SPDX-License-Identifier: GPL-3.0-or-later
"""The journal of a run: a JSON line for each asset, written when the asset has ended.

It alone says what is done.  Only whole lines count, so that a run may be killed at any moment and go on later.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any

from ..report import finite
from ..side_files import UsageError
from .assets import Shard
from .records import Record

try:
    import fcntl
except ImportError:  # Windows, where nothing keeps two runs from one folder
    fcntl = None


def journal_path(out: Path, shard: Shard | None) -> Path:
    return out / ("journal.jsonl" if shard is None else f"journal-{shard}.jsonl")


def read_records(out: Path, shard: Shard | None = None) -> dict[str, Record]:
    """By name how each asset ended last: in the shard's journal, or in all journals of the folder."""
    paths = [journal_path(out, shard)] if shard is not None else sorted(out.glob("journal*.jsonl"))
    return {record["asset"]: record for path in paths for record in _records_in(path)}


class Journal:
    """Open for writing, by one run at a time.

    keep: go on with what is there; otherwise begin anew, and where this is no shard without the shards' journals too.
    Raises OSError, UsageError.
    """

    def __init__(self, out: Path, shard: Shard | None, keep: bool) -> None:
        if shard is None and not keep:
            for path in out.glob("journal-*-of-*.jsonl"):
                os.close(_open_locked(path))
                path.unlink()
        self._descriptor = _open_locked(journal_path(out, shard))
        os.ftruncate(self._descriptor, _end_of_whole_lines(self._descriptor) if keep else 0)
        os.lseek(self._descriptor, 0, os.SEEK_END)

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._descriptor)

    def write(self, record: Record) -> None:
        line = (json.dumps(finite(record), allow_nan=False) + "\n").encode("ascii")
        while line:
            line = line[os.write(self._descriptor, line) :]


def _open_locked(path: Path) -> int:
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666)
    if fcntl is None:
        return descriptor
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        os.close(descriptor)
        raise UsageError(f"another run is writing to '{path}'; wait for its end or name another folder") from error
    except OSError:
        pass  # storage that knows no locks
    return descriptor


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


def _records_in(path: Path) -> Iterator[Record]:
    if not path.exists():
        return
    with path.open("rb") as lines:
        for line in lines:
            record = _parsed(line)
            if isinstance(record, dict) and isinstance(record.get("asset"), str):
                yield record


def _parsed(line: bytes) -> Any:
    """None for a line that is broken, as an unfinished one is, or one on a disk that lost its power."""
    try:
        return json.loads(line)
    except ValueError:
        return None
