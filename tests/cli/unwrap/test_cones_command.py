# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp cones`: cones and their angles in a file that `lsgp unwrap` accepts."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import lsgp as library
import numpy as np
import pytest
from command import REPORT_KEYS
from lsgp.cli import main
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate
from meshes import moebius_strip
from polygon_meshes import cube, cube_corners, faces_of, obj_text

PLACE = ["cones", "ball.obj", "-o", "placed.json"]
TURN = np.pi / 2


def placed(folder: Path, name: str = "placed.json") -> dict:
    return json.loads((folder / name).read_text())


def ledger(folder: Path, file: dict, mesh: str = "ball.obj") -> list[library.LedgerPart]:
    polygons = read_mesh(folder / mesh)
    surface = library.Surface(polygons.positions, triangulate(polygons).triangles)
    return library.build_ledger(surface, file["cones"], file["cone_angles"])


def test_cones_come_with_angles_that_add_up_and_say_what_they_promise(lsgp, ball_files: Path) -> None:
    done = lsgp(*PLACE, "--report", "report.json")
    assert (done.code, done.err) == (0, "")
    file = placed(ball_files)
    assert list(file) == ["mesh", "cones", "cone_angles", "predicted_l2", "mapped_l2", "reached"]
    assert file["mesh"] == "ball.obj"
    assert len(file["cones"]) == len(file["cone_angles"]) == len(set(file["cones"])) > 0
    (part,) = ledger(ball_files, file)
    assert part.complete
    told = f"placed.json: {len(file['cones'])} cones, an L2 stretch of {file['predicted_l2']:.4f} predicted"
    told += f" and {file['mapped_l2']:.4f} in the map"
    assert done.out.startswith(told) and "the target was reached; " in done.out
    assert done.out.rstrip().endswith("back-substitutions") and done.out.count("\n") == 1
    report = done.report()
    assert list(report) == REPORT_KEYS
    assert (report["status"], report["cones"], report["cone_angles"]) == ("ok", file["cones"], file["cone_angles"])
    assert report["placement"] == {key: file[key] for key in ("predicted_l2", "mapped_l2", "reached")}
    assert report["distortion"] is None
    assert set(report["stage_seconds"]) == {"read_file", "triangulate", "cut_costs", "place_cones", "write_file"}


def test_what_is_predicted_is_what_is_unwrapped(lsgp, ball_files: Path) -> None:
    lsgp(*PLACE, "--count", 8)
    file = placed(ball_files)
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "placed.json", "--report", "report.json")
    report = done.report()
    assert report["cones"] == file["cones"]
    assert report["cone_angles"] == pytest.approx(file["cone_angles"], abs=1e-9)
    assert report["distortion"]["l2_stretch"] == pytest.approx(file["predicted_l2"], rel=0.03)
    assert report["distortion"]["l2_stretch"] == pytest.approx(file["mapped_l2"], rel=1e-9)
    assert report["placement"] is None
    # An unwrap that places cones by itself takes as many, as good ones; of those that are alike maybe others.
    own = lsgp("unwrap", "ball.obj", "-o", "own.obj", "--cones", "auto:8", "--report", "own.json").report("own.json")
    assert len(own["cones"]) == 8 and own["placement"]["mapped_l2"] == pytest.approx(file["mapped_l2"], rel=0.005)


@pytest.mark.parametrize("count", [4, 9])
def test_as_many_as_asked_for(lsgp, ball_files: Path, count: int) -> None:
    done = lsgp(*PLACE, "--count", count)
    assert len(placed(ball_files)["cones"]) == count
    assert f"placed.json: {count} cones, " in done.out and "target" not in done.out


def test_kept_cones_stay_with_their_angles(lsgp, ball_files: Path) -> None:
    kept = placed(ball_files, "cones.json")["cones"][:3]
    (ball_files / "kept.json").write_text(json.dumps({"cones": kept, "cone_angles": [4.0, None, 5.0]}))
    assert lsgp(*PLACE, "--keep", "kept.json", "--count", 7).code == 0
    file = placed(ball_files)
    assert file["cones"][:3] == kept and len(file["cones"]) == 7
    assert (file["cone_angles"][0], file["cone_angles"][2]) == pytest.approx((4.0, 5.0))
    assert ledger(ball_files, file)[0].complete


def test_a_file_of_cones_can_be_completed_in_place(lsgp, ball_files: Path) -> None:
    lsgp(*PLACE, "--count", 5)
    before = placed(ball_files)["cones"]
    # Without their angles, which are those of five.
    (ball_files / "placed.json").write_text(json.dumps({"cones": before}))
    assert lsgp(*PLACE, "--keep", "placed.json", "--count", 8).code == 0
    assert placed(ball_files)["cones"][:5] == before and len(placed(ball_files)["cones"]) == 8


@pytest.mark.parametrize(("lattice", "turn"), [(None, TURN), ("stripe", np.pi), ("hexagon", np.pi / 3)])
def test_seamless_angles_are_turns_of_the_lattice(lsgp, ball_files: Path, lattice: str | None, turn: float) -> None:
    more = [] if lattice is None else ["--lattice", lattice]
    assert lsgp(*PLACE, "--count", 8, "--seamless", *more).code == 0
    file = placed(ball_files)
    turns = np.array(file["cone_angles"]) / turn
    assert turns == pytest.approx(turns.round(), abs=1e-9)
    assert ledger(ball_files, file)[0].complete


def test_every_component_gets_its_own(lsgp, tmp_path: Path) -> None:
    positions, faces = cube(4)
    both = np.concatenate([positions / 3, positions / 2 + 9])
    (tmp_path / "in.obj").write_text(obj_text(both, [*faces, *[[v + len(positions) for v in face] for face in faces]]))
    assert lsgp("cones", "in.obj", "-o", "placed.json", "--count", 8).code == 0
    corners = cube_corners(positions)
    assert sorted(placed(tmp_path)["cones"]) == sorted([*corners, *[v + len(positions) for v in corners]])
    assert placed(tmp_path)["cone_angles"] == pytest.approx([3 * TURN] * 16, abs=1e-6)


def test_marked_edges_part_the_surface_as_in_an_unwrap(lsgp, cube_files: Path) -> None:
    mesh = read_mesh(cube_files / "cube.obj")
    top = np.flatnonzero(mesh.positions[:, 2] == mesh.positions[:, 2].max())
    largest = np.abs(mesh.positions[:, :2]).max()
    rim = {v for v in top.tolist() if np.abs(mesh.positions[v, :2]).max() == largest}
    faces = mesh.corners.reshape(-1, 4)
    edges = {tuple(sorted(pair)) for face in faces.tolist() for pair in zip(face, face[1:] + face[:1], strict=True)}
    seams = [list(edge) for edge in edges if set(edge) <= rim]
    (cube_files / "seams.json").write_text(json.dumps(seams))
    place = ["cones", "cube.obj", "-o", "placed.json", "--seam-edges", "seams.json"]
    assert lsgp(*place, "--seams", "boundary").code == 0
    # The lid is flat by itself, and no cone lies on the rim.
    assert not set(placed(cube_files)["cones"]) & set(top.tolist())
    assert lsgp(*place, "--seams", "ignore").code == 0
    assert set(placed(cube_files)["cones"]) & set(top.tolist())


def test_same_input_same_bytes(lsgp, ball_files: Path) -> None:
    outputs = set()
    for _ in range(2):
        lsgp(*PLACE)
        outputs.add((ball_files / "placed.json").read_bytes())
    assert len(outputs) == 1


WRONG_USAGE = {
    "no output": (["cones", "ball.obj"], "--output"),
    "output of a mesh": (["cones", "ball.obj", "-o", "placed.obj"], "the output is JSON"),
    "report over output": ([*PLACE, "--report", "placed.json"], "same file"),
    "missing mesh": (["cones", "none.obj", "-o", "placed.json"], "none.obj"),
    "missing kept cones": ([*PLACE, "--keep", "none.json"], "none.json"),
    "kept cones that are no JSON": ([*PLACE, "--keep", "ball.obj"], "not valid JSON"),
    "count and target": ([*PLACE, "--count", "4", "--target", "1.1"], "not allowed with"),
    "count that is no number": ([*PLACE, "--count", "some"], "some"),
    "lattice without seamless": ([*PLACE, "--lattice", "square"], "add --seamless"),
    "mirror without symmetric": ([*PLACE, "--mirror", *"000100"], "add --symmetric"),
    "mirror of five numbers": ([*PLACE, "--symmetric", "--mirror", *"00010"], "--mirror"),
    "missing folder": (["cones", "ball.obj", "-o", "none/placed.json"], "no folder"),
}
REFUSED = {
    "count below none": ([*PLACE, "--count", "-1"], "WRONG_PARAMETER"),
    "no vertex": ([*PLACE, "--keep", "outside.json"], "CONE_INDEX"),
    "an angle too few": ([*PLACE, "--keep", "angles.json"], "ANGLE_COUNT"),
    "cones of another form": ([*PLACE, "--keep", "list.json"], "MALFORMED_FILE"),
    "no triangles": (["cones", "points.obj", "-o", "placed.json"], "EMPTY_MESH"),
}


@pytest.fixture
def files(ball_files: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (ball_files / "outside.json").write_text('{"cones": [999999]}')
    (ball_files / "angles.json").write_text('{"cones": [0, 9], "cone_angles": [3]}')
    (ball_files / "list.json").write_text("[0, 9]")
    (ball_files / "points.obj").write_text("v 0 0 0\nv 1 0 0\n")
    monkeypatch.chdir(ball_files)
    return ball_files


@pytest.mark.parametrize("name", WRONG_USAGE)
def test_wrong_usage_ends_with_2_and_nothing_written(
    files: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    arguments, said = WRONG_USAGE[name]
    before = sorted(files.iterdir())
    assert main(arguments) == 2
    assert said in capsys.readouterr().err
    assert sorted(files.iterdir()) == before


@pytest.mark.parametrize("name", REFUSED)
def test_refusals_end_with_3_a_code_and_a_report(files: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    arguments, code = REFUSED[name]
    assert main([*arguments, "--report", "report.json"]) == 3
    report = json.loads((files / "report.json").read_text())
    assert (report["status"], report["code"]) == ("refused", code)
    assert list(report) == REPORT_KEYS
    assert capsys.readouterr().err.startswith(f"lsgp: refused: {code}: ")
    assert not (files / "placed.json").exists()


def test_interrupted_it_leaves_the_file_as_it_was(
    files: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def place_cones(*arguments: object, progress: library.api.Progress, **options: object) -> library.api.Placement:
        def tell(done: float) -> bool | None:
            signal.raise_signal(signal.SIGINT)
            return progress(done)

        tell(0.5)
        return library.place_cones(*arguments, progress=tell, **options)

    (files / "placed.json").write_text("before")
    monkeypatch.setattr("lsgp.run.place_file.place_cones", place_cones)
    assert main(PLACE) == 130
    assert capsys.readouterr().err == "lsgp: interrupted\n"
    assert (files / "placed.json").read_text() == "before"


def test_help_names_every_option(lsgp) -> None:
    done = lsgp("cones", "--help")
    assert (done.code, done.err) == (0, "")
    for option in ("count", "target", "keep", "seamless", "lattice", "symmetric", "mirror", "prefer-sharp", "seams"):
        assert f"--{option}" in done.out


QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"


def test_cones_that_find_no_room_are_said_by_both_commands(lsgp, tmp_path: Path) -> None:
    (tmp_path / "quad.obj").write_text(QUAD)
    for command in (["cones", "quad.obj", "-o", "placed.json", "--count", 8], ["unwrap", "quad.obj", "-o", "out.obj"]):
        asked = [] if command[0] == "cones" else ["--cones", "auto:8"]
        done = lsgp(*command, *asked, "--report", "report.json")
        assert done.code == 0 and "0 of the 8 cones asked for" in done.err
        (warning,) = done.report()["warnings"]
        assert warning["code"] == "PLACEMENT_NOT_REACHED" and warning["elements"]["indices"] == [0]
    assert placed(tmp_path)["cones"] == []


@pytest.mark.parametrize(
    "command",
    [
        ["cones", "quad.obj", "-o", "out.json", "--count", "8"],
        ["unwrap", "quad.obj", "-o", "out.obj", "--cones", "auto:8"],
    ],
    ids=["cones", "unwrap"],
)
def test_strict_refuses_what_misses_what_was_asked_for(lsgp, tmp_path: Path, command: list[str]) -> None:
    (tmp_path / "quad.obj").write_text(QUAD)
    done = lsgp(*command, "--strict", "--report", "report.json")
    report = done.report()
    assert done.code == 3 and "refused: PLACEMENT_NOT_REACHED" in done.err
    assert (report["status"], report["code"]) == ("refused", "PLACEMENT_NOT_REACHED")
    assert not (tmp_path / command[3]).exists()


def test_strict_lets_a_flawless_result_pass(lsgp, ball_files: Path) -> None:
    assert lsgp(*PLACE, "--strict").code == 0
    assert lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "placed.json", "--strict").code == 0


def test_strict_refuses_parts_left_out_with_given_cones(lsgp, ball_files: Path) -> None:
    lsgp(*PLACE)
    ball, strip = read_mesh(ball_files / "ball.obj"), moebius_strip()
    faces = [*faces_of(ball), *(strip.triangles + len(ball.positions)).tolist()]
    (ball_files / "both.obj").write_text(obj_text(np.concatenate([ball.positions, strip.positions + 5]), faces))
    unwrap = ["unwrap", "both.obj", "--cones", "placed.json"]
    loose = lsgp(*unwrap, "-o", "out.obj")
    assert loose.code == 4 and "COMPONENT_SKIPPED" in loose.err
    strict = lsgp(*unwrap, "-o", "strict.obj", "--strict")
    assert strict.code == 3 and "refused: COMPONENT_SKIPPED" in strict.err
    assert not (ball_files / "strict.obj").exists()


def test_strict_refuses_parts_that_single_precision_spoils(lsgp, ball_files: Path) -> None:
    ball = read_mesh(ball_files / "ball.obj")
    whole = faces_of(ball)
    speck = (np.array(whole[: len(whole) // 6]) + len(ball.positions)).tolist()
    places = np.concatenate([ball.positions, 1e-9 * ball.positions])
    (ball_files / "both.obj").write_text(obj_text(places, [*whole, *speck]))
    unwrap = ["unwrap", "both.obj", "--report", "report.json", "-o"]
    loose = lsgp(*unwrap, "loose.glb")
    (warning,) = [said for said in loose.report()["warnings"] if said["code"] == "ISLANDS_TINY"]
    assert warning["elements"]["indices"] == list(range(len(whole), len(whole) + len(speck)))
    assert lsgp("measure", "loose.glb", "--report", "report.json").report()["flipped"] > 0
    strict = lsgp(*unwrap, "strict.glb", "--strict")
    assert strict.code == 3 and "refused: ISLANDS_TINY" in strict.err
    assert not (ball_files / "strict.glb").exists()


def test_seams_on_the_way_are_no_reason_to_refuse_placed_cones(lsgp, ball_files: Path) -> None:
    corners = read_mesh(ball_files / "ball.obj").corners[:4].tolist()
    (ball_files / "seams.json").write_text(json.dumps([corners[:2], corners[1:3]]))
    seams = ["--seam-edges", "seams.json"]
    for mode in ("follow", "boundary", "ignore"):
        assert lsgp(*PLACE, *seams, "--seams", mode).code == 0
        with_file = lsgp("unwrap", "ball.obj", "-o", "a.obj", "--cones", "placed.json", *seams, "--seams", mode)
        at_once = lsgp("unwrap", "ball.obj", "-o", "b.obj", "--cones", "auto", *seams, "--seams", mode)
        assert (with_file.code, at_once.code) == (0, 0), with_file.err + at_once.err
