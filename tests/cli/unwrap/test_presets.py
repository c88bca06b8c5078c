# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --preset`: the result of each preset, and that additional options take precedence."""

from __future__ import annotations

import json
from pathlib import Path

import meshes
import numpy as np
import pytest
from command import uv_of
from polygon_meshes import obj_text
from zoo import closed

UNWRAP = ("unwrap", "ball.obj", "-o", "out.obj", "--report", "report.json")


def report_of(lsgp, *options: object) -> dict:
    done = lsgp(*UNWRAP, *options)
    assert done.code == 0, done.err
    return done.report()


def test_without_a_preset_the_map_is_the_conformal_one_with_its_overlaps(lsgp, ball_files: Path) -> None:
    report_of(lsgp)
    plain = (ball_files / "out.obj").read_bytes()
    report_of(lsgp, "--mode", "conformal", "--overlaps", "keep")
    assert (ball_files / "out.obj").read_bytes() == plain
    plain_choices = ("--mode", "conformal", "--overlaps", "keep", "--compact", "off", "--pack", "shelves")
    report_of(lsgp, "--preset", "paint", "--no-symmetric", *plain_choices)
    assert (ball_files / "out.obj").read_bytes() == plain


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_paint_and_bake_keep_lengths(lsgp, ball_files: Path, preset: str) -> None:
    conformal, chosen = report_of(lsgp), report_of(lsgp, "--preset", preset, "--no-symmetric")
    compact = ["--compact", {"paint": "sparing", "bake": "full"}[preset]]
    by_hand = report_of(lsgp, "--mode", "low-stretch", "--overlaps", "split", *compact)
    assert chosen["distortion"] == pytest.approx(by_hand["distortion"], rel=1e-9)
    assert chosen["distortion"]["l2_stretch"] < conformal["distortion"]["l2_stretch"]


def test_tile_is_seamless_and_takes_the_options_of_seamless_layouts(lsgp, ball_files: Path) -> None:
    seamless = report_of(lsgp, "--preset", "tile", "--no-symmetric", "--tiles", 24)["seamless"]
    up = ("--up", 0, 1, 0)
    assert seamless == report_of(lsgp, "--seamless", "--tiles", 24, "--overlaps", "split", *up)["seamless"]
    assert report_of(lsgp, "--preset", "tile", "--lattice", "hexagon")["seamless"]["rotation_order"] == 6
    assert report_of(lsgp, "--preset", "paint", "--seamless")["seamless"]["rotation_order"] == 4
    refused = lsgp(*UNWRAP, "--preset", "bake", "--tiles", 24)
    assert refused.code == 2 and "add --seamless" in refused.err


def test_a_stretch_goes_with_presets_that_keep_lengths(lsgp, ball_files: Path) -> None:
    half, full = (report_of(lsgp, "--preset", "paint", *options) for options in (("--stretch", 0.3), ()))
    assert half["distortion"]["l2_stretch"] > full["distortion"]["l2_stretch"]
    refused = lsgp(*UNWRAP, "--preset", "tile", "--stretch", 0.3)
    assert refused.code == 2 and "add --mode low-stretch" in refused.err


def test_nearly_straight_sides_become_straight_unless_that_is_turned_off(lsgp, tmp_path: Path) -> None:
    panel = meshes.grid(12, 16, lambda x, y: np.sin(np.pi * x / 12) * np.sin(np.pi * y / 16))
    (tmp_path / "panel.obj").write_text(obj_text(panel.positions, panel.triangles))

    def covered_share(*options: str) -> float:
        """Of the layout's bounding box."""
        done = lsgp("unwrap", "panel.obj", "-o", "out.obj", *options)
        assert done.code == 0, done.err
        uv = uv_of(tmp_path / "out.obj").reshape(-1, 3, 2)
        (a, b), (c, d) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
        return float(np.abs(a * d - b * c).sum() / 2 / np.ptp(uv, axis=(0, 1)).prod())

    whole = ("--preset", "bake", "--compact", "off")
    assert covered_share(*whole) == pytest.approx(1, abs=1e-6)
    assert covered_share(*whole, "--no-straighten") < 0.999
    refused = lsgp("unwrap", "panel.obj", "-o", "out.obj", "--no-straighten")
    assert refused.code == 2 and "add --preset paint, tile or bake" in refused.err


def test_cones_of_a_file_are_completed_with_a_preset_alone(lsgp, ball_files: Path) -> None:
    (ball_files / "one.json").write_text(json.dumps({"cones": [0]}))
    assert lsgp(*UNWRAP, "--cones", "one.json").code == 3
    report = report_of(lsgp, "--cones", "one.json", "--preset", "paint")
    assert 0 in report["cones"] and len(report["cones"]) > 1
    assert report["placement"] is not None
    enough = report_of(lsgp, "--cones", "cones.json", "--preset", "paint")
    assert enough["cones"] == json.loads((ball_files / "cones.json").read_text())["cones"]
    assert enough["placement"] is None


def test_cones_are_symmetric_with_a_preset_unless_told_otherwise(lsgp, ball_files: Path) -> None:
    horned = meshes.two_horned()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in horned.positions.tolist()]
    lines += ["f {} {} {}".format(*row) for row in (horned.triangles + 1).tolist()]
    (ball_files / "ball.obj").write_text("\n".join(lines) + "\n")
    paint = ("--preset", "paint", "--cuts", "shortest")
    free, alike = (report_of(lsgp, *paint, *option)["cones"] for option in (("--no-symmetric",), ()))
    right_less_left = np.sign(horned.positions[:, 0].round(9))
    assert right_less_left[alike].sum() == 0 != right_less_left[free].sum()
    refused = lsgp(*UNWRAP, "--no-symmetric")
    assert refused.code == 2 and "--no-symmetric is for presets" in refused.err


def test_a_batch_takes_presets_and_makes_the_bytes_of_single_runs(lsgp, ball_files: Path) -> None:
    done = lsgp("batch", "ball.obj", "--out", "many", "--preset", "bake", "--no-pictures")
    assert done.code == 0, done.err
    report_of(lsgp, "--preset", "bake")
    assert (ball_files / "many" / "ball.obj").read_bytes() == (ball_files / "out.obj").read_bytes()
    (line,) = (json.loads(text) for text in (ball_files / "many" / "journal.jsonl").read_text().splitlines())
    assert line["overlapping"] == 0


def test_creases_are_borders_where_the_map_gains_by_them(lsgp, tmp_path: Path) -> None:
    z = np.linspace(-1, 1, 5)
    barrel = closed.lathe(1 - 0.25 * z**2, 1.3 * z, 24, caps=(True, True))
    (tmp_path / "barrel.obj").write_text(obj_text(barrel.positions, barrel.triangles))
    run = ("unwrap", "barrel.obj", "-o", "out.obj", "--report", "report.json", "--preset", "paint")
    bordered, plain = lsgp(*run).report(), lsgp(*run, "--no-creases").report()
    assert bordered["islands"] == 3 and not bordered["cones"] and plain["cones"]
    assert bordered["distortion"]["l2_stretch"] - 1 < 0.5 * (plain["distortion"]["l2_stretch"] - 1)
    assert bordered["stage_seconds"]["choose"] > 0
