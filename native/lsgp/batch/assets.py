# SPDX-License-Identifier: GPL-3.0-or-later
"""The assets of a run: what a folder or a list names, which of them are this shard's, and where their results go."""

from __future__ import annotations

import argparse
import os
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePath

from ..side_files import UsageError

PICTURES = "pictures"


@dataclass(frozen=True, slots=True)
class Asset:
    """A file to unwrap.

    name: by which it goes everywhere, a relative path with slashes; the same in every run on the same folder or list.
    path: where it is. size: in bytes, 0 where there is no such file.
    """

    name: str
    path: Path
    size: int


@dataclass(frozen=True, slots=True)
class Shard:
    """One of `count` parts of a run that are worked on by themselves; index is from 1."""

    index: int
    count: int

    def __str__(self) -> str:
        return f"{self.index}-of-{self.count}"

    def holds(self, name: str) -> bool:
        """Told by the name alone, so that assets that come or go do not move others to another shard."""
        return zlib.crc32(os.fsencode(name)) % self.count == self.index - 1


def shard_option(text: str) -> Shard:
    """The value of --shard."""
    index, _, count = text.partition("/")
    if not all(part.isascii() and part.isdigit() and len(part) < 10 for part in (index, count)):
        raise argparse.ArgumentTypeError(f"'{text}': a shard is i/n, for instance 3/16")
    if not 1 <= int(index) <= int(count):
        raise argparse.ArgumentTypeError(f"'{text}': i in i/n is from 1 to n")
    return Shard(int(index), int(count))


def find_assets(source: Path, out: Path, suffixes: Iterable[str], shard: Shard | None = None) -> list[Asset]:
    """The assets that a folder holds, at any depth, or that a list names, by name; of them the shard's.

    A list has a path on each line, relative to its own folder; empty lines are left out.
    out: the folder of the results; what lies there is no asset.
    suffixes: of the files of a folder, lower case, with the dot; the files of a list may have any.
    Raises OSError; UsageError where there is no asset at all.
    """
    found = dict(_in_folder(source, out, frozenset(suffixes)) if source.is_dir() else _in_list(source))
    if not found:
        raise UsageError(f"'{source}' has no assets ({', '.join(suffixes)}); name a folder with some or a list of them")
    names = sorted(name for name in found if shard is None or shard.holds(name))
    return [Asset(name, found[name], _size(found[name])) for name in names]


def output_name(name: str, suffix: str = ".obj") -> str:
    """The name of an asset's result: its own if that has the suffix, otherwise with the suffix added."""
    return name if name.lower().endswith(suffix) else name + suffix


def picture_name(name: str) -> str:
    """The name of the picture of an asset's result."""
    return f"{PICTURES}/{name}.png"


def require_distinct_results(assets: Iterable[Asset], results: Iterable[str]) -> None:
    """Raise UsageError where two assets have the same result, or an asset would be overwritten by a result."""
    owner: dict[str, str] = {}
    for asset, result in zip(assets, results, strict=True):
        other = owner.setdefault(os.path.normcase(result), asset.name)
        if other != asset.name:
            raise UsageError(f"'{other}' and '{asset.name}' would both be written to '{result}'; rename one of them")


def _in_folder(folder: Path, out: Path, suffixes: frozenset[str]) -> Iterator[tuple[str, Path]]:
    results = os.path.realpath(out)
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if os.path.realpath(os.path.join(place, name)) != results]
        for file in files:
            if os.path.splitext(file)[1].lower() in suffixes:
                path = Path(place, file)
                yield path.relative_to(folder).as_posix(), path


def _in_list(source: Path) -> Iterator[tuple[str, Path]]:
    for line in source.read_bytes().splitlines():
        text = os.fsdecode(line.strip())
        if text:
            yield _name_of(Path(text), source.parent), source.parent / text


def _name_of(path: Path, folder: Path) -> str:
    """A listed path as it is, if it stays in the list's folder, otherwise the whole path without its root."""
    if path.is_absolute() or ".." in path.parts:
        path = Path(os.path.abspath(folder / path))
        return PurePath(*path.parts[1:]).as_posix()
    return path.as_posix()


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0
