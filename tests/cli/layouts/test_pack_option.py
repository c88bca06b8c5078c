# SPDX-License-Identifier: GPL-3.0-or-later
"""`--pack`: the output and report for each of its values, and incompatible options."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from layout_check import coverage, overlapping_islands, room
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate
from polygon_meshes import bumpy_ball, cube, obj_text

UNWRAP = ("unwrap", "parts.obj", "-o", "out.obj", "--report", "report.json")
BAKE = (*UNWRAP, "--preset", "bake")
# Coordinates are written with six digits.
WRITTEN = 2e-6


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    """parts.obj: two bumpy balls and a cube, far from each other."""
    positions, faces = np.empty((0, 3)), []
    for i in range(3):
        places, polygons = bumpy_ball() if i < 2 else cube(2)
        faces += [[vertex + len(positions) for vertex in polygon] for polygon in polygons]
        positions = np.concatenate([positions, np.asarray(places, float) + np.array([5.0 * i, 0, 0])])
    (tmp_path / "parts.obj").write_text(obj_text(positions, faces))
    return tmp_path


def layout(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangles, coordinates of their corners and the island of each, of a file: what shares both ends of an edge."""
    mesh = read_mesh(path, with_uv=True)
    found = triangulate(mesh)
    uv = mesh.corner_uv[found.corner]
    island = np.arange(len(uv))
    both = zip(found.triangles.tolist(), uv.tolist(), strict=True)
    keys = [[(vertex, *place) for vertex, place in zip(*corners, strict=True)] for corners in both]
    sides: dict[frozenset, int] = {}
    for triangle, corners in enumerate(keys):
        for k in range(3):
            other = sides.setdefault(frozenset([corners[k], corners[k - 1]]), triangle)
            island[island == island[triangle]] = island[other]
    return found.triangles, uv, np.unique(island, return_inverse=True)[1]


def test_doubled_faces_cover_their_place_once(lsgp, parts: Path) -> None:
    once = lsgp(*UNWRAP, "--pack", "shelves").report()["packing"]["coverage"]
    text = (parts / "parts.obj").read_text()
    faces = [line for line in text.splitlines() if line.startswith("f ")]
    (parts / "parts.obj").write_text("\n".join([text.rstrip(), *faces[::2], ""]))
    doubled = lsgp(*UNWRAP, "--pack", "shelves").report()
    assert [warning["code"] for warning in doubled["warnings"]].count("DUPLICATE_FACE") == 1
    assert doubled["packing"]["coverage"] == pytest.approx(once, rel=0.1)  # other diagonals, hence other cones


@pytest.mark.slow
def test_bake_and_paint_are_packed_by_default_and_the_report_says_so(lsgp, parts: Path) -> None:
    for preset in ("paint", "bake"):
        shelves = lsgp(*UNWRAP, "--preset", preset, "--pack", "shelves").report()
        assert shelves["packing"]["pack"] == "shelves"
        done = lsgp(*UNWRAP, "--preset", preset, "--strict")
        assert (done.code, done.err) == (0, "")
        report = done.report()
        assert report["packing"]["pack"] == "tight"
        triangles, uv, island = layout(parts / "out.obj")
        assert report["packing"]["coverage"] == pytest.approx(coverage(uv, island), rel=1e-4)
        assert report["packing"]["coverage"] > shelves["packing"]["coverage"]
        assert report["stage_seconds"]["pack"] > 0
        (line,) = [line for line in done.out.splitlines() if line.startswith("part of the square")]
        assert line.endswith("packed tightly")
        found = room(triangles, uv, island)
        assert found.between >= 8 / 1024 - WRITTEN and found.border >= 4 / 1024 - WRITTEN
        assert overlapping_islands(uv, island) == 0 == report["overlapping"]
        kept = {"seams", "distortion", "islands", "cones", "overlapping", "warnings"}
        assert {key: report[key] for key in kept} == {key: shelves[key] for key in kept}


@pytest.mark.slow
@pytest.mark.parametrize(("margin", "size"), [(4, None), (16, None), (1, 256), (0, 64), (None, 512)])
def test_the_margin_is_in_texels_of_the_texture(lsgp, parts: Path, few_tries, margin, size) -> None:
    options = [*(("--margin", margin) if margin is not None else ()), *(("--texture-size", size) if size else ())]
    done = lsgp(*BAKE, *options)
    assert (done.code, done.err) == (0, "")
    assert done.report()["packing"]["pack"] == "tight"
    texel, wanted = 1 / (size or 1024), 4 if margin is None else margin
    found = room(*layout(parts / "out.obj"))
    assert found.between >= 2 * wanted * texel - WRITTEN and found.border >= wanted * texel - WRITTEN


@pytest.mark.slow
def test_a_texel_density_keeps_its_margin_and_warns_of_what_is_outside(lsgp, parts: Path, few_tries) -> None:
    for density, outside in ((20, False), (200, True)):
        options = ("--texel-density", density, "--texture-size", 512, "--margin", 6)
        done = lsgp(*BAKE, "--pack", "tight", *options)
        assert done.code == 0 and ("ISLANDS_OUTSIDE" in done.err) == outside
        assert done.report()["texel_density"]["mean"] == pytest.approx(density)
        triangles, uv, island = layout(parts / "out.obj")
        assert room(triangles, uv, island).between >= 12 / 512 - WRITTEN
        assert (uv.max() > 1) == outside and uv.min() == pytest.approx(6 / 512, abs=WRITTEN)


@pytest.mark.slow
@pytest.mark.parametrize("options", [("--preset", "bake"), ("--overlaps", "split")])
def test_islands_in_udim_tiles_get_as_large_as_they_can(lsgp, parts: Path, few_tries, options) -> None:
    done = lsgp(*UNWRAP, *options, "--udim", 3, "--margin", 8, "--texture-size", 512)
    assert (done.code, done.err) == (0, "")
    triangles, uv, island = layout(parts / "out.obj")
    tile = np.array([np.floor(uv[island == i].mean(axis=(0, 1))) for i in range(island.max() + 1)])
    count = len(np.unique(tile, axis=0))
    assert count in (2, 3) and np.unique(tile, axis=0).tolist() == [[k, 0] for k in range(count)]
    for k in range(count):
        inside = np.where((tile == (k, 0)).all(axis=1)[island], island, -1)
        found = room(triangles, uv - (k, 0), inside)
        assert found.between >= 16 / 512 - 3 * WRITTEN and found.border >= 8 / 512 - 3 * WRITTEN
    packing = done.report()["packing"]
    assert packing["tiles"] == count
    assert packing["coverage"] == pytest.approx(coverage(uv, island) / count, rel=1e-4)
    assert f"in {count} UDIM tiles" in done.out
    plain = lsgp(*UNWRAP, *options, "--pack", "tight", "--margin", 8, "--texture-size", 512)
    assert plain.report()["packing"]["tiles"] == 1 and "UDIM" not in plain.out


def test_any_map_can_be_packed_and_without_a_preset_it_is_not(lsgp, parts: Path, few_tries) -> None:
    assert lsgp(*UNWRAP).report()["packing"] is None
    plain = (parts / "out.obj").read_bytes()
    assert lsgp(*UNWRAP, "--pack", "shelves").report()["packing"]["pack"] == "shelves"
    assert (parts / "out.obj").read_bytes() == plain
    assert lsgp(*UNWRAP, "--overlaps", "split", "--pack", "tight").report()["packing"]["pack"] == "tight"
    assert room(*layout(parts / "out.obj")).between >= 8 / 1024 - WRITTEN


def test_seamless_and_udim_layouts_are_left_alone(lsgp, parts: Path) -> None:
    assert lsgp(*UNWRAP, "--preset", "tile").report()["packing"] is None
    udim = ("--texel-density", 40, "--texture-size", 512, "--udim", 9)
    assert lsgp(*BAKE, *udim).report()["packing"] is None
    for options, told in (
        (("--preset", "tile", "--pack", "tight"), "not seamless"),
        (("--seamless", "--pack", "shelves"), "not seamless"),
        (("--preset", "bake", *udim, "--pack", "tight"), "not in rows"),
        (("--preset", "bake", "--udim", 2, "--pack", "shelves"), "leave --pack shelves out"),
        (("--preset", "tile", "--udim", 2), "not seamless"),
        (("--seamless", "--udim", 2), "not seamless"),
        (("--margin", 2), "or --pack tight"),
        (("--preset", "bake", "--pack", "shelves", "--margin", 2), "--pack tight"),
        (
            ("--preset", "bake", "--pack", "shelves", "--texture-size", 512),
            "add --pack tight, --udim, --texel-density or --seamless",
        ),
        (("--preset", "bake", "--pack", "loose"), "invalid choice"),
    ):
        done = lsgp(*UNWRAP, *options)
        assert done.code == 2 and told in done.err, options


def test_stacks_lie_on_each_other_and_are_told(lsgp, parts: Path, few_tries) -> None:
    kite = np.array([[0, 0, 0], [2, 0, 0], [1.5, 1, 0], [0.25, 2, 0]])
    polygons = [kite, kite + np.array([8, 0, 0]), (kite * np.array([-1, 1, 1]))[[0, 3, 2, 1]] - np.array([8, 0, 0])]
    faces = [list(range(4 * i, 4 * i + 4)) for i in range(3)]
    (parts / "parts.obj").write_text(obj_text(np.concatenate(polygons), faces))
    for stack, count in (("same", 1), ("mirrored", 2)):
        report = lsgp(*BAKE, "--stack", stack).report()
        (told,) = (warning for warning in report["warnings"] if warning["code"] == "ISLANDS_STACKED")
        assert told["message"].startswith(f"{count} of 3 islands") and told["elements"]["indices"] == [1, 2][:count]
        assert report["overlap_area"] == 0
        _, uv, _ = layout(parts / "out.obj")
        corners = {tuple(map(tuple, np.unique(uv[i : i + 2].reshape(-1, 2), axis=0))) for i in (0, 2, 4)}
        assert len(corners) == 3 - count
        # A stack is counted once.
        area = abs(np.linalg.det(uv[:2, 1:] - uv[:2, :1])).sum() / 2
        assert report["packing"]["coverage"] == pytest.approx((3 - count) * area, rel=1e-4)
    for options in (("--pack", "shelves"), ("--overlaps", "split"), ("--preset", "tile")):
        for option, value in (("--stack", "same"), ("--effort", "quick")):
            refused = lsgp(*UNWRAP, *options, option, value)
            assert refused.code == 2 and f"{option} is for" in refused.err


def test_the_effort_is_that_of_the_packer(lsgp, parts: Path) -> None:
    """Two layouts of the same islands: more effort covers no less."""
    covered = {}
    for effort in ("quick", "good"):
        report = lsgp(*BAKE, "--effort", effort).report()
        _, uv, island = layout(parts / "out.obj")
        covered[effort] = report["packing"]["coverage"]
        assert covered[effort] == pytest.approx(coverage(uv, island), rel=1e-4)
    assert covered["good"] >= covered["quick"]
    assert lsgp(*BAKE).report()["packing"]["coverage"] == covered["good"]


def test_a_margin_as_wide_as_the_texture_is_wrong_usage(lsgp, parts: Path, few_tries) -> None:
    done = lsgp(*BAKE, "--pack", "tight", "--margin", 32, "--texture-size", 64)
    assert done.code == 2 and "no room" in done.err
    refused = lsgp(*BAKE, "--pack", "tight", "--margin", 30, "--texture-size", 64)
    assert refused.code == 3 and "smaller margin" in refused.err


@pytest.mark.slow
def test_a_batch_makes_the_bytes_of_single_runs(lsgp, parts: Path) -> None:
    options = ("--preset", "bake", "--pack", "tight", "--margin", 8)
    done = lsgp("batch", "parts.obj", "--out", "many", "--no-pictures", "--reports", *options)
    assert done.code == 0, done.err
    single = lsgp(*UNWRAP, *options)
    assert (parts / "many" / "parts.obj").read_bytes() == (parts / "out.obj").read_bytes()
    reported = json.loads((parts / "many" / "parts.obj.report.json").read_text())
    assert reported["packing"] == single.report()["packing"]


def test_islands_inside_have_their_share_of_the_texels(lsgp, tmp_path: Path) -> None:
    positions, faces = bumpy_ball()
    inner = [[vertex + len(positions) for vertex in polygon] for polygon in faces]
    both = np.concatenate([np.asarray(positions), 0.5 * np.asarray(positions)])
    (tmp_path / "parts.obj").write_text(obj_text(both, [*faces, *inner]))

    def sizes(*options: str) -> tuple[float, float]:
        report = lsgp(*UNWRAP, "--preset", "paint", *options).report()
        told = [warning["code"] for warning in report["warnings"]].count("ISLANDS_HIDDEN")
        assert told == bool(options)
        triangles, uv, _ = layout(tmp_path / "out.obj")
        is_inner = (triangles >= len(positions)).any(axis=1)
        areas = np.abs(np.linalg.det(np.diff(uv, axis=1))) / 2
        return areas[is_inner].sum(), areas[~is_inner].sum()

    usual, less = sizes(), sizes("--inside", "0.5")
    assert less[0] / less[1] == pytest.approx(usual[0] / usual[1] / 4, rel=1e-3)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--preset", "paint", "--inside", "2"), "0.01 to 1"),
        (("--preset", "paint", "--inside", "1e-300"), "0.01 to 1"),
        (("--preset", "tile", "--inside", "0.5"), "not seamless"),
        (("--inside", "0.5"), "--pack tight"),
        (("--pack", "shelves", "--inside", "0.5"), "--pack tight"),
        (("--preset", "paint", "--pack", "shelves", "--inside", "0.5"), "--pack tight"),
        (("--preset", "paint", "--inside", "0.5", "--texel-density", "9", "--texture-size", "1024"), "leave one out"),
    ],
)
def test_sizes_inside_are_refused_where_they_have_no_place(lsgp, parts: Path, options, reason: str) -> None:
    done = lsgp(*UNWRAP, *options)
    assert done.code == 2
    assert reason in done.err
