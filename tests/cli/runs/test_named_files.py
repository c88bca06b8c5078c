# SPDX-License-Identifier: GPL-3.0-or-later
"""No command writes over a file that another of its arguments names, whatever the arguments are."""

from __future__ import annotations

import argparse
import os
from itertools import combinations, product
from pathlib import Path

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
