# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of all kinds with random damage, through the commands: each ends with a documented exit code and a reason.

Damage goes from single bits to lines and numbers that are put in, left out, doubled and exchanged; a seed names it.
`file_mutations` changes single fields of files that stay whole otherwise.
"""

from __future__ import annotations

import contextlib
import io
import json
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from file_mutations import mutated as with_other_fields
from gltf_files import content_of, scene
from lsgp.cli import main
from lsgp.errors import InputError
from lsgp.io.mesh_files import read_mesh, read_mesh_file, write_mesh_file
from nightly import EVERYTHING
from polygon_meshes import bumpy_ball, cube, cube_corners, obj_text, off_text, patch, ply_bytes, stl_files

RESULT, USAGE, REFUSED, INCOMPLETE = 0, 2, 3, 4
SEEDS, MANY_SEEDS = (60, 100) if EVERYTHING else (20, 40)
# What reading and writing may end with.
REFUSALS = {"MALFORMED_FILE", "INDEX_OUT_OF_RANGE", "BAD_FACE", "WRONG_PARAMETER", "EMPTY_MESH"}

BALL, BALL_CONES = bumpy_ball(3), cube_corners(cube(3)[0])
WITH_UV = "".join(f"vt {i % 5} {i // 5}\n" for i in range(25)) + "".join(
    "f " + " ".join(f"{v + 1}/{v + 1}" for v in face) + "\n" for face in patch()[1]
)
MESHES: dict[str, bytes] = {
    "ball.obj": obj_text(*BALL).encode(),
    "patch.obj": obj_text(patch()[0], []).encode() + WITH_UV.encode(),
    "ball.off": off_text(*BALL).encode(),
    "text.ply": ply_bytes(*patch(), extras=True),
    "little.ply": ply_bytes(*BALL, form="binary_little_endian", coordinate="float"),
    "big.ply": ply_bytes(*patch(), form="binary_big_endian", extras=True),
}
SIDE_FILES: dict[str, bytes] = {
    "cones.json": json.dumps({"cones": BALL_CONES, "cone_angles": [None] * 4 + [1.5 * np.pi] * 4}).encode(),
    "seams.json": json.dumps([face[:2] for face in BALL[1][:6]]).encode(),
    "importance.txt": "\n".join(map(str, np.linspace(0, 1, len(BALL[0])))).encode(),
    "importance.json": json.dumps(np.linspace(0, 1, len(BALL[0])).tolist()).encode(),
}
TOKENS = [
    *[
        b"nan",
        b"inf",
        b"-1",
        b"0",
        b"1e999",
        b"-1e308",
        b"1e-320",
        b"99999999999999999999",
        b"2147483648",
        b"\0",
        b"\xff",
    ],
    *[b"1/1/1", b"//", b"#", b"\\\n", b"\r\n", b"null", b"true", b"[", b"]", b"{}", b'"', b",", b"1" * 400, b"[" * 400],
    *[b"end_header\n", b"element face 3\n", b"property list uchar int vertex_indices\n", b"v 0 0 0\n", b"f 1 1 1\n"],
]


def mutated(data: bytes, seed: int) -> bytes:
    rng, out = random.Random(seed), bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 5])):
        rng.choice(DAMAGE)(rng, out)
    return bytes(out)


def flip(rng: random.Random, data: bytearray) -> None:
    if data:
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)


def put_in(rng: random.Random, data: bytearray) -> None:
    at = rng.randint(0, len(data))
    data[at:at] = rng.choice(TOKENS)


def leave_out(rng: random.Random, data: bytearray) -> None:
    at = rng.randint(0, len(data))
    del data[at : at + rng.choice([1, 2, 10, 100])]


def cut_short(rng: random.Random, data: bytearray) -> None:
    del data[rng.randint(0, len(data)) :]


def double(rng: random.Random, data: bytearray) -> None:
    at, size = rng.randint(0, len(data)), rng.choice([1, 8, 60])
    data[at:at] = data[at : at + size]


def exchange_lines(rng: random.Random, data: bytearray) -> None:
    lines = bytes(data).split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    data[:] = b"\n".join(lines)


def replace_word(rng: random.Random, data: bytearray) -> None:
    words = bytes(data).split(b" ")
    words[rng.randrange(len(words))] = rng.choice(TOKENS)
    data[:] = b" ".join(words)


DAMAGE: list[Callable[[random.Random, bytearray], None]] = [
    *(flip, put_in, leave_out, cut_short, double, exchange_lines, replace_word)
]


def run(folder: Path, *arguments: str) -> tuple[int, str]:
    """Exit code and what was printed; anything that is raised is a failure of the test."""
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        return main(list(arguments)), printed.getvalue()


def require_documented_end(folder: Path, output: str, code: int, printed: str) -> None:
    """A result that can be read, or a reason and no output."""
    assert code in (RESULT, USAGE, REFUSED, INCOMPLETE)
    if code in (RESULT, INCOMPLETE):
        assert (folder / output).exists()
        if output.endswith(".obj"):
            uv = read_mesh(folder / output, with_uv=True).corner_uv
            assert np.isfinite(uv).all(axis=1).any()
        return
    assert "lsgp: refused: " in printed or "lsgp: error: " in printed
    assert not (folder / output).exists()


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_damaged_meshes(tmp_path: Path, name: str) -> None:
    ends = set()
    for seed in range(SEEDS):
        (tmp_path / name).write_bytes(mutated(MESHES[name], seed))
        commands = {
            "out.obj": ["unwrap", name, "-o", "out.obj", "--report", "report.json"],
            "out.json": ["cones", name, "-o", "out.json"],
        }
        for output, arguments in commands.items():
            code, printed = run(tmp_path, *arguments)
            require_documented_end(tmp_path, output, code, printed)
            ends.add(code)
            (tmp_path / output).unlink(missing_ok=True)
        code, printed = run(tmp_path, "measure", name, "--report", "report.json")
        assert code in (RESULT, REFUSED)
        if code == REFUSED:
            assert json.loads((tmp_path / "report.json").read_text())["code"] in printed
    assert {RESULT, REFUSED} <= ends


@pytest.mark.slow
@pytest.mark.parametrize("name", SIDE_FILES)
def test_damaged_side_files(tmp_path: Path, name: str) -> None:
    option = {"cones": "--cones", "seams": "--seam-edges", "importance": "--importance"}[name.split(".")[0]]
    more = ["--mode", "low-stretch"] if option == "--importance" else []
    (tmp_path / "ball.obj").write_bytes(MESHES["ball.obj"])
    (tmp_path / "cones.json").write_bytes(SIDE_FILES["cones.json"])
    cones = [] if option == "--cones" else ["--cones", "cones.json"]
    ends = set()
    for seed in range(SEEDS):
        (tmp_path / name).write_bytes(mutated(SIDE_FILES[name], seed))
        code, printed = run(tmp_path, "unwrap", "ball.obj", "-o", "out.obj", option, name, *cones, *more)
        require_documented_end(tmp_path, "out.obj", code, printed)
        ends.add(code)
        (tmp_path / "out.obj").unlink(missing_ok=True)
        if option == "--cones":
            code, printed = run(tmp_path, "cones", "ball.obj", "-o", "out.json", "--keep", name)
            require_documented_end(tmp_path, "out.json", code, printed)
            (tmp_path / "out.json").unlink(missing_ok=True)
    assert len(ends) >= 2


@pytest.mark.parametrize("name", MESHES)
def test_undamaged_files_have_results(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(MESHES[name])
    code, printed = run(tmp_path, "unwrap", name, "-o", "out.obj")
    assert code == RESULT
    require_documented_end(tmp_path, "out.obj", code, printed)


SCENE = scene(with_uv=True)
TRIANGLES = np.array([half for a, b, c, d in BALL[1] for half in ((a, b, c), (a, c, d))])
FIELDS: dict[str, bytes] = MESHES | {
    "scene.gltf": SCENE.gltf(),
    "scene.glb": SCENE.glb(),
    **{f"{kind}.stl": data for kind, data in stl_files(BALL[0], TRIANGLES).items()},
}


@pytest.mark.slow
@pytest.mark.filterwarnings("error", "ignore:loadtxt")
@pytest.mark.parametrize("name", FIELDS)
def test_files_with_other_fields_are_read_and_written_or_refused(tmp_path: Path, name: str) -> None:
    """By the functions alone, as thousands of files are cheap there."""
    path, ends = tmp_path / name, set()
    (tmp_path / "far").mkdir()
    for seed in range(MANY_SEEDS):
        path.write_bytes(with_other_fields(FIELDS[name], random.Random(seed)))
        try:
            file = read_mesh_file(path)
        except InputError as error:
            assert error.code in REFUSALS and len(error.message) < 400
            ends.add(error.code)
            continue
        except OSError:  # of a file that the document names
            continue
        uv = np.zeros((len(file.triangulation.triangles), 3, 2))
        for suffix in (".obj", ".gltf", ".glb", ".ply"):
            out = tmp_path / "far" / f"out{suffix}"
            out.unlink(missing_ok=True)
            try:
                write_mesh_file(out, file, uv)
            except InputError as error:
                assert error.code in REFUSALS and len(error.message) < 400
                assert not out.exists()
                continue
            ends.add("written")
            if suffix in (".gltf", ".glb"):
                content_of(out.read_bytes())
    assert {"written", "MALFORMED_FILE"} <= ends


@pytest.mark.parametrize("name", ["scene.gltf", "scene.glb", "binary.stl", "text.stl"])
def test_commands_on_files_with_other_fields(tmp_path: Path, name: str) -> None:
    ends = set()
    for seed in range(SEEDS // 3):
        (tmp_path / name).write_bytes(with_other_fields(FIELDS[name], random.Random(1000 + seed)))
        code, printed = run(tmp_path, "unwrap", name, "-o", "out.obj")
        require_documented_end(tmp_path, "out.obj", code, printed)
        ends.add(code)
        (tmp_path / "out.obj").unlink(missing_ok=True)
    assert RESULT in ends


@pytest.mark.slow
@pytest.mark.parametrize("name", SIDE_FILES)
def test_side_files_with_other_fields(tmp_path: Path, name: str) -> None:
    option = {"cones": "--cones", "seams": "--seam-edges", "importance": "--importance"}[name.split(".")[0]]
    more = ["--mode", "low-stretch"] if option == "--importance" else []
    (tmp_path / "ball.obj").write_bytes(MESHES["ball.obj"])
    for seed in range(SEEDS // 2):
        (tmp_path / name).write_bytes(with_other_fields(SIDE_FILES[name], random.Random(seed)))
        code, printed = run(tmp_path, "unwrap", "ball.obj", "-o", "out.obj", option, name, *more)
        require_documented_end(tmp_path, "out.obj", code, printed)
        (tmp_path / "out.obj").unlink(missing_ok=True)
