# SPDX-License-Identifier: GPL-3.0-or-later
"""The assets of a run: those of a folder or a list, the ones of this shard, and the paths of their results."""

from __future__ import annotations

import argparse
import codecs
import os
import stat
import zlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath

from ..base.counted import counted
from ..io.mesh_files import MESH_SUFFIXES
from ..io.safe_files import ignores_case, name_by_case
from ..io.side_files import UsageError

PICTURES = "pictures"

# No system takes a longer path.
_LONGEST_PATH = 1 << 15
_OF_A_DEVICE = "device or pipe"


@dataclass(frozen=True, slots=True)
class Asset:
    """A file to unwrap.

    name: identifies it, a relative path with slashes; the same in every run on the same folder or list.
    path: where it is. size: in bytes, 0 where there is no such file.
    """

    name: str
    path: Path
    size: int


@dataclass(frozen=True, slots=True)
class Found:
    """The files of a folder or a list.

    assets: sorted by name. skipped: number of other mesh files, which cannot be read, by kind; devices and pipes
    included.
    """

    assets: list[Asset]
    skipped: Counter[str]


@dataclass(frozen=True, slots=True)
class Shard:
    """One of `count` independent parts of a run; index is from 1."""

    index: int
    count: int

    def __str__(self) -> str:
        return f"{self.index}-of-{self.count}"

    def holds(self, name: str) -> bool:
        """Decided by the name alone, so that assets that come or go do not move others to another shard."""
        return zlib.crc32(os.fsencode(name)) % self.count == self.index - 1


def shard_option(text: str) -> Shard:
    """The value of --shard."""
    index, _, count = text.partition("/")
    if not all(part.isascii() and part.isdigit() and len(part) < 10 for part in (index, count)):
        raise argparse.ArgumentTypeError(f"'{text}': a shard is i/n, for instance 3/16")
    if not 1 <= int(index) <= int(count):
        raise argparse.ArgumentTypeError(f"'{text}': i in i/n is from 1 to n")
    return Shard(int(index), int(count))


def find_assets(source: Path, out: Path, suffixes: Iterable[str], shard: Shard | None = None) -> Found:
    """The assets that a folder holds, at any depth, or that a list names, or a single one; of them the shard's.

    A list has a path on each line, relative to its own folder; empty lines are left out.
    out: the folder of the results; what lies there is no asset.
    suffixes: of the files of a folder, and of a single asset, lower case, with the dot; those of a list may have any.
    Raises OSError; UsageError where there is no asset at all, or the source is no list.
    """
    suffixes = tuple(suffixes)
    skipped: Counter[str] = Counter()
    if source.is_dir():
        found = _in_folder(source, out, suffixes, skipped)
    elif source.suffix.lower() in suffixes:
        found = {source.name: source}
    elif source.suffix.lower() in MESH_SUFFIXES:
        raise UsageError(f"'{source}' is a mesh of a kind that is not read; export it as {_any_of(suffixes)}")
    else:
        found = _in_list(source)
    if not found:
        others = f"; {skipped_note(skipped)}" if skipped else ""
        raise UsageError(
            f"'{source}' has no assets ({', '.join(suffixes)}){others}; name a folder with some or a list of them"
        )
    names = sorted(name for name in found if shard is None or shard.holds(name))
    return Found([Asset(name, found[name], _size(found[name])) for name in names], skipped)


def skipped_note(skipped: Counter[str]) -> str:
    """How many files were left out, and of which kinds."""
    kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(skipped.items()))
    return f"{counted(skipped.total(), 'file was', 'files were')} left out, of kinds that are not read: {kinds}"


def output_name(name: str, suffix: str = ".obj") -> str:
    """The name of an asset's result: its own if that has the suffix, otherwise with the suffix added."""
    return name if name.lower().endswith(suffix) else name + suffix


def picture_name(name: str) -> str:
    """The name of the picture of an asset's result."""
    return f"{PICTURES}/{name}.png"


def report_name(output: str) -> str:
    """The name of the report of a result."""
    return f"{output}.report.json"


def require_distinct_files(out: Path, results: Iterable[tuple[str, str]], others: Iterable[str]) -> None:
    """Raise UsageError where two files of a run are one, one would be a folder of another, or one is a folder.

    results: the names of assets and of their results in the folder `out`. others: names of its further files.
    """
    owner: dict[str, str] = {}
    is_one = ignores_case(Path(os.path.realpath(out)))
    written = [(f"'{asset}'", result) for asset, result in results]
    written += [("the run itself", other) for other in others]
    keys = [name_by_case(name, ignores_case=is_one) for _, name in written]
    for key, (who, name) in zip(keys, written, strict=True):
        other = owner.setdefault(key, who)
        if other != who:
            raise UsageError(f"{other} and {who} would both be written to '{name}'; rename one of them")
        if (out / name).is_dir():
            raise UsageError(f"'{out / name}', which {who} would be written to, is a folder; name another folder")
    for key, (who, name) in zip(keys, written, strict=True):
        for folder in PurePosixPath(key).parents:
            if other := owner.get(str(folder)):
                raise UsageError(
                    f"{who} would be written to '{name}', and {other} to a file with the name of one of its folders; "
                    "rename one of them"
                )


def _in_folder(folder: Path, out: Path, suffixes: tuple[str, ...], skipped: Counter[str]) -> dict[str, Path]:
    results = os.path.realpath(out)
    found = {}
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if os.path.realpath(os.path.join(place, name)) != results]
        for file in files:
            path, suffix = Path(place, file), os.path.splitext(file)[1].lower()
            if suffix not in suffixes:
                skipped.update([suffix] if suffix in MESH_SUFFIXES else [])
            elif _would_block(path):
                skipped.update([_OF_A_DEVICE])
            else:
                found[path.relative_to(folder).as_posix()] = path
    return found


def _would_block(path: Path) -> bool:
    """Whether it is a pipe or a device, which would block its reader; a missing file is reported when it is read."""
    try:
        return not stat.S_ISREG(path.stat().st_mode)
    except OSError:
        return False


def _in_list(source: Path) -> dict[str, Path]:
    found = {}
    for number, line in enumerate(_lines_of(source.read_bytes()), 1):
        try:
            text = os.fsdecode(line.strip())
        except UnicodeDecodeError:  # on Windows, where paths are text
            text = "\0"
        if "\0" in text or len(line) > _LONGEST_PATH:
            raise UsageError(
                f"'{source}' is not a list of files: line {number} cannot be a path. Name a folder, a mesh, or a text "
                "file in UTF-8 with a path on each line"
            )
        if text:
            found[_name_of(Path(text), source.parent)] = source.parent / text
    return found


def _lines_of(data: bytes) -> list[bytes]:
    """The lines of a list in UTF-8, or in UTF-16 as programs of Windows write it, with a byte order mark."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        data = data.decode("utf-16", "replace").encode()
    return data.removeprefix(codecs.BOM_UTF8).splitlines()


def _any_of(suffixes: tuple[str, ...]) -> str:
    return " or ".join([", ".join(suffixes[:-1]), suffixes[-1]]) if len(suffixes) > 1 else suffixes[0]


def _name_of(path: Path, folder: Path) -> str:
    """A listed path as it is, if it stays in the list's folder, otherwise the whole path without its root."""
    if path.anchor or ".." in path.parts:
        return rootless(Path(os.path.abspath(folder / path)))
    return path.as_posix()


def rootless(path: PurePath) -> str:
    """An absolute path as a relative one with slashes; drives and network shares of Windows become folders."""
    drive = path.drive.replace("\\", "/").removeprefix("//?/").replace(":", "").strip("/")
    return PurePosixPath(drive, *path.parts[1:]).as_posix()


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0
