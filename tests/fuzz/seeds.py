# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what the fuzzers begin with: small inputs of every verb and every kind of file, one file each.

python tests/fuzz/seeds.py FOLDER      into FOLDER/surface, FOLDER/arrays and FOLDER/files; the same ones every time
"""

from __future__ import annotations

import base64
import json
import random
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

VERBS = 8  # of fuzz_surface and fuzz_arrays
SHAPES = 6  # of fuzz_surface
OPTIONS = 8  # of fuzz_files
SEPARATOR = b"\n%%\n"
UNWRAP, MEASURE, CONES, BATCH = 0, 2, 4, 5  # commands of fuzz_files
OBJ, PLY, OFF, NONE, GLTF, GLB, STL = range(7)  # suffixes of fuzz_files

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def surfaces() -> Iterator[bytes]:
    """A verb, one or two sound parts of some shape, nothing moved or changed, then any options."""
    numbers = random.Random(1)
    for verb in range(VERBS):
        for shape in range(SHAPES):
            for parts in range(2):
                part = bytes([shape, 2, 2])
                # Moved, changed, size, seams, borders, features, edges, importance, directions, scale.
                sound = bytes(10)
                yield bytes([verb, parts]) + part * (parts + 1) + sound + numbers.randbytes(60)
        yield bytes([verb]) + numbers.randbytes(200)


def arrays() -> Iterator[bytes]:
    numbers = random.Random(2)
    for length in range(16, 400, 4):
        yield numbers.randbytes(length)


def obj(sides: list[tuple[int, ...]], uv: bool = False) -> bytes:
    lines = ["# a cube", "o cube", *(f"v {x} {y} {z}" for x, y, z in CUBE)]
    lines += [f"vt {x} {y}" for x, y, _ in CUBE] if uv else []
    lines += ["usemtl red", "s 1"]
    lines += ["f " + " ".join(f"{v + 1}/{v + 1}" if uv else str(v + 1) for v in side) for side in sides]
    return "\n".join(lines).encode()


def off(header: str) -> bytes:
    rows = [" ".join(map(str, point)) for point in CUBE] + [" ".join(map(str, (4, *side))) for side in SIDES]
    return "\n".join([header, "8 6 12", *rows]).encode()


def ply(form: str, per_vertex: str = "") -> bytes:
    header = (
        f"ply\nformat {form} 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty float y\n"
        f"property float z\n{per_vertex}element face 6\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()
    if form == "ascii":
        extra = " 1" if per_vertex else ""
        rows = [" ".join(map(str, point)) + extra for point in CUBE]
        return header + "\n".join(rows + [" ".join(map(str, (4, *side))) for side in SIDES]).encode()
    order = "<" if form == "binary_little_endian" else ">"
    extra = struct.pack("B", 1) if per_vertex else b""
    points = b"".join(struct.pack(order + "3f", *point) + extra for point in CUBE)
    return header + points + b"".join(struct.pack(order + "B4i", 4, *side) for side in SIDES)


def gltf(*, binary: bool) -> bytes:
    """Two primitives of a cube, one without indices, below a node that moves them, with what else meshes have."""
    triangles = [half for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
    views = [
        b"".join(struct.pack("<3f", *point) for point in CUBE),
        b"".join(struct.pack("<3H", *triangle) for triangle in triangles[:10]),
        b"".join(struct.pack("<3hH", *CUBE[vertex], 0) for triangle in triangles[10:] for vertex in triangle),
        bytes(4 * len(CUBE)),
    ]
    data = b"".join(views)
    begins = [sum(map(len, views[:i])) for i in range(len(views))]
    buffer: dict[str, Any] = {"byteLength": len(data)}
    if not binary:
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    content = {
        "asset": {"version": "2.0"},
        "buffers": [buffer],
        "bufferViews": [
            {"buffer": 0, "byteOffset": b, "byteLength": len(v)} for b, v in zip(begins, views, strict=True)
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 30, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5122, "count": 6, "type": "VEC3", "normalized": False},
            {"bufferView": 3, "componentType": 5121, "count": 8, "type": "VEC4", "normalized": True},
            {"bufferView": 3, "componentType": 5121, "count": 8, "type": "VEC2", "normalized": True},
            {"componentType": 5126, "count": 8, "type": "VEC3"},
        ],
        "meshes": [
            {
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "COLOR_0": 3, "TEXCOORD_0": 4},
                        "indices": 1,
                        "targets": [{"POSITION": 5}],
                        "extras": {"kept": [1, "a"]},
                    },
                    {"attributes": {"POSITION": 2}},
                ]
            }
        ],
        "nodes": [
            {"children": [1], "scale": [2, 1, 1]},
            {"mesh": 0, "rotation": [0, 0, 0, 1], "translation": [1, 2, 3]},
        ],
        "images": [{"uri": "mesh.png"}],
    }
    content["bufferViews"][2]["byteStride"] = 8
    text = json.dumps(content, separators=(",", ":")).encode()
    if not binary:
        return text
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def stl(*, binary: bool) -> bytes:
    triangles = [[CUBE[v] for v in half] for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
    if binary:
        facets = b"".join(bytes(12) + struct.pack("<9f", *sum(corners, ())) + bytes(2) for corners in triangles)
        return bytes(80) + struct.pack("<I", len(triangles)) + facets
    lines = ["solid a cube"]
    for corners in triangles:
        loop = ["vertex " + " ".join(map(str, point)) for point in corners]
        lines += ["facet normal 0 0 0", "outer loop", *loop, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid"]).encode()


def meshes() -> Iterator[tuple[int, bytes]]:
    yield OBJ, obj(SIDES)
    yield OBJ, obj(SIDES[:5])
    yield OBJ, obj(SIDES, uv=True)
    yield OBJ, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
    yield OBJ, b"v 0 0 0 1 0 0\r\nv 1 0 0\r\nv 0 1 \\\n0\nvn 0 0 1\ng a b\nf 1//1 2//1 3//1\nl 1 2\n"
    yield OFF, off("OFF")
    yield NONE, off("COFF")
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        yield PLY, ply(form)
        yield NONE, ply(form, "property uchar red\n")
    yield GLTF, gltf(binary=False)
    yield GLB, gltf(binary=True)
    yield STL, stl(binary=False)
    yield STL, stl(binary=True)


def files() -> Iterator[bytes]:
    cones = [b'{"cones": [0, 1, 2, 3, 4, 5, 6, 7]}', b'{"cones": [0, 7, 3], "cone_angles": [3.1, null, 4.7]}']
    cones.append(b'{"cones": [0, 7], "angles_over_pi_2": [3, 1e2]}')
    seams = [b"[[0, 1], [1, 3]]", b"[]"]
    importance = [b"1 2 0 1 1 0.5 1 1", b"[1, 2, 0, 1, 1, 0.5, 1, 1]"]
    directions = [b"[[0, 0, 0, 1]]", b"[[1, 0.5, 2e3, -1], [1, 0, 1, 0]]"]
    for i, (suffix, mesh) in enumerate(meshes()):
        sides = SEPARATOR.join([mesh, cones[i % 3], seams[i % 2], importance[i % 2], directions[i % 2]])
        for command in (UNWRAP, MEASURE, CONES):
            for how in range(OPTIONS if command == UNWRAP else 2):
                yield bytes([command, 8 * suffix + how]) + sides
    journal = b'{"asset": "a.obj", "status": "ok", "output": "a.obj", "options": ""}\n{"asset": "b.ply", "status": "ref'
    record = b'{"asset": "a.obj", "status": "refused", "code": "BAD_FACE", "message": "?", "options": "", "seconds": 9}'
    for how in range(4):
        for lines in (journal, record, b""):
            yield bytes([BATCH, 8 * NONE + how]) + SEPARATOR.join([b"a.obj\nsub/b.ply\r\n\n../c.off", lines])


def main(folder: Path) -> None:
    for name, inputs in (("surface", surfaces()), ("arrays", arrays()), ("files", files())):
        (folder / name).mkdir(parents=True, exist_ok=True)
        for i, data in enumerate(inputs):
            (folder / name / f"seed-{i:03}").write_bytes(data)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
