# SPDX-License-Identifier: GPL-3.0-or-later
"""New texture coordinates in the text of an OBJ file; every other byte of it stays.

The text is taken apart into runs of lines that are treated alike, in a first pass, and put together in a second: only
at the end of the file is it known which of the old coordinates are still needed. Runs of plain lines, which is nearly
all of a file, are found and written at once; a statement with comments, continued lines or other
peculiarities goes token by token. Statements are told apart exactly as `mesh_obj.read_obj` does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from .mesh_obj import FACES, index_polygon_corners
from .mesh_text import BYTE_ORDER_MARK
from .polygons import PolygonMesh

LINE_END = re.compile(rb"\r\n?|\n")
TOKEN = re.compile(rb"\S+")

# Lines taken at once: one face without coordinates makes a run of faces go face by face.
RUN = 4096
# Statements other than faces that refer to texture coordinates, and those coordinates.
REFERRING, COORDINATES = (b"l", b"surf"), b"vt"


@dataclass(frozen=True)
class _Segment:
    """data[begin:end], whole lines. kind: "other"; "coordinates", a number of `count` statements vt; "faces", `count`
    of them, from `first` on. is_plain: a run of plain faces. pieces: of a single statement, the stretches of data with
    its tokens, keyword first. above: how many vt stand above."""

    kind: str
    begin: int
    end: int
    count: int = 0
    first: int = 0
    above: int = 0
    is_plain: bool = False
    pieces: list[tuple[int, int]] = field(default_factory=list)


def edit_obj(data: bytes, mesh: PolygonMesh, corner_uv: NDArray[np.float64]) -> bytes:
    """The text with these texture coordinates, (c, 2) per polygon corner, in the place of its own.

    mesh: as `read_obj` reads it from data.

    All `vt` are replaced, and what the corners of faces say of them. A polygon with a NaN keeps the coordinates it has,
    as do lines (`l`) and surfaces (`surf`) that refer to some: those `vt` stay, renumbered where they are referred to.
    The new `vt` stand where the first one stood, at the latest above the first face.
    """
    vt, index, mapped = index_polygon_corners(mesh, corner_uv)
    return _Edit(data, mesh, vt, index, mapped).text()


class _Edit:
    def __init__(
        self,
        data: bytes,
        mesh: PolygonMesh,
        vt: NDArray[np.float64],
        index: NDArray[np.int64],
        mapped: NDArray[np.bool_],
    ) -> None:
        self.data = data
        self.vt = vt
        self.numbers = index + 1
        self.mapped = mapped
        self.starts = np.append(mesh.starts, len(mesh.corners))
        self.segments = list(_segments(data))
        # Numbers in the new file of the old coordinates that stay, by their place in the old one, from 0.
        self.kept: dict[int, int] = {}
        total = sum(segment.count for segment in self.segments if segment.kind == "coordinates")
        needed = {old for segment in self.segments for old in self._needed(segment)}
        for old in sorted(needed):
            if 0 <= old < total:
                self.kept[old] = len(vt) + len(self.kept) + 1

    def text(self) -> bytes:
        parts = []
        is_written = False
        for segment in self.segments:
            if segment.kind != "other" and not is_written:
                parts.append(self._new_coordinates(segment))
                is_written = True
            parts.append(self._written(segment))
        return b"".join(parts)

    def _written(self, segment: _Segment) -> bytes:
        if segment.kind == "coordinates":
            return self._kept_coordinates(segment)
        if segment.kind == "references":
            return self._with_references(segment, self._kept_reference(segment))
        if segment.kind == "faces":
            return self._faces(segment)
        return self.data[segment.begin : segment.end]

    def _new_coordinates(self, segment: _Segment) -> bytes:
        """The lines of the new coordinates, with the line ending of the place where they are put."""
        ending = LINE_END.search(self.data, segment.begin) or LINE_END.search(self.data)
        return _lsgp.format_rows(COORDINATES, self.vt, b"\n" if ending is None else ending[0])

    def _kept_coordinates(self, segment: _Segment) -> bytes:
        olds = range(segment.above, segment.above + segment.count)
        if self.kept.keys().isdisjoint(olds):
            return _without_statement(self.data, segment)
        if segment.pieces:
            return self.data[segment.begin : segment.end]
        lines = self.data[segment.begin : segment.end].splitlines(keepends=True)
        return b"".join(line for line, old in zip(lines, olds, strict=True) if old in self.kept)

    def _faces(self, segment: _Segment) -> bytes:
        mapped = self.mapped[segment.first : segment.first + segment.count]
        if not segment.is_plain:
            if not mapped[0]:
                return self._with_references(segment, self._kept_reference(segment))
            numbers = iter(self._numbers(segment).tolist())
            return self._with_references(segment, lambda parts: next(numbers))
        if mapped.all():
            return _lsgp.replace_references(self.data[segment.begin : segment.end], self._numbers(segment))
        return b"".join(map(self._faces, _single_faces(self.data, segment)))

    def _numbers(self, segment: _Segment) -> NDArray[np.int64]:
        return self.numbers[self.starts[segment.first] : self.starts[segment.first + segment.count]]

    def _with_references(self, segment: _Segment, number_of: Callable[[list[bytes]], int | None]) -> bytes:
        """The statement with other references; number_of: the parts of a token between its slashes to the number of its
        coordinates, None for none."""
        written = []
        at = segment.begin
        is_keyword = True
        for begin, end in segment.pieces:
            for token in TOKEN.finditer(self.data, begin, end):
                if not is_keyword:
                    written += [self.data[at : token.start()], self._corner(token[0], number_of)]
                    at = token.end()
                is_keyword = False
        return b"".join([*written, self.data[at : segment.end]])

    @staticmethod
    def _corner(token: bytes, number_of: Callable[[list[bytes]], int | None]) -> bytes:
        vertex, *rest = parts = token.split(b"/", 2)
        number = number_of(parts)
        if number is None and not any(rest[1:]):
            return vertex
        return b"/".join([vertex, b"" if number is None else b"%d" % number, *rest[1:]])

    def _kept_reference(self, segment: _Segment) -> Callable[[list[bytes]], int | None]:
        return lambda parts: self.kept.get(_old_coordinates(parts, segment.above))

    def _needed(self, segment: _Segment) -> Iterator[int]:
        """The old coordinates that the segment goes on to refer to, as places from 0 that need not exist."""
        if segment.kind == "references":
            yield from _referred_to(self.data, segment)
        elif segment.kind == "faces" and not self.mapped[segment.first : segment.first + segment.count].all():
            for single in _single_faces(self.data, segment):
                if not self.mapped[single.first]:
                    yield from _referred_to(self.data, single)


def _referred_to(data: bytes, segment: _Segment) -> Iterator[int]:
    tokens = [token for begin, end in segment.pieces for token in data[begin:end].split()]
    for token in tokens[1:]:
        yield _old_coordinates(token.split(b"/", 2), segment.above)


def _old_coordinates(parts: list[bytes], above: int) -> int:
    """The place, from 0, of the coordinates that a corner names; negative where it names none."""
    try:
        number = int(parts[1])
    except (IndexError, ValueError):
        return -1
    return above + number if number < 0 else number - 1


def _single_faces(data: bytes, segment: _Segment) -> Iterator[_Segment]:
    """The faces of a run as statements of their own."""
    if not segment.is_plain:
        yield segment
        return
    at = segment.begin
    for number, line in enumerate(data[segment.begin : segment.end].splitlines(keepends=True), segment.first):
        end = at + len(line)
        yield _Segment("faces", at, end, 1, number, segment.above, pieces=[(at, end)])
        at = end


def _without_statement(data: bytes, segment: _Segment) -> bytes:
    """The rest of lines whose statements are removed: comments and empty lines between continued ones."""
    if not segment.pieces:
        return b""
    kept = []
    at = segment.begin
    begins = {begin for begin, _ in segment.pieces}
    for line in data[segment.begin : segment.end].splitlines(keepends=True):
        if at not in begins:
            kept.append(line)
        at += len(line)
    return b"".join(kept)


def _segments(data: bytes) -> Iterator[_Segment]:
    """The text taken apart, in its order."""
    at = len(BYTE_ORDER_MARK) if data.startswith(BYTE_ORDER_MARK) else 0
    if at:
        yield _Segment("other", 0, at)
    faces = coordinates = 0
    while at < len(data):
        segment = _run(data, at, faces, coordinates) or _statement(data, at, faces, coordinates)
        faces += segment.count * (segment.kind == "faces")
        coordinates += segment.count * (segment.kind == "coordinates")
        at = segment.end
        yield segment


def _run(data: bytes, at: int, faces: int, coordinates: int) -> _Segment | None:
    """Plain lines of one kind from here on; None where there is no such line."""
    kind, end, count = _lsgp.plain_lines(data, at, RUN)
    if not count:
        return None
    if kind == "other":
        return _Segment(kind, at, end)
    return _Segment(kind, at, end, count, faces if kind == "faces" else 0, coordinates, is_plain=kind == "faces")


def _statement(data: bytes, at: int, faces: int, coordinates: int) -> _Segment:
    """The statement that begins on this line, over all lines on which it goes on; or the line, if it has none."""
    begin = at
    pieces: list[tuple[int, int]] = []
    while at < len(data):
        ending = LINE_END.search(data, at)
        line_end, text_end = (len(data), len(data)) if ending is None else (ending.end(), ending.start())
        text = data[at:text_end].partition(b"#")[0].rstrip()
        goes_on = text.endswith(b"\\")
        is_empty = not text
        text = text.removesuffix(b"\\")
        if text or (pieces and not is_empty):
            pieces.append((at, at + len(text)))
        at = line_end
        if not pieces or not (goes_on or is_empty):
            break
    keyword = next((data[b:e].split(None, 1)[0] for b, e in pieces if data[b:e].strip()), b"")
    if keyword in FACES:
        return _Segment("faces", begin, at, 1, faces, coordinates, pieces=pieces)
    if keyword == COORDINATES:
        return _Segment("coordinates", begin, at, 1, above=coordinates, pieces=pieces)
    kind = "references" if keyword in REFERRING and b"/" in data[begin:at] else "other"
    return _Segment(kind, begin, at, above=coordinates, pieces=pieces)
