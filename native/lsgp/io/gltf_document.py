# SPDX-License-Identifier: GPL-3.0-or-later
"""A glTF 2.0 document: its JSON, kept as it is, and the binary data that accessors stand for.

Written on the standard library alone: available readers drop what they do not know of a document, and here all of it
has to be preserved.

Documents come from anywhere. Every value is checked where it is read, and as parts of a document may share their data,
so that a short one stands for any amount, what is written is bounded by `Document.require_room`.
"""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .json_text import JsonError, parse_json
from .mesh_text import malformed, quoted

MAGIC, VERSION = b"glTF", 2
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
COMPONENTS = {
    **{BYTE: "<i1", UNSIGNED_BYTE: "<u1", SHORT: "<i2", UNSIGNED_SHORT: "<u2"},
    **{UNSIGNED_INT: "<u4", FLOAT: "<f4"},
}
# Of the elements of attributes, the integers as by KHR_mesh_quantization; and of indices.
IN_ATTRIBUTES = (FLOAT, BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT)
IN_INDICES = (UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT)
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
VERTICES, INDICES = 34962, 34963
ALIGNMENT = 4
# Of a GLB file, which says in 32 bits how long it and its chunks are.
LONGEST_GLB = (1 << 32) - 1
# Compressed forms of data, for which there is no decoder here.
COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
# The lists of a document that are read here.
LISTS = ("accessors", "bufferViews", "buffers", "images", "meshes", "nodes")

# Bytes that may be written of data that parts of a document share, and as a multiple of the document. Where every
# triangle of a closed mesh becomes an island, vertices with all they have become six each.
SHARED_BYTES, SHARED_TIMES = 1 << 28, 8

ReadUri = Callable[[str], bytes]


@dataclass(frozen=True, slots=True)
class View:
    """source[begin:end], the bytes of a buffer view; others of the same buffer, by its number, may overlap them."""

    source: memoryview
    begin: int
    end: int
    buffer: int

    @property
    def data(self) -> memoryview:
        return self.source[self.begin : self.end]


class Document:
    """content: the JSON, with objects in all of LISTS. views: its buffer views. size: of the file and all that was read
    for it, in bytes."""

    def __init__(self, content: dict[str, Any], buffers: list[bytes], size: int) -> None:
        """Raises InputError: MALFORMED_FILE."""
        self.content = content
        self.size = size
        self._buffers = len(buffers)
        self._written = 0
        self._text_lengths: dict[int, int] = {}
        sources = [memoryview(buffer) for buffer in buffers]
        self.views = [_view(view, sources) for view in content.get("bufferViews", [])]
        self._largest = max((view.end - view.begin for view in self.views), default=0)

    def named_files(self) -> tuple[str, ...]:
        """The paths, from the document's folder, of its buffers and images that are files of their own."""
        entries = [*self.content.get("buffers", []), *self.content.get("images", [])]
        uris = [entry["uri"] for entry in entries if isinstance(entry.get("uri"), str)]
        return tuple(unquote(uri) for uri in uris if not uri.startswith("data:"))

    def accessor(self, number: Any) -> dict[str, Any]:
        """Raises InputError."""
        accessors = self.content.get("accessors", [])
        return accessors[index_of(number, accessors, "accessor")]

    def count(self, accessor: Any) -> int:
        """How many elements an accessor has, at least one.  Raises InputError."""
        return whole_number(self.accessor(accessor), "count", least=1)

    def text_length(self, accessor: int) -> int:
        """About how long an accessor is in the JSON, as long as it is the one of before.  Raises InputError."""
        if accessor not in self._text_lengths:
            self._text_lengths[accessor] = len(json.dumps(self.accessor(accessor)))
        return self._text_lengths[accessor]

    def rows(self, accessor: Any) -> NDArray[np.uint8]:
        """The elements of an accessor as bytes, (count, bytes of an element).  Raises InputError."""
        a = self.accessor(accessor)
        if "sparse" in a:
            raise malformed("sparse accessors are not read.")
        width = WIDTHS[one_of(a, "type", WIDTHS)]
        size, count = component_of(a).itemsize * width, self.count(accessor)
        if "bufferView" not in a:
            if count > self._largest:
                raise malformed(f"an accessor of {count} elements without data.")
            return np.zeros((count, size), np.uint8)
        number = index_of(a["bufferView"], self.views, "buffer view")
        view, begin = self.views[number].data, whole_number(a, "byteOffset", 0)
        stride = whole_number(self.content["bufferViews"][number], "byteStride", size)
        if stride < size or begin + stride * (count - 1) + size > len(view):
            raise malformed(f"accessor {accessor} reaches beyond its data.")
        return np.lib.stride_tricks.as_strided(
            np.frombuffer(view, np.uint8)[begin:], (count, size), (stride, 1), writeable=False
        )

    def numbers(self, accessor: Any, kind: str, at: NDArray[np.int64]) -> NDArray[np.float64]:
        """Some elements of an accessor of an attribute as numbers, (k, width).  at: (k,), less than its count.

        Raises InputError.
        """
        a = self.accessor(accessor)
        values = self._values(accessor, kind, IN_ATTRIBUTES, at)
        with np.errstate(invalid="ignore"):  # a NaN of any kind
            numbers = values.astype(np.float64)
        if values.dtype.kind == "f" or not a.get("normalized"):
            return numbers
        return np.maximum(numbers / np.iinfo(values.dtype).max, -1.0)

    def indices(self, accessor: Any) -> NDArray[np.int64]:
        """The elements of an accessor of indices.  Raises InputError."""
        if self.accessor(accessor).get("normalized"):
            raise malformed("indices that are normalized.")
        return self._values(accessor, "SCALAR", IN_INDICES)[:, 0].astype(np.int64)

    def _values(
        self, accessor: Any, kind: str, components: Collection[int], at: NDArray[np.int64] | None = None
    ) -> NDArray:
        a = self.accessor(accessor)
        if one_of(a, "type", WIDTHS) != kind or one_of(a, "componentType", COMPONENTS) not in components:
            numbers = ", ".join(map(str, components))
            raise malformed(f"accessor {accessor} is used as a {kind} of components {numbers}, which it is not.")
        rows = self.rows(accessor)
        return np.ascontiguousarray(rows if at is None else rows[at]).view(component_of(a))

    def require_room(self, count: int) -> None:
        """For so many bytes more to be written of the data of the document, in memory and in the file.

        Raises InputError: MALFORMED_FILE where all of them are out of proportion.
        """
        self._written += count
        if self._written > max(SHARED_BYTES, SHARED_TIMES * self.size):
            raise malformed(
                f"parts of the glTF share data so often that {self.size} bytes would become more than "
                f"{self._written}. Give parts their own data."
            )

    def add_view(self, rows: NDArray, target: int) -> int:
        """Append elements as a buffer view; those of vertices begin at multiples of four bytes.  Raises InputError."""
        view: dict[str, Any] = {"buffer": 0, "target": target}
        data = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
        self.require_room(data.nbytes)
        padding = -data.shape[1] % ALIGNMENT
        if target == VERTICES and padding:
            data = np.pad(data, ((0, 0), (0, padding)))
            view["byteStride"] = data.shape[1]
        self.views.append(View(memoryview(data.tobytes()), 0, data.size, self._buffers))
        self._buffers += 1
        self.content.setdefault("bufferViews", []).append(view)
        return len(self.views) - 1

    def add_accessor(self, accessor: dict[str, Any]) -> int:
        self.content.setdefault("accessors", []).append(accessor)
        return len(self.content["accessors"]) - 1

    def to_bytes(self, *, binary: bool) -> bytes:
        """A GLB file, or with its data in the JSON a glTF file.  Buffer views that nothing refers to are dropped.

        Raises InputError; WRONG_PARAMETER where it would be longer than a GLB file can be.
        """
        self._drop_unused_views()
        groups = self._overlapping()
        if binary:  # before all of it is in memory once more
            _require_glb(sum(map(self._length, groups)))
        buffer = self._joined_views(groups)
        self.content.pop("buffers", None)
        if buffer:
            self.content["buffers"] = [{"byteLength": len(buffer)}]
            if not binary:
                text = base64.b64encode(buffer).decode("ascii")
                self.content["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{text}"
        text = json.dumps(self.content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        content = text.encode("utf-8", "surrogatepass")
        if not binary:
            return content + b"\n"
        _require_glb(len(content) + len(buffer))
        chunks = _chunk(JSON_CHUNK, content, b" ") + (_chunk(BINARY_CHUNK, bytes(buffer), b"\0") if buffer else b"")
        return MAGIC + struct.pack("<II", VERSION, 12 + len(chunks)) + chunks

    def _length(self, group: list[int]) -> int:
        """From the first byte of its views to the last one."""
        return max(self.views[number].end for number in group) - self.views[group[0]].begin

    def _joined_views(self, groups: list[list[int]]) -> bytearray:
        """The data of all views, whose places are put into the JSON; bytes that views share are there once."""
        buffer = bytearray()
        for group in groups:
            views = [self.views[number] for number in group]
            begin = views[0].begin
            end = begin + self._length(group)
            if len(group) > 1:  # what begins at a multiple of four bytes does so again
                buffer += bytes(begin % ALIGNMENT)
            for number, view in zip(group, views, strict=True):
                without_compressed(self.content["bufferViews"][number])
                place = {"byteOffset": len(buffer) + view.begin - begin, "byteLength": view.end - view.begin}
                self.content["bufferViews"][number].update(buffer=0, **place)
            buffer += views[0].source[begin:end]
            buffer += bytes(-len(buffer) % ALIGNMENT)
        return buffer

    def _overlapping(self) -> list[list[int]]:
        """The views in groups, by their first bytes; those of different groups have none in common. Groups are in the
        order of their first views."""
        groups: list[list[int]] = []
        end, buffer = 0, -1
        for number in sorted(range(len(self.views)), key=lambda n: (self.views[n].buffer, self.views[n].begin)):
            view = self.views[number]
            if view.buffer != buffer or view.begin >= end:
                groups.append([])
                end, buffer = view.end, view.buffer
            groups[-1].append(number)
            end = max(end, view.end)
        return sorted(groups, key=min)

    def _drop_unused_views(self) -> None:
        """By convention all that refers to a buffer view, extensions included, calls it "bufferView"."""
        views = self.content.get("bufferViews", [])
        holders = list(_holders(self.content, "bufferView"))
        used = sorted({index_of(holder["bufferView"], views, "buffer view") for holder in holders})
        place = {old: new for new, old in enumerate(used)}
        for holder in holders:
            holder["bufferView"] = place[holder["bufferView"]]
        self.views = [self.views[old] for old in used]
        if used:
            self.content["bufferViews"] = [views[old] for old in used]
        else:
            self.content.pop("bufferViews", None)


def _require_glb(length: int) -> None:
    """For so many bytes of content.  Raises InputError: WRONG_PARAMETER where a GLB file cannot have them."""
    if length > LONGEST_GLB - 2 * (8 + ALIGNMENT) - 12:
        raise InputError(
            "WRONG_PARAMETER",
            f"A GLB file can have {LONGEST_GLB} bytes, and this one would have some {length}. Write glTF or OBJ.",
        )


def load_document(data: bytes, read_uri: ReadUri) -> Document:
    """A document from a glTF or GLB file.  read_uri: the content of a file that it names, the same object each time.

    Raises OSError, InputError: MALFORMED_FILE.
    """
    text, binary = _chunks(data) if data[:4] == MAGIC else (data, b"")
    try:
        content = parse_json(text, finite=True)
    except JsonError as error:
        raise malformed(f"no glTF: {error}.") from error
    asset = content.get("asset") if isinstance(content, dict) else None
    version = asset.get("version") if isinstance(asset, dict) else None
    if not isinstance(version, str):
        raise malformed("no glTF: the version is missing.")
    if not version.startswith("2."):
        raise malformed(f"glTF {quoted_text(version)} is not read, only 2.0.")
    required = content.get("extensionsRequired", [])
    compressed = [name for name in COMPRESSED if isinstance(required, list) and name in required]
    if compressed:
        raise malformed(f"compressed data ({compressed[0]}) is not read; export without compression.")
    for name in LISTS:
        objects_of(content, name)
    outside: dict[int, bytes] = {}
    buffers = [_buffer(entry, binary, read_uri, outside) for entry in content.get("buffers", [])]
    return Document(content, buffers, len(data) + sum(map(len, outside.values())))


def uri_data(uri: str, read_uri: ReadUri) -> bytes:
    """What a URI stands for: itself, or a file."""
    if not uri.startswith("data:"):
        return read_uri(unquote(uri))
    head, _, text = uri.partition(",")
    return base64.b64decode(text, validate=False) if head.endswith(";base64") else unquote_to_bytes(text)


def quoted_text(text: str) -> str:
    """For a message."""
    return quoted(text[:40].encode("utf-8", "surrogatepass"))


def objects_of(holder: dict[str, Any], name: str) -> list[dict[str, Any]]:
    """A list of objects in an object, empty where there is none.  Raises InputError."""
    value = holder.get(name, [])
    if not (isinstance(value, list) and all(isinstance(item, dict) for item in value)):
        raise malformed(f"{quoted_text(name)} in the glTF is not a list of objects.")
    return value


def index_of(value: Any, among: Collection[Any], what: str) -> int:
    """A number that names one of these, from 0.  what: they are.  Raises InputError."""
    if type(value) is not int or not 0 <= value < len(among):
        raise malformed(f"the glTF names a {what} that is not among its {len(among)}.")
    return value


def whole_number(holder: dict[str, Any], name: str, default: int | None = None, *, least: int = 0) -> int:
    """An integer in an object.  default: where it is not there; None requires it.  Raises InputError."""
    value = holder.get(name, default)
    if type(value) is not int or value < least:
        raise malformed(f"{quoted_text(name)} in the glTF is not a whole number of {least} or more.")
    return value


def some_numbers(holder: dict[str, Any], name: str, default: tuple[float, ...]) -> NDArray[np.float64]:
    """As many numbers as there are defaults, where they are not there.  Raises InputError."""
    value = holder.get(name, default)
    if len(value) != len(default) if isinstance(value, list) else value is not default:
        raise malformed(f"{quoted_text(name)} in the glTF is not a list of {len(default)} numbers.")
    if not all(type(number) in (int, float) for number in value):
        raise malformed(f"{quoted_text(name)} in the glTF is not a list of numbers.")
    return np.array(value, np.float64)


def one_of(holder: dict[str, Any], name: str, table: Collection[Any]) -> Any:
    """A value in an object that is one of these keys.  Raises InputError."""
    value = holder.get(name)
    if type(value) not in (int, str) or value not in table:
        raise malformed(f"{quoted_text(name)} in the glTF is none of {', '.join(map(str, table))}.")
    return value


def component_of(accessor: dict[str, Any]) -> np.dtype:
    """The type of the numbers of an accessor.  Raises InputError."""
    return np.dtype(COMPONENTS[one_of(accessor, "componentType", COMPONENTS)])


def without_compressed(holder: dict[str, Any]) -> None:
    """Take out what an object says of the same data in a compressed form."""
    extensions = holder.get("extensions")
    if isinstance(extensions, dict) and not extensions.keys().isdisjoint(COMPRESSED):
        holder["extensions"] = {name: value for name, value in extensions.items() if name not in COMPRESSED}


def _view(view: dict[str, Any], sources: list[memoryview]) -> View:
    buffer = index_of(view.get("buffer"), sources, "buffer")
    begin = whole_number(view, "byteOffset", 0)
    end = begin + whole_number(view, "byteLength")
    if end > len(sources[buffer]):
        raise malformed("a buffer view reaches beyond its buffer.")
    return View(sources[buffer], begin, end, buffer)


def _buffer(entry: dict[str, Any], binary: bytes, read_uri: ReadUri, outside: dict[int, bytes]) -> bytes:
    """outside: gets those of other files."""
    uri = entry.get("uri")
    if uri is None:
        return binary
    if not isinstance(uri, str):
        raise malformed("the name of a buffer is no text.")
    data = uri_data(uri, read_uri)
    if not uri.startswith("data:"):
        outside[id(data)] = data
    return data


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary data of a GLB file."""
    at, found = 12, {}
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise malformed("the file ends within a chunk.")
        if kind in (JSON_CHUNK, BINARY_CHUNK) and kind not in found:
            found[kind] = data[at + 8 : at + 8 + length]
        at += 8 + length
    if JSON_CHUNK not in found:
        raise InputError("MALFORMED_FILE", "A GLB file without content. Export the file again.")
    return found[JSON_CHUNK], found.get(BINARY_CHUNK, b"")


def _chunk(kind: int, data: bytes, padding: bytes) -> bytes:
    padded = data + padding * (-len(data) % ALIGNMENT)
    return struct.pack("<II", len(padded), kind) + padded


def _holders(value: Any, key: str) -> Iterator[dict[str, Any]]:
    """All objects of the JSON that have an integer by the key, each once."""
    waiting, seen = [value], set()
    while waiting:
        item = waiting.pop()
        if not isinstance(item, dict | list) or id(item) in seen:
            continue
        seen.add(id(item))
        if isinstance(item, dict) and type(item.get(key)) is int:
            yield item
        waiting.extend(item.values() if isinstance(item, dict) else item)
