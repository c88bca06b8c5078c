# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --up` and `--directions`: the direction of the texture and its deviation."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from lsgp import measure_distortion, read_mesh_file, upright_turns

UNWRAP = ("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "report.json")


def image_of(path: Path, face: int, direction: object) -> complex:
    """What the map of a quad's first triangle makes of a direction in its plane."""
    file = read_mesh_file(path, with_uv=True)
    triangle = int(np.flatnonzero(file.triangulation.polygon == face)[0])
    place = file.mesh.positions[file.triangulation.triangles[triangle]]
    z = file.triangle_uv[triangle] @ [1, 1j]
    edges = place[1:] - place[0]
    return complex(np.linalg.lstsq(edges.T, np.array(direction, float), rcond=None)[0] @ (z[1:] - z[0]))


def test_up_is_the_way_of_v_on_the_walls_of_a_cube(lsgp, cube_files: Path) -> None:
    done = lsgp(*UNWRAP, "--seamless", "--up", 0, 1, 0)
    assert done.code == 0, done.err
    report = done.report()["direction_error"]
    assert report["mean"] <= 1e-6 and report["largest"] <= 1e-6
    assert "direction error" in done.out and "faces" not in report


def test_faces_of_a_directions_file_are_told_one_by_one(lsgp, cube_files: Path) -> None:
    strokes = [[7, 0.2, 0.5, 0.1], [3, 0.1, -0.3, 0.6]]
    (cube_files / "strokes.json").write_text(json.dumps(strokes))
    done = lsgp(*UNWRAP, "--directions", "strokes.json")
    assert done.code == 0, done.err
    told = done.report()["direction_error"]
    assert told["faces"] == [3, 7]
    for face, error in zip(told["faces"], told["errors"], strict=True):
        direction = next(row[1:] for row in strokes if row[0] == face)
        written = abs(np.angle(image_of(cube_files / "out.obj", face, direction) / 1j))
        assert error == pytest.approx(written, abs=1e-6)
    assert told["largest"] == max(told["errors"])
    worst, other = np.argsort(told["errors"])[::-1]
    lines = [f"  face {told['faces'][k]}: {np.degrees(told['errors'][k]):.2f}\n" for k in (worst, other)]
    assert f"misses by more than 0.05 degrees: 2 of 2\n{''.join(lines)}" in done.out
    (cube_files / "strokes.json").write_text(json.dumps(strokes[:1]))
    done = lsgp(*UNWRAP, "--directions", "strokes.json")
    assert done.report()["direction_error"]["largest"] <= 1e-9 and "strokes" not in done.out.replace("strokes.json", "")


def written_edge(path: Path, edge: list[int]) -> list[complex]:
    """The images of an edge, from its first vertex to its second, in the faces of a file beside it."""
    mesh = read_mesh_file(path, with_uv=True).mesh
    out = []
    for start, size in zip(mesh.starts, mesh.sizes, strict=True):
        corners = mesh.corners[start : start + size].tolist()
        if set(edge) <= set(corners):
            first, last = (mesh.corner_uv[start + corners.index(vertex)] @ [1, 1j] for vertex in edge)
            out.append(complex(last - first))
    return out


@pytest.mark.parametrize("reverse", [False, True])
def test_v_runs_along_an_edge_of_a_directions_file(lsgp, cube_files: Path, reverse: bool) -> None:
    mesh = read_mesh_file(cube_files / "cube.obj").mesh
    edge = mesh.corners[4 * 7 : 4 * 7 + 2].tolist()[:: -1 if reverse else 1]
    (cube_files / "strokes.json").write_text(json.dumps([edge]))
    done = lsgp(*UNWRAP, "--directions", "strokes.json")
    assert done.code == 0, done.err
    images = written_edge(cube_files / "out.obj", edge)
    assert images and np.abs(np.angle(np.array(images) / 1j)).max() <= np.radians(0.01)
    told = done.report()["direction_error"]
    assert told["edges"] == [edge] and told["edge_errors"][0] <= 1e-9 and told["faces"] == []


def test_faces_of_a_directions_file_take_precedence_over_edges(lsgp, cube_files: Path) -> None:
    mesh = read_mesh_file(cube_files / "cube.obj").mesh
    corners = mesh.corners.reshape(-1, 4).tolist()
    edge = corners[7][:2]
    beside = [face for face, vertices in enumerate(corners) if set(edge) <= set(vertices)]
    assert len(beside) == 2
    along = mesh.positions[edge[1]] - mesh.positions[edge[0]]
    tilted = along + 0.5 * (mesh.positions[corners[beside[0]][2]] - mesh.positions[edge[1]])

    def told(strokes: list[list]) -> tuple[dict, str]:
        (cube_files / "strokes.json").write_text(json.dumps(strokes))
        done = lsgp(*UNWRAP, "--directions", "strokes.json")
        assert done.code == 0, done.err
        return done.report()["direction_error"], done.out

    of_one, _ = told([[beside[0], *tilted], edge])
    alone, _ = told([[beside[0], *tilted]])
    of_both, _ = told([[beside[0], *tilted], [beside[1], *along], edge])
    assert alone["largest"] <= 1e-9 < of_one["largest"]
    assert of_one["faces"] == beside[:1] and of_one["edge_errors"][0] > 0.01
    assert of_both["faces"] == sorted(beside) and of_both["edge_errors"] == [None]
    a, b = edge
    _, out = told([[beside[0], *tilted], edge])
    assert f"  edge {a} {b}: {np.degrees(of_one['edge_errors'][0]):.2f}\n" in out


def test_the_preset_for_tiles_has_the_up_of_most_exporters(lsgp, cube_files: Path) -> None:
    def written(*options: object) -> bytes:
        assert lsgp(*UNWRAP, *options).code == 0
        return (cube_files / "out.obj").read_bytes()

    assert written("--preset", "tile") == written("--preset", "tile", "--up", 0, 1, 0)
    assert written("--preset", "paint") != written("--preset", "paint", "--up", 1, 2, 3)
    none = lsgp(*UNWRAP, "--preset", "tile", "--up", 0, 0, 0)
    assert none.report()["direction_error"] is None and "direction error" not in none.out


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_other_presets_have_it_as_far_as_quarter_turns_take_no_room(lsgp, cube_files: Path, preset: str) -> None:
    maps = []
    for options in ((), ("--up", 0, 0, 0)):
        assert lsgp(*UNWRAP, "--preset", preset, *options).code == 0
        file = read_mesh_file(cube_files / "out.obj", with_uv=True)
        uv = file.triangle_uv
        island = measure_distortion(file.surface(), uv).island
        turns = upright_turns(file.surface(), uv, island, (0, 1, 0))
        first, second = np.moveaxis(uv[:, 1:] - uv[:, :1], 1, 0)
        area = np.bincount(island, abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]))
        maps.append((np.ptp(uv.reshape(-1, 2), axis=0).max(), area.sum(), float((area * np.cos(turns)).sum())))
    (upright, free) = maps
    assert upright[:2] == pytest.approx(free[:2], rel=1e-5)
    assert upright[2] >= free[2] - 1e-6 * free[1]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{}", "does not have the form [[face, x, y, z] or [vertex, vertex], ...]"),
        ("[[0, 1.0]]", "does not have the form"),
        ("[[0, 1], [1, 1]]", "There is no edge from vertex 1 to 1"),
        ("[[0, 97]]", "There is no edge from vertex 0 to 97"),
        ("[[0, 9999]]", "'strokes.json' does not hold directions. edges holds 9999"),
        ("[[0, 10000000000]]", "A vertex of a direction lies outside the mesh"),
        ("[[0, 1, 2]]", "does not have the form"),
        ("[[0.5, 1, 2, 3]]", "does not have the form"),
        ("[[96, 0, 1, 0]]", "has a direction at face 96, but the mesh has 96 faces"),
        ("[[-1, 0, 1, 0]]", "has a direction at face -1"),
        ("[[0, NaN, 1, 0]]", "The direction at 2 triangles is not a finite vector"),
    ],
)
def test_a_wrong_directions_file_is_refused(lsgp, cube_files: Path, content: str, said: str) -> None:
    (cube_files / "strokes.json").write_text(content)
    refused = lsgp(*UNWRAP, "--directions", "strokes.json")
    assert refused.code == 3 and said in refused.err
    assert not (cube_files / "out.obj").exists()


def test_options_that_contradict_each_other(lsgp, cube_files: Path) -> None:
    (cube_files / "strokes.json").write_text("[]")
    both = lsgp(*UNWRAP, "--up", 0, 1, 0, "--directions", "strokes.json")
    assert both.code == 2 and "not allowed with" in both.err
    for number in (math.nan, math.inf):
        refused = lsgp(*UNWRAP, "--up", 0, number, 0)
        assert refused.code == 2 and "--up takes finite numbers" in refused.err
    missing = lsgp(*UNWRAP, "--directions", "none.json")
    assert missing.code == 2 and "none.json" in missing.err


def test_negative_numbers_with_exponents_are_no_options(lsgp, cube_files: Path) -> None:
    def written(*up: str) -> bytes:
        assert lsgp(*UNWRAP, "--seamless", "--up", *up).code == 0
        return (cube_files / "out.obj").read_bytes()

    assert written("-1e-1", "-.2E0", "-3.e-1") == written("-0.1", "-0.2", "-0.3")
