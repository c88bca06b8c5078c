# SPDX-License-Identifier: GPL-3.0-or-later
"""A run from the list to the summary: the bytes of single runs, a line per asset, exit codes, shards, side files."""

from __future__ import annotations

import json
import os
import re
import shutil
import statistics
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
from batch_meshes import off_text
from lsgp.batch.assets import Asset
from lsgp.batch.progress import RunProgress
from lsgp.batch.records import EMPTY
from lsgp.cli import main
from meshes import cube, grid, merge, moebius_strip

ASSETS = ["cube.off", "deep/ball two.off", "deep/ball.off", "moebius.off", "patch.off"]
RESULTS = [name for name in ASSETS if name != "moebius.off"]


def files_in(folder: Path, suffix: str) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob(f"*{suffix}")}


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--seamless", "--tiles", "6", "--cones", "auto:8"],
        ["--seamless", "--tiles", "6", "--features", "crease:60,borders"],
    ],
)
def test_same_bytes_as_single_runs_and_a_line_an_asset(batch, lines_in, library: Path, options: list[str]) -> None:
    done = batch("library", "--out", "out", "--jobs", 2, *options)
    assert (done.returncode, done.stderr) == (4, "")
    out = library.parent / "out"
    lines = {line["asset"]: line for line in lines_in(out / "journal.jsonl")}
    assert sorted(lines) == ASSETS
    results = {}
    for name in ASSETS:
        single = library.parent / "single.obj"
        code = main(["unwrap", str(library / name), "-o", str(single), *options])
        line = lines[name]
        assert list(line) == list(EMPTY)
        if code == 0:
            results[f"{name}.obj"] = single.read_bytes()
            assert (line["status"], line["code"], line["output"]) == ("ok", None, f"{name}.obj")
            assert line["distortion"]["l2_stretch"] >= 1 - 1e-9
            assert min(line["seconds"], line["triangles"], line["input_bytes"]) > 0
        else:
            assert (line["status"], line["code"], line["output"]) == ("refused", "NOT_ORIENTABLE", None)
    assert files_in(out, ".obj") == results
    assert not list(out.rglob("*.partial"))


@pytest.mark.slow
def test_exit_codes_of_all_some_and_none(batch, library: Path) -> None:
    for name, listed, code in (
        ("all", RESULTS, 0),
        ("some", ["patch.off", "gone.off", "moebius.off"], 4),
        ("none", ["moebius.off", "gone.off"], 3),
    ):
        (library / "list.txt").write_text("\n".join(listed))
        done = batch("library/list.txt", "--out", name)
        assert (done.returncode, done.stderr) == (code, "")
        assert done.stdout.startswith(f"{len(listed)} assets\n")
        assert re.search(rf"^results +{code != 3 and len(set(listed) & set(RESULTS))}$", done.stdout, re.M) or code == 3


def test_no_empty_folders_stay_behind(batch, tmp_path: Path) -> None:
    folder = tmp_path / "library"
    for name, mesh in {"good/cube.off": cube(2), "bad/moebius.off": moebius_strip()}.items():
        (folder / name).parent.mkdir(parents=True)
        (folder / name).write_text(off_text(mesh))
    assert batch("library", "--out", "out", "--no-pictures").returncode == 4
    assert [path.name for path in (tmp_path / "out").iterdir() if path.is_dir()] == ["good"]


def test_warnings_of_one_kind_are_added_up(batch, lines_in, tmp_path: Path) -> None:
    strip = moebius_strip()
    both = merge([grid(3, 3), strip, strip])
    (tmp_path / "both.off").write_text(off_text(both))
    assert batch("both.off", "--out", "out", "--no-pictures").returncode == 4
    (line,) = lines_in(tmp_path / "out" / "journal.jsonl")
    assert line["warnings"]["COMPONENT_SKIPPED"] == 2 * len(strip.triangles)
    assert (line["status"], line["missing_faces"]) == ("ok", 2 * len(strip.triangles))
    summary = (tmp_path / "out" / "summary.txt").read_text()
    assert f"most {line['missing_area_percent']:.3g} % of the area: both.off" in summary
    assert "with faces left out" in summary


def test_the_summary_has_a_line_for_each_of_several_folders(batch, lines_in, tmp_path: Path) -> None:
    folder = tmp_path / "library"
    sizes = {"flat/small": 1, "flat/middle": 2, "flat/large": 4, "round": 3}
    for name, mesh in {name: merge([grid(3, 3)] * size) for name, size in sizes.items()}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.off").write_text(off_text(mesh))
    (folder / "flat" / "none.off").write_text("OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n")
    done = batch("library", "--out", "out", "--no-pictures", "--preset", "paint")
    lines = {line["asset"]: line for line in lines_in(tmp_path / "out" / "journal.jsonl")}
    inside = [lines[f"{name}.off"] for name in ("flat/small", "flat/middle", "flat/large")]
    assert [line["islands"] for line in inside] == [1, 2, 4]
    rows = dict(line.split(maxsplit=1) for line in done.stdout.splitlines() if line.startswith(("flat ", ". ")))
    flat, other = rows["flat"].split(), rows["."].split()
    assert flat[:2] == ["4", "3"] and other[:2] == ["1", "1"]
    assert flat[4:6] == ["2", "4"] and other[4:6] == ["3", "3"]
    assert flat[6] == f"{statistics.median(line['coverage'] for line in inside):.2f}"
    assert flat[8] == f"{max(line['distortion']['l2_stretch'] for line in inside):.3f}"


def test_the_summary_of_one_folder_has_no_lines_for_folders(batch, library: Path) -> None:
    assert "folder, medians" not in batch("library/cube.off", "--out", "one").stdout


@pytest.mark.skipif(os.name == "nt", reason="names of files of POSIX")
def test_names_end_no_line_of_the_summary(batch, tmp_path: Path) -> None:
    for name in ("odd\nresults 9/a.off", "plain/none\x1b[2J\n.off"):
        path = tmp_path / "library" / name
        path.parent.mkdir(parents=True)
        path.write_text(off_text(grid(3, 3)) if path.name == "a.off" else "OFF\n")
    done = batch("library", "--out", "out", "--no-pictures", "--preset", "paint")
    summary = (tmp_path / "out" / "summary.txt").read_text()
    for text in (done.stdout, summary):
        assert all(line.isprintable() for line in text.split("\n"))
    folders = summary.splitlines()[-2:]
    assert [line.split("  ")[0] for line in folders] == ["odd\\x0aresults 9", "plain"]


WRONG_USAGE = {
    "no source": (["nowhere", "--out", "out"], "nowhere"),
    "no assets": (["empty", "--out", "out"], "has no assets"),
    "no out": (["library"], "--out"),
    "out in a file": (["library", "--out", "library/cube.off"], "cube.off"),
    "no jobs": (["library", "--out", "out", "--jobs", "0"], "whole number"),
    "no time": (["library", "--out", "out", "--timeout", "0"], "number of seconds"),
    "shard outside": (["library", "--out", "out", "--shard", "3/2"], "from 1 to n"),
    "options that do not go together": (["library", "--out", "out", "--tiles", "4"], "add --seamless"),
    "missing cones": (["library", "--out", "out", "--cones", "none.json"], "none.json"),
}


@pytest.mark.parametrize("name", WRONG_USAGE)
def test_wrong_usage_ends_with_2_before_any_work(
    library: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    arguments, said = WRONG_USAGE[name]
    monkeypatch.chdir(library.parent)
    Path("empty").mkdir()
    assert main(["batch", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert not list(Path("out").glob("journal*"))


@pytest.mark.slow
def test_file_that_is_missing_is_told_and_tried_again(batch, lines_in, library: Path) -> None:
    (library / "list.txt").write_text("patch.off\nlate.off\n")
    assert batch("library/list.txt", "--out", "out").returncode == 4
    journal = library.parent / "out" / "journal.jsonl"
    (line,) = (line for line in lines_in(journal) if line["asset"] == "late.off")
    assert (line["status"], line["code"]) == ("failed", "FILE_ERROR")
    assert "late.off" in line["message"]
    shutil.copy(library / "cube.off", library / "late.off")
    assert batch("library/list.txt", "--out", "out", "--only-missing").returncode == 0
    assert [line["asset"] for line in lines_in(journal)].count("patch.off") == 1


@pytest.mark.slow
def test_only_missing_does_what_has_no_result(batch, lines_in, library: Path) -> None:
    assert batch("library", "--out", "out").returncode == 4
    journal = library.parent / "out" / "journal.jsonl"
    (library.parent / "out" / "cube.off.obj").unlink()
    (library / "new.off").write_text(off_text(cube(2)))
    done = batch("library", "--out", "out", "--only-missing")
    assert done.returncode == 4
    assert done.stdout.startswith("6 assets\n")
    assert "\n2 of them in this run" in done.stdout
    assert sorted(line["asset"] for line in lines_in(journal)[5:]) == ["cube.off", "new.off"]
    before = journal.read_bytes()
    assert batch("library", "--out", "out", "--only-missing").returncode == 4
    assert journal.read_bytes() == before


@pytest.mark.slow
def test_only_missing_does_not_mix_options(batch, library: Path) -> None:
    assert batch("library", "--out", "out").returncode == 4
    other = batch("library", "--out", "out", "--only-missing", "--border", "straight")
    assert (other.returncode, "other options" in other.stderr) == (2, True)
    assert batch("library", "--out", "out", "--border", "straight").returncode == 4


@pytest.mark.slow
def test_shards_together_are_the_whole(batch, library: Path, lines_in) -> None:
    out = library.parent / "out"
    codes = {batch("library", "--out", "out", "--shard", f"{i}/3").returncode for i in (1, 2, 3)}
    assert codes <= {0, 3, 4}
    lines = [line for i in (1, 2, 3) for line in lines_in(out / f"journal-{i}-of-3.jsonl")]
    assert sorted(line["asset"] for line in lines) == ASSETS
    assert not (out / "summary.txt").exists()
    whole = batch("library", "--out", "out", "--only-missing")
    assert whole.returncode == 4
    assert "\n0 of them in this run" in whole.stdout
    assert (out / "journal.jsonl").read_bytes() == b""
    assert (out / "summary.txt").read_text().startswith("5 assets\n")


def test_side_files_beside_each_mesh(batch, lines_in, library: Path) -> None:
    for name in RESULTS:
        cones = [0, 1, 2, 3] if name == "cube.off" else []
        (library / f"{Path(name).with_suffix('')}.cones.json").write_text(json.dumps({"cones": cones}))
    (library / "patch.cones.json").unlink()
    batch("library", "--out", "out", "--cones", "{}.cones.json")
    lines = {line["asset"]: line for line in lines_in(library.parent / "out" / "journal.jsonl")}
    assert (lines["cube.off"]["status"], lines["cube.off"]["cones"]) == ("ok", 4)
    assert (lines["patch.off"]["status"], lines["patch.off"]["code"]) == ("failed", "FILE_ERROR")
    assert "patch.cones.json" in lines["patch.off"]["message"]
    assert lines["deep/ball.off"]["code"] == "TOO_FEW_CONES"


def test_reports_are_those_of_single_runs(batch, library: Path) -> None:
    assert batch("library", "--out", "out", "--reports", "--no-pictures").returncode == 4
    reports = files_in(library.parent / "out", ".report.json")
    assert sorted(reports) == [f"{name}.obj.report.json" for name in RESULTS]
    single = library.parent / "single.json"
    output = library.parent / "single.obj"
    assert main(["unwrap", str(library / "cube.off"), "-o", str(output), "--report", str(single)]) == 0
    wanted, found = json.loads(single.read_bytes()), json.loads(reports["cube.off.obj.report.json"])
    assert found.pop("stage_seconds").keys() == wanted.pop("stage_seconds").keys()
    assert found == wanted
    assert not list((library.parent / "out").rglob("*.png"))


class Sheet(HTMLParser):
    """The links and the text of a contact sheet."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.places: list[str] = []
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.places += [unquote(value) for key, value in attributes if key in ("src", "href")]

    def handle_data(self, data: str) -> None:
        self.text += data


def test_contact_sheet_shows_every_asset(batch, library: Path) -> None:
    odd = "a&b <i>#?.off" if os.name == "posix" else "a&b #%41.off"  # Windows has no names with the others
    (library / odd).write_text(off_text(grid()))
    assert batch("library", "--out", "out").returncode == 4
    out = library.parent / "out"
    sheet = Sheet((out / "contact-sheet.html").read_text())
    assert all((out / place).is_file() for place in sheet.places)
    assert sorted(place for place in sheet.places if place.endswith(".png")) == sorted(
        f"pictures/{name}.png" for name in [*RESULTS, odd]
    )
    assert all(name in sheet.text for name in [*ASSETS, odd, "refused: NOT_ORIENTABLE"])


@pytest.mark.skipif(os.name != "posix", reason="names that are no text are a POSIX matter")
def test_names_of_any_kind(batch, lines_in, library: Path) -> None:
    odd = [os.fsdecode(b"b\xe4r.off"), "立 方.off", "-o.off", "{}.off"]
    for name in odd:
        shutil.copy(library / "patch.off", library / name)
    done = batch("library", "--out", "out")
    assert (done.returncode, done.stderr) == (4, "")
    lines = lines_in(library.parent / "out" / "journal.jsonl")
    assert sorted(line["asset"] for line in lines) == sorted([*ASSETS, *odd])
    assert (library.parent / "out" / f"{odd[0]}.obj").is_file()


def test_assets_that_are_worked_on_are_part_of_the_progress() -> None:
    shown: list[tuple[float, str]] = []
    assets = [Asset("large", Path("large"), 300), Asset("small", Path("small"), 100)]
    progress = RunProgress(lambda done, note: shown.append((done, note)), assets, [])
    for shares in ({"large": 0.0}, {"large": 0.5, "small": 0.0}, {"large": 0.5, "small": 1.0}):
        progress.working(shares)
    progress({"asset": "small", "status": "ok"})
    progress({"asset": "large", "status": "refused"})
    assert [done for done, _ in shown] == [0, 0, 0.375, 0.625, 0.625, 1]
    assert [note.split(", ")[1] for _, note in shown] == ["0/2"] * 4 + ["1/2", "2/2"]
    assert all("for 0:00" in note for _, note in shown[:2]) and all("left" in note for _, note in shown[2:])


def test_progress_on_a_terminal(library: Path) -> None:
    pty = pytest.importorskip("pty")
    terminal_end, process_end = pty.openpty()
    command = [
        sys.executable,
        "-c",
        "from lsgp import cli; from lsgp.run import terminal; terminal.SILENT_SECONDS = 0; cli.main()",
    ]
    command += ["batch", "library", "--out", "out", "--jobs", "1"]
    process = subprocess.Popen(command, cwd=library.parent, stdout=subprocess.DEVNULL, stderr=process_end)
    os.close(process_end)
    sent = b""
    try:
        while part := os.read(terminal_end, 10_000):
            sent += part
    except OSError:  # how Linux says that nobody is left at the other end
        pass
    os.close(terminal_end)
    assert process.wait(60) == 0
    shown = sent.decode().split("\r")
    counts = [int(count) for line in shown for count in re.findall(r"%, (\d)/5", line)]
    assert counts == sorted(counts) and {0, 5} <= set(counts)
    assert any(re.search(r"1 without a result, [\d.]+/s, \d+:\d\d left", line) for line in shown)
    assert shown[-1] == ""
