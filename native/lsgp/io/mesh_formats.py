# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of mesh files: how they are recognized, which can be read and written, and what that requires."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError
from .mesh_off import HEADER as OFF_HEADER
from .optional_packages import installation, is_installed
from .side_files import UsageError


@dataclass(frozen=True)
class Format:
    """A format of mesh files, all of which can be read.

    name: as people write it. suffix: of its files, with the dot, lower case.
    writer: the package that writing requires, "" for none; None where there is no writer.
    """

    name: str
    suffix: str
    writer: str | None

    @property
    def key(self) -> str:
        """By which options name it."""
        return self.suffix[1:]


OBJ = Format("OBJ", ".obj", "")
OFF = Format("OFF", ".off", None)
PLY = Format("PLY", ".ply", "plyfile")
GLTF = Format("glTF", ".gltf", "")
GLB = Format("GLB", ".glb", "")
STL = Format("STL", ".stl", None)
FORMATS = (OBJ, OFF, PLY, GLTF, GLB, STL)
BY_KEY = {form.key: form for form in FORMATS}

# First bytes of compressed files, whatever their names, and the programs that decompress them.
_COMPRESSED = {
    b"\x1f\x8b": "gunzip",
    b"BZh": "bunzip2",
    b"\xfd7zXZ\0": "unxz",
    b"\x28\xb5\x2f\xfd": "unzstd",
    b"PK\3\4": "unzip",
}


def input_format(path: str | os.PathLike[str] | None, data: bytes, given: str | None = None) -> Format:
    """The format of a file: by its suffix, then as given, then by its first bytes.

    path: None for standard input, which is OBJ where nothing tells otherwise. given: a key.
    Raises InputError: UNKNOWN_FORMAT.
    """
    suffix = "" if path is None else Path(path).suffix.lower()
    found = BY_KEY.get(suffix[1:]) or (BY_KEY[given] if given else _by_content(data)) or (OBJ if path is None else None)
    program = next((program for begin, program in _COMPRESSED.items() if data.startswith(begin)), None)
    if program is not None and found != STL:  # which may begin with any bytes
        raise InputError(
            "UNKNOWN_FORMAT",
            f"'{os.fspath(path or '-')}' is compressed. Decompress it first, for instance with {program}.",
        )
    if found is None:
        readable = _one_of([form.name for form in FORMATS])
        raise InputError(
            "UNKNOWN_FORMAT", f"'{os.fspath(path or '-')}' is not an {readable} file. Export the mesh as one."
        )
    return found


def output_format(path: str | os.PathLike[str] | None, given: str | None = None) -> Format:
    """The format of a file to be written: by its suffix; where it has none, or for None, as given, or OBJ.

    Raises UsageError where it cannot be written.
    """
    suffix = "" if path is None else Path(path).suffix.lower()
    found = BY_KEY.get(suffix[1:]) if suffix else BY_KEY[given or OBJ.key]
    shown = os.fspath(path or "-")
    if found is None or found.writer is None:
        raise UsageError(
            f"'{shown}' cannot be written as {suffix if found is None else found.name}; "
            f"{_one_of([f'{form.name} ({form.suffix})' for form in _writable()])} can"
        )
    if not is_installed(found.writer):
        raise UsageError(f"writing '{shown}' takes the package {found.writer}; {installation('formats')}")
    return found


def readable_suffixes() -> tuple[str, ...]:
    """The suffixes of the formats, all of which can be read."""
    return tuple(form.suffix for form in FORMATS)


def formats_table() -> str:
    """Which formats are read and written here, and how to get the others, as lines of text."""
    rows = [f"{'':6}{'read':6}write", *(f"{form.name:6}{'yes':6}{_writing(form)}" for form in FORMATS)]
    return "\n".join(rows)


def _writing(form: Format) -> str:
    if form.writer is None:
        return "no"
    return "yes" if is_installed(form.writer) else f"no, {installation('formats')}"


def _writable() -> list[Format]:
    """Those that can be written with the packages that are installed."""
    return [form for form in FORMATS if form.writer is not None and is_installed(form.writer)]


def _one_of(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}"


def _by_content(data: bytes) -> Format | None:
    if data[:4].rstrip() == b"ply":
        return PLY
    if data[:4] == b"glTF":
        return GLB
    if OFF_HEADER.match((data[:80].split() or [b""])[0]):
        return OFF
    return None
