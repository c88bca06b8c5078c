# SPDX-License-Identifier: GPL-3.0-or-later
"""`--texel-density` and `--udim`: the written coordinates, reports, and incompatible options."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from command import uv_of
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate
from polygon_meshes import bumpy_ball, cube, obj_text

UNWRAP = ("unwrap", "parts.obj", "-o", "out.obj", "--report", "report.json", "--preset", "bake")


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    """parts.obj: four bumpy balls and four cubes."""
    positions, faces = np.empty((0, 3)), []
    for i in range(8):
        places, polygons = bumpy_ball() if i < 4 else cube(2)
        faces += [[vertex + len(positions) for vertex in polygon] for polygon in polygons]
        positions = np.concatenate([positions, np.asarray(places, float) + np.array([5.0 * i, 0, 0])])
    (tmp_path / "parts.obj").write_text(obj_text(positions, faces))
    return tmp_path


def density_of(path: Path, size: int) -> float:
    """Of a file as a whole, by the shoelace formula and cross products of its polygons."""
    mesh = read_mesh(path, with_uv=True)
    texels = 0.0
    for start, count in zip(mesh.starts.tolist(), mesh.sizes.tolist(), strict=True):
        corners = slice(start, start + count)
        u, v = mesh.corner_uv[corners].T
        texels += abs(u @ np.roll(v, -1) - v @ np.roll(u, -1)) / 2 * size**2
    a, b, c = np.moveaxis(mesh.positions[triangulate(mesh).triangles], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return math.sqrt(texels / area)


def test_the_file_has_the_density_and_the_report_says_so(lsgp, parts: Path, few_tries) -> None:
    done = lsgp(*UNWRAP, "--texel-density", 12.5, "--texture-size", 2048)
    assert (done.code, done.err) == (0, "")
    assert density_of(parts / "out.obj", 2048) == pytest.approx(12.5, rel=1e-5)
    told = done.report()["texel_density"]
    assert (told["texture_size"], told["mean"]) == (2048, pytest.approx(12.5))
    assert told["minimum"] < told["median"] < told["maximum"]
    (line,) = [line for line in done.out.splitlines() if line.startswith("texel density")]
    assert line.split()[2] == f"{told['median']:.4g}"
    measured = lsgp("measure", "out.obj", "--texture-size", 2048, "--report", "measured.json")
    assert measured.report("measured.json")["texel_density"]["mean"] == pytest.approx(12.5, rel=1e-5)
    assert lsgp("measure", "out.obj", "--report", "measured.json").report("measured.json")["texel_density"] is None


def test_the_layout_is_the_usual_one_at_another_scale(lsgp, parts: Path, few_tries) -> None:
    assert lsgp(*UNWRAP).report()["texel_density"] is None
    usual = uv_of(parts / "out.obj")
    lsgp(*UNWRAP, "--texel-density", 3, "--texture-size", 512)
    ratio = (uv_of(parts / "out.obj") / np.where(usual > 0.01, usual, np.nan)).ravel()
    assert np.nanmax(ratio) == pytest.approx(np.nanmin(ratio), rel=1e-6)


def test_islands_outside_the_square_are_a_warning_with_their_faces(lsgp, parts: Path, few_tries) -> None:
    done = lsgp(*UNWRAP, "--texel-density", 300, "--texture-size", 1024)
    assert done.code == 0 and "ISLANDS_OUTSIDE" in done.err
    (warning,) = done.report()["warnings"]
    assert warning["elements"]["kind"] == "faces"
    mesh = read_mesh(parts / "out.obj", with_uv=True)
    outside = {
        face
        for face, (start, count) in enumerate(zip(mesh.starts, mesh.sizes, strict=True))
        if (mesh.corner_uv[start : start + count] > 1).any()
    }
    assert outside and outside <= set(warning["elements"]["indices"])


def test_islands_are_spread_over_udim_tiles(lsgp, parts: Path, few_tries) -> None:
    density = 55
    done = lsgp(*UNWRAP, "--texel-density", density, "--texture-size", 512, "--udim", 8, "--margin", 8)
    assert (done.code, done.err) == (0, "")
    assert density_of(parts / "out.obj", 512) == pytest.approx(density, rel=1e-5)
    mesh = read_mesh(parts / "out.obj", with_uv=True)
    tiles = set()
    for start, count in zip(mesh.starts.tolist(), mesh.sizes.tolist(), strict=True):
        corners = mesh.corner_uv[start : start + count]
        tile = np.floor(corners.mean(axis=0))
        tiles.add(tuple(tile.astype(int).tolist()))
        assert (corners - tile >= 8 / 512 - 1e-6).all() and (corners - tile <= 1 - 8 / 512 + 1e-6).all()
    assert tiles == {(column, 0) for column in range(len(tiles))} and 1 < len(tiles) <= 8


@pytest.mark.parametrize("preset", ["--seamless", "--preset=tile"])
def test_tiles_get_the_density_that_is_asked_for(lsgp, parts: Path, preset: str) -> None:
    (parts / "cube.obj").write_text(obj_text(*cube(2)))
    side = np.ptp(cube(2)[0], axis=0)[0]
    # Three whole textures of 512 texels along an edge: nothing has to be rounded.
    density = 3 * 512 / side
    arguments = ("unwrap", "cube.obj", "-o", "out.obj", "--report", "report.json", "--cones", "auto:8", preset)
    done = lsgp(*arguments, "--texel-density", density, "--texture-size", 512)
    assert (done.code, done.err) == (0, "")
    assert density_of(parts / "out.obj", 512) == pytest.approx(density, rel=1e-5)
    assert done.report()["texel_density"]["median"] == pytest.approx(density)
    assert done.report()["seamless"]["error"] == 0


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (("--texel-density", 2000, "--udim", 100), "ISLAND_TOO_LARGE"),
        (("--texel-density", 55, "--udim", 1), "TOO_FEW_TILES"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_written(
    lsgp, parts: Path, few_tries, options: tuple, code: str
) -> None:
    done = lsgp(*UNWRAP, *options, "--texture-size", 512)
    assert done.code == 3 and code in done.err
    report = done.report()
    assert (report["status"], report["code"], report["elements"]["kind"]) == ("refused", code, "faces")
    assert not (parts / "out.obj").exists()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--texel-density", 10), "add --texture-size"),
        (("--pack", "shelves", "--margin", 2), "add --udim"),
        (("--pack", "shelves", "--texture-size", 1024), "add --pack tight, --udim, --texel-density or --seamless"),
        (("--pack", "shelves", "--texel-density", 10, "--texture-size", 1024, "--margin", 2), "add --udim"),
        (("--texel-density", 10, "--texture-size", 16, "--udim", 2, "--margin", 8), "no room"),
        (("--texel-density", 10, "--seamless"), "add --texture-size"),
        (("--texel-density", 10, "--texture-size", 1024, "--seamless", "--tiles", 4), "leave --tiles"),
        (("--texel-density", 10, "--texture-size", 1024, "--preset", "tile", "--tile-size", 4), "leave --tiles"),
        (("--texel-density", 10, "--texture-size", 1024, "--preset", "tile", "--udim", 4), "not seamless"),
        (("--texel-density", 0, "--texture-size", 1024), "above 0"),
        (("--texel-density", "inf", "--texture-size", 1024), "above 0"),
        (("--texel-density", "nan", "--texture-size", 1024), "above 0"),
        (("--texel-density", 10, "--texture-size", 1024, "--udim", 0), "from 1 to 100"),
        (("--texel-density", 10, "--texture-size", 1024, "--udim", 101), "from 1 to 100"),
        (("--texel-density", 10, "--texture-size", 1024, "--udim", 2, "--margin", -1), "0 or more"),
    ],
)
def test_options_that_do_not_go_together_are_wrong_usage(lsgp, parts: Path, options: tuple, told: str) -> None:
    done = lsgp(*UNWRAP, *options)
    assert done.code == 2 and told in done.err
    assert not (parts / "out.obj").exists()


def test_a_batch_makes_the_bytes_of_single_runs(lsgp, parts: Path) -> None:
    options = ("--texel-density", 40, "--texture-size", 1024, "--udim", 3)
    done = lsgp("batch", "parts.obj", "--out", "many", "--preset", "bake", "--no-pictures", "--reports", *options)
    assert done.code == 0, done.err
    single = lsgp(*UNWRAP, *options)
    assert (parts / "many" / "parts.obj").read_bytes() == (parts / "out.obj").read_bytes()
    reported = json.loads((parts / "many" / "parts.obj.report.json").read_text())
    assert reported["texel_density"] == single.report()["texel_density"]
