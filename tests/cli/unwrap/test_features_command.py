# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --features`: which edges run straight along u or v."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from lsgp.io.mesh_files import read_mesh
from polygon_meshes import faces_of

UNWRAP = ("unwrap", "cube.obj", "-o", "out.obj", "--preset", "tile", "--no-straighten", "--report", "report.json")


def edges_where(path: Path, is_on: np.ndarray) -> list[list[int]]:
    """Edges of the faces both of whose ends are among these vertices."""
    pairs = {
        tuple(sorted(pair))
        for face in faces_of(read_mesh(path))
        for pair in zip(face, face[1:] + face[:1], strict=True)
    }
    return sorted([a, b] for a, b in pairs if is_on[a] and is_on[b])


def around(folder: Path) -> list[list[int]]:
    """A loop around the cube that is not on its edges."""
    height = read_mesh(folder / "cube.obj").positions[:, 2]
    return edges_where(folder / "cube.obj", np.isclose(height, np.unique(np.round(height, 9))[1]))


def share(lsgp, *options: object) -> float | None:
    done = lsgp(*UNWRAP, *options)
    assert done.code == 0, done.err
    features = done.report()["features"]
    return None if features is None else features["share"]


def test_edges_of_a_file(lsgp, cube_files: Path) -> None:
    edges = around(cube_files)
    assert len(edges) >= 12
    (cube_files / "loop.json").write_text(json.dumps(edges))
    assert share(lsgp) is None
    assert share(lsgp, "--features", "loop.json") == 1
    assert len(lines_of(cube_files / "out.obj", edges)) == 2 * len(edges)


def lines_of(path: Path, edges: list[list[int]]) -> list[float]:
    """The coordinate of both sides of edges that is the same along them."""
    mesh = read_mesh(path, with_uv=True)
    wanted, found = set(map(tuple, edges)), []
    for start, face in zip(mesh.starts.tolist(), faces_of(mesh), strict=True):
        for i, a in enumerate(face):
            j = (i + 1) % len(face)
            if tuple(sorted((a, face[j]))) in wanted:
                one, other = (np.float32(mesh.corner_uv[start + k]) for k in (i, j))
                assert (one == other).any()
                found.append(float(one[one == other][0]))
    return found


def test_features_at_whole_and_half_tiles(lsgp, cube_files: Path) -> None:
    edges = around(cube_files)
    (cube_files / "loop.json").write_text(json.dumps(edges))
    off = {}
    for places in ("anywhere", "half", "whole"):
        assert share(lsgp, "--features", "loop.json", "--no-straighten", "--feature-places", places) == 1
        lines = np.array(lines_of(cube_files / "out.obj", edges))
        off[places] = [np.abs(lines - step * np.round(lines / step)).max() for step in (1, 0.5)]
    assert off["whole"][0] == off["half"][1] == 0 < min(off["half"][0], off["anywhere"][1])


def test_kinds_of_edges(lsgp, cube_files: Path) -> None:
    edges = around(cube_files)
    (cube_files / "seams.json").write_text(json.dumps(edges))
    assert share(lsgp, "--features", "crease:89") == 1
    assert share(lsgp, "--features", "crease:91") is None
    assert share(lsgp, "--features", "seams", "--seam-edges", "seams.json") == 1
    by_kinds = (cube_files / "out.obj").read_bytes()
    assert share(lsgp, "--features", "seams.json", "--seam-edges", "seams.json") == 1
    assert (cube_files / "out.obj").read_bytes() == by_kinds
    assert share(lsgp, "--features", "borders") is None


def test_a_map_of_low_stretch(lsgp, cube_files: Path) -> None:
    (cube_files / "loop.json").write_text(json.dumps(around(cube_files)))
    done = lsgp(
        *("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--mode", "low-stretch"),
        *("--features", "loop.json", "--report", "report.json"),
    )
    assert done.code == 0 and done.report()["features"]["share"] == 1


def test_released_features_are_in_the_report(lsgp, cube_files: Path) -> None:
    """The triangles around a corner cannot all have sides along u and v."""
    mesh = read_mesh(cube_files / "cube.obj")
    all_edges = edges_where(cube_files / "cube.obj", np.ones(len(mesh.positions), bool))
    (cube_files / "all.json").write_text(json.dumps(all_edges))
    done = lsgp(
        *("unwrap", "cube.obj", "-o", "out.obj", "--seamless", "--lattice", "hexagon", "--features", "all.json"),
        *("--report", "report.json"),
    )
    assert done.code == 0, done.err
    found = done.report()["features"]
    named = {tuple(sorted(pair)) for of in found["released"] for pair in zip(of["path"], of["path"][1:], strict=False)}
    assert {of["reason"] for of in found["released"]} == {"unsupported"} and named <= set(map(tuple, all_edges))
    assert sum(of["share"] for of in found["released"]) == pytest.approx(1 - found["share"])
    assert "FEATURES_RELEASED" in done.err


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--features", "crease"], "ANGLE is in degrees"),
        (["--features", "borders,crease:0"], "ANGLE is in degrees"),
        (["--features", "crease:nan"], "ANGLE is in degrees"),
        (["--features", "seams:3"], "seams has no value"),
        (["--features", "sharp"], "mark no edges sharp"),
        (["--features", "none.json"], "none.json"),
    ],
)
def test_what_it_does_not_take(lsgp, cube_files: Path, options: list[str], told: str) -> None:
    refused = lsgp(*UNWRAP, *options)
    assert refused.code == 2 and told in refused.err
    assert not (cube_files / "out.obj").exists()


def test_conformal_maps_have_none(lsgp, cube_files: Path) -> None:
    refused = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--features", "borders")
    assert refused.code == 2 and "--mode low-stretch" in refused.err


def test_a_pair_that_is_no_edge(lsgp, cube_files: Path) -> None:
    (cube_files / "far.json").write_text(f"[[0, {len(read_mesh(cube_files / 'cube.obj').positions) - 1}]]")
    refused = lsgp(*UNWRAP, "--features", "far.json")
    assert refused.code == 3 and "EDGE_NOT_IN_MESH" in refused.err


@pytest.mark.parametrize("option", ["--features", "--directions"])
def test_edges_at_boundaries_that_are_stitched_have_the_vertices_of_the_file(
    lsgp, cube_files: Path, option: str
) -> None:
    # A tube of four walls, the first and last of which have their own vertices where they meet, 0 and 4 to 5 and 9.
    places = [(x, y, z) for z in (0, 2) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))]
    lines = [f"v {x} {y} {z}" for x, y, z in places]
    lines += [f"f {i} {i + 1} {i + 6} {i + 5}" for i in range(1, 5)]
    (cube_files / "tube.obj").write_text("\n".join(lines) + "\n")
    (cube_files / "edge.json").write_text("[[4, 9]]")
    done = lsgp("unwrap", "tube.obj", "-o", "out.obj", "--preset", "tile", option, "edge.json")
    assert done.code == 0, done.err
    a, b = (read_mesh(cube_files / "out.obj", with_uv=True).corner_uv[k] for k in (13, 14))
    assert np.argmax(np.abs(b - a)) == 1 or option == "--features"
    assert np.abs(b - a).min() <= 1e-9
