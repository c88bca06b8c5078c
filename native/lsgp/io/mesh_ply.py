# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygon File Format (PLY), text and binary of both byte orders: vertices and polygons, nothing else."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from .mesh_text import Rows, malformed, quoted, ranges
from .polygons import PolygonMesh, require_polygons

TYPES = {
    **{b"char": "i1", b"uchar": "u1", b"short": "i2", b"ushort": "u2", b"int": "i4", b"uint": "u4"},
    **{b"int8": "i1", b"uint8": "u1", b"int16": "i2", b"uint16": "u2", b"int32": "i4", b"uint32": "u4"},
    **{b"float": "f4", b"double": "f8", b"float32": "f4", b"float64": "f8"},
}
BYTE_ORDERS = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
AXES = (b"x", b"y", b"z")
LINE_END = re.compile(rb"\r\n?|\n")
# By convention; the format itself has no images.
TEXTURE = re.compile(rb"^comment[ \t]+TextureFile[ \t]+([^\r\n]*[^\s])", re.MULTILINE)
# Of the lines of a header that are no comments.
KEYWORDS = (b"ply", b"format", b"element", b"property", b"end_header")
CORNER_LISTS = (b"vertex_indices", b"vertex_index")
# Of a structured array, in bytes.
LONGEST_ROW = 1 << 30


@dataclass(frozen=True)
class Property:
    """A number, or with count_type a list of numbers, in each row of an element."""

    name: bytes
    type: str
    count_type: str | None = None


@dataclass(frozen=True)
class Element:
    """A table of the file: a number of rows with these properties."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    def wanted(self) -> list[int]:
        """Positions of the properties that make the mesh: x, y, z of vertices, the corner list of faces."""
        names = [p.name for p in self.properties]
        if self.name == "vertex":
            places = [names.index(axis) for axis in AXES if axis in names]
            if len(places) < 3 or any(self.properties[place].count_type for place in places):
                raise malformed("the vertices have no x, y, z.")
            return places
        if self.name == "face":
            places = [names.index(name) for name in CORNER_LISTS if name in names]
            if not places or self.properties[places[0]].count_type is None:
                raise malformed("the faces have no list vertex_indices.")
            if "f" in self.properties[places[0]].type:
                raise malformed("the faces name their vertices by floating-point numbers.")
            return places[:1]
        return []


def read_ply(data: bytes) -> PolygonMesh:
    """Polygons of a PLY file.  Raises InputError: MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE."""
    elements, byte_order, begin, line = _read_header(data)
    names = [element.name for element in elements]
    if names.count("vertex") > 1 or names.count("face") > 1:
        raise malformed("there are several elements of vertices or of faces.")
    table = _TextTable(data[begin:], line) if byte_order == "" else _BinaryTable(data, begin, byte_order)
    positions = np.empty((0, 3))
    corners, sizes = np.empty(0, np.int64), np.empty(0, np.int64)
    for element in elements:
        if element.name == "vertex":
            positions = table.read_points(element, element.wanted())
        elif element.name == "face":
            corners, sizes = table.read_lists(element, element.wanted()[0])
        elif element.name == "tristrips":
            raise malformed("triangle strips are not read; write faces.")
        else:
            table.skip(element)
    require_polygons(len(positions), corners, sizes)
    textures = tuple(map(os.fsdecode, TEXTURE.findall(data[:begin])))
    return PolygonMesh(positions, corners.astype(np.int32), sizes, extras=_extras(elements), named=textures)


@dataclass(frozen=True, slots=True)
class TextTables:
    """header: of the file, to the end of its last line. tables: a structured array of each element."""

    header: bytes
    tables: list[NDArray]


def read_text_tables(data: bytes) -> TextTables | None:
    """All rows of a text file that `read_ply` accepts; None of a binary one, and where a list is not as long in all
    rows, an integer is none of its type, an element has no properties, or the name of one is not in ASCII."""
    elements, byte_order, begin, line = _read_header(data)
    if byte_order or not all(p.name.isascii() for element in elements for p in element.properties):
        return None
    text = _TextTable(data[begin:], line)
    tables = []
    for element in elements:
        table = text.read_table(element)
        if table is None:
            return None
        tables.append(table)
    return TextTables(data[:begin], tables)


def structured(columns: dict[str, NDArray]) -> NDArray:
    """A structured array of columns, (n,) or (n, k) each."""
    count = len(next(iter(columns.values())))
    out = np.empty(count, [(name, column.dtype, column.shape[1:]) for name, column in columns.items()])
    for name, column in columns.items():
        out[name] = column
    return out


def _extras(elements: list[Element]) -> tuple[str, ...]:
    """The content of the file other than its mesh."""
    extras = []
    for element in elements:
        if element.name in ("vertex", "face"):
            wanted = element.wanted()
            extras += [
                f"{element.name} {quoted(p.name)[1:-1]}"
                for place, p in enumerate(element.properties)
                if place not in wanted
            ]
        else:
            extras.append(f"element {element.name}")
    return tuple(extras)


def _read_header(data: bytes) -> tuple[list[Element], str, int, int]:
    """Elements, byte order ("" for text), where the rows begin and on which line."""
    elements: list[Element] = []
    byte_order: str | None = None
    begin, line = 0, 0
    for ending in LINE_END.finditer(data):
        tokens, line = data[begin : ending.start()].split(), line + 1
        begin = ending.end()
        match tokens:
            case [b"ply"] if line == 1:
                pass
            case _ if line == 1:
                raise malformed("the file does not begin with 'ply'.", line)
            case [] | [b"comment" | b"obj_info", *_]:
                pass
            case [keyword, *_] if keyword not in KEYWORDS:
                pass  # as of `with_whole_comments`
            case [b"format", name, _] if name in BYTE_ORDERS:
                byte_order = BYTE_ORDERS[name]
            case [b"element", name, count] if count.isdigit() and len(count) < 19:
                elements.append(Element(quoted(name)[1:-1], int(count)))
            case [b"property", b"list", count_type, item_type, name] if (
                elements and TYPES.get(count_type, "f")[0] != "f" and item_type in TYPES
            ):
                elements[-1].properties.append(Property(name, TYPES[item_type], TYPES[count_type]))
            case [b"property", item_type, name] if elements and item_type in TYPES:
                elements[-1].properties.append(Property(name, TYPES[item_type]))
            case [b"end_header"] if byte_order is not None:
                return elements, byte_order, begin, line + 1
            case _:
                raise malformed(
                    f"{quoted(b' '.join(tokens))} is not a line of a PLY header, or the format is missing.", line
                )
    raise malformed("the header has no end (end_header).", line + 1)


def with_whole_comments(data: bytes) -> bytes:
    """A PLY file that `read_ply` accepts, without empty lines in its header, and with the keyword at further lines of
    comments, at which some writers leave it out."""
    _, _, begin, _ = _read_header(data)
    known = (*KEYWORDS, b"comment", b"obj_info")
    lines = [(line, line.split()) for line in data[:begin].splitlines(keepends=True)]
    whole = [line if words[0] in known else b"comment " + line.lstrip() for line, words in lines if words]
    return b"".join(whole) + data[begin:]


class _TextTable:
    """The rows of a text file, one a line, from the first on."""

    def __init__(self, data: bytes, line: int) -> None:
        rows = Rows.split(data, comments=False)
        self.rows = replace(rows, lines=rows.lines + (line - 1))
        self.next = 0

    def read_points(self, element: Element, wanted: list[int]) -> NDArray[np.float64]:
        rows = self._take(element)
        cells = self._cells(element, rows, wanted)
        return rows.floats(np.stack([cells[place][0] for place in wanted], axis=1).ravel()).reshape(-1, 3)

    def read_lists(self, element: Element, wanted: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        rows = self._take(element)
        begins, counts = self._cells(element, rows, [wanted])[wanted]
        return rows.integers(ranges(begins, counts)), counts

    def read_table(self, element: Element) -> NDArray | None:
        """A structured array of all properties, lists as fields of several numbers; None as of `read_text_tables`."""
        if not element.properties:
            return None  # such rows are empty lines, which are left out
        rows = self._take(element)
        columns = {}
        for place, (begins, counts) in self._cells(element, rows, [*range(len(element.properties))]).items():
            p = element.properties[place]
            if (counts != counts[:1]).any():
                return None
            found = rows.floats(ranges(begins, counts))
            with np.errstate(invalid="ignore", over="ignore"):
                typed = found.astype(p.type)
            if typed.dtype.kind != "f" and (typed != found).any():
                return None
            width = int(counts[0]) if len(counts) else 0
            columns[p.name.decode()] = typed if p.count_type is None else typed.reshape(len(counts), width)
        return structured(columns)

    def skip(self, element: Element) -> None:
        if element.properties:
            self._take(element)

    def _take(self, element: Element) -> Rows:
        begin, end = self.next, self.next + element.count
        if end > len(self.rows.lines):
            present = len(self.rows.lines) - begin
            raise malformed(f"the file ends after {present} of {element.count} rows of element '{element.name}'.")
        self.next = end
        return self.rows.select(slice(begin, end))

    @staticmethod
    def _cells(
        element: Element, rows: Rows, wanted: list[int]
    ) -> dict[int, tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """For each wanted property, where its tokens begin in each row and how many they are."""
        cells = {}
        at, end = rows.starts, rows.starts + rows.counts
        for place, p in enumerate(element.properties):
            counts = np.ones(len(at), np.int64)
            if p.count_type is not None:
                _require_room(element, rows, at + 1, end)
                counts, at = rows.integers(at), at + 1
            # A length that is no length reaches beyond the row.
            _require_room(element, rows, np.where((counts < 0) | (counts > rows.counts), end + 1, at + counts), end)
            if place in wanted:
                cells[place] = (at, counts)
            at = at + counts
        return cells


def _require_room(element: Element, rows: Rows, needed: NDArray[np.int64], end: NDArray[np.int64]) -> None:
    short = np.flatnonzero(needed > end)
    if len(short):
        raise malformed(
            f"a row of '{element.name}' with {rows.counts[short[0]]} numbers is too short.", int(rows.lines[short[0]])
        )


class _BinaryTable:
    """The rows of a binary file, from the first on."""

    def __init__(self, data: bytes, begin: int, byte_order: str) -> None:
        self.data, self.at, self.order = data, begin, byte_order

    def read_points(self, element: Element, wanted: list[int]) -> NDArray[np.float64]:
        table = self._read_uniform(element)
        if table is None:
            columns = [numbers for _, numbers in self._walk(element, wanted)]
        else:
            columns = [table[f"{place}"] for place in wanted]
        with np.errstate(invalid="ignore"):  # a NaN of any kind
            return np.stack([column.astype(np.float64) for column in columns], axis=1)

    def read_lists(self, element: Element, wanted: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        table = self._read_uniform(element)
        if table is None:
            ((counts, items),) = self._walk(element, [wanted])
            return items.astype(np.int64), counts
        items = table[f"{wanted}"].astype(np.int64)
        return items.ravel(), np.full(len(items), items.shape[1], np.int64)

    def skip(self, element: Element) -> None:
        if element.properties and self._read_uniform(element) is None:
            self._walk(element, [])

    def _read_uniform(self, element: Element) -> NDArray | None:
        """All rows at once where every list is as long as in the first row, otherwise None and nothing read."""
        fields: list[tuple] = []
        at = self.at
        for place, p in enumerate(element.properties):
            if p.count_type is None:
                fields.append((f"{place}", self.order + p.type))
                at += np.dtype(p.type).itemsize
                continue
            length = self._number(element, 0, at, p.count_type) if element.count else 0
            if length < 0 or length * np.dtype(p.type).itemsize > len(self.data):
                return None
            fields += [(f"length {place}", self.order + p.count_type), (f"{place}", self.order + p.type, (length,))]
            at += np.dtype(p.count_type).itemsize + length * np.dtype(p.type).itemsize
            if at - self.at > LONGEST_ROW:
                return None
        row = np.dtype(fields)
        count = element.count if row.itemsize else 0
        if self.at + count * row.itemsize > len(self.data):
            return None
        table = np.frombuffer(self.data, row, count, self.at)
        for name in row.names or ():
            if name.startswith("length ") and (table[name] != row[name.removeprefix("length ")].shape[0]).any():
                return None
        self.at += count * row.itemsize
        return table

    def _walk(self, element: Element, wanted: list[int]) -> list[tuple[NDArray[np.int64], NDArray]]:
        """Row by row: of each wanted property how many numbers each row has, and all of them."""
        properties = element.properties
        counts = [0 if p.count_type is None else _signed_width(p.count_type) for p in properties]
        widths = [np.dtype(p.type).itemsize for p in properties]
        end, short, lengths, cells = _lsgp.binary_rows(
            self.data, self.at, element.count, counts, widths, wanted, self.order == "<"
        )
        if short >= 0:
            raise self._cut_short(element, short)
        self.at = end
        return [
            (length, np.frombuffer(cell, self.order + properties[place].type))
            for place, length, cell in zip(wanted, lengths, cells, strict=True)
        ]

    def _number(self, element: Element, row: int, at: int, type_code: str) -> int:
        width = np.dtype(type_code).itemsize
        if at + width > len(self.data):
            raise self._cut_short(element, row)
        return int.from_bytes(
            self.data[at : at + width], "little" if self.order == "<" else "big", signed=type_code[0] == "i"
        )

    @staticmethod
    def _cut_short(element: Element, row: int) -> Exception:
        return malformed(f"the file ends in row {row} of {element.count} of element '{element.name}'.")


def _signed_width(type_code: str) -> int:
    """Of an integer, in bytes; negative for a type with a sign."""
    width = np.dtype(type_code).itemsize
    return -width if type_code[0] == "i" else width
