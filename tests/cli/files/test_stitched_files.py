# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that repeat vertices: the surface is continuous where boundaries lie on each other."""

from __future__ import annotations

import json
from itertools import product
from pathlib import Path

import lsgp as library
import meshes
import numpy as np
import pytest
from command import uv_of
from nightly import nightly
from polygon_meshes import obj_text, perforated_plate, with_own_corners

BALL = meshes.bumpy_sphere(2)
SOUP = meshes.triangle_soup(BALL)
COPY = BALL.triangles.ravel()
"""The vertex of the ball that each of the soup is."""


@pytest.fixture
def soup_file(tmp_path: Path) -> Path:
    (tmp_path / "soup.obj").write_text(obj_text(SOUP.positions, SOUP.triangles.tolist()))
    (tmp_path / "whole.obj").write_text(obj_text(BALL.positions, BALL.triangles.tolist()))
    return tmp_path


def test_a_preset_unwraps_a_soup_of_triangles_as_the_whole_surface(lsgp, soup_file: Path) -> None:
    for name in ("soup", "whole"):
        done = lsgp("unwrap", f"{name}.obj", "-o", f"{name}-uv.obj", "--preset", "paint", "--report", f"{name}.json")
        assert done.code == 0, done.err
    soup, whole = done.report("soup.json"), done.report("whole.json")
    assert [warning["code"] for warning in soup["warnings"]] == ["BORDERS_STITCHED"]
    (told,) = soup["warnings"]
    assert told["elements"]["kind"] == "vertices"
    assert len(told["elements"]["indices"]) == len(SOUP.positions) - len(BALL.positions)
    assert soup["islands"] == whole["islands"]
    assert soup["distortion"]["l2_stretch"] == pytest.approx(whole["distortion"]["l2_stretch"], rel=0.02)
    assert np.isfinite(uv_of(soup_file / "soup-uv.obj")).all()
    assert (soup_file / "soup-uv.obj").read_text().startswith((soup_file / "soup.obj").read_text()[:1000])


def test_boundaries_stay_open_where_that_is_asked_for_and_without_a_preset(lsgp, soup_file: Path) -> None:
    for options in (["--preset", "paint", "--no-stitch"], []):
        done = lsgp("unwrap", "soup.obj", "-o", "uv.obj", "--report", "report.json", *options)
        assert done.code == 0, done.err
        assert done.report()["islands"] == len(SOUP.triangles)


def cut_of(path: Path) -> set[tuple[int, int]]:
    """The edges at which the whole surface is cut, of the ball's vertices."""
    file = library.read_mesh_file(path, with_uv=True)
    cut = library.measure_distortion(file.surface(), file.triangle_uv).cut_edges
    return {tuple(sorted(edge)) for edge in COPY[cut].tolist()}


def test_cones_seams_and_costs_at_repeated_vertices_are_those_of_the_surface(lsgp, soup_file: Path) -> None:
    cones = np.flatnonzero(np.isin(COPY, [3, 8, 17, 20, 33, 40]))  # all copies
    (soup_file / "cones.json").write_text(json.dumps({"cones": cones.tolist()}))

    def cut_with(*options: str) -> set[tuple[int, int]]:
        done = lsgp("unwrap", "soup.obj", "-o", "uv.obj", "--stitch", "--cones", "cones.json", *options)
        assert done.code == 0, done.err
        return cut_of(soup_file / "uv.obj")

    usual = cut_with()
    last = {vertex: copy for copy, vertex in enumerate(COPY.tolist())}
    copies = [[last[a], last[b]] for a, b in sorted(usual)]
    (soup_file / "costs.txt").write_text("".join(f"{a} {b} 1e5\n" for a, b in copies[::2]))
    costs = ("--cut-costs", "costs.txt")
    assert not cut_with(*costs) & set(sorted(usual)[::2])
    (soup_file / "seams.json").write_text(json.dumps(copies))
    assert cut_with(*costs, "--seam-edges", "seams.json") == usual


def test_cones_are_placed_and_quads_made_on_the_whole_surface(lsgp, soup_file: Path) -> None:
    done = lsgp("cones", "soup.obj", "-o", "cones.json", "--stitch", "--count", "8")
    assert done.code == 0, done.err
    assert len(json.loads((soup_file / "cones.json").read_text())["cones"]) == 8
    done = lsgp("quads", "soup.obj", "-o", "quads.obj", "--target", "300")
    assert done.code == 0, done.err


def test_a_file_is_read_as_the_whole_surface_unless_told_otherwise(soup_file: Path) -> None:
    file = library.read_mesh_file(soup_file / "soup.obj")
    assert np.array_equal(COPY[file.triangulation.triangles], BALL.triangles)
    assert np.array_equal(file.stitched, library.stitch_borders(SOUP.positions, SOUP.triangles))
    parted = library.read_mesh_file(soup_file / "soup.obj", stitch=False)
    assert np.array_equal(parted.triangulation.triangles, SOUP.triangles)
    assert np.array_equal(parted.stitched, np.arange(len(SOUP.positions)))
    assert parted.findings == ()


@pytest.mark.parametrize("preset", ["paint", "tile", "bake"])
def test_each_quad_beside_a_pole_of_many_vertices_is_in_one_piece(lsgp, tmp_path: Path, preset: str) -> None:
    """A cut through the pole ends at one side of a quad of which a triangle remains."""
    around = 12
    positions, quads = meshes.ball_of_quads(around, 6)
    (tmp_path / "ball.obj").write_text(obj_text(positions, quads.tolist()))
    done = lsgp("unwrap", "ball.obj", "-o", "uv.obj", "--preset", preset, "--report", "report.json")
    assert done.code == 0, done.err
    assert done.report()["distortion"]["l2_stretch"] < 1.2
    uv = library.read_mesh_file(tmp_path / "uv.obj", with_uv=True).mesh.corner_uv.reshape(-1, 4, 2)
    np.testing.assert_array_equal(uv[:around, 0], uv[:around, 3])
    np.testing.assert_array_equal(uv[-around:, 1], uv[-around:, 2])
    x, y = (uv - np.roll(uv, 1, axis=1)).transpose(2, 0, 1)
    doubled_area = x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y
    assert (doubled_area > -1e-12).all(), "no corner turns back"


@pytest.mark.parametrize(("holes", "corners"), [(1, 3), (2, 7), (5, 12)])
def test_faces_with_holes_and_vertices_of_their_own_are_the_whole_surface(
    tmp_path: Path, holes: int, corners: int
) -> None:
    positions, faces = perforated_plate(holes, corners)
    (tmp_path / "parted.obj").write_text(obj_text(*with_own_corners(positions, faces)))
    found = library.read_mesh_file(tmp_path / "parted.obj").triangulation.triangles
    copied = np.concatenate(faces)[found]
    pairs = np.unique(np.c_[found.ravel(), copied.ravel()], axis=0)
    assert len(pairs) == len(np.unique(found)) == len(np.unique(copied)) == len(positions)
    assert meshes.euler_characteristic(found) == 2 - 2 * holes


SAMPLE = [("parted.obj", "out.glb", "paint"), ("parted.glb", "out.obj", "bake"), ("parted.obj", "out.obj", "tile")]
CROSSED = product(("whole.obj", "parted.obj", "parted.glb"), ("out.obj", "out.glb"), ("paint", "bake", "tile"))


@pytest.mark.slow
@pytest.mark.parametrize(("source", "target", "preset"), [*SAMPLE, *nightly(*sorted(set(CROSSED) - set(SAMPLE)))])
def test_faces_with_holes_lie_flat_in_every_format(lsgp, tmp_path: Path, source: str, target: str, preset: str) -> None:
    positions, faces = perforated_plate(3, 9, 1)
    (tmp_path / "whole.obj").write_text(obj_text(positions, faces))
    (tmp_path / "parted.obj").write_text(obj_text(*with_own_corners(positions, faces)))
    if source.endswith(".glb"):
        assert lsgp("unwrap", "parted.obj", "-o", source).code == 0
    done = lsgp("unwrap", source, "-o", target, "--preset", preset, "--report", "report.json")
    assert done.code == 0, done.err
    told = {warning["code"] for warning in done.report()["warnings"]}
    assert told <= {"BORDERS_STITCHED", "CONTENT_NOT_KEPT"}
    assert done.report()["distortion"]["l2_stretch"] < 1.001, "its caps and its walls can lie flat"
    file = library.read_mesh_file(tmp_path / target, with_uv=True)
    surface, uv = file.surface(), file.triangle_uv.astype(float)
    a, b, c = surface.positions[surface.triangles].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    x, y = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    laid = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
    assert (laid > 0).all() and np.abs(laid / laid.sum() - area / area.sum()).sum() < 0.01
