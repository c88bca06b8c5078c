# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --seamless`: the output is seamless in single precision, as certified in the report."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from crossings import Crossings, require_certified
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate

UNWRAP = ("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--report", "report.json", "--seamless")
TILES = 24


def extent(path: Path) -> float:
    uv = read_mesh(path, with_uv=True).corner_uv
    return float(np.ptp(uv, axis=0).max())


def unwrapped(lsgp, *options: object) -> dict:
    """The certificate of the ball with these options."""
    done = lsgp(*UNWRAP, *options)
    assert done.code == 0, done.err
    report = done.report()
    assert (report["flipped"], report["wrong_angle_sums"]) == (0, 0)
    assert report["seamless"]["relaxed_cones"] == []
    return report["seamless"]


@pytest.mark.parametrize("options", [(), ("--tiles", TILES), ("--tiles", 64), ("--tiles", 500)], ids=str)
@pytest.mark.parametrize("lattice", ["square", "stripe"])
def test_cuts_match_exactly_in_single_precision(lsgp, ball_files: Path, lattice: str, options: tuple) -> None:
    found = unwrapped(lsgp, "--lattice", lattice, *options)
    assert require_certified(ball_files / "out.obj", found) == 0
    assert (found["error"], found["error_texels"]) == (0, 0)
    assert {cut["error_texels"] for cut in found["cuts"]} == {0}
    assert found["rotation_order"] == {"square": 4, "stripe": 2}[lattice]


@pytest.mark.parametrize(("lattice", "rotation_order"), [("triangle", 3), ("hexagon", 6)])
def test_cuts_of_triangular_lattices_match_to_the_last_digit(
    lsgp, ball_files: Path, lattice: str, rotation_order: int
) -> None:
    found = unwrapped(lsgp, "--lattice", lattice, "--tiles", TILES)
    assert found["rotation_order"] == rotation_order
    last_digit = float(np.spacing(np.float32(np.abs(read_mesh(ball_files / "out.obj", with_uv=True).corner_uv).max())))
    assert 0 < require_certified(ball_files / "out.obj", found) <= last_digit
    assert found["error_texels"] <= 1024 * last_digit


def test_translation_lattice_is_refused_on_a_sphere(lsgp, ball_files: Path) -> None:
    done = lsgp(*UNWRAP, "--lattice", "translation")
    assert (done.code, done.report()["code"]) == (3, "SEAMLESS_IMPOSSIBLE")
    assert not (ball_files / "out.obj").exists()


def test_rounding_to_single_precision_moves_no_cut_and_flips_nothing(lsgp, ball_files: Path) -> None:
    found = unwrapped(lsgp, "--tiles", TILES)
    out = read_mesh(ball_files / "out.obj", with_uv=True)
    nodes = {vertex for edge in Crossings(ball_files / "out.obj").cuts for vertex in edge}
    assert nodes >= {cut[end] for cut in found["cuts"] for end in ("tail", "head")}
    on_cut = out.corner_uv[np.isin(out.corners, list(nodes))]
    rounded = out.corner_uv.astype(np.float32).astype(np.float64)
    assert np.array_equal(on_cut, on_cut.astype(np.float32))
    triangulation = triangulate(out)
    a, b, c = np.moveaxis(rounded[triangulation.corner], 1, 0)
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()


def test_cones_lie_on_lattice_points(lsgp, ball_files: Path) -> None:
    unwrapped(lsgp, "--tiles", TILES)
    out = read_mesh(ball_files / "out.obj", with_uv=True)
    cones = json.loads((ball_files / "report.json").read_text())["cones"]
    places = out.corner_uv[np.isin(out.corners, cones)]
    assert len(places) >= 3 * 8
    assert np.array_equal(places, np.round(places))


def test_tiles_are_counted_along_the_longer_side(lsgp, ball_files: Path) -> None:
    for tiles in (16, 50, 200):
        found = unwrapped(lsgp, "--tiles", tiles)
        assert found["tiles"] == pytest.approx(tiles)
        # Rounding and the turn of the layout move its ends by a few tiles, however many there are.
        assert extent(ball_files / "out.obj") == pytest.approx(tiles, rel=0.2, abs=5)


def test_tile_size_is_of_the_surface(lsgp, ball_files: Path) -> None:
    mesh = read_mesh(ball_files / "ball.obj")
    for size in (0.05, 0.1):
        found = unwrapped(lsgp, "--tile-size", size)
        assert found["tile_size"] == pytest.approx(size)
        out = read_mesh(ball_files / "out.obj", with_uv=True)
        quads = [values.reshape(-1, 4, values.shape[-1]) for values in (mesh.positions[mesh.corners], out.corner_uv)]
        lengths = [np.linalg.norm(np.roll(quad, 1, axis=1) - quad, axis=2) for quad in quads]
        # As many tiles fit on the surface as its area asks for.
        assert np.sqrt((lengths[0] ** 2).sum() / (lengths[1] ** 2).sum()) == pytest.approx(size, rel=0.1)


def test_automatic_tiles_cost_at_most_a_tenth(lsgp, ball_files: Path) -> None:
    found = unwrapped(lsgp)
    assert found["energy_after"] <= 1.1 * found["energy_before"]
    assert found["tiles"] >= 2


def test_checker_matches_with_parity(lsgp, ball_files: Path) -> None:
    found = unwrapped(lsgp, "--tiles", TILES, "--parity")
    assert require_certified(ball_files / "out.obj", found) == 0
    crossings = Crossings(ball_files / "out.obj")
    compared = 0
    for a, b in crossings.cuts:
        left, right = crossings.sides[a, b], crossings.sides[b, a][::-1]
        for part in np.linspace(0.05, 0.95, 19):
            places = [(1 - part) * ends[0] + part * ends[1] for ends in (left, right)]
            # Away from the border of a square; there both colors are right.
            if min(abs(x - round(x)) for z in places for x in (z.real, z.imag)) > 1e-3:
                colors = {int(np.floor(z.real) + np.floor(z.imag)) % 2 for z in places}
                assert len(colors) == 1
                compared += 1
    assert compared > 100


@pytest.mark.parametrize(("size", "level"), [(1024, 6), (256, 3), (256, 8), (512, 0)])
def test_translations_are_multiples_of_texels(lsgp, ball_files: Path, size: int, level: int) -> None:
    found = unwrapped(lsgp, "--tiles", TILES, "--texture-size", size, "--mip-levels", level)
    assert (found["cell"], found["texture_size"]) == (2.0**level / size, size)
    assert require_certified(ball_files / "out.obj", found) == 0
    assert extent(ball_files / "out.obj") == pytest.approx(TILES * found["cell"], rel=0.2)


def test_whole_tiles_without_mip_levels(lsgp, ball_files: Path) -> None:
    assert unwrapped(lsgp, "--tiles", TILES, "--texture-size", 4096)["cell"] == 1
    small = unwrapped(lsgp, "--tiles", TILES, "--texture-size", 64)
    assert (small["cell"], small["texture_size"]) == (1, 64)


@pytest.mark.parametrize("choice", ["refine", "merge", "relax"])
def test_too_coarse_a_grid_ends_as_chosen_and_says_so(lsgp, ball_files: Path, choice: str) -> None:
    done = lsgp(*UNWRAP, "--tiles", 1, "--coarse-grid", choice)
    report = done.report()
    if done.code == 3:
        assert report["code"] == "GRID_TOO_COARSE"
        return
    assert done.code == 0
    said = {warning["code"] for warning in report["warnings"]}
    found = report["seamless"]
    assert ("GRID_REFINED" in said) == (found["tiles"] > 1.001)
    assert ("CONES_MERGED" in said) == bool(found["merged_cones"])
    assert ("CONES_NOT_SNAPPED" in said) == bool(found["relaxed_cones"])
    assert {"GRID_REFINED", "CONES_MERGED", "CONES_NOT_SNAPPED"} & said
    if choice == "refine":
        assert require_certified(ball_files / "out.obj", found) == 0


def test_several_components_are_seamless_each(lsgp, ball_files: Path) -> None:
    lines = (ball_files / "ball.obj").read_text().splitlines()
    vertices = [line for line in lines if line.startswith("v ")]
    faces = [line for line in lines if line.startswith("f ")]
    moved = ["v " + " ".join(repr(2.0 * float(x) + 9) for x in line.split()[1:]) for line in vertices]
    again = ["f " + " ".join(str(int(v) + len(vertices)) for v in line.split()[1:]) for line in faces]
    (ball_files / "ball.obj").write_text("\n".join(vertices + moved + faces + again) + "\n")
    cones = json.loads((ball_files / "cones.json").read_text())["cones"]
    (ball_files / "cones.json").write_text(json.dumps({"cones": cones + [v + len(vertices) for v in cones]}))
    found = unwrapped(lsgp, "--tiles", 48)
    assert require_certified(ball_files / "out.obj", found) == 0
    uv = read_mesh(ball_files / "out.obj", with_uv=True).corner_uv.reshape(2, -1, 2)
    boxes = [(part.min(axis=0), part.max(axis=0)) for part in uv]
    assert (np.maximum(boxes[0][0] - boxes[1][1], boxes[1][0] - boxes[0][1]) >= 0).any()
    # One tile has one size on all of the surface.
    areas = [(part.max(axis=0) - part.min(axis=0)).max() for part in uv]
    assert areas[1] / areas[0] == pytest.approx(2, rel=0.3)


def test_text_has_the_certificate(lsgp, ball_files: Path) -> None:
    done = lsgp(*UNWRAP, "--tiles", TILES, "--texture-size", 2048)
    cuts = done.report()["seamless"]["cuts"]
    assert f"seamless: {len(cuts)} cuts, 0 texels off at 2048 x 2048" in done.out
    table = done.out[done.out.index("seamless: ") :].splitlines()[2:]
    told = {tuple(line.replace(",", "").split()) for line in table}
    for cut in cuts:
        turn = f"{cut['turns']}/4" if cut["turns"] else "0"
        words = (cut["tail"], cut["head"], turn, *cut["translation"], 0)
        assert tuple(map(str, words)) in told


def test_without_seamless_there_is_no_certificate(lsgp, ball_files: Path) -> None:
    done = lsgp(*UNWRAP[:-1])
    assert done.report()["seamless"] is None
    assert "seamless" not in done.out


def test_same_input_same_bytes(lsgp, ball_files: Path) -> None:
    outputs = set()
    for _ in range(2):
        unwrapped(lsgp, "--tiles", TILES)
        outputs.add((ball_files / "out.obj").read_bytes())
    assert len(outputs) == 1
