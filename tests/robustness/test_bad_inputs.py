# SPDX-License-Identifier: GPL-3.0-or-later
"""The malformed and extreme inputs of ../shared/bad: each ends as it may, quickly by the API, and by the command line.

`expect` of a case lists classes of outcomes: OK, a result without a defect; W_..., a result with that finding; E_...,
refused with that finding.  As a script this module prints how every case ends, for builds to be compared.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import lsgp
import numpy as np
import pytest
from lsgp.io import polygons
from lsgp.io.mesh_files import read_mesh
from result_check import undeclared_faults
from shared_meshes import shared_folder
from this_process import run_command

SECONDS = 5.0  # of processor time

# Our codes: the class of finding that each is.
CLASS_OF_CODE = {
    "EMPTY_MESH": "E_EMPTY_MESH",
    "BAD_FACE": "E_BAD_FACE",
    "INDEX_OUT_OF_RANGE": "E_INDEX_OUT_OF_RANGE",
    "NON_FINITE_POSITION": "E_NON_FINITE_VERTEX",
    "SCALE_RANGE": "E_SCALE_RANGE",
    "DEGENERATE_MESH": "E_DEGENERATE_MESH",
    "SOLVER_FAILED": "E_SOLVER_FAILED",
    "SEAM_NOT_AN_EDGE": "E_SEAM_NOT_AN_EDGE",
    "NOT_ORIENTABLE": "E_NOT_ORIENTABLE",
    "TOO_FEW_CONES": "E_TOO_FEW_CONES",
    "CONE_INDEX": "E_CONE_INDEX",
    "CONE_DUPLICATE": "E_CONE_DUPLICATE",
    "CONE_NOT_ON_SURFACE": "E_CONE_NOT_ON_SURFACE",
    "CONE_ANGLE_NON_FINITE": "E_CONE_ANGLE_NON_FINITE",
    "CONE_ANGLE_RANGE": "E_CONE_ANGLE_RANGE",
    "GAUSS_BONNET": "E_GAUSS_BONNET",
    "ANGLES_IMPOSSIBLE": "E_CONE_ANGLE_RANGE",
    "ANGLE_COUNT": "E_WRONG_PARAMETER",
    "WRONG_PARAMETER": "E_WRONG_PARAMETER",
    "COMPONENT_SKIPPED": "W_COMPONENT_SKIPPED",
    "CONE_ON_BOUNDARY": "W_CONE_ON_BOUNDARY",
    "DEGENERATE_FACES": "W_DEGENERATE_FACES",
    "DUPLICATE_FACE": "W_DUPLICATE_FACE",
    "ISOLATED_VERTICES": "W_ISOLATED_VERTICES",
    "NON_MANIFOLD_EDGE": "W_NON_MANIFOLD_EDGE",
    "REORIENTED": "W_REORIENTED",
    "SPLIT_VERTEX": "W_SPLIT_VERTEX",
    "FLIPPED_TRIANGLES": "W_POOR_QUALITY",
    "WRONG_ANGLE_SUMS": "W_POOR_QUALITY",
    "HIGH_DISTORTION": "W_POOR_QUALITY",
    "INEXACT_SEAMS": "W_POOR_QUALITY",
    "INEXACT_ANGLES": "W_POOR_QUALITY",
    "ANGLES_ADJUSTED": "W_POOR_QUALITY",
    "CONES_NOT_SNAPPED": "W_CONES_NOT_SNAPPED",
}

# Findings on the quality of a result, and triangles without one: it is then no plain success.
DEFECTS = {
    *("FLIPPED_TRIANGLES", "WRONG_ANGLE_SUMS", "INEXACT_SEAMS", "INEXACT_ANGLES", "ANGLES_ADJUSTED"),
    "COMPONENT_SKIPPED",
}

Case = dict[str, Any]


def case_names() -> list[str]:
    return sorted(path.stem for path in (shared_folder() / "bad").glob("*.json") if path.stem != "index")


def load(name: str) -> Case:
    return json.loads((shared_folder() / "bad" / f"{name}.json").read_text())


def triangulated(case: Case) -> tuple[lsgp.Surface, polygons.Triangulation | None]:
    """The surface of a case; triangles go in as they are, larger polygons the way a file of them would."""
    positions = np.array(case["V"], float).reshape(-1, 3)
    faces, seams = case["F"], np.array(case["seams"], np.int64).reshape(-1, 2)
    importance = importance_in(case)
    if all(len(face) == 3 for face in faces):
        return lsgp.Surface(positions, np.array(faces, np.int64).reshape(-1, 3), None, seams, importance), None
    corners = np.array([v for face in faces for v in face], np.int64)
    sizes = np.array([len(face) for face in faces], np.int64)
    polygons.require_polygons(len(positions), corners, sizes)
    cut = polygons.triangulate(polygons.PolygonMesh(positions, corners.astype(np.int32), sizes))
    return lsgp.Surface(positions, cut.triangles, cut.edges, seams, importance), cut


def importance_in(case: Case) -> list[float] | None:
    """A weight is the importance of every vertex."""
    return [case["params"]["weight"]] * len(case["V"]) if "weight" in case["params"] else None


def options_of(case: Case) -> lsgp.Options:
    """A resolution is a number of tiles; weights are for low stretch.  Raises InputError."""
    unknown = set(case["params"]) - {"resolution", "weight"}
    assert not unknown, f"there are no such options: {unknown}"
    tiles = case["params"].get("resolution")
    return lsgp.Options(
        seamless=None if tiles is None else lsgp.Seamless(tiles=tiles),
        mode="low-stretch" if "weight" in case["params"] else "conformal",
    )


def outcome(case: Case) -> tuple[lsgp.Surface | None, lsgp.Result | lsgp.LsgpError]:
    """How a case ends through the API; anything but an error of the library passes through."""
    surface = None
    try:
        surface, _ = triangulated(case)
        return surface, lsgp.parameterize(surface, case["cones"], case["cone_angles"], options_of(case))
    except lsgp.LsgpError as error:
        return surface, error


def classes_of_result(codes: list[str]) -> set[str]:
    return {CLASS_OF_CODE[code] for code in codes if code in CLASS_OF_CODE} | (
        set() if DEFECTS & set(codes) else {"OK"}
    )


if not case_names():
    pytest.skip(f"no cases in {shared_folder() / 'bad'}: set LSGP_SHARED to run them", allow_module_level=True)


def test_no_case_is_missing() -> None:
    assert len(case_names()) >= 79


@pytest.mark.parametrize("name", case_names())
def test_through_the_api(name: str) -> None:
    case = load(name)
    begin = time.process_time()
    surface, ended = outcome(case)
    seconds = time.process_time() - begin
    if isinstance(ended, lsgp.LsgpError):
        assert CLASS_OF_CODE.get(ended.code) in case["expect"], f"{ended.code}: {ended.message}"
    else:
        given = dict(zip(case["cones"], case["cone_angles"] or [None] * len(case["cones"]), strict=True))
        assert undeclared_faults(surface, ended, options_of(case), given) == []
        assert (ended.seamless is not None) == ("resolution" in case["params"])
        codes = [finding.code for finding in ended.warnings]
        assert classes_of_result(codes) & set(case["expect"]), f"a result with {codes}"
    assert seconds < SECONDS


@pytest.mark.slow
@pytest.mark.parametrize("name", case_names())
def test_through_the_command_line(tmp_path: Path, name: str) -> None:
    """The same end as through the API, with the same coordinates."""
    case = load(name)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in case["V"]]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in case["F"]]
    (tmp_path / "in.obj").write_text("\n".join(lines) + "\n")
    (tmp_path / "cones.json").write_text(json.dumps({"cones": case["cones"], "cone_angles": case["cone_angles"]}))
    (tmp_path / "seams.json").write_text(json.dumps(case["seams"]))
    command = ["unwrap", "in.obj", "-o", "out.obj", "--report", "report.json"]
    command += ["--cones", "cones.json", "--seam-edges", "seams.json", "--cuts", "shortest"]
    if "resolution" in case["params"]:
        command += ["--seamless", "--tiles", str(case["params"]["resolution"])]
    if "weight" in case["params"]:
        (tmp_path / "importance.json").write_text(json.dumps(importance_in(case)))
        command += ["--mode", "low-stretch", "--importance", "importance.json"]
    done = run_command(tmp_path, *command)
    assert done.returncode in (0, 2, 3, 4), done.stderr

    _, expected = outcome(case)
    if done.returncode == 2:
        assert not (tmp_path / "out.obj").exists()
        pytest.fail(f"a file that can be read and written is no wrong usage: {done.stderr}")
    report = json.loads((tmp_path / "report.json").read_text())
    if done.returncode == 3:
        assert isinstance(expected, lsgp.LsgpError), "the API has a result"
        assert report["code"] == expected.code
        assert not (tmp_path / "out.obj").exists()
        return
    if isinstance(expected, lsgp.LsgpError) and expected.code == "BAD_FACE":  # files are taken without such faces
        assert {"FACES_LEFT_OUT", "REPEATED_CORNERS"} & {warning["code"] for warning in report["warnings"]}
        return
    assert isinstance(expected, lsgp.Result), "the API refuses this"
    assert [warning["code"] for warning in report["warnings"]] == [finding.code for finding in expected.warnings]
    _, cut = triangulated(case)
    there = read_mesh(tmp_path / "out.obj", with_uv=True).corner_uv
    wanted = expected.corner_uv.reshape(-1, 2)
    if cut is not None:
        wanted = cut.to_polygon_corners(expected.corner_uv, len(there))
    assert np.array_equal(there, wanted, equal_nan=True)


def main() -> None:
    for name in case_names():
        _, ended = outcome(load(name))
        if isinstance(ended, lsgp.LsgpError):
            print(name, ended.code)
        else:
            print(name, "result", *sorted(finding.code for finding in ended.warnings))


if __name__ == "__main__":
    main()
