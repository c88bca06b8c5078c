# SPDX-License-Identifier: GPL-3.0-or-later
"""The input is overwritten only if requested, and is never lost then."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from lsgp.cli import main
from lsgp.io import mesh_files
from lsgp.io.whole_files import write_whole
from lsgp.run import unwrap_file
from systems import make_link

RUN = ["unwrap", "cube.obj", "--cones", "corners.json"]


def spelled(folder: Path, kind: str) -> str:
    """Another path to cube.obj."""
    other = folder / "other.obj"
    if kind == "hard link":
        os.link(folder / "cube.obj", other)
    elif kind == "symbolic link":
        make_link(other, "cube.obj")
    elif kind == "link to the folder":
        make_link(folder / "here", folder)
        return str(Path("here", "cube.obj"))
    else:
        return str(Path("..", folder.name, "cube.obj"))
    return "other.obj"


@pytest.mark.parametrize("kind", ["hard link", "symbolic link", "link to the folder", "another spelling"])
def test_the_input_by_any_path_is_refused_as_output(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    monkeypatch.chdir(cube_files)
    before = Path("cube.obj").read_bytes()
    path = spelled(cube_files, kind)
    assert main([*RUN, "-o", path]) == 2
    said = capsys.readouterr().err
    assert f"'{path}'" in said and "'cube.obj'" in said and "--in-place" in said
    assert Path("cube.obj").read_bytes() == before
    assert main([*RUN, "-o", path, "--in-place"]) == (2 if kind == "hard link" else 0)
    assert (Path(path).read_bytes() == before) == (kind == "hard link")


@pytest.mark.parametrize("way", ["command", "library"])
def test_what_is_saved_during_a_run_is_not_lost(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], way: str
) -> None:
    """By another program, to the file that is to be replaced; it may even be as long as before."""
    monkeypatch.chdir(cube_files)
    path = Path("cube.obj")
    for saved in (path.read_bytes() + b"# more\n", path.read_bytes().replace(b"v 0", b"v 1", 1)):
        before = path.read_bytes()
        if way == "command":

            def formatted(*given, saved=saved):
                path.write_bytes(saved)
                return mesh_files.format_mesh(*given)

            monkeypatch.setattr(unwrap_file, "format_mesh", formatted)
            assert main([*RUN, "--in-place"]) == 2
            assert "cube.obj'" in (said := capsys.readouterr().err) and "changed since it was read" in said
        else:
            file = mesh_files.read_mesh_file(path)
            path.write_bytes(saved)
            with pytest.raises(OSError, match="changed since it was read"):
                mesh_files.write_mesh_file(path, file, np.zeros((len(file.triangulation.triangles), 3, 2)), True)
        assert path.read_bytes() == saved != before
        assert sorted(entry.name for entry in Path().iterdir() if "lsgp" in entry.name) == []
        path.write_bytes(before)


def test_hard_links_are_not_parted(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What replaces a file as a whole would leave the others as they were."""
    monkeypatch.chdir(cube_files)
    before = Path("cube.obj").read_bytes()
    os.link("cube.obj", "twin.obj")
    assert main([*RUN, "--in-place"]) == 2
    assert "'cube.obj' is one of 2 hard links" in capsys.readouterr().err
    assert Path("cube.obj").read_bytes() == Path("twin.obj").read_bytes() == before
    Path("twin.obj").unlink()
    assert main([*RUN, "--in-place"]) == 0


def test_the_report_is_not_written_over_a_link_to_the_input(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(cube_files)
    os.link("cube.obj", "report.json")
    assert main([*RUN, "-o", "out.obj", "--report", "report.json"]) == 2
    assert "same file" in capsys.readouterr().err


def test_a_backup_is_there_until_the_result_is_in_its_place(cube_files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(cube_files)
    before = Path("cube.obj").read_bytes()
    seen = []
    replace = os.replace

    def watch(source: Path, target: Path) -> None:
        seen.append(Path("cube.obj.lsgp-backup").read_bytes())
        replace(source, target)
        seen.append(Path("cube.obj.lsgp-backup").read_bytes())

    monkeypatch.setattr(os, "replace", watch)
    assert main([*RUN, "--in-place"]) == 0
    assert seen == [before, before]
    assert b"vt" in Path("cube.obj").read_bytes()
    assert sorted(os.listdir()) == ["corners.json", "cube.obj"]


@pytest.mark.parametrize("fails", ["replace", "link"])
def test_the_input_survives_what_fails(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], fails: str
) -> None:
    """Without hard links the backup is a copy."""
    monkeypatch.chdir(cube_files)
    before = Path("cube.obj").read_bytes()

    def fail(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, fails, fail)
    assert main([*RUN, "--in-place"]) == (2 if fails == "replace" else 0)
    assert (Path("cube.obj").read_bytes() == before) == (fails == "replace")
    assert sorted(os.listdir()) == ["corners.json", "cube.obj"]


def test_the_backup_of_a_killed_run_is_not_written_over(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(cube_files)
    Path("cube.obj.lsgp-backup").write_text("the original")
    before = Path("cube.obj").read_bytes()
    assert main([*RUN, "--in-place"]) == 2
    assert "cube.obj.lsgp-backup" in capsys.readouterr().err
    with pytest.raises(FileExistsError):
        write_whole(Path("cube.obj"), b"new", keep_backup=True)
    assert Path("cube.obj").read_bytes() == before
    assert Path("cube.obj.lsgp-backup").read_text() == "the original"
    assert sorted(os.listdir()) == ["corners.json", "cube.obj", "cube.obj.lsgp-backup"]
