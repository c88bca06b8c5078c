# SPDX-License-Identifier: GPL-3.0-or-later
"""No command writes over a file that another of its arguments names, whatever the arguments are."""

from __future__ import annotations

import argparse
import json
import os
from itertools import combinations, product
from pathlib import Path

import numpy as np
import pytest
from lsgp.cli.command import _parser, main
from lsgp.io import safe_files
from lsgp.io.safe_files import is_same_file
from lsgp.run.named_files import Reads
from systems import make_link

# Arguments whose text is no file: folders, addresses, and options within an option.
NO_FILES = {"out", "scheduler", "options"}
CONTENT = b"of the user\n"
(COMMANDS,) = (action.choices for action in _parser()._actions if isinstance(action, argparse._SubParsersAction))
FILES = {name: [a for a in command._actions if isinstance(a, Reads)] for name, command in COMMANDS.items()}


def told(action: argparse.Action) -> str:
    """The argument as messages name it."""
    return action.option_strings[-1] if action.option_strings else action.metavar


def takes_any_text(action: argparse.Action) -> bool:
    if action.nargs is not None or action.choices is not None:
        return False
    try:
        return isinstance((action.type or str)("a path/named so.json"), str | Path)
    except (ValueError, argparse.ArgumentTypeError):
        return False


@pytest.mark.parametrize("name", COMMANDS)
def test_every_argument_that_may_name_a_file_is_declared_so(name: str) -> None:
    free = {action.dest for action in COMMANDS[name]._actions if takes_any_text(action)}
    assert free - NO_FILES == {action.dest for action in FILES[name]}


@pytest.mark.parametrize(
    ("name", "dest"),
    [("batch", "out"), *((name, action.dest) for name, files in FILES.items() for action in files)],
)
def test_an_empty_name_is_not_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str, dest: str
) -> None:
    """As of a variable of the shell that is not set."""
    monkeypatch.chdir(tmp_path)
    assert main(command_line(name, {"out": "results", dest: ""})) == 2
    assert "the name is empty" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


# Every argument that is written with every other one, but with what it completes; a batch writes into a folder.
PAIRS = [
    (name, one.dest, other.dest)
    for name, files in FILES.items()
    for one, other in combinations(files, 2)
    if (one.is_written or other.is_written) and not {told(one), told(other)} & {one.completed_by, other.completed_by}
]


def command_line(name: str, given: dict[str, str]) -> list[str]:
    """With these files, and further ones for the other arguments that are required."""
    line = [name]
    for action in COMMANDS[name]._actions:
        value = given.get(action.dest)
        if value is None and (action.required or action.dest == "output") and action.nargs != 0:
            value = "8" if action.type is float else f"further-{action.dest}.obj"
        if value is not None:
            line += [*action.option_strings[-1:], value]
    return line


def other_path(kind: str) -> str:
    """Another path to the file 'mine' in the working folder."""
    if kind == "hard link":
        os.link("mine", "other")
    elif kind == "symbolic link":
        make_link(Path("other"), "mine")
    elif kind == "linked folder":
        make_link(Path("here"), Path.cwd())
        return os.path.join("here", "mine")
    else:
        return {"same": "mine", "spelling": os.path.join("..", Path.cwd().name, "mine")}[kind]
    return "other"


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["same", "spelling", "symbolic link", "hard link", "linked folder"])
@pytest.mark.parametrize(("name", "one", "other"), PAIRS)
def test_no_argument_writes_over_the_file_of_another(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    name: str,
    one: str,
    other: str,
    kind: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine").write_bytes(CONTENT)
    path = other_path(kind)
    before = sorted(os.listdir())
    for given in ({one: "mine", other: path}, {one: path, other: "mine"}):
        assert main(command_line(name, given)) == 2
        said = capsys.readouterr().err
        if (name, {one, other}) == ("unwrap", {"input", "output"}):
            assert "the output" in said and "the input" in said and "--in-place" in said
        else:
            assert "are the same file" in said
            assert all(told(action) in said for action in FILES[name] if action.dest in (one, other))
        assert Path("mine").read_bytes() == CONTENT
        assert sorted(os.listdir()) == before


@pytest.mark.parametrize(
    "files", [["--seam-edges", "in.obj"], ["--report", "in.obj"], ["--report", "./in.obj", "-o", "in.obj"]]
)
def test_the_input_that_is_written_in_place_is_no_other_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], files: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("in.obj").write_bytes(CONTENT)
    assert main(["unwrap", "in.obj", "--in-place", *files]) == 2
    said = capsys.readouterr().err
    assert "IN 'in.obj'" in said and files[0] in said and "are the same file" in said
    assert Path("in.obj").read_bytes() == CONTENT


@pytest.mark.parametrize("named", ["output", "input", "uv"])
def test_mip_levels_are_written_over_no_file_that_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], named: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("out-mip2.png").write_bytes(CONTENT)
    files = {"input": "in.png", "uv": "in.obj", "output": "out.png"}
    if named == "output":
        make_link(Path("out.png"), "out-mip2.png")
    else:
        files[named] = "out-mip2.png"
    assert main([*command_line("pad", files), "--mips", "3"]) == 2
    said = capsys.readouterr().err
    assert "--mips 'out-mip2.png'" in said and "are the same file" in said
    assert Path("out-mip2.png").read_bytes() == CONTENT


def gltf_with(buffer: str, image: str) -> bytes:
    """A triangle whose data is in one file and whose image is another."""
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    content = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": buffer, "byteLength": 60}],
        "images": [{"uri": image}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [
            {"bufferView": view, "componentType": 5126, "count": 3, "type": kind}
            for view, kind in enumerate(("VEC3", "VEC2"))
        ],
        "meshes": [{"primitives": [{"attributes": attributes}]}],
    }
    return json.dumps(content).encode()


CORNERS = np.array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1], "<f4").tobytes()
OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
PLY = b"ply\nformat ascii 1.0\ncomment TextureFile the file\nelement vertex 3\nproperty float x\nproperty float y\n"
PLY += b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
PLY += b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
REFERRING = {
    "buffer": ("in.gltf", gltf_with("the%20file", "image.png")),
    "image": ("in.gltf", gltf_with("data.bin", "the%20file")),
    "materials": ("in.obj", b"# mtllib\nmtllib the file\n" + OBJ),
    "second materials": ("in.obj", b"mtllib other.mtl the_file\r\n" + OBJ),
    "texture": ("in.ply", PLY),
}


@pytest.mark.parametrize("kind", REFERRING)
@pytest.mark.parametrize("command", ["unwrap", "cones", "quads", "measure"])
def test_nothing_is_written_over_a_file_that_the_input_refers_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], command: str, kind: str
) -> None:
    monkeypatch.chdir(tmp_path)
    name, content = REFERRING[kind]
    if command == "measure" and name == "in.ply":
        pytest.skip("PLY is not measured")
    (tmp_path / "data.bin").write_bytes(CORNERS)
    referred = Path("the_file" if kind == "second materials" else "the file")
    referred.write_bytes(CORNERS)
    make_link(Path("link.json"), str(referred))
    Path(name).write_bytes(content)
    before = {path: path.read_bytes() for path in Path().iterdir()}
    output = [] if command == "measure" else ["-o", "out.json" if command == "cones" else "out.obj"]
    wanted = ["--target", "8"] if command == "quads" else []
    for report in (str(referred), "link.json"):
        assert main([command, name, *output, *wanted, "--report", report]) == 2
        assert f"--report '{report}' is a file that '{name}' refers to" in capsys.readouterr().err
    if command == "cones":
        assert main([command, name, "-o", str(referred)]) == 2
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


def test_the_last_value_of_an_option_counts(cube_files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(cube_files)
    line = ["unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "corners.json"]
    assert main(line) == 2
    assert main([*line, "--report", "report.json"]) == 0
    assert main([*line, "--cones", "auto"]) == 0


def test_the_null_device_takes_several_files(cube_files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(cube_files)
    assert main(["unwrap", "cube.obj", "-o", os.devnull, "--format", "obj", "--report", os.devnull]) == 0


def test_names_that_differ_in_case_alone_are_one_file_where_the_folder_ignores_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pairs = [("out.obj", "Out.OBJ"), ("stra\u00dfe", "STRASSE"), ("\u00e9", "e\u0301")]
    for ignores, (one, other) in product((False, True), pairs):
        monkeypatch.setattr(safe_files, "ignores_case", lambda folder, ignores=ignores: ignores)
        assert is_same_file(tmp_path / one, tmp_path / other) == (ignores or (os.name == "nt" and one == "out.obj"))
        assert not is_same_file(tmp_path / one, tmp_path / "another")
        assert not is_same_file(tmp_path / one, tmp_path / "folder" / one)


def test_whether_a_folder_ignores_case_is_seen_at_its_names(tmp_path: Path) -> None:
    folder = tmp_path / "Mixed" / "12"
    folder.mkdir(parents=True)
    sees = not (tmp_path / "mIXED").exists()
    assert safe_files.ignores_case(folder) == (not sees)
    if sees:
        make_link(tmp_path / "mIXED", "Mixed")
        assert safe_files.ignores_case(folder)
