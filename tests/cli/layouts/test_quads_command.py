# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp quads`: a file of quads, and its report."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command import DISTORTION_KEYS, REPORT_KEYS
from lsgp.io.mesh_files import read_mesh
from meshes import cylinder, transform
from polygon_meshes import obj_text
from quad_checks import fans, sides
from zoo import closed

QUADS = ["quads", "ball.obj", "-o", "quads.obj"]


def quads_of(path: Path) -> tuple[np.ndarray, np.ndarray]:
    mesh = read_mesh(path)
    assert set(mesh.sizes.tolist()) == {4}
    return mesh.positions, mesh.corners.reshape(-1, 4)


def test_a_closed_mesh_becomes_a_file_of_quads(lsgp, ball_files: Path) -> None:
    done = lsgp(*QUADS, "--target", 300, "--cones", "cones.json", "--report", "report.json")
    assert (done.code, done.err) == (0, "")
    positions, quads = quads_of(ball_files / "quads.obj")
    assert b"vt" not in (ball_files / "quads.obj").read_bytes()
    once = sides(quads)
    assert set(once.values()) == {1} and all((b, a) in once for a, b in once)
    assert fans(quads) == len(positions) == len(quads) + 2
    assert abs(len(quads) - 300) <= 30
    report = done.report()
    assert list(report) == REPORT_KEYS
    assert list(report["distortion"]) == DISTORTION_KEYS
    told = report["quads"]
    assert (told["count"], told["vertices"]) == (len(quads), len(positions))
    valence = np.bincount(quads.ravel())
    counts = {str(v): int((valence == v).sum()) for v in np.unique(valence[valence != 4]).tolist()}
    assert told["irregular"] == counts
    turns = np.round(np.array(report["cone_angles"]) / (np.pi / 2)).astype(int)
    assert sorted(turns.tolist()) == sorted(valence[valence != 4].tolist())
    assert 0 < told["angle_error"] < told["worst_angle_error"] < np.pi / 2
    assert told["shortest_edge"] < 1 < told["longest_edge"]
    assert set(report["stage_seconds"]) == {"read_file", "triangulate", "remesh_to_quads", "write_file"}
    first = done.out.splitlines()[0]
    assert first.startswith(f"quads.obj: {len(quads)} quads of side {told['size']:.4g}, {len(positions)} vertices, ")
    assert f"{len(turns)} irregular" in first
    assert f"{np.degrees(told['worst_angle_error']):.1f} at most" in done.out


def test_the_side_of_quads_is_that_on_the_surface(lsgp, cube_files: Path) -> None:
    size = float(np.ptp(read_mesh(cube_files / "cube.obj").positions[:, 0])) / 8
    done = lsgp("quads", "cube.obj", "-o", "out.obj", "--size", size, "--cones", "corners.json", "--up", 0, 0, 1)
    assert done.code == 0
    positions, quads = quads_of(cube_files / "out.obj")
    assert len(quads) == 6 * 8 * 8
    lengths = np.linalg.norm(positions[quads] - positions[np.roll(quads, 1, axis=1)], axis=2)
    np.testing.assert_allclose(lengths, size, rtol=1e-5)


def test_strokes_direct_rows_as_up_does(lsgp, ball_files: Path) -> None:
    faces = len(read_mesh(ball_files / "ball.obj").sizes)
    made = {}
    for name, vector in (("up", (0, 0, 1)), ("across", (1, 2, 0))):
        (ball_files / f"{name}.json").write_text(json.dumps([[face, *vector] for face in range(faces)]))
        for option, value in (("--up", vector), ("--directions", [f"{name}.json"])):
            assert lsgp(*QUADS, "--target", 300, "--cones", "cones.json", option, *value).code == 0
            made[name, option] = (ball_files / "quads.obj").read_text()
        assert made[name, "--directions"] == made[name, "--up"]
    assert made["up", "--up"] != made["across", "--up"]
    (ball_files / "outside.json").write_text(json.dumps([[faces, 0, 0, 1]]))
    refused = lsgp(*QUADS, "--directions", "outside.json")
    assert refused.code == 3 and "INDEX_OUT_OF_RANGE" in refused.err


def test_the_place_of_irregular_vertices_is_told_where_there_are_features(lsgp, cube_files: Path) -> None:
    run = ["quads", "cube.obj", "-o", "out.obj", "--target", 300, "--report", "report.json"]
    done = lsgp(*run)
    assert "8 of 8 irregular vertices on creases or marked edges\n" in done.out
    assert done.report()["quads"]["feature_distance"] == 0
    done = lsgp(*run, "--no-straighten")
    assert "marked edges" not in done.out
    assert done.report()["quads"]["feature_distance"] is None


def test_low_stretch_makes_edges_more_alike(lsgp, ball_files: Path) -> None:
    deviations = []
    for mode in ("conformal", "low-stretch"):
        lsgp(*QUADS, "--target", 300, "--cones", "cones.json", "--mode", mode, "--report", "report.json")
        deviations.append(json.loads((ball_files / "report.json").read_text())["quads"]["edge_deviation"])
    assert deviations[1] < 0.9 * deviations[0]


def test_polish_makes_edges_more_alike(lsgp, ball_files: Path) -> None:
    deviations = []
    for options in ((), ("--polish",)):
        lsgp(*QUADS, "--target", 300, "--cones", "cones.json", *options, "--report", "report.json")
        deviations.append(json.loads((ball_files / "report.json").read_text())["quads"]["edge_deviation"])
    assert deviations[1] < deviations[0]


def test_an_open_mesh_is_refused_with_its_border(lsgp, tmp_path: Path) -> None:
    mesh = cylinder()
    (tmp_path / "tube.obj").write_text(obj_text(mesh.positions, mesh.triangles.tolist()))
    done = lsgp("quads", "tube.obj", "-o", "out.obj", "--target", 100, "--report", "report.json")
    assert done.code == 3
    assert "refused: OPEN_SURFACE: The surface has a boundary of 32 edges" in done.err
    report = done.report()
    assert (report["status"], report["code"], report["elements"]["kind"]) == ("refused", "OPEN_SURFACE", "edges")
    assert len(report["elements"]["indices"]) == 32
    assert not (tmp_path / "out.obj").exists()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["-o", "quads.ply"], "name the output .obj"),
        (["-o", "ball.obj"], "IN 'ball.obj' are the same file"),
        (["-o", "quads.obj", "--stretch", "0.5"], "add --mode low-stretch"),
        (["-o", "quads.obj", "--up", "nan", "0", "0"], "finite"),
        (["-o", "quads.obj", "--target", "9", "--size", "1"], "not allowed with"),
        ([], "-o/--output"),
    ],
)
def test_wrong_usage(lsgp, ball_files: Path, arguments: list[str], told: str) -> None:
    done = lsgp("quads", "ball.obj", *arguments)
    assert done.code == 2
    assert told in done.err


@pytest.mark.parametrize("arguments", [["--target", 0], ["--size", 0], ["--size", "nan"]])
def test_numbers_that_no_mesh_has_are_refused(lsgp, ball_files: Path, arguments: list[object]) -> None:
    done = lsgp(*QUADS, *arguments)
    assert done.code == 3
    assert "WRONG_PARAMETER" in done.err


def test_standard_streams(lsgp, ball_files: Path) -> None:
    lsgp(*QUADS, "--target", 200)
    done = lsgp("quads", "ball.obj", "-o", "-", "--target", 200)
    assert done.out == (ball_files / "quads.obj").read_text()
    assert "quads of side" in done.err


def test_creases_are_followed_unless_told_not_to(lsgp, tmp_path: Path) -> None:
    box = transform(closed.box(3, (1, 1.4, 2.2)), seed=2)
    (tmp_path / "box.obj").write_text(obj_text(box.positions, box.triangles.tolist()))
    run = ["quads", "box.obj", "-o", "quads.obj", "--target", 300, "--up", 1, 2, 3]
    corners = []
    for arguments in ([], ["--no-straighten"], ["--no-straighten", "--features", "crease:40"]):
        assert lsgp(*run, *arguments).code == 0
        positions, _ = quads_of(tmp_path / "quads.obj")
        normals = [np.cross(*np.diff(box.positions[t], axis=0)) for t in box.triangles]
        normals = np.unique(np.round([n / np.linalg.norm(n) for n in normals], 6), axis=0)
        off = np.abs(positions @ normals.T - (box.positions @ normals.T).max(axis=0)) < 1e-5
        corners.append(int((off.sum(axis=1) >= 2).sum()))
    followed, free, marked = corners
    assert followed == marked > 50
    assert free < followed / 2


def test_quads_are_smaller_where_the_density_is_high(lsgp, ball_files: Path) -> None:
    ball = read_mesh(ball_files / "ball.obj").positions
    high = np.flatnonzero(ball[:, 2] > 0).tolist()
    files = {
        "pairs.json": json.dumps([[vertex, 9] for vertex in high]),
        "list.json": json.dumps(np.where(ball[:, 2] > 0, 9, 1).tolist()),
        "numbers.txt": "\n".join(np.where(ball[:, 2] > 0, "9.0", "1").tolist()),
    }
    made = set()
    for name, text in files.items():
        (ball_files / name).write_text(text)
        done = lsgp(*QUADS, "--target", 400, "--density", name, "--report", "report.json")
        assert done.code == 0, done.err
        made.add((ball_files / "quads.obj").read_bytes())
    assert len(made) == 1
    positions, quads = quads_of(ball_files / "quads.obj")
    assert abs(len(quads) - 400) <= 40
    a, b, c, d = positions[quads].transpose(1, 0, 2)
    areas, heights = np.linalg.norm(np.cross(c - a, d - b), axis=1) / 2, positions[quads].mean(axis=1)[:, 2]
    assert areas[heights < -0.5].mean() > 5 * areas[heights > 0.5].mean()
    assert " where the density is 1, " in done.out and "\nedges by the density: " in done.out
    # The report has the same figures: edges of equal quads.
    assert done.report()["quads"]["edge_deviation"] < 0.3


def test_the_last_value_of_a_vertex_counts(lsgp, ball_files: Path) -> None:
    (ball_files / "once.json").write_text(json.dumps([[5, 4]]))
    (ball_files / "twice.json").write_text(json.dumps([[5, 9], [5, 4]]))
    made = set()
    for name in ("once.json", "twice.json"):
        assert lsgp(*QUADS, "--target", 300, "--density", name).code == 0
        made.add((ball_files / "quads.obj").read_bytes())
    assert len(made) == 1


def test_no_density_at_all_is_that_of_one(lsgp, ball_files: Path) -> None:
    (ball_files / "none.json").write_text("[]")
    made = set()
    for density in ((), ("--density", "none.json")):
        assert lsgp(*QUADS, "--target", 300, *density).code == 0
        made.add((ball_files / "quads.obj").read_bytes())
    assert len(made) == 1
