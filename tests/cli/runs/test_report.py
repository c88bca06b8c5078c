# SPDX-License-Identifier: GPL-3.0-or-later
"""The reports of `lsgp unwrap` and `lsgp measure`, for programs and for people."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import lsgp as library
import numpy as np
import pytest
from command import DISTORTION_KEYS, REPAIR_KEYS, REPORT_KEYS, SEAM_KEYS
from lsgp import Distortion, Elements, LsgpError, RepairReport, SeamQuality
from lsgp.io.polygons import triangulate
from lsgp.run.report import on_faces, quality_table, refusal_report, to_json
from polygon_meshes import cube, cube_corners, obj_text, patch, polygon_mesh


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_json_has_not_become_null(value: float) -> None:
    report = {"a": value, "b": [value, 1.5], "c": {"d": [{"e": value}]}}
    text = to_json(report).decode("ascii")
    assert json.loads(text) == {"a": None, "b": [None, 1.5], "c": {"d": [{"e": None}]}}
    assert "NaN" not in text
    assert "Infinity" not in text


def test_doubles_in_a_report_read_back_as_the_same_doubles() -> None:
    values = np.random.default_rng(0).normal(size=100).tolist()
    assert json.loads(to_json({"a": values}))["a"] == values


def test_triangles_become_the_faces_they_were_cut_from() -> None:
    positions, faces = patch()
    triangulation = triangulate(polygon_mesh(positions, faces))
    triangles = Elements("triangles", np.array([9, 0, 1, 3, 2, 8], np.int32))
    # Face 0 is a triangle, face 1 a pentagon, the rest are quads.
    assert on_faces(triangles, triangulation).kind == "faces"
    assert on_faces(triangles, triangulation).indices.tolist() == [0, 1, 4]
    for kind in ("vertices", "edges"):
        elements = Elements(kind, triangles.indices)
        assert on_faces(elements, triangulation) is elements
    error = LsgpError("CODE", "Message.", triangles)
    assert refusal_report(error, triangulation)["elements"] == {"kind": "faces", "indices": [0, 1, 4]}
    assert refusal_report(error, None)["elements"]["kind"] == "triangles"


def test_elements_in_a_sentence() -> None:
    assert str(Elements()) == ""
    assert str(Elements("faces", np.array([3], np.int32))) == "faces 3"
    assert str(Elements("edges", np.array([[3, 4], [0, 1]], np.int32))) == "edges 3-4, 0-1"
    assert str(Elements("vertices", np.arange(9, dtype=np.int32))) == "vertices 0, 1, 2, 3, 4 and 4 more"


def rows_of(table: str) -> dict[str, list[str]]:
    return {line[:22].strip(): line[22:].split() for line in table.splitlines()}


def test_table_has_every_figure() -> None:
    surface = library.Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    figures = {
        "distortion": Distortion(1.01, 1.02, 1.03, 0.84, 1.25, 1.06),
        "seams": SeamQuality(1 + 2**-40, 3e-13, 4e-16),
        "flipped": np.arange(5, dtype=np.int32),
    }
    of_a_map = {
        "wrong_angle_sums": np.arange(6, dtype=np.int32),
        "repair": RepairReport(7, 8, 9),
        "overlapping": np.arange(10, dtype=np.int32),
        "overlap_area": 0.0123,
    }
    rows = rows_of(quality_table(replace(library.parameterize(surface, []), **figures, **of_a_map)))
    assert rows["quasi-conformal"] == ["1.0100", "1", "area-weighted", "1.0200"]
    assert rows["area"] == ["1.0300", "1", "10", "%", "0.8400,", "90", "%", "1.2500"]
    assert rows["L2 stretch"][0] == "1.0600"
    assert rows["seam length mismatch"][0] == "9.1e-13"
    assert rows["rotation residual"] == ["1.7e-11", "0", "degrees"]
    assert rows["translation residual"][0] == "4.0e-16"
    assert rows["flipped triangles"] == ["5", "0", "7", "as", "first", "unfolded"]
    assert rows["wrong angle sums"] == ["6", "0", "vertices,", "8", "as", "first", "unfolded"]
    assert rows["Newton iterations"] == ["9"]
    assert rows["overlapping triangles"] == ["10", "0", "1.23", "%", "of", "the", "layout"]

    measured = library.measure_distortion(surface, np.zeros((1, 3, 2)))
    of_a_measurement = rows_of(quality_table(replace(measured, **figures)))
    assert of_a_measurement["flipped triangles"] == ["5", "0"]
    assert set(rows) - set(of_a_measurement) == {"wrong angle sums", "Newton iterations", "overlapping triangles"}
    assert all(of_a_measurement[label] == rows[label] for label in of_a_measurement if label != "flipped triangles")


# --- of unwrap ------------------------------------------------------------------------------------------------------


def test_report_of_a_result(lsgp, ball_files: Path) -> None:
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json")
    report = done.report()
    assert list(report) == REPORT_KEYS
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
    assert (report["flipped"], report["wrong_angle_sums"], report["islands"]) == (0, 0, 1)
    assert list(report["repair"]) == REPAIR_KEYS
    assert all(isinstance(count, int) and count >= 0 for count in report["repair"].values())
    assert (report["overlapping"] > 0) == (report["overlap_area"] > 0)
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


def test_report_to_standard_output(lsgp, ball_files: Path) -> None:
    """What is said to people goes to standard error then, and a refusal is reported as well."""
    before = sorted(ball_files.iterdir())
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "-")
    assert done.code == 0 and json.loads(done.out)["triangles"] == 432 and "432 of 432 triangles" in done.err
    assert sorted(ball_files.iterdir()) == sorted([*before, ball_files / "out.obj"])
    refused = lsgp("measure", "ball.obj", "--report", "-")
    assert refused.code == 3 and json.loads(refused.out)["code"] == "NO_UV" and "NO_UV" in refused.err
    both = lsgp("unwrap", "ball.obj", "-o", "-", "--report", "-")
    assert both.code == 2 and both.out == "" and "both -" in both.err


def test_report_of_a_refusal(lsgp, ball_files: Path) -> None:
    (ball_files / "out.obj").write_text("before")
    (ball_files / "given.json").write_text(json.dumps({"cones": [0, 4, 0]}))
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "given.json", "--report", "report.json")
    assert done.code == 3
    report = done.report()
    assert list(report) == REPORT_KEYS
    assert (report["status"], report["code"]) == ("refused", "CONE_DUPLICATE")
    assert report["elements"] == {"kind": "vertices", "indices": [0]}
    assert (report["triangles"], report["warnings"], report["distortion"], report["seams"]) == (432, [], None, None)
    for key in ("islands", "flipped", "wrong_angle_sums", "repair", "overlapping", "overlap_area"):
        assert report[key] is None
    assert (report["cones"], report["cone_angles"]) == ([], [])
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


# --- of measure -----------------------------------------------------------------------------------------------------


def test_measure_agrees_with_unwrap(lsgp, ball_files: Path) -> None:
    unwrapped = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "a.json").report(
        "a.json"
    )
    done = lsgp("measure", "out.obj", "--report", "b.json")
    measured = done.report("b.json")
    assert (done.code, done.err) == (0, "")
    assert list(measured) == REPORT_KEYS
    assert measured["status"] == "ok"
    assert measured["distortion"] == pytest.approx(unwrapped["distortion"], rel=1e-9)
    assert measured["seams"]["sister_ratio_max"] == pytest.approx(1, abs=1e-9)
    assert (measured["flipped"], measured["triangles"]) == (0, 432)
    assert (measured["cones"], measured["cone_angles"], measured["islands"]) == ([], [], 1)
    for key in ("wrong_angle_sums", "repair", "overlapping", "overlap_area"):
        assert measured[key] is None
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
    assert report["islands"] == 1
    assert "FACES_WITHOUT_UV" in done.err
    assert "2 of 4 triangles" in done.out
