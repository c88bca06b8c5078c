# SPDX-License-Identifier: GPL-3.0-or-later
"""The templates for farms: accepted by the validator, and a dry run of their tasks."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from nightly import nightly

FARM = Path(__file__).resolve().parents[2] / "examples" / "job_templates"
ASSETS = ["cube.off", "deep/ball two.off", "deep/ball.off", "moebius.off", "patch.off"]

# What Flamenco Manager gives to job types, as far as ours uses it.
AUTHOR = """
const author = {
    Task: (name, type) => ({
        name, type, commands: [], dependencies: [],
        addCommand(command) { this.commands.push(command); },
        addDependency(task) { this.dependencies.push(task.name); },
    }),
    Command: (name, parameters) => ({ name, parameters }),
};
function compiled(settings) {
    const tasks = [];
    compileJob({ settings: JSON.parse(settings), addTask(task) { tasks.push(task); } });
    return JSON.stringify(tasks);
}
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program that is lsgp, at a path with a space in it."""
    path = tmp_path / "a program"
    path.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m lsgp "$@"\n')
    path.chmod(0o755)
    return path


# Each is a command for a shell that takes it apart, and would leave a file behind.
HOSTILE = [
    "`touch stolen`; touch stolen #",
    "two\nlines\ntouch stolen",
    "\\ back ${HOME} %PATH% {{Param.Options}}",
    *nightly(
        "$(touch stolen)",
        "a \"quoted\" 'name' && touch stolen",
        "-rf --out=stolen",
        "längs ✂ \u00a0日本",
    ),
]


@pytest.fixture(params=HOSTILE)
def hostile(request: pytest.FixtureRequest, tmp_path: Path, library: Path) -> tuple[Path, Path]:
    """A library and a folder of results with such names; a single mesh suffices."""
    if os.name == "nt" and set('"\n\\') & set(request.param):
        pytest.skip("Windows has no such names")
    source = tmp_path / f"in {request.param}"
    source.mkdir()
    (library / "cube.off").rename(source / f"{request.param}.off")
    return source, tmp_path / request.param


def require_untouched(tmp_path: Path, out: Path, lines_in) -> None:
    assert {line["status"] for line in lines_in(out / "journal-1-of-1.jsonl")} == {"ok"}
    assert not [path for path in tmp_path.rglob("*") if path.name.startswith("stolen")]
    assert not Path("stolen").exists()


def require_whole(out: Path, lines_in, shards: int) -> None:
    lines = [line for i in range(1, shards + 1) for line in lines_in(out / f"journal-{i}-of-{shards}.jsonl")]
    assert sorted(line["asset"] for line in lines) == ASSETS
    assert (out / "journal.jsonl").read_bytes() == b""
    assert (out / "summary.txt").read_text().startswith("5 assets\n")
    results = {path.relative_to(out).as_posix() for path in out.rglob("*.obj")}
    assert results == {f"{name}.obj" for name in ASSETS if name != "moebius.off"}


@pytest.mark.slow
def test_flamenco_job_type(library: Path, program: Path, lines_in) -> None:
    quickjs = pytest.importorskip("quickjs")
    script = quickjs.Context()
    script.eval(AUTHOR + (FARM / "cone_unwrap.js").read_text())
    kinds = {setting["key"]: setting for setting in json.loads(script.eval("JSON.stringify(JOB_TYPE.settings)"))}
    assert all(setting["type"] in ("string", "int32", "float", "bool") for setting in kinds.values())
    settings = {key: setting["default"] for key, setting in kinds.items() if "default" in setting}
    assert settings.keys() | {"source", "results"} == kinds.keys()
    out = library.parent / "the results"
    settings |= {"source": str(library), "results": str(out), "shards": 3, "program": str(program)}
    settings |= {"options": "--jobs 1  --cones 'auto'"}
    *parts, whole = json.loads(script.get("compiled")(json.dumps(settings)))
    assert len(parts) == 3
    assert whole["dependencies"] == [task["name"] for task in parts]
    for task in (*parts, whole):
        (command,) = task["commands"]
        assert command["name"] == "exec"
        subprocess.run([command["parameters"]["exe"], *command["parameters"]["args"]], check=True, timeout=120)
    require_whole(out, lines_in, 3)


@pytest.mark.slow
def test_flamenco_job_type_with_names_that_are_commands(
    hostile: tuple[Path, Path], program: Path, tmp_path: Path, lines_in
) -> None:
    quickjs = pytest.importorskip("quickjs")
    script = quickjs.Context()
    script.eval(AUTHOR + (FARM / "cone_unwrap.js").read_text())
    source, out = hostile
    settings = {"source": str(source), "results": str(out), "shards": 1, "program": str(program), "options": "--jobs 1"}
    for task in json.loads(script.get("compiled")(json.dumps(settings))):
        (command,) = task["commands"]
        parameters = command["parameters"]
        subprocess.run([parameters["exe"], *parameters["args"]], cwd=tmp_path, check=True, timeout=120)
    require_untouched(tmp_path, out, lines_in)


@pytest.mark.slow
def test_openjd_job_template_with_names_that_are_commands(
    hostile: tuple[Path, Path], program: Path, tmp_path: Path, lines_in
) -> None:
    pytest.importorskip("openjd.cli")
    source, out = hostile
    command = [sys.executable, "-m", "openjd", "run", str(FARM / "cone_unwrap.openjd.yaml"), "--run-dependencies"]
    command += ["--step", "Summary"]
    values = {"Source": source, "Results": out, "Shards": 1, "Program": program, "Options": "--jobs 1"}
    parameters = tmp_path / "parameters.json"
    parameters.write_text(json.dumps({name: str(value) for name, value in values.items()}))
    command += ["-p", f"file://{parameters}"]  # a line break does not go through its command line
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stdout + done.stderr
    require_untouched(tmp_path, out, lines_in)


def test_options_in_one_argument_go_through_no_shell(batch, library: Path, lines_in) -> None:
    done = batch("--options=--jobs 1 --reports --no-pictures", "--out=--out", "--", library)
    assert done.returncode == 4, done.stderr
    assert (library.parent / "--out" / "cube.off.obj.report.json").is_file()
    for text, said in (("--jobs 'x", "No closing quotation"), ("--jobs $(id)", "$(id)"), ("x; y", "unrecognized")):
        done = batch("--options", text, "--out", "other", library)
        assert done.returncode == 2 and said in done.stderr
        assert not (library.parent / "other").exists()


@pytest.mark.slow
def test_openjd_job_template(library: Path, program: Path, lines_in) -> None:
    pytest.importorskip("openjd.cli")
    template = str(FARM / "cone_unwrap.openjd.yaml")
    openjd = [sys.executable, "-m", "openjd"]
    checked = subprocess.run([*openjd, "check", template], capture_output=True, text=True, timeout=60)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    out = library.parent / "the results"
    parameters = {
        "Source": library,
        "Results": out,
        "Shards": 2,
        "Program": program,
        "Options": "--jobs 1  --cones 'auto'",
    }
    command = [*openjd, "run", template, "--step", "Summary", "--run-dependencies"]
    for name, value in parameters.items():
        command += ["-p", f"{name}={value}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stdout + done.stderr
    require_whole(out, lines_in, 2)
