# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF documents for tests: built without the library's writer, and read without its reader."""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import numpy as np

COMPONENTS = {"<f4": 5126, "<u4": 5125, "<u2": 5123, "|u1": 5121}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
DTYPES = {number: kind for kind, number in COMPONENTS.items()}
WIDTHS = {name: width for width, name in TYPES.items()}


class Builder:
    """Collects accessors into one buffer."""

    def __init__(self) -> None:
        self.buffer = b""
        self.content: dict[str, Any] = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": []}

    def add(self, values: np.ndarray, **further: object) -> int:
        data = values.tobytes()
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)}
        self.buffer += data + bytes(-len(data) % 4)
        self.content["bufferViews"].append(view)
        width = 1 if values.ndim == 1 else values.shape[1]
        accessor = {"bufferView": len(self.content["bufferViews"]) - 1, "count": len(values), "type": TYPES[width]}
        self.content["accessors"].append(accessor | {"componentType": COMPONENTS[values.dtype.str], **further})
        return len(self.content["accessors"]) - 1

    def gltf(self) -> bytes:
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.buffer).decode()
        return json.dumps(self.content | {"buffers": [{"byteLength": len(self.buffer), "uri": uri}]}).encode()

    def glb(self) -> bytes:
        content = json.dumps(self.content | {"buffers": [{"byteLength": len(self.buffer)}]}).encode()
        content += b" " * (-len(content) % 4)
        chunks = struct.pack("<II", len(content), 0x4E4F534A) + content
        chunks += struct.pack("<II", len(self.buffer), 0x004E4942) + self.buffer
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def content_of(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON and the one buffer of a file as the library writes it."""
    if data[:4] != b"glTF":
        content = json.loads(data)
        return content, base64.b64decode(content["buffers"][0]["uri"].partition(",")[2])
    version, length, json_length = struct.unpack_from("<III", data, 4)
    assert (version, length, length % 4) == (2, len(data), 0)
    at = 20 + json_length
    return json.loads(data[20:at]), data[at + 8 : at + 8 + struct.unpack_from("<I", data, at)[0]]


def values_of(data: bytes, accessor: int) -> np.ndarray:
    """The elements of an accessor, (count, width)."""
    content, buffer = content_of(data)
    a = content["accessors"][accessor]
    view = content["bufferViews"][a["bufferView"]]
    dtype, width = np.dtype(DTYPES[a["componentType"]]), WIDTHS[a["type"]]
    step = view.get("byteStride", dtype.itemsize * width)
    begin = view["byteOffset"] + a.get("byteOffset", 0)
    assert begin % dtype.itemsize == step % dtype.itemsize == 0
    assert a.get("byteOffset", 0) + step * (a["count"] - 1) + dtype.itemsize * width <= view["byteLength"]
    rows = [np.frombuffer(buffer, dtype, width, begin + step * i) for i in range(a["count"])]
    return np.array(rows)


def corners_of(data: bytes, mesh: int, primitive: int, name: str) -> np.ndarray:
    """The values of an attribute at the corners of the triangles, (t, 3, width)."""
    content, _ = content_of(data)
    found = content["meshes"][mesh]["primitives"][primitive]
    indices = values_of(data, found["indices"])[:, 0].astype(int)
    return values_of(data, found["attributes"][name])[indices].reshape(len(indices) // 3, 3, -1)
