# SPDX-License-Identifier: GPL-3.0-or-later
"""The files that the arguments of a command name.

Every argument that names a file is declared by the action `Reads` or `Writes`, so that `require_separate_files` knows
all of them: what is written is never a file that another argument names.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import wraps
from itertools import combinations
from pathlib import Path
from typing import Any

from ..io.safe_files import is_same_file
from ..io.side_files import UsageError


@dataclass(frozen=True, slots=True)
class NamedFile:
    """A file, and the argument that names it as users know that: an option, or the placeholder of a positional one.

    completed_by: the argument that may write it, because it keeps what is there.
    """

    argument: str
    path: Path
    is_written: bool
    completed_by: str | None = None


def path_option(text: str) -> Path:
    """Raises ArgumentTypeError for no name, as of a variable that a shell does not know: it would be the working
    folder."""
    return Path(_named(text))


def _named(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty; is a variable of the shell not set?")
    return text


class Reads(argparse.Action):
    """Stores the value of an argument that names a file to read, or keeps its own meaning for some values."""

    is_written = False
    completed_by: str | None = None

    def __init__(self, *words: Any, **named: Any) -> None:
        value_of: Callable[[str], Any] = named.pop("type", None) or str
        super().__init__(*words, type=wraps(value_of)(lambda text: value_of(_named(text))), **named)

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, option: str | None = None
    ) -> None:
        setattr(namespace, self.dest, values)
        files = named_files(namespace)
        files.pop(self.dest, None)  # the last value of an option counts
        path = self.path_in(values)
        if path is not None:
            name = self.option_strings[-1] if self.option_strings else str(self.metavar)
            files[self.dest] = NamedFile(name, path, self.is_written, self.completed_by)
        namespace.named_files = files

    @staticmethod
    def path_in(value: Any) -> Path | None:
        """The file that a value names, None where it names none."""
        return Path(value) if isinstance(value, str | os.PathLike) else None


class Writes(Reads):
    """Stores the value of an argument that names a file to write."""

    is_written = True


def named_files(args: argparse.Namespace) -> dict[str, NamedFile]:
    """Those of the arguments that were given, by the names of their values."""
    return dict(vars(args).get("named_files", {}))


def read_files(parser: argparse.ArgumentParser) -> list[Reads]:
    """The arguments of a parser that name files to read."""
    return [action for action in parser._actions if isinstance(action, Reads) and not action.is_written]


def require_separate_files(files: Iterable[NamedFile]) -> None:
    """Raise UsageError where two arguments name one file, by whatever paths, and one of them writes it; a device, as
    the null device, may have several writers."""
    for one, other in combinations(files, 2):
        if one.argument == other.completed_by or other.argument == one.completed_by:
            continue
        is_device = one.path.exists() and not one.path.is_file()
        if (one.is_written or other.is_written) and not is_device and is_same_file(one.path, other.path):
            written, named = (one, other) if one.is_written else (other, one)
            raise UsageError(
                f"{written.argument} '{written.path}' and {named.argument} '{named.path}' are the same file; name "
                "another"
            )


def require_apart_from(files: Iterable[NamedFile], source: Path, belonging: Iterable[Path]) -> None:
    """Raise UsageError where a file that is written belongs to the one that is read.  belonging: those that do."""
    there = [path for path in belonging if path.is_file()]
    for file in files:
        for path in there:
            if file.is_written and is_same_file(file.path, path):
                raise UsageError(
                    f"{file.argument} '{file.path}' is a file that '{source}' refers to; name another for what is "
                    "written"
                )


def written_files(args: argparse.Namespace) -> list[NamedFile]:
    """What a command on one file writes, as far as its arguments name it."""
    files = named_files(args)
    if args.output is not None and "output" not in files:  # of a batch
        files["output"] = NamedFile("the output", args.output, is_written=True)
    return [file for file in files.values() if file.is_written]
