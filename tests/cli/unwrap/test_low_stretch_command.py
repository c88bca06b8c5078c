# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --mode low-stretch`, `--no-repair` and `--overlaps`: the effect of each on the written map."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from command import cut_edges
from crossings import require_certified
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate
from overlap_check import overlaps
from polygon_meshes import bumpy_ball, faces_of

UNWRAP = ("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json")


# --- low stretch ----------------------------------------------------------------------------------------------------


def unwrapped(lsgp, *options: object) -> dict:
    done = lsgp(*UNWRAP, *options)
    assert done.code == 0, done.err
    report = done.report()
    assert (report["flipped"], report["wrong_angle_sums"]) == (0, 0)
    assert report["seams"]["sister_ratio_max"] == pytest.approx(1, abs=1e-9)
    assert report["seams"]["translation_residual"] <= 1e-12
    return report


def test_conformal_is_the_default(lsgp, ball_files: Path) -> None:
    default = unwrapped(lsgp)
    bytes_of_default = (ball_files / "out.obj").read_bytes()
    unwrapped(lsgp, "--mode", "conformal")
    assert (ball_files / "out.obj").read_bytes() == bytes_of_default
    none = unwrapped(lsgp, "--mode", "low-stretch", "--stretch", 0)
    assert none["distortion"] == pytest.approx(default["distortion"], rel=0.03)
    assert none["distortion"]["quasi_conformal"] <= default["distortion"]["quasi_conformal"]


def test_stretch_trades_angles_for_lengths(lsgp, ball_files: Path) -> None:
    reports = [
        unwrapped(lsgp, "--mode", "low-stretch", *options)
        for options in (("--stretch", 0), ("--stretch", 0.25), ("--stretch", 0.5), ())
    ]
    stretch = [report["distortion"]["l2_stretch"] for report in reports]
    conformality = [report["distortion"]["quasi_conformal"] for report in reports]
    assert stretch == sorted(stretch, reverse=True)
    assert stretch[-1] < stretch[0] - 1e-3
    assert conformality == sorted(conformality)
    assert reports[-1]["repair"]["iterations"] > 0
    assert unwrapped(lsgp, "--mode", "low-stretch", "--stretch", 1)["distortion"] == reports[-1]["distortion"]
    cones = json.loads((ball_files / "cones.json").read_text())["cones"]
    for report in reports:
        assert report["cones"] == cones
        assert report["cone_angles"] == pytest.approx(reports[0]["cone_angles"], abs=1e-9)


def triangle_stretch(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Middles of the quads' halves on the ball and their symmetric Dirichlet energy at the layout's own scale."""
    mesh = read_mesh(path, with_uv=True)
    quads = np.array(faces_of(mesh))
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [2, 3, 0]]])
    place = np.arange(quads.size).reshape(-1, 4)
    uv = mesh.corner_uv[np.concatenate([place[:, [0, 1, 2]], place[:, [2, 3, 0]]])]
    points = mesh.positions[corners]
    area = [np.empty(len(corners)), np.empty(len(corners))]
    singular = np.empty((len(corners), 2))
    for i, (p, q) in enumerate(zip(points, uv, strict=True)):
        _, edges = np.linalg.qr((p[1:] - p[0]).T)
        images = (q[1:] - q[0]).T
        area[0][i], area[1][i] = abs(np.linalg.det(edges)), np.linalg.det(images)
        singular[i] = np.linalg.svd(images @ np.linalg.inv(edges), compute_uv=False)
    singular *= math.sqrt(area[0].sum() / area[1].sum())
    return points.mean(axis=1), (singular**2 + singular**-2).sum(axis=1) / 4


def test_stretch_goes_where_it_matters_least(lsgp, ball_files: Path) -> None:
    positions, _ = bumpy_ball()
    energy = {}
    for side in (1, -1):
        weights = np.where(side * positions[:, 2] > 0, 100.0, 0.01)
        (ball_files / "w.txt").write_text("\n".join(map(repr, weights.tolist())))
        unwrapped(lsgp, "--mode", "low-stretch", "--importance", "w.txt")
        middle, stretch = triangle_stretch(ball_files / "out.obj")
        energy[side] = [stretch[sign * middle[:, 2] > 0.2].mean() for sign in (1, -1)]
    assert energy[1][0] < energy[-1][0]
    assert energy[-1][1] < energy[1][1]


def test_low_stretch_of_a_seamless_layout_is_seamless(lsgp, ball_files: Path) -> None:
    conformal = unwrapped(lsgp, "--seamless", "--tiles", 24)
    low = unwrapped(lsgp, "--seamless", "--tiles", 24, "--mode", "low-stretch")
    assert low["seamless"]["error"] == 0
    assert low["distortion"]["l2_stretch"] < conformal["distortion"]["l2_stretch"]


# --- repair ---------------------------------------------------------------------------------------------------------


UNWRAP_CUBE = ("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "report.json")


def on_the_cube(lsgp, folder: Path, *options: object) -> dict:
    """The report on a cube with angles whose first map has flips, and whose layout lies on itself."""
    cones = json.loads((folder / "corners.json").read_text())["cones"]
    angles = np.array([1, 4, 4, 6, 2, 2, 4, 1]) * math.pi / 2
    (folder / "corners.json").write_text(json.dumps({"cones": cones, "cone_angles": angles.tolist()}))
    done = lsgp(*UNWRAP_CUBE, *options)
    assert done.code == 0, done.err
    report = done.report()
    given = dict(zip(cones, angles.tolist(), strict=True))
    assert report["cone_angles"] == pytest.approx([given[cone] for cone in report["cones"]], abs=1e-9)
    assert f"{report['repair']['flipped_before']} as first unfolded" in done.out
    assert f"{report['islands']} island" in done.out
    return report


def test_without_repair_flips_stay_as_they_came_out(lsgp, cube_files: Path) -> None:
    mended, left = on_the_cube(lsgp, cube_files), on_the_cube(lsgp, cube_files, "--no-repair")
    before = mended["repair"]["flipped_before"], mended["repair"]["wrong_angle_sums_before"]
    assert min(before) > 0
    assert (left["flipped"], left["wrong_angle_sums"]) == before
    assert left["repair"] == mended["repair"] | {"iterations": 0}
    assert mended["repair"]["iterations"] > 0
    assert (mended["flipped"], mended["wrong_angle_sums"]) == (0, 0)
    named = {warning["code"]: warning["elements"] for warning in left["warnings"]}
    assert len(named["WRONG_ANGLE_SUMS"]["indices"]) == left["wrong_angle_sums"]
    assert named["FLIPPED_TRIANGLES"]["kind"] == "faces"
    assert not {"FLIPPED_TRIANGLES", "WRONG_ANGLE_SUMS"} & {warning["code"] for warning in mended["warnings"]}


# --- overlaps -------------------------------------------------------------------------------------------------------


def faces_on_others(path: Path) -> set[int]:
    mesh = read_mesh(path, with_uv=True)
    triangulation = triangulate(mesh)
    z = mesh.corner_uv[triangulation.corner] @ (1, 1j)
    pairs, area = overlaps(z)
    return set(triangulation.polygons_of(pairs[area > 1e-12].ravel()).tolist())


def test_overlaps_are_told(lsgp, cube_files: Path) -> None:
    report = on_the_cube(lsgp, cube_files)
    named = [w["elements"] for w in report["warnings"] if w["code"] == "OVERLAPPING_TRIANGLES"]
    assert named == [{"kind": "faces", "indices": sorted(faces_on_others(cube_files / "out.obj"))}]
    assert report["overlapping"] >= len(named[0]["indices"]) > 0
    assert 0 < report["overlap_area"] < 1


def test_split_islands_lie_on_nothing(lsgp, cube_files: Path) -> None:
    kept = on_the_cube(lsgp, cube_files)
    cuts = cut_edges(cube_files / "out.obj")
    split = on_the_cube(lsgp, cube_files, "--overlaps", "split")
    assert (split["overlapping"], split["overlap_area"]) == (0, 0)
    assert "OVERLAPPING_TRIANGLES" not in {warning["code"] for warning in split["warnings"]}
    assert faces_on_others(cube_files / "out.obj") == set()
    assert split["islands"] >= kept["islands"] == 1
    assert cut_edges(cube_files / "out.obj") != cuts
    assert split["seams"]["sister_ratio_max"] == pytest.approx(1, abs=1e-9)
    assert split["distortion"] == pytest.approx(kept["distortion"], rel=1e-9)
    # Faces are whole: the file measures as the map did.
    measured = lsgp("measure", "out.obj", "--report", "measured.json").report("measured.json")
    assert measured["distortion"] == pytest.approx(split["distortion"], rel=1e-9)
    assert (measured["islands"], measured["flipped"]) == (split["islands"], 0)


def test_split_seamless_layouts_stay_seamless(lsgp, cube_files: Path) -> None:
    kept = on_the_cube(lsgp, cube_files, "--seamless", "--tiles", 32)
    split = on_the_cube(lsgp, cube_files, "--seamless", "--tiles", 32, "--overlaps", "split")
    assert kept["overlapping"] > 0 == split["overlapping"]
    assert faces_on_others(cube_files / "out.obj") == set()
    assert require_certified(cube_files / "out.obj", split["seamless"]) == 0
