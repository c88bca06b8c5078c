# SPDX-License-Identifier: GPL-3.0-or-later
"""What a command line says to frequent mistakes: in two lines what happened, why, and what to do."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from command import Ended
from meshes import moebius_strip

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
FILES = {
    "words.txt": "hello\n",
    "packed.obj": b"\x1f\x8b\x08" + bytes(9),
    "cut-short.obj": TRIANGLE + "f 1 2 x\n",
    "noise.glb": bytes(range(128, 256)),
    "points.obj": TRIANGLE,
    "empty.obj": "",
    "line.obj": "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
    "infinite.obj": TRIANGLE.replace("1", "inf", 1) + "f 1 2 3\n",
    "foreign.obj": TRIANGLE + "f 1 2 9\n",
    "one.json": json.dumps({"cones": [0]}),
    "far.json": json.dumps({"cones": [99999]}),
    "twice.json": json.dumps({"cones": [1, 1, 5, 9]}),
    "angles.json": json.dumps({"cones": [0, 20, 50, 90], "cone_angles": [1, 1, 1, 1]}),
    "broken.json": '{"cones": [0, 20',
    "other.json": json.dumps({"cone": [1]}),
}
OUT = ("-o", "out.obj")
# Arguments, the exit code, what is said of the mistake, and of what to do.
MISTAKES = {
    "no command": ((), 2, "a command is needed", "unwrap, cones, quads, batch, measure or pad"),
    "unknown command": (("unwarp", "cube.obj"), 2, "invalid choice: 'unwarp'", "'unwrap'"),
    "no output": (("unwrap", "cube.obj"), 2, "where to write to is missing", "-o/--output, or --in-place"),
    "no file": (("unwrap", "cube.ojb", *OUT), 2, "No such file or directory: 'cube.ojb'", "check the path"),
    "a folder": (("unwrap", ".", *OUT), 2, "'.'", "lsgp batch"),
    "no folder": (("unwrap", "cube.obj", "-o", "none/out.obj"), 2, "there is no folder '.*none'", "make it"),
    "onto itself": (("unwrap", "cube.obj", "-o", "cube.obj"), 2, "is the input", "--in-place"),
    "output format": (("unwrap", "cube.obj", "-o", "out.fbx"), 2, "cannot be written as .fbx", r"OBJ \(.obj\)"),
    "zero byte": (("unwrap", "cu\0be.obj", *OUT), 2, r"'cu\\x00be.obj' has a character", "leave it out"),
    "half a character": (("measure", "\ud800.obj"), 2, r"'\\ud800.obj' has a character", "leave it out"),
    "option": (("unwrap", "cube.obj", *OUT, "--cone", "auto"), 2, "unrecognized arguments: --cone", "is --cones meant"),
    "option of another": (("measure", "cube.obj", "--preset", "paint"), 2, "--preset paint\n", "lsgp measure --help"),
    "value": (("unwrap", "cube.obj", *OUT, "--preset", "pain"), 2, "invalid choice: 'pain'", "'paint', 'tile', 'bake'"),
    "number": (("unwrap", "cube.obj", *OUT, "--tiles", "ten"), 2, "invalid float value: 'ten'", "lsgp unwrap --help"),
    "option alone": (("unwrap", "cube.obj", *OUT, "--tiles", "8"), 2, "is for seamless layouts", "add --seamless"),
    "other content": (("unwrap", "words.txt", *OUT), 3, "UNKNOWN_FORMAT: 'words.txt' is not an OBJ", "Export the mesh"),
    "compressed": (("unwrap", "packed.obj", *OUT), 3, "'packed.obj' is compressed", "Decompress it first"),
    "damaged": (("unwrap", "cut-short.obj", *OUT), 3, "Line 4: 'x' is not an integer", "Export the file again"),
    "no text": (("unwrap", "noise.glb", *OUT), 3, "no glTF: it has bytes that are no text", "Export the file again"),
    "no faces": (("unwrap", "points.obj", *OUT), 3, "'points.obj' has 3 vertices and no faces", "with its faces"),
    "empty file": (("unwrap", "empty.obj", *OUT), 3, "EMPTY_MESH: 'empty.obj' has no mesh", "Export the mesh again"),
    "no area": (("unwrap", "line.obj", *OUT), 3, "No triangle has an area", "Restore the surface's shape"),
    "not finite": (("unwrap", "infinite.obj", *OUT), 3, "not a finite number", "Move or delete it"),
    "no vertex": (("unwrap", "foreign.obj", *OUT), 3, r"Face 0 \(line 4\)", "Export the mesh again"),
    "one side": (("unwrap", "strip.obj", *OUT), 3, "one side only", "Delete or split faces"),
    "no cones": (("unwrap", "cube.obj", *OUT, "--cones", "one.json"), 3, "1 cone cannot take up", "Mark more cones"),
    "cone": (("unwrap", "cube.obj", *OUT, "--cones", "far.json"), 3, "outside the vertices 0 to 97", "Mark vertices"),
    "cone twice": (("unwrap", "cube.obj", *OUT, "--cones", "twice.json"), 3, "listed twice", "List every cone once"),
    "angles": (("unwrap", "cube.obj", *OUT, "--cones", "angles.json"), 3, "requires 720 degrees", "one automatic"),
    "no JSON": (("unwrap", "cube.obj", *OUT, "--cones", "broken.json"), 2, "is not valid JSON", "correct it there"),
    "other JSON": (("unwrap", "cube.obj", *OUT, "--cones", "other.json"), 3, "not have the form", "Correct the file"),
    "no coordinates": (("measure", "cube.obj"), 3, "NO_UV: The file has no texture coordinates", "lsgp unwrap"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_two_lines_say_what_is_wrong_and_what_to_do(cube_files: Path, lsgp: Callable[..., Ended], mistake: str) -> None:
    arguments, code, wrong, remedy = MISTAKES[mistake]
    for name, content in FILES.items():
        (cube_files / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    strip = moebius_strip()
    lines = [f"v {x} {y} {z}" for x, y, z in strip.positions]
    lines += [f"f {a} {b} {c}" for a, b, c in (strip.triangles + 1).tolist()]
    (cube_files / "strip.obj").write_text("\n".join(lines) + "\n")
    before = sorted(path.name for path in cube_files.iterdir())
    done = lsgp(*arguments)
    assert done.code == code, done.err
    assert done.out == ""
    assert len(done.err.splitlines()) <= 2
    assert re.search(wrong, done.err) and re.search(remedy, done.err), done.err
    assert sorted(path.name for path in cube_files.iterdir()) == before
