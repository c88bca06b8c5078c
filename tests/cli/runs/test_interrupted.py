# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress on a terminal, and what a run leaves behind that is interrupted or asked to end: files as they were, and
exit code 130 or that of the signal."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import lsgp as library
import pytest
from lsgp.cli import main
from lsgp.run import terminal
from lsgp.run.terminal import BAR_WIDTH, SILENT_SECONDS, ProgressLine
from polygon_meshes import cube, obj_text

BALL = ["unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json"]
RUNS = {"conformal": BALL, "seamless": [*BALL, "--seamless", "--tiles", "16"], "placed": [*BALL, "--cones", "auto"]}

# The command line with progress from the beginning.
AT_ONCE = (
    "import sys; from lsgp import cli; from lsgp.run import terminal; "
    "terminal.SILENT_SECONDS = 0; sys.exit(cli.main(sys.argv[1:]))"
)


class Terminal(io.StringIO):
    """What a terminal was sent, and what it shows: a carriage return goes back to the line's first column."""

    def isatty(self) -> bool:
        return True

    @property
    def shown(self) -> list[str]:
        return screen(self.getvalue())


def screen(sent: str) -> list[str]:
    lines = []
    for text in sent.replace("\r\n", "\n").split("\n"):
        line = ""
        for part in text.split("\r"):
            line = part + line[len(part) :]
        lines.append(line.rstrip())
    return lines


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Stops the clock of progress; the function lets some seconds pass."""
    now = 1000.0

    def wait(seconds: float) -> None:
        nonlocal now
        now += seconds

    monkeypatch.setattr(terminal.time, "monotonic", lambda: now)
    return wait


# --- the line of progress -------------------------------------------------------------------------------------------


def test_progress_is_one_line_that_is_wiped(clock: Callable[[float], None]) -> None:
    out = Terminal()
    with ProgressLine(out) as progress:
        clock(2 * SILENT_SECONDS)
        filled = []
        for percent in range(0, 101, 5):
            progress(percent / 100)
            (line,) = out.shown
            assert line.endswith(f" {percent} %") and len(line) < 60
            filled.append(line.count("#"))
        assert filled == sorted(filled)
        assert (filled[0], filled[-1]) == (0, BAR_WIDTH)
    assert out.shown == [""]
    assert "\n" not in out.getvalue()


def test_runs_shorter_than_half_a_second_show_none(clock: Callable[[float], None]) -> None:
    out = Terminal()
    with ProgressLine(out) as progress:
        progress(0)
        clock(0.9 * SILENT_SECONDS)
        progress(0.9)
        assert out.getvalue() == ""
        clock(0.2 * SILENT_SECONDS)
        progress(0.91)
        assert out.shown[0].endswith("91 %")
    with ProgressLine(short := Terminal()) as progress:
        progress(1)
    assert short.getvalue() == ""


def test_files_and_pipes_get_no_progress(clock: Callable[[float], None]) -> None:
    with ProgressLine(out := io.StringIO()) as progress:
        clock(9 * SILENT_SECONDS)
        progress(0.5)
    assert out.getvalue() == ""


def test_same_progress_is_not_written_again(clock: Callable[[float], None]) -> None:
    with ProgressLine(out := Terminal()) as progress:
        clock(9 * SILENT_SECONDS)
        for _ in range(1000):
            progress(0.5)
    assert out.getvalue().count("50 %") == 1


def test_a_terminal_that_has_gone_stops_nothing(clock: Callable[[float], None]) -> None:
    class Gone(Terminal):
        def write(self, text: str) -> int:
            raise OSError(5, "Input/output error")

    with ProgressLine(Gone()) as progress:
        clock(9 * SILENT_SECONDS)
        progress(0.5)


# --- interrupted ----------------------------------------------------------------------------------------------------


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def interrupt_at(call: int, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Lets Ctrl-C be pressed when progress is told for the call-th time, from 1; returns what is told."""
    told: list[float] = []

    def parameterize(*arguments: object, progress: library.api.Progress, **options: object) -> library.Result:
        def tell(done: float) -> bool | None:
            told.append(done)
            if len(told) == call:
                signal.raise_signal(signal.SIGINT)
            return progress(done)

        return library.parameterize(*arguments, progress=tell, **options)

    monkeypatch.setattr("lsgp.run.unwrap_file.parameterize", parameterize)
    return told


@pytest.mark.parametrize("name", RUNS)
def test_interrupted_at_any_progress_files_stay_as_they_were(
    ball_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    monkeypatch.chdir(ball_files)
    for file in ("out.obj", "report.json"):
        Path(file).write_text(f"the {file} of another run")
    before = content(ball_files)
    told = interrupt_at(0, monkeypatch)
    assert main(RUNS[name]) == 0
    assert content(ball_files).keys() == before.keys()
    assert all(content(ball_files)[file] != before[file] for file in ("out.obj", "report.json"))
    for file, old in before.items():
        Path(file).write_bytes(old)
    capsys.readouterr()
    for call in range(1, len(told) + 1):
        interrupted = interrupt_at(call, monkeypatch)
        assert main(RUNS[name]) == 130
        assert interrupted == told[:call]
        captured = capsys.readouterr()
        assert (captured.out, captured.err) == ("", "lsgp: interrupted\n")
        assert content(ball_files) == before


@pytest.mark.parametrize("fails", ["os.replace", "shutil.copymode"])
def test_interrupted_while_writing_leaves_no_half_a_file(
    ball_files: Path, monkeypatch: pytest.MonkeyPatch, fails: str
) -> None:
    monkeypatch.chdir(ball_files)
    Path("out.obj").write_text("before")
    before = content(ball_files)
    monkeypatch.setattr(f"lsgp.io.whole_files.{fails}", lambda *paths: signal.raise_signal(signal.SIGINT))
    assert main(BALL) == 130
    assert content(ball_files) == before


# Half of a file is written when the process is asked to end.
ASKED_WHILE_WRITING = """
import os, signal, sys
from lsgp import cli
from lsgp.io import whole_files

def write_half(path, data):
    with path.open("xb") as file:
        file.write(data[: len(data) // 2])
        file.flush()
        os.kill(os.getpid(), getattr(signal, sys.argv[1]))
        file.write(data[len(data) // 2 :])

whole_files._write_new = write_half
sys.exit(cli.main(sys.argv[2:]))
"""


@pytest.mark.skipif(os.name != "posix", reason="Windows sends no such requests")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
@pytest.mark.parametrize("in_place", [False, True])
def test_asked_to_end_while_writing_files_stay_as_they_were(ball_files: Path, name: str, in_place: bool) -> None:
    (ball_files / "out.obj").write_text("before")
    before = content(ball_files)
    command = [*BALL, "-o", "ball.obj", "--in-place"] if in_place else BALL
    done = subprocess.run(
        [sys.executable, "-c", ASKED_WHILE_WRITING, name, *command], cwd=ball_files, capture_output=True, text=True
    )
    assert done.returncode == 128 + getattr(signal, name)
    assert (done.stdout, done.stderr) == ("", "lsgp: asked to end\n")
    assert content(ball_files) == before


@pytest.mark.skipif(os.name != "posix", reason="Windows sends no such requests")
def test_requests_that_are_ignored_or_heard_by_the_program_are_left_to_it(
    ball_files: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ball_files)
    heard = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number))
    try:
        monkeypatch.setattr(
            "lsgp.run.unwrap_file.read_input", lambda path: [signal.raise_signal(signal.SIGTERM), path.read_bytes()][1]
        )
        assert main(BALL) == 0
    finally:
        signal.signal(signal.SIGTERM, before)
    assert heard == [signal.SIGTERM]
    assert signal.getsignal(signal.SIGHUP) == signal.SIG_DFL


def test_measuring_can_be_interrupted(ball_files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ball_files)
    monkeypatch.setattr("lsgp.run.unwrap_file.read_input", lambda *arguments: signal.raise_signal(signal.SIGINT))
    assert main(["measure", "ball.obj", "--report", "report.json"]) == 130
    assert not Path("report.json").exists()


@pytest.mark.slow
def test_ctrl_c_on_a_terminal(tmp_path: Path) -> None:
    """A process whose errors go to a terminal: progress appears, Ctrl-C wipes it and ends the run."""
    pty = pytest.importorskip("pty")
    positions, faces = cube(60)
    positions[:, 2] += 0.3 * positions[:, 0] ** 2
    (tmp_path / "in.obj").write_text(obj_text(positions, faces))
    (tmp_path / "out.obj").write_text("before")
    before = content(tmp_path)
    terminal_end, process_end = pty.openpty()
    command = [sys.executable, "-c", AT_ONCE, "unwrap", "in.obj", "-o", "out.obj", "--seamless"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=process_end)
    os.close(process_end)
    sent = b""
    while b"%" not in sent:
        sent += os.read(terminal_end, 1000)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=120)
    while part := read_rest(terminal_end):
        sent += part
    os.close(terminal_end)
    assert (process.returncode, out) == (130, b"")
    assert screen(sent.decode()) == ["lsgp: interrupted", ""]
    assert content(tmp_path) == before


def read_rest(descriptor: int) -> bytes:
    try:
        return os.read(descriptor, 1000)
    except OSError:  # how Linux says that nobody is left at the other end
        return b""
