# SPDX-License-Identifier: GPL-3.0-or-later
"""A glTF 2.0 document: its JSON, kept as it is, and the binary data that accessors stand for.

Written on the standard library alone: available readers drop what they do not know of a document, and here all of it
has to be preserved.
"""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .mesh_text import malformed, quoted

MAGIC, VERSION = b"glTF", 2
JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
VERTICES, INDICES = 34962, 34963
ALIGNMENT = 4
# Compressed forms of data, for which there is no decoder here.
COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")

ReadUri = Callable[[str], bytes]


@dataclass
class Document:
    """content: the JSON. views: the bytes of each of its buffer views."""

    content: dict[str, Any]
    views: list[bytes]

    def rows(self, accessor: int) -> NDArray[np.uint8]:
        """The elements of an accessor as bytes, (count, bytes of an element)."""
        a = self.content["accessors"][accessor]
        if "sparse" in a:
            raise malformed("sparse accessors are not read.")
        dtype, width = np.dtype(COMPONENTS[a["componentType"]]), WIDTHS[a["type"]]
        size, count = dtype.itemsize * width, int(a["count"])
        if "bufferView" not in a:
            if count > max(map(len, self.views), default=0):
                raise malformed(f"an accessor of {count} elements without data.")
            return np.zeros((count, size), np.uint8)
        view = self.views[a["bufferView"]]
        begin = int(a.get("byteOffset", 0))
        stride = int(self.content["bufferViews"][a["bufferView"]].get("byteStride", size))
        if count < 1 or begin < 0 or stride < size or begin + stride * (count - 1) + size > len(view):
            raise malformed(f"accessor {accessor} reaches beyond its data.")
        return np.lib.stride_tricks.as_strided(
            np.frombuffer(view, np.uint8)[begin:], (count, size), (stride, 1), writeable=False
        )

    def numbers(self, accessor: int) -> NDArray[np.float64]:
        """The elements of an accessor as numbers, (count, width)."""
        a = self.content["accessors"][accessor]
        dtype = np.dtype(COMPONENTS[a["componentType"]])
        values = np.ascontiguousarray(self.rows(accessor)).view(dtype).astype(np.float64)
        return np.maximum(values / np.iinfo(dtype).max, -1.0) if a.get("normalized") else values

    def add_view(self, rows: NDArray, target: int) -> int:
        """Append elements as a buffer view; those of vertices begin at multiples of four bytes."""
        view: dict[str, Any] = {"buffer": 0, "target": target}
        data = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
        padding = -data.shape[1] % ALIGNMENT
        if target == VERTICES and padding:
            data = np.pad(data, ((0, 0), (0, padding)))
            view["byteStride"] = data.shape[1]
        self.views.append(data.tobytes())
        self.content.setdefault("bufferViews", []).append(view)
        return len(self.views) - 1

    def add_accessor(self, accessor: dict[str, Any]) -> int:
        self.content.setdefault("accessors", []).append(accessor)
        return len(self.content["accessors"]) - 1

    def to_bytes(self, *, binary: bool) -> bytes:
        """A GLB file, or with its data in the JSON a glTF file.  Buffer views that nothing refers to are dropped."""
        self._drop_unused_views()
        buffer = bytearray()
        for view, data in zip(self.content.get("bufferViews", []), self.views, strict=True):
            view.update(buffer=0, byteOffset=len(buffer), byteLength=len(data))
            buffer += data + bytes(-len(data) % ALIGNMENT)
        self.content.pop("buffers", None)
        if buffer:
            self.content["buffers"] = [{"byteLength": len(buffer)}]
            if not binary:
                text = base64.b64encode(buffer).decode("ascii")
                self.content["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{text}"
        content = json.dumps(self.content, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "surrogatepass")
        if not binary:
            return content + b"\n"
        chunks = _chunk(JSON_CHUNK, content, b" ") + (_chunk(BINARY_CHUNK, bytes(buffer), b"\0") if buffer else b"")
        return MAGIC + struct.pack("<II", VERSION, 12 + len(chunks)) + chunks

    def _drop_unused_views(self) -> None:
        """By convention all that refers to a buffer view, extensions included, calls it "bufferView"."""
        views = self.content.get("bufferViews", [])
        used = sorted({holder["bufferView"] for holder in _holders(self.content, "bufferView")})
        place = {old: new for new, old in enumerate(used)}
        for holder in _holders(self.content, "bufferView"):
            holder["bufferView"] = place[holder["bufferView"]]
        self.views = [self.views[old] for old in used]
        if used:
            self.content["bufferViews"] = [views[old] for old in used]
        else:
            self.content.pop("bufferViews", None)


def load_document(data: bytes, read_uri: ReadUri) -> Document:
    """A document from a glTF or GLB file.  read_uri: the content of a file that it names.

    Raises OSError, InputError: MALFORMED_FILE.
    """
    text, binary = _chunks(data) if data[:4] == MAGIC else (data, b"")
    try:
        content = json.loads(text.decode("utf-8"))
        version = str(content["asset"]["version"])
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise malformed(f"no glTF: {error}.") from error
    if not version.startswith("2."):
        raise malformed(f"glTF {quoted(version.encode())} is not read, only 2.0.")
    compressed = [name for name in COMPRESSED if name in content.get("extensionsRequired", [])]
    if compressed:
        raise malformed(f"compressed data ({compressed[0]}) is not read; export without compression.")
    buffers = [_buffer(entry, binary, read_uri) for entry in content.get("buffers", [])]
    return Document(content, [_view(view, buffers) for view in content.get("bufferViews", [])])


def uri_data(uri: str, read_uri: ReadUri) -> bytes:
    """What a URI stands for: itself, or a file."""
    if not uri.startswith("data:"):
        return read_uri(unquote(uri))
    head, _, text = uri.partition(",")
    return base64.b64decode(text, validate=False) if head.endswith(";base64") else unquote(text).encode("latin-1")


def _view(view: dict[str, Any], buffers: list[bytes]) -> bytes:
    begin, length = int(view.get("byteOffset", 0)), int(view["byteLength"])
    found = buffers[view["buffer"]][begin : begin + length]
    if begin < 0 or len(found) != length:
        raise malformed("a buffer view reaches beyond its buffer.")
    return found


def _buffer(entry: dict[str, Any], binary: bytes, read_uri: ReadUri) -> bytes:
    return uri_data(entry["uri"], read_uri) if "uri" in entry else binary


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary data of a GLB file."""
    at, found = 12, {}
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise malformed("the file ends within a chunk.")
        found.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length
    if JSON_CHUNK not in found:
        raise InputError("MALFORMED_FILE", "A GLB file without content. Export the file again.")
    return found[JSON_CHUNK], found.get(BINARY_CHUNK, b"")


def _chunk(kind: int, data: bytes, padding: bytes) -> bytes:
    padded = data + padding * (-len(data) % ALIGNMENT)
    return struct.pack("<II", len(padded), kind) + padded


def _holders(value: Any, key: str) -> Iterator[dict[str, Any]]:
    """All objects of the JSON that have the key."""
    waiting = [value]
    while waiting:
        item = waiting.pop()
        if isinstance(item, dict):
            if isinstance(item.get(key), int):
                yield item
            waiting.extend(item.values())
        elif isinstance(item, list):
            waiting.extend(item)
