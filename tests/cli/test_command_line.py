# SPDX-License-Identifier: GPL-3.0-or-later
"""The contract of `lsgp unwrap` and `lsgp measure`: files in and out, options, exit codes, reports."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from lsgp.cli import main
from lsgp.mesh_files import read_mesh
from polygon_meshes import bumpy_ball, cube, cube_corners, faces_of, obj_text, off_text, patch, ply_bytes

KEYS = [
    *["status", "code", "message", "elements", "warnings", "triangles", "cones", "cone_angles", "distortion", "seams"],
    *["flipped", "wrong_angle_sums", "stage_seconds"],
]
DISTORTION_KEYS = [
    *["quasi_conformal", "quasi_conformal_area_weighted", "area", "area_p10", "area_p90", "l2_stretch"],
]
SEAM_KEYS = ["sister_ratio_max", "rotation_residual", "translation_residual"]


@pytest.fixture
def cube_files(tmp_path: Path) -> Path:
    """cube.obj of quads, its corners in corners.json."""
    positions, faces = cube(4)
    (tmp_path / "cube.obj").write_text(obj_text(positions / 3, faces))
    (tmp_path / "corners.json").write_text(json.dumps({"cones": cube_corners(positions)}))
    return tmp_path


@pytest.fixture
def ball_files(tmp_path: Path) -> Path:
    """ball.obj, closed, curved everywhere, of quads; eight cones in cones.json."""
    positions, faces = bumpy_ball()
    (tmp_path / "ball.obj").write_text(obj_text(positions, faces))
    (tmp_path / "cones.json").write_text(json.dumps({"cones": cube_corners(cube(6)[0])}))
    return tmp_path


def uv_of(path: Path) -> np.ndarray:
    return read_mesh(path, with_uv=True).corner_uv


def cut_edges(path: Path) -> set[tuple[int, int]]:
    """Edges whose two faces have different texture coordinates there."""
    sides: dict[tuple[int, int], list] = {}
    mesh = read_mesh(path, with_uv=True)
    for start, face in zip(mesh.starts.tolist(), faces_of(mesh), strict=True):
        for i, a in enumerate(face):
            j = (i + 1) % len(face)
            here = {a: tuple(mesh.corner_uv[start + i]), face[j]: tuple(mesh.corner_uv[start + j])}
            sides.setdefault((min(here), max(here)), []).append(here)
    return {edge for edge, both in sides.items() if len(both) == 2 and both[0] != both[1]}


# --- what is written ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_vertices_order_and_polygons_stay(lsgp, tmp_path: Path, kind: str) -> None:
    positions, faces = patch()
    positions = positions / 3 + 1e-9  # doubles that no short decimal stands for
    contents = {"obj": obj_text(positions, faces).encode(), "off": off_text(positions, faces).encode()}
    contents["ply"] = ply_bytes(positions, faces, "binary_big_endian")
    (tmp_path / f"in.{kind}").write_bytes(contents[kind])
    (tmp_path / "none.json").write_text('{"cones": []}')
    done = lsgp("unwrap", f"in.{kind}", "-o", "out.obj", "--cones", "none.json")
    assert (done.code, done.err) == (0, "")
    out = read_mesh(tmp_path / "out.obj", with_uv=True)
    assert out.positions.tobytes() == positions.tobytes()
    assert faces_of(out) == faces
    assert np.isfinite(out.corner_uv).all()
    assert out.corner_uv.min() >= 0
    assert out.corner_uv.max() <= 1
    # A disk without cones is not cut: every vertex has one place.
    assert (tmp_path / "out.obj").read_text().count("vt ") == len(positions)


def test_cube_is_unfolded_isometrically_to_full_precision(lsgp, cube_files: Path) -> None:
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "report.json")
    assert done.code == 0
    mesh = read_mesh(cube_files / "out.obj", with_uv=True)
    after = np.roll(np.arange(len(mesh.corners)).reshape(-1, 4), -1, axis=1).ravel()
    length = np.linalg.norm(mesh.positions[mesh.corners[after]] - mesh.positions[mesh.corners], axis=1)
    ratio = np.linalg.norm(mesh.corner_uv[after] - mesh.corner_uv, axis=1) / length
    assert ratio.max() / ratio.min() - 1 < 1e-9
    report = done.report()
    assert report["cone_angles"] == pytest.approx([1.5 * math.pi] * 8, abs=1e-9)
    assert report["distortion"]["l2_stretch"] == pytest.approx(1, abs=1e-9)


def test_cuts_form_a_tree_through_all_cones_along_polygon_edges(lsgp, ball_files: Path) -> None:
    assert lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json").code == 0
    cuts = cut_edges(ball_files / "out.obj")
    vertices = {vertex for edge in cuts for vertex in edge}
    cones = set(json.loads((ball_files / "cones.json").read_text())["cones"])
    ends = {v for v in vertices if sum(v in edge for edge in cuts) == 1}
    assert cones <= vertices
    assert ends <= cones
    assert len(cuts) == len(vertices) - 1
    # Corners of one quad are never apart: a diagonal was not cut.
    text = (ball_files / "out.obj").read_text()
    assert text.count("vt ") == len(read_mesh(ball_files / "ball.obj").positions) + len(cuts) - 1


def test_same_input_same_bytes(lsgp, ball_files: Path) -> None:
    for cones in ("cones.json", "auto"):
        outputs = set()
        for threads in (1, 4):
            os.environ["OMP_NUM_THREADS"] = str(threads)
            try:
                assert lsgp("unwrap", "ball.obj", "-o", f"{threads}.obj", "--cones", cones).code == 0
            finally:
                del os.environ["OMP_NUM_THREADS"]
            outputs.add((ball_files / f"{threads}.obj").read_bytes())
        assert len(outputs) == 1


def test_all_formats_give_the_same_bytes(lsgp, ball_files: Path) -> None:
    positions, faces = bumpy_ball()
    (ball_files / "ball.off").write_text(off_text(positions, faces))
    (ball_files / "ball.ply").write_bytes(ply_bytes(positions, faces, "binary_little_endian"))
    for kind in ("obj", "off", "ply"):
        assert lsgp("unwrap", f"ball.{kind}", "-o", f"{kind}.obj", "--cones", "cones.json").code == 0
    assert len({(ball_files / f"{kind}.obj").read_bytes() for kind in ("obj", "off", "ply")}) == 1


def test_an_input_can_be_its_own_output(lsgp, cube_files: Path) -> None:
    assert lsgp("unwrap", "cube.obj", "-o", "once.obj", "--cones", "corners.json").code == 0
    assert lsgp("unwrap", "cube.obj", "-o", "cube.obj", "--cones", "corners.json").code == 0
    assert (cube_files / "cube.obj").read_bytes() == (cube_files / "once.obj").read_bytes()


def test_component_that_cannot_be_solved_keeps_no_vt_and_is_named(lsgp, tmp_path: Path) -> None:
    closed, closed_faces = cube(2)
    opened, opened_faces = patch()
    faces = opened_faces + [[v + len(opened) for v in face] for face in closed_faces]
    (tmp_path / "in.obj").write_text(obj_text(np.concatenate([opened, closed + 9]), faces))
    (tmp_path / "none.json").write_text('{"cones": []}')
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--cones", "none.json", "--report", "report.json")
    assert done.code == 0
    unsolved = np.isnan(uv_of(tmp_path / "out.obj")).any(axis=1)
    polygon = np.repeat(np.arange(len(faces)), [len(face) for face in faces])
    assert (unsolved == (polygon >= len(opened_faces))).all()
    report = done.report()
    named = [w["elements"] for w in report["warnings"] if w["code"] == "COMPONENT_SKIPPED"]
    assert named == [{"kind": "faces", "indices": list(range(len(opened_faces), len(faces)))}]
    assert report["triangles"] == sum(len(face) - 2 for face in faces)
    assert "COMPONENT_SKIPPED" in done.err
    assert f"faces {len(opened_faces)}, " in done.err


# --- cones and angles -----------------------------------------------------------------------------------------------

QUARTERS = [3, 3, 2, 4, 3, 3, 3, 3]  # of a turn, at eight cones: 24 = 32 - 8, as on every sphere


def unwrap_with(lsgp, folder: Path, cones: dict, *options: str) -> tuple[int, dict]:
    (folder / "given.json").write_text(json.dumps(cones))
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "given.json", "--report", "report.json", *options)
    return done.code, done.report()


def angles_of(folder: Path) -> dict[str, list]:
    cones = json.loads((folder / "cones.json").read_text())["cones"]
    return {"cones": cones, "angles_over_pi_2": QUARTERS}


def test_angles_in_quarter_turns_are_for_manual_only(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)
    code, manual = unwrap_with(lsgp, ball_files, cones, "--prescription", "manual")
    imposed = dict(zip(manual["cones"], manual["cone_angles"], strict=True))
    expected = {v: k * math.pi / 2 for v, k in zip(cones["cones"], QUARTERS, strict=True)}
    assert code == 0
    assert imposed == pytest.approx(expected, abs=1e-9)
    _, default = unwrap_with(lsgp, ball_files, cones)
    _, without = unwrap_with(lsgp, ball_files, {"cones": cones["cones"]})
    assert default["cone_angles"] == without["cone_angles"]
    assert default["cone_angles"] != pytest.approx(manual["cone_angles"], abs=1e-3)


def test_angles_in_radians_are_used_unless_a_rule_is_named(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)
    radians = [k * math.pi / 2 for k in QUARTERS[::-1]]
    for options in ((), ("--prescription", "manual")):  # they go before the quarter turns
        _, report = unwrap_with(lsgp, ball_files, cones | {"cone_angles": radians}, *options)
        imposed = dict(zip(report["cones"], report["cone_angles"], strict=True))
        assert imposed == pytest.approx(dict(zip(cones["cones"], radians, strict=True)), abs=1e-9)
    for rule in ("least-distortion", "harmonic"):
        _, given = unwrap_with(lsgp, ball_files, cones | {"cone_angles": radians}, "--prescription", rule)
        _, free = unwrap_with(lsgp, ball_files, {"cones": cones["cones"]}, "--prescription", rule)
        assert given["cone_angles"] == free["cone_angles"]


def test_null_is_an_automatic_angle(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)["cones"]
    _, report = unwrap_with(lsgp, ball_files, {"cones": cones, "cone_angles": [4.0, None, 5.0] + [None] * 5})
    imposed = dict(zip(report["cones"], report["cone_angles"], strict=True))
    assert (imposed[cones[0]], imposed[cones[2]]) == pytest.approx((4.0, 5.0), abs=1e-9)
    assert sum(2 * math.pi - angle for angle in imposed.values()) == pytest.approx(4 * math.pi, abs=1e-9)
    _, empty = unwrap_with(lsgp, ball_files, {"cones": cones, "cone_angles": [None] * 8})
    _, absent = unwrap_with(lsgp, ball_files, {"cones": cones})
    assert empty["cone_angles"] == absent["cone_angles"]


def test_report_is_a_cones_file_for_the_same_map(lsgp, ball_files: Path) -> None:
    assert lsgp("unwrap", "ball.obj", "-o", "a.obj", "--cones", "auto:6", "--report", "a.json").code == 0
    assert lsgp("unwrap", "ball.obj", "-o", "b.obj", "--cones", "a.json", "--report", "b.json").code == 0
    first, second = (json.loads((ball_files / name).read_text()) for name in ("a.json", "b.json"))
    assert len(first["cones"]) == 6
    assert second["cone_angles"] == pytest.approx(first["cone_angles"], abs=1e-9)
    # The same up to a similarity that keeps the size of the island.
    a, b = (uv_of(ball_files / name) for name in ("a.obj", "b.obj"))
    assert np.abs(_lengths(a) / _lengths(b) - 1).max() < 1e-6


def _lengths(uv: np.ndarray) -> np.ndarray:
    quads = uv.reshape(-1, 4, 2)
    return np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2)


def test_automatic_cones(lsgp, ball_files: Path) -> None:
    assert lsgp("unwrap", "ball.obj", "-o", "out.obj", "--report", "default.json").code == 0
    for option in ("auto", "auto:3", "auto:11"):
        done = lsgp("unwrap", "ball.obj", "-o", f"{option}.obj", "--cones", option, "--report", f"{option}.json")
        assert done.code == 0
    counts = {n: len(done.report(f"{n}.json")["cones"]) for n in ("default", "auto", "auto:3", "auto:11")}
    assert counts["default"] == counts["auto"] >= 3
    assert (counts["auto:3"], counts["auto:11"]) == (3, 11)
    assert (ball_files / "out.obj").read_bytes() == (ball_files / "auto.obj").read_bytes()


def test_prescriptions_differ_and_keep_gauss_bonnet(lsgp, ball_files: Path) -> None:
    found = {}
    for rule in ("least-distortion", "harmonic", "straightness"):
        code, report = unwrap_with(lsgp, ball_files, {"cones": angles_of(ball_files)["cones"]}, "--prescription", rule)
        assert code == 0
        assert sum(2 * math.pi - a for a in report["cone_angles"]) == pytest.approx(4 * math.pi, abs=1e-9)
        found[rule] = report
    stretch = {rule: report["distortion"]["l2_stretch"] for rule, report in found.items()}
    assert stretch["least-distortion"] < stretch["harmonic"]
    assert len({tuple(np.round(report["cone_angles"], 4)) for report in found.values()}) == 3


# --- other options --------------------------------------------------------------------------------------------------


def test_lscm_gives_up_the_continuity_that_lsgp_keeps(lsgp, ball_files: Path) -> None:
    ratios = {}
    for method in ("lsgp", "lscm"):
        done = lsgp(
            "unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--method", method, "--report", "r.json"
        )
        ratios[method] = done.report("r.json")["seams"]["sister_ratio_max"]
    assert ratios["lsgp"] == pytest.approx(1, abs=1e-9)
    assert ratios["lscm"] > 1.01


def test_both_ways_to_unfold_give_one_map_where_it_is_exact(lsgp, cube_files: Path) -> None:
    for unfold in ("poisson", "spectral"):
        done = lsgp("unwrap", "cube.obj", "-o", f"{unfold}.obj", "--cones", "corners.json", "--unfold", unfold)
        assert (done.code, done.err) == (0, "")
    poisson, spectral = (_lengths(uv_of(cube_files / f"{unfold}.obj")) for unfold in ("poisson", "spectral"))
    ratio = poisson / spectral
    assert ratio.max() / ratio.min() - 1 < 1e-8


def test_cuts_are_drawn_to_seam_edges(lsgp, cube_files: Path) -> None:
    corners = set(json.loads((cube_files / "corners.json").read_text())["cones"])
    mesh = read_mesh(cube_files / "cube.obj")
    neighbours: dict[int, set[int]] = {}
    for face in faces_of(mesh):
        for i in range(4):
            neighbours.setdefault(face[i], set()).update((face[i - 1], face[(i + 1) % 4]))
    # The twelve edges of the cube: straight walks from corner to corner.
    walks = []
    for corner in sorted(corners):
        for following in sorted(neighbours[corner]):
            walk = [corner, following]
            while walk[-1] not in corners:
                straight = 2 * mesh.positions[walk[-1]] - mesh.positions[walk[-2]]
                walk.append(min(neighbours[walk[-1]], key=lambda v: float(((mesh.positions[v] - straight) ** 2).sum())))
            walks.append({tuple(sorted(pair)) for pair in pairwise(walk)})
    assert lsgp("unwrap", "cube.obj", "-o", "free.obj", "--cones", "corners.json").code == 0
    free = cut_edges(cube_files / "free.obj")
    wanted = next(walk for walk in walks if not walk & free)
    (cube_files / "seams.json").write_text(json.dumps(sorted(map(list, wanted))))
    drawn = lsgp("unwrap", "cube.obj", "-o", "drawn.obj", "--cones", "corners.json", "--seam-edges", "seams.json")
    assert (drawn.code, drawn.err) == (0, "")
    assert wanted <= cut_edges(cube_files / "drawn.obj")


# --- reports --------------------------------------------------------------------------------------------------------


def test_report_of_a_result(lsgp, ball_files: Path) -> None:
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json")
    report = done.report()
    assert list(report) == KEYS
    assert (report["status"], report["code"], report["message"], report["elements"]) == ("ok", None, None, None)
    assert report["triangles"] == 432
    assert report["cones"] == json.loads((ball_files / "cones.json").read_text())["cones"]
    assert sum(2 * math.pi - a for a in report["cone_angles"]) == pytest.approx(4 * math.pi, abs=1e-9)
    assert list(report["distortion"]) == DISTORTION_KEYS
    assert list(report["seams"]) == SEAM_KEYS
    assert 1 <= report["distortion"]["quasi_conformal"] < 1.2
    assert report["distortion"]["area_p10"] <= report["distortion"]["area"] <= report["distortion"]["area_p90"]
    assert report["seams"]["sister_ratio_max"] == pytest.approx(1, abs=1e-9)
    assert report["seams"]["translation_residual"] <= 1e-12
    assert (report["flipped"], report["wrong_angle_sums"]) == (0, 0)
    assert {"read_file", "triangulate", "write_file"} < set(report["stage_seconds"])
    assert all(seconds >= 0 for seconds in report["stage_seconds"].values())
    for figure in (
        f"{report['distortion']['l2_stretch']:.4f}",
        "out.obj",
        "432 of 432 triangles",
        "8 cones",
        "1 island\n",
    ):
        assert figure in done.out


def test_report_of_a_refusal(lsgp, ball_files: Path) -> None:
    (ball_files / "out.obj").write_text("before")
    (ball_files / "given.json").write_text(json.dumps({"cones": [0, 4, 0]}))
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "given.json", "--report", "report.json")
    assert done.code == 3
    report = done.report()
    assert list(report) == KEYS
    assert (report["status"], report["code"]) == ("refused", "CONE_DUPLICATE")
    assert report["elements"] == {"kind": "vertices", "indices": [0]}
    assert (report["triangles"], report["warnings"], report["distortion"], report["seams"]) == (432, [], None, None)
    assert (report["flipped"], report["wrong_angle_sums"], report["cones"], report["cone_angles"]) == (
        None,
        None,
        [],
        [],
    )
    assert report["message"] in done.err
    assert "CONE_DUPLICATE" in done.err
    assert done.out == ""
    assert (ball_files / "out.obj").read_text() == "before"


def test_triangles_in_a_report_are_faces_of_the_file(lsgp, tmp_path: Path) -> None:
    positions, faces = cube(2)
    positions[faces[5][0]] = positions[faces[5][1]]  # a zero-area triangle beside other ones
    (tmp_path / "in.obj").write_text(obj_text(positions, faces))
    (tmp_path / "cones.json").write_text(json.dumps({"cones": cube_corners(cube(2)[0])}))
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json")
    report = done.report()
    found = [w["elements"] for w in report["warnings"]] + ([report["elements"]] if report["elements"] else [])
    on_faces = [elements for elements in found if elements["kind"] == "faces"]
    assert on_faces
    assert all(elements["kind"] != "triangles" for elements in found)
    assert all(elements["indices"] == sorted(set(elements["indices"])) for elements in on_faces)
    assert all(0 <= face < len(faces) for elements in on_faces for face in elements["indices"])
    touching = [i for i, face in enumerate(faces) if {faces[5][0], faces[5][1]} <= set(face)]
    degenerate = next(elements for elements in on_faces if set(elements["indices"]) & set(touching))
    assert set(degenerate["indices"]) <= set(touching)


# --- measure --------------------------------------------------------------------------------------------------------


def test_measure_agrees_with_unwrap(lsgp, ball_files: Path) -> None:
    unwrapped = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "a.json").report(
        "a.json"
    )
    done = lsgp("measure", "out.obj", "--report", "b.json")
    measured = done.report("b.json")
    assert (done.code, done.err) == (0, "")
    assert list(measured) == KEYS
    assert measured["status"] == "ok"
    assert measured["distortion"] == pytest.approx(unwrapped["distortion"], rel=1e-9)
    assert measured["seams"]["sister_ratio_max"] == pytest.approx(1, abs=1e-9)
    assert (measured["flipped"], measured["triangles"]) == (0, 432)
    assert (measured["cones"], measured["cone_angles"], measured["wrong_angle_sums"]) == ([], [], None)
    assert f"{measured['distortion']['l2_stretch']:.4f}" in done.out


def test_measure_of_known_maps(lsgp, tmp_path: Path) -> None:
    square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt {s} 0\nvt {s} 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    (tmp_path / "in.obj").write_text(square.format(s=3))
    distortion = lsgp("measure", "in.obj", "--report", "r.json").report("r.json")["distortion"]
    # Stretched three times in one direction: sigma 3 and 1, for the inverse map 1/3 and 1 at a third of the density.
    assert distortion["quasi_conformal"] == pytest.approx(3, rel=1e-12)
    assert distortion["area"] == pytest.approx(1, rel=1e-12)
    assert distortion["l2_stretch"] == pytest.approx(math.sqrt((1 + 1 / 9) / 2 * 3), rel=1e-12)
    # Three faces one way and one the other.
    strip = "".join(f"v {x} 0 0\nv {x} 1 0\n" for x in range(5))
    strip += "vt 0 0\nvt 0 1\nvt 1 0\nvt 1 1\nvt 2 0\nvt 2 1\nvt 3 0\nvt 3 1\nvt 2.5 0\nvt 2.5 1\n"
    strip += "".join(f"f {a}/{a} {a + 2}/{a + 2} {a + 3}/{a + 3} {a + 1}/{a + 1}\n" for a in (1, 3, 5, 7))
    (tmp_path / "in.obj").write_text(strip)
    assert lsgp("measure", "in.obj", "--report", "r.json").report("r.json")["flipped"] == 2


def test_measure_leaves_faces_without_coordinates_out_and_names_them(lsgp, tmp_path: Path) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    (tmp_path / "in.obj").write_text(text + "f 1/1 2/2 3/3 4/4\nf 2 5 6 3\n")
    done = lsgp("measure", "in.obj", "--report", "r.json")
    report = done.report("r.json")
    assert done.code == 0
    assert report["distortion"]["quasi_conformal"] == pytest.approx(1, rel=1e-12)
    assert [(w["code"], w["elements"]) for w in report["warnings"]] == [
        ("FACES_WITHOUT_UV", {"kind": "faces", "indices": [1]})
    ]
    assert "FACES_WITHOUT_UV" in done.err
    assert "2 of 4 triangles" in done.out


# --- exit codes -----------------------------------------------------------------------------------------------------

UNWRAP = ["unwrap", "in.obj", "-o", "out.obj"]
REFUSED = {
    "vertices only": ({"in.obj": "v 0 0 0\nv 1 0 0\n"}, UNWRAP, "EMPTY_MESH"),
    "empty file": ({"in.obj": ""}, UNWRAP, "EMPTY_MESH"),
    "isolated cone": ({"in.obj": "PATCH", "c.json": '{"cones": [99]}'}, [*UNWRAP, "--cones", "c.json"], "CONE_INDEX"),
    "negative cone": ({"in.obj": "PATCH", "c.json": '{"cones": [-1]}'}, [*UNWRAP, "--cones", "c.json"], "CONE_INDEX"),
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
    "other format": ({"in.stl": "solid\n"}, ["unwrap", "in.stl", "-o", "out.obj"], "UNKNOWN_FORMAT"),
    "measure without uv": ({"in.obj": "PATCH"}, ["measure", "in.obj"], "NO_UV"),
    "measure an off": ({"in.off": "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}, ["measure", "in.off"], "NO_UV"),
    "measure no faces": ({"in.obj": "v 0 0 0\nvt 0 0\n"}, ["measure", "in.obj"], "EMPTY_MESH"),
    "measure broken vt": (
        {"in.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n"},
        ["measure", "in.obj"],
        "INDEX_OUT_OF_RANGE",
    ),
}
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
    "output of another format": (["unwrap", "in.obj", "-o", "out.ply"], "out.ply"),
    "report in no folder": ([*UNWRAP, "--report", "none/r.json"], "none"),
    "report over output": ([*UNWRAP, "--report", "./out.obj"], "same file"),
    "manual for automatic cones": ([*UNWRAP, "--prescription", "manual"], "manual"),
    "measure missing": (["measure", "none.obj"], "none.obj"),
    "measure nothing": (["measure"], "FILE.obj"),
}


def write_files(folder: Path, files: dict[str, str]) -> None:
    made = {"PATCH": lambda: obj_text(*patch()), "CUBE": lambda: obj_text(*cube(2))}
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
    assert list(report) == KEYS
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


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="needs a user whom file modes bind")
def test_file_that_cannot_be_written_ends_with_2(lsgp, cube_files: Path) -> None:
    (cube_files / "out.obj").touch(mode=0o444)
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json")
    assert (done.code, "out.obj" in done.err) == (2, True)


def test_full_disk_ends_with_2(lsgp, cube_files: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "/dev/full")
    assert (done.code, "No space left" in done.err) == (2, True)
    assert "Traceback" not in done.err


def test_same_codes_from_a_process(lsgp, cube_files: Path) -> None:
    assert lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json").code == 0
    assert lsgp("unwrap", "cube.obj").code == 2
    assert lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "auto:0").code == 3
    assert lsgp("unwrap", "none.obj", "-o", "out.obj").code == 2


def test_not_enough_memory_is_a_refusal(
    cube_files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def exhaust(*arguments: object) -> None:
        raise MemoryError

    monkeypatch.chdir(cube_files)
    monkeypatch.setattr("lsgp.cli.parameterize", exhaust)
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


def test_version_and_help(lsgp) -> None:
    assert lsgp("--version").out == f"lsgp {version('lsgp')}\n"
    for arguments in (["--help"], ["unwrap", "--help"], ["measure", "--help"]):
        done = lsgp(*arguments)
        assert (done.code, done.err) == (0, "")
        assert "--report" in done.out or "unwrap" in done.out


# --- files of the shared folder -------------------------------------------------------------------------------------


def test_shared_cube_with_its_cones_file(lsgp, shared: Path, tmp_path: Path) -> None:
    mesh, cones = shared / "meshes" / "cube-768.obj", shared / "meshes" / "cube-768.cones.json"
    for rule in ("least-distortion", "manual"):
        done = lsgp("unwrap", mesh, "-o", "o.obj", "--cones", cones, "--prescription", rule, "--report", "r.json")
        assert (done.code, done.err) == (0, "")
        report = done.report("r.json")
        assert report["distortion"]["l2_stretch"] == pytest.approx(1, abs=1e-9)
        assert report["cone_angles"] == pytest.approx([1.5 * math.pi] * 8, abs=1e-9)
    assert (read_mesh(tmp_path / "o.obj").positions == read_mesh(mesh).positions).all()


def test_shared_moebius_strip_is_refused_by_name(lsgp, shared: Path) -> None:
    done = lsgp("unwrap", shared / "meshes" / "moebius.obj", "-o", "o.obj", "--report", "r.json")
    assert (done.code, done.report("r.json")["code"]) == (3, "NOT_ORIENTABLE")


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
