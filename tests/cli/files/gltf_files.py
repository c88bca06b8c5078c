# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF documents for tests: built without the library's writer, and read without its reader."""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import numpy as np
from polygon_meshes import bumpy_ball

COMPONENTS = {"<f4": 5126, "<u4": 5125, "<u2": 5123, "|u1": 5121}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
DTYPES = {number: kind for kind, number in COMPONENTS.items()}
WIDTHS = {name: width for width, name in TYPES.items()}
QUARTER_TURN = [0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]


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


def soup(n: int = 3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places of the corners of a closed surface's triangles, each repeated as for flat shading; normals; triangles."""
    positions, faces = bumpy_ball(n)
    triangles = np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))])
    corners = positions[triangles].astype(np.float32)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return corners, np.repeat(normal[:, None], 3, axis=1).astype(np.float32), triangles


def scene(*, with_uv: bool = False) -> Builder:
    """Two meshes, the first of two primitives with materials, under nodes that turn, scale, move and mirror it; with an
    animation, a camera, colors, a morph target, extensions, and keys of no version of the format."""
    corners, normals, _ = soup()
    half = len(corners) // 2
    b = Builder()
    primitives = []
    for part in (slice(None, half), slice(half, None)):
        points = corners[part].reshape(-1, 3)
        attributes = {
            "POSITION": b.add(points, min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist()),
            "NORMAL": b.add(normals[part].reshape(-1, 3)),
            "COLOR_0": b.add(np.arange(4 * len(points), dtype=np.uint8).reshape(-1, 4), normalized=True),
            "TANGENT": b.add(np.ones((len(points), 4), np.float32)),
        }
        if with_uv:
            attributes["TEXCOORD_0"] = b.add(np.full((len(points), 2), 0.25, np.float32))
        attributes["TEXCOORD_1"] = b.add(np.arange(2.0 * len(points), dtype=np.float32).reshape(-1, 2))
        primitives.append(
            {
                "attributes": attributes,
                "material": len(primitives),
                "targets": [{"POSITION": b.add(points * 2, min=[0] * 3, max=[1] * 3)}],
                "extras": {"part": len(primitives)},
            }
        )
    shared = b.add(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4"), min=[0, 0, 0], max=[1, 1, 0])
    quad = [
        {"attributes": {"POSITION": shared}, "indices": b.add(np.array(indices, "<u2"))}
        for indices in ([0, 1, 2], [0, 2, 3])
    ]
    lines = {"mode": 1, "attributes": {"POSITION": shared}}
    b.content |= {
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"children": [1], "rotation": QUARTER_TURN, "scale": [2, 3, 4], "name": "würfel 立"},
            {"mesh": 0, "translation": [5, 0, 0]},
            {"mesh": 1, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]},
        ],
        "meshes": [{"name": "ball", "primitives": primitives}, {"primitives": [*quad, lines]}],
        "materials": [{"name": "a", "extensions": {"KHR_materials_unlit": {}}}, {"name": "b"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}],
        "animations": [
            {
                "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                "samplers": [
                    {"input": b.add(np.array([0.0, 1.0], "<f4")), "output": b.add(np.ones((2, 3), np.float32))}
                ],
            }
        ],
        "extensionsUsed": ["KHR_materials_unlit"],
        "extras": {"kept": [None, 1.5, "ü"]},
        "later": {"than": "version 2"},
    }
    return b


def content_of(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON and the one buffer of a file as the library writes it."""
    if data[:4] != b"glTF":
        content = json.loads(data, parse_constant=_no_constant)
        return content, base64.b64decode(content["buffers"][0]["uri"].partition(",")[2])
    version, length, json_length = struct.unpack_from("<III", data, 4)
    assert (version, length, length % 4) == (2, len(data), 0)
    at = 20 + json_length
    return json.loads(data[20:at], parse_constant=_no_constant), data[
        at + 8 : at + 8 + struct.unpack_from("<I", data, at)[0]
    ]


def _no_constant(text: str) -> None:
    raise AssertionError(f"{text} is no JSON")


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
