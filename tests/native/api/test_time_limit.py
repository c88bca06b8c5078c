# SPDX-License-Identifier: GPL-3.0-or-later
"""A limit of the time in which a map is chosen: the best one made until then, or an error."""

from __future__ import annotations

import json
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.cli import main
from lsgp.run import exit_codes

LIMIT = "TIME_LIMIT"
BALL = meshes.bumpy_sphere(3)


def surface() -> lsgp.Surface:
    return lsgp.Surface(BALL.positions, BALL.triangles)


def test_a_limit_that_is_not_reached_changes_nothing() -> None:
    assert lsgp.auto_unwrap(surface(), preset="bake", seconds=1e12) == lsgp.auto_unwrap(surface(), preset="bake")


def test_no_map_in_time_is_an_error() -> None:
    with pytest.raises(lsgp.SolverError, match="No map was made within") as caught:
        lsgp.auto_unwrap(surface(), seconds=1e-9)
    assert caught.value.code == LIMIT


def stopped(seconds: float) -> lsgp.Result | None:
    try:
        return lsgp.auto_unwrap(surface(), preset="bake", seconds=seconds)
    except lsgp.SolverError as error:
        assert error.code == LIMIT
        return None


def test_whatever_the_limit_there_is_a_whole_map_or_the_error() -> None:
    """Longer and longer until nothing is stopped."""
    usual = lsgp.auto_unwrap(surface(), preset="bake")
    seconds, kinds = 1e-3, []
    while True:
        found = stopped(seconds)
        codes = [] if found is None else [finding.code for finding in found.warnings]
        kinds.append("none" if found is None else "best" if LIMIT in codes else "usual")
        if found is not None:
            assert found.solved.all() and not len(found.flipped) and not len(found.overlapping)
            assert np.isfinite(found.corner_uv).all() and found.corner_uv.min() >= 0 and found.corner_uv.max() <= 1
        if kinds[-1] == "usual":
            break
        seconds *= 1.3
    assert found.distortion == usual.distortion and kinds[0] == "none"


@pytest.mark.parametrize("seconds", [0, -1.0, float("nan")])
def test_a_limit_is_a_positive_number(seconds: float) -> None:
    with pytest.raises(lsgp.InputError, match="seconds is"):
        lsgp.auto_unwrap(surface(), seconds=seconds)


def test_cancelling_is_heard_within_a_limit() -> None:
    with pytest.raises(lsgp.Cancelled):
        lsgp.auto_unwrap(surface(), seconds=1e6, progress=lambda _done: False)


@pytest.fixture
def mesh_file(tmp_path: Path) -> Path:
    lines = ["v {!r} {!r} {!r}".format(*point) for point in BALL.positions.tolist()]
    lines += ["f {} {} {}".format(*face) for face in (BALL.triangles + 1).tolist()]
    path = tmp_path / "ball.obj"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("options", [["--preset", "bake"], [], ["--cones", "cones.json"]])
def test_the_command_ends_by_name_and_writes_nothing(
    options: list[str], mesh_file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(mesh_file.parent)
    placed = lsgp.place_cones(surface(), count=4)
    Path("cones.json").write_text(json.dumps({"cones": placed.cones.tolist()}))
    code = main(["unwrap", "ball.obj", "-o", "out.obj", "--time-limit", "1e-9", *options])
    assert code == exit_codes.REFUSED and LIMIT in capsys.readouterr().err and not Path("out.obj").exists()
    assert main(["unwrap", "ball.obj", "-o", "out.obj", "--time-limit", "1e6", *options]) == 0


def test_a_batch_counts_assets_that_were_stopped_as_failed(mesh_file: Path) -> None:
    out = mesh_file.parent / "out"
    assert main(["batch", str(mesh_file), "--out", str(out), "--time-limit", "1e-9", "--preset", "paint"]) != 0
    (line,) = [json.loads(line) for line in (out / "journal.jsonl").read_text().splitlines()]
    assert (line["status"], line["code"]) == ("failed", LIMIT)


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "soon"])
def test_the_option_takes_seconds(text: str, mesh_file: Path) -> None:
    assert main(["unwrap", str(mesh_file), "-o", "out.obj", "--time-limit", text]) == exit_codes.USAGE
