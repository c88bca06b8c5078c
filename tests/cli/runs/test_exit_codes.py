# SPDX-License-Identifier: GPL-3.0-or-later
"""Exit codes: 0 for a result, 2 for wrong usage and missing files, 3 for refused input."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from command import REPORT_KEYS, uv_of
from lsgp.cli import main
from polygon_meshes import cube, obj_text, off_text, patch

UNWRAP = ["unwrap", "in.obj", "-o", "out.obj"]
SEAMLESS = [*UNWRAP, "--seamless"]
LOW_STRETCH = [*UNWRAP, "--mode", "low-stretch"]
QUADS = ["quads", "in.obj", "-o", "out.obj", "--target", "50"]
TETRAHEDRON = "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"
ROOF = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
# For the four vertices of it.
IMPORTANCE = {
    "1 1 1": "WRONG_PARAMETER",
    "1 1 1 1 1": "WRONG_PARAMETER",
    "": "WRONG_PARAMETER",
    "[1, 1, 1]": "WRONG_PARAMETER",
    "[]": "WRONG_PARAMETER",
    "1 -1e-300 1 1": "WRONG_PARAMETER",
    "1 1 nan 1": "WRONG_PARAMETER",
    "inf 1 1 1": "WRONG_PARAMETER",
    "[1, 1, 1, NaN]": "WRONG_PARAMETER",
    "[1, -1, 1, 1]": "WRONG_PARAMETER",
    "[1, 1" + "0" * 400 + ", 1, 1]": "WRONG_PARAMETER",
    "1 1 one 1": "MALFORMED_FILE",
    "1_0 1 1 1": "MALFORMED_FILE",
    "[1, null, 1, 1]": "MALFORMED_FILE",
    "[1, true, 1, 1]": "MALFORMED_FILE",
    "[[1], [1], [1], [1]]": "MALFORMED_FILE",
    '{"importance": [1, 1, 1, 1]}': "MALFORMED_FILE",
}
# On four vertices.
DENSITY = {
    "1 1 1": "WRONG_PARAMETER",
    "1 0 1 1": "WRONG_PARAMETER",
    "1 1 nan 1": "WRONG_PARAMETER",
    "[1, 1, 1, -1]": "WRONG_PARAMETER",
    "[1, 1, 1, Infinity]": "WRONG_PARAMETER",
    "[[0, 0]]": "WRONG_PARAMETER",
    "[[4, 2]]": "INDEX_OUT_OF_RANGE",
    "[[-1, 2]]": "INDEX_OUT_OF_RANGE",
    "[[99999999999, 2]]": "INDEX_OUT_OF_RANGE",
    "1 1 one 1": "MALFORMED_FILE",
    "[1, [1, 2], 1, 1]": "MALFORMED_FILE",
    "[[0.5, 2]]": "MALFORMED_FILE",
    "[[0, 1, 2]]": "MALFORMED_FILE",
    '{"density": [1, 1, 1, 1]}': "MALFORMED_FILE",
}
REFUSED = (
    {
        "vertices only": ({"in.obj": "v 0 0 0\nv 1 0 0\n"}, UNWRAP, "EMPTY_MESH"),
        "empty file": ({"in.obj": ""}, UNWRAP, "EMPTY_MESH"),
        "isolated cone": (
            {"in.obj": "PATCH", "c.json": '{"cones": [99]}'},
            [*UNWRAP, "--cones", "c.json"],
            "CONE_INDEX",
        ),
        "negative cone": (
            {"in.obj": "PATCH", "c.json": '{"cones": [-1]}'},
            [*UNWRAP, "--cones", "c.json"],
            "CONE_INDEX",
        ),
        "enormous cone": (
            {"in.obj": "PATCH", "c.json": '{"cones": [99999999999]}'},
            [*UNWRAP, "--cones", "c.json"],
            "CONE_INDEX",
        ),
        "unlike cones": ({"in.obj": "PATCH", "c.json": "[1, 2]"}, [*UNWRAP, "--cones", "c.json"], "MALFORMED_FILE"),
        "cones of text": (
            {"in.obj": "PATCH", "c.json": '{"cones": ["1"]}'},
            [*UNWRAP, "--cones", "c.json"],
            "MALFORMED_FILE",
        ),
        "fraction of a cone": (
            {"in.obj": "PATCH", "c.json": '{"cones": [1.5]}'},
            [*UNWRAP, "--cones", "c.json"],
            "MALFORMED_FILE",
        ),
        "angle of text": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7], "cone_angles": ["pi"]}'},
            [*UNWRAP, "--cones", "c.json"],
            "MALFORMED_FILE",
        ),
        "angle NaN": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7], "cone_angles": [NaN]}'},
            [*UNWRAP, "--cones", "c.json"],
            "CONE_ANGLE_NON_FINITE",
        ),
        "angle of 400 digits": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7], "cone_angles": [1' + "0" * 400 + "]}"},
            [*UNWRAP, "--cones", "c.json"],
            "CONE_ANGLE_NON_FINITE",
        ),
        "angles too few": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7, 8], "cone_angles": [4]}'},
            [*UNWRAP, "--cones", "c.json"],
            "ANGLE_COUNT",
        ),
        "quarter turns too many": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7], "angles_over_pi_2": [3, 3]}'},
            [*UNWRAP, "--cones", "c.json", "--prescription", "manual"],
            "ANGLE_COUNT",
        ),
        "manual without angles": (
            {"in.obj": "PATCH", "c.json": '{"cones": [7]}'},
            [*UNWRAP, "--cones", "c.json", "--prescription", "manual"],
            "ANGLE_COUNT",
        ),
        "Gauss-Bonnet": (
            {"in.obj": "CUBE", "c.json": '{"cones": [0, 1, 2], "cone_angles": [3, 3, 3]}'},
            [*UNWRAP, "--cones", "c.json"],
            "GAUSS_BONNET",
        ),
        "closed without cones": (
            {"in.obj": "CUBE", "c.json": '{"cones": []}'},
            [*UNWRAP, "--cones", "c.json"],
            "TOO_FEW_CONES",
        ),
        "seam beside the mesh": (
            {"in.obj": "PATCH", "s.json": "[[0, 24]]"},
            [*UNWRAP, "--seam-edges", "s.json"],
            "SEAM_NOT_AN_EDGE",
        ),
        "unlike seams": (
            {"in.obj": "PATCH", "s.json": "[[0, 1, 2]]"},
            [*UNWRAP, "--seam-edges", "s.json"],
            "MALFORMED_FILE",
        ),
        "malformed mesh": ({"in.obj": "v 0 0\n"}, UNWRAP, "MALFORMED_FILE"),
        "index out of range": ({"in.obj": "v 0 0 0\nf 1 2 3\n"}, UNWRAP, "INDEX_OUT_OF_RANGE"),
        "face of two corners": ({"in.obj": "v 0 0 0\nv 1 0 0\nf 1 2\n"}, UNWRAP, "BAD_FACE"),
        "not finite": ({"in.obj": "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}, UNWRAP, "NON_FINITE_POSITION"),
        "other format": ({"in.fbx": "Kaydara"}, ["unwrap", "in.fbx", "-o", "out.obj"], "UNKNOWN_FORMAT"),
        "measure without uv": ({"in.obj": "PATCH"}, ["measure", "in.obj"], "NO_UV"),
        "measure an off": ({"in.off": "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}, ["measure", "in.off"], "NO_UV"),
        "measure no faces": ({"in.obj": "v 0 0 0\nvt 0 0\n"}, ["measure", "in.obj"], "EMPTY_MESH"),
        "measure broken vt": (
            {"in.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n"},
            ["measure", "in.obj"],
            "INDEX_OUT_OF_RANGE",
        ),
    }
    | {
        f"{option} {value}": ({"in.obj": "CUBE"}, [*SEAMLESS, option, value], "WRONG_PARAMETER")
        for option, extreme in (("--tiles", "1e300"), ("--tile-size", "1e-300"))
        for value in ("0", "-8", "nan", "inf", "1e999", extreme)
    }
    | {
        f"--stretch {value}": ({"in.obj": "CUBE"}, [*LOW_STRETCH, "--stretch", value], "WRONG_PARAMETER")
        for value in ("-0.001", "1.001", "nan", "inf")
    }
    | {
        f"importance {content[:12]!r}": (
            {"in.obj": "ROOF", "weights": content},
            [*LOW_STRETCH, "--importance", "weights"],
            code,
        )
        for content, code in IMPORTANCE.items()
    }
    | {
        f"density {content[:12]!r}": (
            {"in.obj": TETRAHEDRON, "density": content},
            [*QUADS, "--density", "density"],
            code,
        )
        for content, code in DENSITY.items()
    }
)
WRONG_USAGE = {
    "no command": ([], "command"),
    "unknown command": (["wrap"], "wrap"),
    "no output": (["unwrap", "in.obj"], "--output"),
    "no input": (["unwrap", "-o", "out.obj"], "IN"),
    "unknown option": ([*UNWRAP, "--fast"], "--fast"),
    "shortened option": ([*UNWRAP, "--unf", "poisson"], "--unf"),
    "unknown prescription": ([*UNWRAP, "--prescription", "best"], "best"),
    "unknown unfold": ([*UNWRAP, "--unfold", "abf"], "abf"),
    "unknown method": ([*UNWRAP, "--method", "abf"], "abf"),
    "count of no cones": ([*UNWRAP, "--cones", "auto:x"], "auto:x"),
    "negative count": ([*UNWRAP, "--cones", "auto:-1"], "auto:-1"),
    "missing input": (["unwrap", "none.obj", "-o", "out.obj"], "none.obj"),
    "folder as input": (["unwrap", ".", "-o", "out.obj"], "directory"),
    "missing cones": ([*UNWRAP, "--cones", "none.json"], "none.json"),
    "missing seams": ([*UNWRAP, "--seam-edges", "none.json"], "none.json"),
    "cones that are no JSON": ([*UNWRAP, "--cones", "in.obj"], "in.obj"),
    "seams that are no JSON": ([*UNWRAP, "--seam-edges", "in.obj"], "in.obj"),
    "JSON without end": ([*UNWRAP, "--cones", "deep.json"], "deep.json"),
    "output in no folder": (["unwrap", "in.obj", "-o", "none/out.obj"], "none"),
    "output is a folder": (["unwrap", "in.obj", "-o", "."], "folder"),
    "output in a file": (["unwrap", "in.obj", "-o", "in.obj/out.obj"], "in.obj"),
    "output of a format that is only read": (
        ["unwrap", "in.obj", "-o", "out.off"],
        "'out.off' cannot be written as OFF",
    ),
    **{
        f"output of another format, {suffix}": (
            ["unwrap", "in.obj", "-o", f"out.{suffix}"],
            f"'out.{suffix}' cannot be",
        )
        for suffix in ("fbx", "stl", "json", "OBJ2")
    },
    "output that names what can be written": (["unwrap", "in.obj", "-o", "out.fbx"], "OBJ (.obj)"),
    "standard output of a format that is only read": (["unwrap", "in.obj", "-o", "-", "--format", "off"], "as OFF"),
    "cones into a mesh": (["cones", "in.obj", "-o", "cones.glb"], "cones.glb"),
    "unknown format": ([*UNWRAP, "--format", "fbx"], "fbx"),
    "output over the input": (["unwrap", "in.obj", "-o", "./in.obj"], "--in-place"),
    "in place and elsewhere": ([*UNWRAP, "--in-place"], "out.obj"),
    "standard input in place": (["unwrap", "-", "--in-place"], "--in-place is for files"),
    "report in no folder": ([*UNWRAP, "--report", "none/r.json"], "none"),
    "report over output": ([*UNWRAP, "--report", "./out.obj"], "same file"),
    "report over input": ([*UNWRAP, "--report", "./in.obj"], "same file"),
    "report over measured file": (["measure", "in.obj", "--report", "in.obj"], "same file"),
    "manual for automatic cones": ([*UNWRAP, "--prescription", "manual"], "manual"),
    "measure missing": (["measure", "none.obj"], "none.obj"),
    "tiles without seamless": ([*UNWRAP, "--tiles", "8"], "--tiles"),
    "tile size without seamless": ([*UNWRAP, "--tile-size", "0.1"], "--tile-size"),
    "lattice without seamless": ([*UNWRAP, "--lattice", "square"], "--lattice"),
    "parity without seamless": ([*UNWRAP, "--parity"], "--parity"),
    "places of features without seamless": ([*UNWRAP, "--feature-places", "whole"], "--feature-places"),
    "coarse grid without seamless": ([*UNWRAP, "--coarse-grid", "refine"], "--coarse-grid"),
    "texture size without seamless": ([*UNWRAP, "--texture-size", "1024"], "--texture-size"),
    "mip levels without seamless": ([*UNWRAP, "--mip-levels", "0"], "--mip-levels"),
    "tiles and tile size": ([*SEAMLESS, "--tiles", "8", "--tile-size", "0.1"], "not allowed with"),
    "tiles that are no number": ([*SEAMLESS, "--tiles", "many"], "many"),
    "unknown lattice": ([*SEAMLESS, "--lattice", "cubic"], "cubic"),
    "unknown coarse grid": ([*SEAMLESS, "--coarse-grid", "snap"], "snap"),
    "texture size 0": ([*SEAMLESS, "--texture-size", "0"], "power of two"),
    "negative texture size": ([*SEAMLESS, "--texture-size", "-1024"], "power of two"),
    "texture size 1000": ([*SEAMLESS, "--texture-size", "1000"], "power of two"),
    "texture size of half texels": ([*SEAMLESS, "--texture-size", "0.5"], "power of two"),
    "texture too large": ([*SEAMLESS, "--texture-size", "131072"], "power of two"),
    "texture size of 5000 digits": ([*SEAMLESS, "--texture-size", "1" + "0" * 5000], "power of two"),
    "negative mip level": ([*SEAMLESS, "--mip-levels", "-1"], "levels 0 to 10"),
    "more levels than mipmaps": ([*SEAMLESS, "--mip-levels", "11"], "levels 0 to 10"),
    "more levels than a small texture has": ([*SEAMLESS, "--texture-size", "64", "--mip-levels", "7"], "levels 0 to 6"),
    "half a mip level": ([*SEAMLESS, "--mip-levels", "1.5"], "1.5"),
    "unknown mode": ([*UNWRAP, "--mode", "isometric"], "isometric"),
    "unknown overlaps": ([*UNWRAP, "--overlaps", "cut"], "cut"),
    "stretch without low stretch": ([*UNWRAP, "--stretch", "0.5"], "--stretch is for maps of low stretch"),
    "stretch of a conformal map": ([*UNWRAP, "--mode", "conformal", "--stretch", "1"], "add --mode low-stretch"),
    "importance without low stretch": ([*UNWRAP, "--importance", "in.obj"], "--importance is for maps of low stretch"),
    "stretch that is no number": ([*LOW_STRETCH, "--stretch", "much"], "much"),
    "repair with a value": ([*UNWRAP, "--no-repair=yes"], "--no-repair"),
    "missing density": ([*QUADS, "--density", "none.json"], "none.json"),
    "missing importance": ([*LOW_STRETCH, "--importance", "none.txt"], "none.txt"),
    "importance without end": ([*LOW_STRETCH, "--importance", "deep.json"], "deep.json"),
    "measure nothing": (["measure"], "FILE"),
}


def write_files(folder: Path, files: dict[str, str]) -> None:
    made = {"PATCH": lambda: obj_text(*patch()), "CUBE": lambda: obj_text(*cube(2)), "ROOF": lambda: ROOF}
    for name, text in files.items():
        (folder / name).write_text(made[text]() if text in made else text)


@pytest.mark.parametrize("name", REFUSED)
def test_refused_input_ends_with_3_a_code_and_a_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    files, arguments, code = REFUSED[name]
    write_files(tmp_path, files)
    monkeypatch.chdir(tmp_path)
    assert main([*arguments, "--report", "report.json"]) == 3
    report = json.loads((tmp_path / "report.json").read_text())
    captured = capsys.readouterr()
    assert (report["status"], report["code"]) == ("refused", code)
    assert list(report) == REPORT_KEYS
    assert captured.err.startswith(f"lsgp: refused: {code}: ")
    assert captured.out == ""
    assert not (tmp_path / "out.obj").exists()


@pytest.mark.parametrize("name", WRONG_USAGE)
def test_wrong_usage_ends_with_2_and_nothing_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    arguments, said = WRONG_USAGE[name]
    write_files(tmp_path, {"in.obj": "PATCH", "deep.json": "[" * 100_000})
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert said in capsys.readouterr().err
    assert sorted(os.listdir(tmp_path)) == ["deep.json", "in.obj"]


@pytest.mark.parametrize("protected", ["out.obj", "."])
def test_file_or_folder_that_cannot_be_written_ends_with_2(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], protected: str
) -> None:
    monkeypatch.chdir(cube_files)
    Path("out.obj").write_text("before")
    # As for a user without the rights; the tests may run as one who has them all.
    monkeypatch.setattr(os, "access", lambda path, mode: not os.path.samefile(path, protected))
    assert main(["unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json"]) == 2
    assert "'out.obj' cannot be written" in capsys.readouterr().err
    assert Path("out.obj").read_text() == "before"


def test_full_disk_ends_with_2(lsgp, cube_files: Path) -> None:
    if os.name != "posix" or not Path("/dev/full").exists():  # Wine shows that of the system below it
        pytest.skip("no /dev/full here")
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "/dev/full")
    assert (done.code, "No space left" in done.err) == (2, True)
    assert "Traceback" not in done.err


@pytest.mark.parametrize("what", ["out.obj", "report.json"])
def test_the_null_device_is_written_to(cube_files: Path, monkeypatch: pytest.MonkeyPatch, what: str) -> None:
    """By the name the system has for it."""
    monkeypatch.chdir(cube_files)
    out, report = (os.devnull if what == name else name for name in ("out.obj", "report.json"))
    assert main(["unwrap", "cube.obj", "-o", out, "--format", "obj", "--report", report]) == 0
    assert not Path(what).exists() and not Path(os.devnull).is_file()


@pytest.mark.slow
def test_same_codes_from_a_process(lsgp, cube_files: Path) -> None:
    assert lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json").code == 0
    assert lsgp("unwrap", "cube.obj").code == 2
    assert lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "auto:0").code == 3
    assert lsgp("unwrap", "none.obj", "-o", "out.obj").code == 2


def test_not_enough_memory_is_a_refusal(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def exhaust(*arguments: object, **options: object) -> None:
        raise MemoryError

    monkeypatch.chdir(cube_files)
    monkeypatch.setattr("lsgp.run.unwrap_file.parameterize", exhaust)
    assert main(["unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "r.json"]) == 3
    assert json.loads((cube_files / "r.json").read_text())["code"] == "OUT_OF_MEMORY"
    assert "OUT_OF_MEMORY" in capsys.readouterr().err


def test_reader_that_closes_the_pipe_early_changes_nothing(cube_files: Path) -> None:
    command = [sys.executable, "-m", "lsgp", "unwrap", "cube.obj", "-o", "out.obj", "--report", "r.json"]
    read_end, write_end = os.pipe()
    os.close(read_end)
    done = subprocess.run(command, cwd=cube_files, stdout=write_end, stderr=subprocess.PIPE, timeout=120)
    os.close(write_end)
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads((cube_files / "r.json").read_text())["status"] == "ok"


def test_names_the_terminal_cannot_show_are_escaped(cube_files: Path) -> None:
    (cube_files / "cube.obj").rename(cube_files / "würfel 立.obj")
    command = [
        sys.executable,
        "-m",
        "lsgp",
        "unwrap",
        "würfel 立.obj",
        "-o",
        "würfel 2 立.obj",
        "--cones",
        "corners.json",
    ]
    environment = os.environ | {"PYTHONIOENCODING": "ascii:strict"}
    done = subprocess.run(command, cwd=cube_files, env=environment, capture_output=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, b"")
    assert rb"w\xfcrfel 2 \u7acb.obj" in done.stdout
    assert (cube_files / "würfel 2 立.obj").exists()


@pytest.mark.slow
def test_version_and_help(lsgp) -> None:
    assert lsgp("--version").out == f"lsgp {version('lsgp')}\n"
    for arguments in (["--help"], ["unwrap", "--help"], ["measure", "--help"]):
        done = lsgp(*arguments)
        assert (done.code, done.err) == (0, "")
        assert "--report" in done.out or "unwrap" in done.out


BAD_CASES = {
    "a01_empty": "EMPTY_MESH",
    "a02_vertices_only": "EMPTY_MESH",
    "a03_single_triangle": None,
    "a04_two_triangles": None,
    "a05_tetrahedron_auto": None,
    "a07_single_quad": None,
    "a08_concave_ngon": None,
    "b_nan_coordinate": "NON_FINITE_POSITION",
    "b_inf_coordinate": "NON_FINITE_POSITION",
    "d_closed_sphere_no_cones": "TOO_FEW_CONES",
    "d_isolated_vertices": None,
    "d_many_holes": None,
    "d_triangle_soup": None,
    "e_cone_index_out_of_range": "CONE_INDEX",
    "e_cone_negative": "CONE_INDEX",
    "e_cone_duplicate": "CONE_DUPLICATE",
    "e_angle_count_mismatch": "ANGLE_COUNT",
    "e_angle_nan": "CONE_ANGLE_NON_FINITE",
    "e_angle_inf": "CONE_ANGLE_NON_FINITE",
    "e_gauss_bonnet_wrong": "GAUSS_BONNET",
    "e_gauss_bonnet_off_1e-9": None,
    "f_seam_edge_not_in_mesh": "SEAM_NOT_AN_EDGE",
    "f_self_loop_seam": "SEAM_NOT_AN_EDGE",
}


@pytest.mark.parametrize("name", BAD_CASES)
def test_shared_bad_cases_through_files(
    shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    case = json.loads((shared / "bad" / f"{name}.json").read_text())
    code = BAD_CASES[name]
    monkeypatch.chdir(tmp_path)
    Path("in.off").write_text(off_text(np.reshape(case["V"], (-1, 3)), case["F"]))
    Path("c.json").write_text(json.dumps({"cones": case["cones"], "cone_angles": case["cone_angles"]}))
    Path("s.json").write_text(json.dumps(case["seams"]))
    arguments = ["unwrap", "in.off", "-o", "o.obj", "--cones", "c.json", "--seam-edges", "s.json", "--report", "r.json"]
    assert main(arguments) == (3 if code else 0)
    report = json.loads(Path("r.json").read_text())
    assert report["code"] == code
    assert any(expected.startswith("E_") if code else expected == "OK" for expected in case["expect"])
    if code is None:
        assert np.isfinite(uv_of(Path("o.obj"))).all()
        assert (report["flipped"], report["wrong_angle_sums"]) == (0, 0)
    capsys.readouterr()


@pytest.mark.parametrize("given", ["mesh", "cones"])
def test_a_file_that_breaks_off_while_it_is_read_is_named(
    given: str, cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As on a network or a failing disk: the error of reading does not have the name."""
    broken = cube_files / {"mesh": "cube.obj", "cones": "corners.json"}[given]
    read = Path.read_bytes

    def read_bytes(path: Path) -> bytes:
        if path.name == broken.name:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", read_bytes)
    monkeypatch.chdir(cube_files)
    assert main(["unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json"]) == 2
    assert broken.name in capsys.readouterr().err and not Path("out.obj").exists()
