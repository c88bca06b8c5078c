# SPDX-License-Identifier: GPL-3.0-or-later
"""Standard input and output, and closed, full, missing or endless streams: one plain message and an exit."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from polygon_meshes import cube, off_text

RUN = ["unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "r.json"]
needs_posix = pytest.mark.skipif(os.name != "posix", reason="a shell's redirections of POSIX")


def shell(folder: Path, redirection: str, *arguments: str) -> subprocess.CompletedProcess[bytes]:
    """Without PYTHONUNBUFFERED, with which argparse passes over what it cannot print."""
    command = ["sh", "-c", f'exec "$0" -m lsgp "$@" {redirection}', sys.executable, *arguments]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=120)


def test_from_standard_input_to_standard_output(cube_files: Path, lsgp) -> None:
    assert lsgp(*RUN).code == 0
    command = [sys.executable, "-m", "lsgp", "unwrap", "-", "-o", "-", "--cones", "corners.json"]
    data = (cube_files / "cube.obj").read_bytes()
    done = subprocess.run(command, cwd=cube_files, input=data, capture_output=True, timeout=120)
    assert done.returncode == 0
    assert done.stdout == (cube_files / "out.obj").read_bytes()
    assert b"quasi-conformal" in done.stderr and done.stderr.startswith(b"-: 192 of 192 triangles unwrapped")


@pytest.mark.slow
def test_a_format_that_the_first_bytes_tell_needs_no_option(cube_files: Path, lsgp) -> None:
    positions, faces = cube(4)
    data = off_text(positions / 3, faces).encode()
    assert lsgp(*RUN).code == 0
    command = [sys.executable, "-m", "lsgp", "unwrap", "-", "-o", "-", "--cones", "corners.json"]
    done = subprocess.run(command, cwd=cube_files, input=data, capture_output=True, timeout=120)
    assert done.stdout == (cube_files / "out.obj").read_bytes()
    (cube_files / "off").write_bytes(data)
    assert lsgp("unwrap", "off", "-o", "named", "--cones", "corners.json").code == 0
    assert (cube_files / "named").read_bytes() == done.stdout
    (cube_files / "obj").write_bytes((cube_files / "cube.obj").read_bytes())
    assert lsgp("unwrap", "obj", "-o", "named").code == 3
    assert lsgp("unwrap", "obj", "-o", "named", "--format", "obj").code == 0


@pytest.mark.slow
def test_cones_and_measures_go_through_streams_too(cube_files: Path, lsgp) -> None:
    data = (cube_files / "cube.obj").read_bytes()
    command = [sys.executable, "-m", "lsgp", "cones", "-", "-o", "-", "--count", "8"]
    done = subprocess.run(command, cwd=cube_files, input=data, capture_output=True, timeout=120)
    assert (done.returncode, len(json.loads(done.stdout)["cones"])) == (0, 8)
    assert lsgp(*RUN).code == 0
    mapped = (cube_files / "out.obj").read_bytes()
    done = subprocess.run(
        [sys.executable, "-m", "lsgp", "measure", "-"], cwd=cube_files, input=mapped, capture_output=True, timeout=120
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(b"-: 192 of 192 triangles measured")


def require_plain_end(done: subprocess.CompletedProcess[bytes], said: bytes) -> None:
    assert done.returncode == 2
    assert done.stderr.count(b"\n") == 1 and done.stderr.startswith(b"lsgp: error: ") and said in done.stderr


@needs_posix
def test_messages_on_a_full_disk_leave_the_files_and_end_with_2(cube_files: Path) -> None:
    require_plain_end(shell(cube_files, ">/dev/full", *RUN), b"standard output")
    assert json.loads((cube_files / "r.json").read_text())["status"] == "ok"
    assert (cube_files / "out.obj").exists()


@needs_posix
@pytest.mark.parametrize("redirection", [">&-", ">/dev/full"])
def test_a_mesh_that_cannot_be_printed_ends_with_2(cube_files: Path, redirection: str) -> None:
    done = shell(cube_files, redirection, "unwrap", "cube.obj", "-o", "-", "--cones", "corners.json")
    require_plain_end(done, b"standard output")


@needs_posix
def test_a_mesh_whose_reader_has_gone_ends_with_2(cube_files: Path) -> None:
    read_end, write_end = os.pipe()
    os.close(read_end)
    command = [sys.executable, "-m", "lsgp", "unwrap", "cube.obj", "-o", "-", "--cones", "corners.json"]
    done = subprocess.run(command, cwd=cube_files, stdout=write_end, stderr=subprocess.PIPE, timeout=120)
    os.close(write_end)
    require_plain_end(done, b"Broken pipe")


@pytest.mark.slow
@needs_posix
@pytest.mark.parametrize("redirection", [">&-", "2>&-", "2>/dev/full", "<&-", "<&- 2>&-", "<&- >&- 2>&-"])
def test_closed_streams_change_nothing(cube_files: Path, redirection: str) -> None:
    done = shell(cube_files, redirection, *RUN)
    assert (done.returncode, done.stderr) == (0, b"")
    assert (b"quasi-conformal" in done.stdout) == (" >&-" not in f" {redirection}")
    text = (cube_files / "out.obj").read_text()
    assert text.count("\nf ") == 96 and "lsgp" not in text


@pytest.mark.slow
@needs_posix
@pytest.mark.parametrize("redirection", ["2>&-", "2>/dev/full", ">&- 2>&- <&-"])
def test_exit_codes_do_not_depend_on_being_heard(cube_files: Path, redirection: str) -> None:
    assert shell(cube_files, redirection, "unwrap", "none.obj", "-o", "out.obj").returncode == 2
    assert shell(cube_files, redirection, "unwrap", "cube.obj", "-o", "out.obj", "--cones", "auto:0").returncode == 3
    assert shell(cube_files, redirection, "unwrap").returncode == 2


@pytest.mark.slow
@needs_posix
@pytest.mark.parametrize("arguments", [["--version"], ["--formats"], ["--help"], ["unwrap", "--help"]])
def test_information_that_cannot_be_printed_ends_with_2(cube_files: Path, arguments: list[str]) -> None:
    require_plain_end(shell(cube_files, ">/dev/full", *arguments), b"standard output")


@needs_posix
def test_closed_standard_input_is_said(cube_files: Path) -> None:
    require_plain_end(shell(cube_files, "<&-", "unwrap", "-", "-o", "out.obj"), b"standard input")


@pytest.mark.slow
@needs_posix
@pytest.mark.parametrize("use", ["input", "output", "report", "cones", "importance"])
def test_pipes_by_name_are_refused_at_once(cube_files: Path, lsgp, use: str) -> None:
    os.mkfifo(cube_files / "pipe.obj")
    arguments = {
        "input": ["pipe.obj", "-o", "out.obj"],
        "output": ["cube.obj", "-o", "pipe.obj"],
        "report": ["cube.obj", "-o", "out.obj", "--report", "pipe.obj"],
        "cones": ["cube.obj", "-o", "out.obj", "--cones", "pipe.obj"],
        "importance": ["cube.obj", "-o", "out.obj", "--mode", "low-stretch", "--importance", "pipe.obj"],
    }
    done = lsgp("unwrap", *arguments[use])
    assert (done.code, "Not a regular file" in done.err, "pipe.obj" in done.err) == (2, True, True)
    assert not (cube_files / "out.obj").exists()


@needs_posix
@pytest.mark.parametrize("use", ["output", "report"])
def test_standard_output_that_is_a_pipe_is_refused_by_name_at_once(cube_files: Path, use: str) -> None:
    if not os.path.exists("/dev/stdout"):
        pytest.skip("no /dev/stdout here")
    paths = {"output": ["-o", "/dev/stdout"], "report": ["-o", "out.obj", "--report", "/dev/stdout"]}
    done = shell(cube_files, "", "unwrap", "cube.obj", *paths[use], "--cones", "corners.json", "--format", "obj")
    assert (done.returncode, done.stdout, b"Not a regular file" in done.stderr) == (2, b"", True)
    assert b"'/dev/stdout'" in done.stderr and not (cube_files / "out.obj").exists()


@needs_posix
def test_endless_devices_are_refused(cube_files: Path, lsgp) -> None:
    done = lsgp("unwrap", "/dev/zero", "-o", "out.obj", "--format", "obj")
    assert (done.code, "Not a regular file" in done.err) == (2, True)


@needs_posix
@pytest.mark.parametrize("name", ["a\x1b[2Jb.obj", "a\x07.obj", "a\r.obj", "a\x9b2J.obj", "a\x7f.obj"])
def test_a_name_does_not_command_the_terminal(cube_files: Path, lsgp, name: str) -> None:
    (cube_files / name).write_bytes((cube_files / "cube.obj").read_bytes())
    corners = ("--cones", "corners.json")
    for arguments in ((name, "-o", "out.obj"), ("cube.obj", "-o", name), ("none" + name, "-o", "out.obj")):
        done = lsgp("unwrap", *arguments, *corners)
        assert all(line.isprintable() for line in (done.out + done.err).split("\n"))
        assert (name in arguments[::2]) == (done.code == 0)
