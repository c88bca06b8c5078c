# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap`: its output, the choice of cones and angles, and the effect of options."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from command import cut_edges, uv_of
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate
from polygon_meshes import bumpy_ball, cube, faces_of, obj_text, off_text, patch, ply_bytes

# --- what is written ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_vertices_order_and_polygons_stay(lsgp, tmp_path: Path, kind: str) -> None:
    positions, faces = patch()
    positions = positions / 3 + 1e-9  # doubles that no short decimal stands for
    contents = {"obj": obj_text(positions, faces).encode(), "off": off_text(positions, faces).encode()}
    contents["ply"] = ply_bytes(positions, faces, "binary_big_endian")
    (tmp_path / f"in.{kind}").write_bytes(contents[kind])
    (tmp_path / "none.json").write_text('{"cones": []}')
    done = lsgp("unwrap", f"in.{kind}", "-o", "out.obj", "--cones", "none.json")
    assert (done.code, done.err) == (0, "")
    out = read_mesh(tmp_path / "out.obj", with_uv=True)
    assert out.positions.tobytes() == positions.tobytes()
    assert faces_of(out) == faces
    assert np.isfinite(out.corner_uv).all()
    assert out.corner_uv.min() >= 0
    assert out.corner_uv.max() <= 1
    # A disk without cones is not cut: every vertex has one place.
    assert (tmp_path / "out.obj").read_text().count("vt ") == len(positions)


def test_cube_is_unfolded_isometrically_to_full_precision(lsgp, cube_files: Path) -> None:
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--report", "report.json")
    assert done.code == 0
    mesh = read_mesh(cube_files / "out.obj", with_uv=True)
    after = np.roll(np.arange(len(mesh.corners)).reshape(-1, 4), -1, axis=1).ravel()
    length = np.linalg.norm(mesh.positions[mesh.corners[after]] - mesh.positions[mesh.corners], axis=1)
    ratio = np.linalg.norm(mesh.corner_uv[after] - mesh.corner_uv, axis=1) / length
    assert ratio.max() / ratio.min() - 1 < 1e-9
    report = done.report()
    assert report["cone_angles"] == pytest.approx([1.5 * math.pi] * 8, abs=1e-9)
    assert report["distortion"]["l2_stretch"] == pytest.approx(1, abs=1e-9)


def test_cuts_form_a_tree_through_all_cones_along_polygon_edges(lsgp, ball_files: Path) -> None:
    # From cone to cone it is shorter across the quads.
    cones = set(range(0, 218, 31))
    (ball_files / "apart.json").write_text(json.dumps({"cones": sorted(cones)}))
    assert lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "apart.json").code == 0
    cuts = cut_edges(ball_files / "out.obj")
    vertices = {vertex for edge in cuts for vertex in edge}
    ends = {v for v in vertices if sum(v in edge for edge in cuts) == 1}
    assert cones <= vertices
    assert ends <= cones
    assert len(cuts) == len(vertices) - 1
    # Corners of one quad are never apart: a diagonal was not cut.
    text = (ball_files / "out.obj").read_text()
    assert text.count("vt ") == len(read_mesh(ball_files / "ball.obj").positions) + len(cuts) - 1


def test_same_input_same_bytes(lsgp, ball_files: Path) -> None:
    for cones in ("cones.json", "auto"):
        outputs = set()
        for threads in (1, 4):
            done = lsgp("unwrap", "ball.obj", "-o", f"{threads}.obj", "--cones", cones, "--threads", threads)
            assert done.code == 0
            outputs.add((ball_files / f"{threads}.obj").read_bytes())
        assert len(outputs) == 1


def test_all_formats_give_the_same_bytes(lsgp, ball_files: Path) -> None:
    positions, faces = bumpy_ball()
    (ball_files / "ball.off").write_text(off_text(positions, faces))
    (ball_files / "ball.ply").write_bytes(ply_bytes(positions, faces, "binary_little_endian"))
    for kind in ("obj", "off", "ply"):
        assert lsgp("unwrap", f"ball.{kind}", "-o", f"{kind}.obj", "--cones", "cones.json").code == 0
    assert len({(ball_files / f"{kind}.obj").read_bytes() for kind in ("obj", "off", "ply")}) == 1


def test_an_input_can_be_its_own_output(lsgp, cube_files: Path) -> None:
    assert lsgp("unwrap", "cube.obj", "-o", "once.obj", "--cones", "corners.json").code == 0
    assert lsgp("unwrap", "cube.obj", "--in-place", "--cones", "corners.json").code == 0
    assert (cube_files / "cube.obj").read_bytes() == (cube_files / "once.obj").read_bytes()


def test_component_that_cannot_be_solved_keeps_no_vt_and_is_named(lsgp, tmp_path: Path) -> None:
    closed, closed_faces = cube(2)
    opened, opened_faces = patch()
    faces = opened_faces + [[v + len(opened) for v in face] for face in closed_faces]
    (tmp_path / "in.obj").write_text(obj_text(np.concatenate([opened, closed + 9]), faces))
    (tmp_path / "none.json").write_text('{"cones": []}')
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--cones", "none.json", "--report", "report.json")
    assert done.code == 4
    unsolved = np.isnan(uv_of(tmp_path / "out.obj")).any(axis=1)
    polygon = np.repeat(np.arange(len(faces)), [len(face) for face in faces])
    assert (unsolved == (polygon >= len(opened_faces))).all()
    report = done.report()
    named = [w["elements"] for w in report["warnings"] if w["code"] == "COMPONENT_SKIPPED"]
    assert named == [{"kind": "faces", "indices": list(range(len(opened_faces), len(faces)))}]
    assert report["triangles"] == sum(len(face) - 2 for face in faces)
    assert "COMPONENT_SKIPPED" in done.err
    assert f"faces {len(opened_faces)}, " in done.err
    left_out = np.arange(len(opened_faces), len(faces))
    share = 100 * area_of(closed, closed_faces) / (area_of(closed, closed_faces) + area_of(opened, opened_faces))
    assert report["missing"]["faces"] == left_out.tolist() and report["missing"]["impossible"] == []
    assert report["missing"]["area_percent"] == pytest.approx(share, rel=1e-3)  # quads that are not flat
    assert f"{len(left_out)} faces without coordinates, 58.8 % of the area (faces {left_out[0]}, " in done.out


def area_of(positions: np.ndarray, faces: list[list[int]]) -> float:
    return sum(
        0.5 * float(np.linalg.norm(np.cross(positions[b] - positions[a], positions[c] - positions[a])))
        for a, *others in faces
        for b, c in pairwise(others)
    )


def test_a_result_without_faces_that_have_no_area_is_whole(lsgp, tmp_path: Path) -> None:
    """A component that is a line cannot be unfolded."""
    positions, faces = patch()
    n = len(positions)
    positions = np.concatenate([positions, [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [3.0, 0.0, 5.0]]])
    (tmp_path / "in.obj").write_text(obj_text(positions, [*faces, [n, n + 1, n + 2]]))
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--report", "report.json")
    assert np.isnan(uv_of(tmp_path / "out.obj"))[-3:].all()
    assert done.code == 0
    missing = done.report()["missing"]
    assert (missing["faces"], missing["area_percent"]) == ([], 0.0)
    assert (missing["impossible"], missing["impossible_area_percent"]) == ([len(faces)], 0.0)
    assert "1 face without coordinates and without triangles or area, 0 % of the area" in done.out


# --- cones and angles -----------------------------------------------------------------------------------------------

QUARTERS = [3, 3, 2, 4, 3, 3, 3, 3]  # of a turn, at eight cones: 24 = 32 - 8, as on every sphere


def unwrap_with(lsgp, folder: Path, cones: dict, *options: str) -> tuple[int, dict]:
    (folder / "given.json").write_text(json.dumps(cones))
    done = lsgp("unwrap", "ball.obj", "-o", "out.obj", "--cones", "given.json", "--report", "report.json", *options)
    return done.code, done.report()


def angles_of(folder: Path) -> dict[str, list]:
    cones = json.loads((folder / "cones.json").read_text())["cones"]
    return {"cones": cones, "angles_over_pi_2": QUARTERS}


def test_angles_in_quarter_turns_are_for_manual_only(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)
    code, manual = unwrap_with(lsgp, ball_files, cones, "--prescription", "manual")
    imposed = dict(zip(manual["cones"], manual["cone_angles"], strict=True))
    expected = {v: k * math.pi / 2 for v, k in zip(cones["cones"], QUARTERS, strict=True)}
    assert code == 0
    assert imposed == pytest.approx(expected, abs=1e-9)
    _, default = unwrap_with(lsgp, ball_files, cones)
    _, without = unwrap_with(lsgp, ball_files, {"cones": cones["cones"]})
    assert default["cone_angles"] == without["cone_angles"]
    assert default["cone_angles"] != pytest.approx(manual["cone_angles"], abs=1e-3)


def test_angles_in_radians_are_used_unless_a_rule_is_named(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)
    radians = [k * math.pi / 2 for k in QUARTERS[::-1]]
    for options in ((), ("--prescription", "manual")):  # they go before the quarter turns
        _, report = unwrap_with(lsgp, ball_files, cones | {"cone_angles": radians}, *options)
        imposed = dict(zip(report["cones"], report["cone_angles"], strict=True))
        assert imposed == pytest.approx(dict(zip(cones["cones"], radians, strict=True)), abs=1e-9)
    for rule in ("least-distortion", "harmonic"):
        _, given = unwrap_with(lsgp, ball_files, cones | {"cone_angles": radians}, "--prescription", rule)
        _, free = unwrap_with(lsgp, ball_files, {"cones": cones["cones"]}, "--prescription", rule)
        assert given["cone_angles"] == free["cone_angles"]


def test_null_is_an_automatic_angle(lsgp, ball_files: Path) -> None:
    cones = angles_of(ball_files)["cones"]
    _, report = unwrap_with(lsgp, ball_files, {"cones": cones, "cone_angles": [4.0, None, 5.0] + [None] * 5})
    imposed = dict(zip(report["cones"], report["cone_angles"], strict=True))
    assert (imposed[cones[0]], imposed[cones[2]]) == pytest.approx((4.0, 5.0), abs=1e-9)
    assert sum(2 * math.pi - angle for angle in imposed.values()) == pytest.approx(4 * math.pi, abs=1e-9)
    _, empty = unwrap_with(lsgp, ball_files, {"cones": cones, "cone_angles": [None] * 8})
    _, absent = unwrap_with(lsgp, ball_files, {"cones": cones})
    assert empty["cone_angles"] == absent["cone_angles"]


def test_report_is_a_cones_file_for_the_same_map(lsgp, ball_files: Path) -> None:
    assert lsgp("unwrap", "ball.obj", "-o", "a.obj", "--cones", "auto:6", "--report", "a.json").code == 0
    assert lsgp("unwrap", "ball.obj", "-o", "b.obj", "--cones", "a.json", "--report", "b.json").code == 0
    first, second = (json.loads((ball_files / name).read_text()) for name in ("a.json", "b.json"))
    assert len(first["cones"]) == 6
    assert second["cone_angles"] == pytest.approx(first["cone_angles"], abs=1e-9)
    # The same up to a similarity that keeps the size of the island.
    a, b = (uv_of(ball_files / name) for name in ("a.obj", "b.obj"))
    assert np.abs(_lengths(a) / _lengths(b) - 1).max() < 1e-6


def _lengths(uv: np.ndarray) -> np.ndarray:
    quads = uv.reshape(-1, 4, 2)
    return np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2)


def test_automatic_cones(lsgp, ball_files: Path) -> None:
    assert lsgp("unwrap", "ball.obj", "-o", "out.obj", "--report", "default.json").code == 0
    for option in ("auto", "auto:3", "auto:11"):
        done = lsgp("unwrap", "ball.obj", "-o", f"{option}.obj", "--cones", option, "--report", f"{option}.json")
        assert done.code == 0
    counts = {n: len(done.report(f"{n}.json")["cones"]) for n in ("default", "auto", "auto:3", "auto:11")}
    assert counts["default"] == counts["auto"] >= 3
    assert (counts["auto:3"], counts["auto:11"]) == (3, 11)
    assert (ball_files / "out.obj").read_bytes() == (ball_files / "auto.obj").read_bytes()


def test_prescriptions_differ_and_keep_gauss_bonnet(lsgp, ball_files: Path) -> None:
    found = {}
    for rule in ("least-distortion", "harmonic", "straightness"):
        code, report = unwrap_with(lsgp, ball_files, {"cones": angles_of(ball_files)["cones"]}, "--prescription", rule)
        assert code == 0
        assert sum(2 * math.pi - a for a in report["cone_angles"]) == pytest.approx(4 * math.pi, abs=1e-9)
        found[rule] = report
    stretch = {rule: report["distortion"]["l2_stretch"] for rule, report in found.items()}
    assert stretch["least-distortion"] < stretch["harmonic"]
    assert len({tuple(np.round(report["cone_angles"], 4)) for report in found.values()}) == 3


# --- other options --------------------------------------------------------------------------------------------------


def test_lscm_gives_up_the_continuity_that_lsgp_keeps(lsgp, ball_files: Path) -> None:
    ratios = {}
    for method in ("lsgp", "lscm"):
        done = lsgp(
            "unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--method", method, "--report", "r.json"
        )
        ratios[method] = done.report("r.json")["seams"]["sister_ratio_max"]
    assert ratios["lsgp"] == pytest.approx(1, abs=1e-9)
    assert ratios["lscm"] > 1.01


def test_both_ways_to_unfold_give_one_map_where_it_is_exact(lsgp, cube_files: Path) -> None:
    for unfold in ("poisson", "spectral"):
        done = lsgp("unwrap", "cube.obj", "-o", f"{unfold}.obj", "--cones", "corners.json", "--unfold", unfold)
        assert (done.code, done.err) == (0, "")
    poisson, spectral = (_lengths(uv_of(cube_files / f"{unfold}.obj")) for unfold in ("poisson", "spectral"))
    ratio = poisson / spectral
    assert ratio.max() / ratio.min() - 1 < 1e-8


def test_spectral_unfolding_is_the_more_conformal_one(lsgp, ball_files: Path) -> None:
    found = {}
    for unfold in ("poisson", "spectral"):
        done = lsgp(
            "unwrap", "ball.obj", "-o", f"{unfold}.obj", "--cones", "cones.json", "--unfold", unfold, "--report", "r"
        )
        found[unfold] = done.report("r")
    poisson, spectral = found["poisson"], found["spectral"]
    assert poisson["cone_angles"] == spectral["cone_angles"]
    assert spectral["distortion"]["l2_stretch"] == pytest.approx(poisson["distortion"]["l2_stretch"], rel=0.01)
    assert _conformal_energy(ball_files / "spectral.obj") < _conformal_energy(ball_files / "poisson.obj") * (1 - 1e-6)


def _conformal_energy(path: Path) -> float:
    """Dirichlet energy less area, as a share of the Dirichlet energy: 0 for a conformal map."""
    mesh = read_mesh(path, with_uv=True)
    triangulation = triangulate(mesh)
    points = mesh.positions[triangulation.triangles]
    uv = mesh.corner_uv[triangulation.corner]
    dirichlet = area = 0.0
    for p, q in zip(points, uv, strict=True):
        # The triangle in its own plane, by its two edges from the first corner; the map takes them to their images.
        _, edges = np.linalg.qr((p[1:] - p[0]).T)
        images = (q[1:] - q[0]).T
        jacobian = images @ np.linalg.inv(edges)
        dirichlet += abs(np.linalg.det(edges)) / 2 * (jacobian**2).sum() / 2
        area += np.linalg.det(images) / 2
    return 1 - abs(area) / dirichlet


def test_cuts_are_drawn_to_seam_edges(lsgp, cube_files: Path) -> None:
    corners = set(json.loads((cube_files / "corners.json").read_text())["cones"])
    mesh = read_mesh(cube_files / "cube.obj")
    neighbors: dict[int, set[int]] = {}
    for face in faces_of(mesh):
        for i in range(4):
            neighbors.setdefault(face[i], set()).update((face[i - 1], face[(i + 1) % 4]))
    # The twelve edges of the cube: straight walks from corner to corner.
    walks = []
    for corner in sorted(corners):
        for following in sorted(neighbors[corner]):
            walk = [corner, following]
            while walk[-1] not in corners:
                straight = 2 * mesh.positions[walk[-1]] - mesh.positions[walk[-2]]
                walk.append(min(neighbors[walk[-1]], key=lambda v: float(((mesh.positions[v] - straight) ** 2).sum())))
            walks.append({tuple(sorted(pair)) for pair in pairwise(walk)})
    assert lsgp("unwrap", "cube.obj", "-o", "free.obj", "--cones", "corners.json").code == 0
    free = cut_edges(cube_files / "free.obj")
    wanted = next(walk for walk in walks if not walk & free)
    (cube_files / "seams.json").write_text(json.dumps(sorted(map(list, wanted))))
    drawn = lsgp("unwrap", "cube.obj", "-o", "drawn.obj", "--cones", "corners.json", "--seam-edges", "seams.json")
    cut = cut_edges(cube_files / "drawn.obj")
    assert wanted <= cut
    (told,) = drawn.err.splitlines()
    assert drawn.code == 0 and told.startswith(f"lsgp: warning: CUTS_ADDED: {len(cut - wanted)} edges were cut")


def _seam_sides(path: Path, seam: set[tuple[int, int]]) -> np.ndarray:
    """(s, 2) lengths of the two sides of every seam edge in the texture."""
    mesh = read_mesh(path, with_uv=True)
    sides: dict[tuple[int, int], list[float]] = {}
    for start, face in zip(mesh.starts.tolist(), faces_of(mesh), strict=True):
        for i, a in enumerate(face):
            j = (i + 1) % len(face)
            edge = (min(a, face[j]), max(a, face[j]))
            length = np.linalg.norm(mesh.corner_uv[start + i] - mesh.corner_uv[start + j])
            sides.setdefault(edge, []).append(float(length))
    return np.array([sides[edge] for edge in sorted(seam)])


def test_seams_are_followed_are_borders_or_are_ignored(lsgp, ball_files: Path) -> None:
    positions, faces = cube(6)  # the same numbering as the ball
    on_ring = positions[:, 2] == 0
    edges = {(min(a, b), max(a, b)) for face in faces for a, b in pairwise([*face, face[0]])}
    ring = {edge for edge in edges if on_ring[list(edge)].all()}
    assert len(ring) == 24
    (ball_files / "ring.json").write_text(json.dumps(sorted(ring)))
    options = ("unwrap", "ball.obj", "--cones", "cones.json")
    for mode in ("follow", "boundary", "ignore"):
        done = lsgp(*options, "-o", f"{mode}.obj", "--seam-edges", "ring.json", "--seams", mode)
        assert done.code == 0
        assert f"{1 if mode == 'ignore' else 2} island" in done.out
    assert lsgp(*options, "-o", "default.obj", "--seam-edges", "ring.json").code == 0
    assert lsgp(*options, "-o", "none.obj").code == 0
    content = {name: (ball_files / f"{name}.obj").read_bytes() for name in ("follow", "ignore", "default", "none")}
    assert content["default"] == content["follow"] != content["none"]
    assert content["ignore"] == content["none"]
    for mode in ("follow", "boundary"):
        assert ring <= cut_edges(ball_files / f"{mode}.obj")
    followed, borders = (_seam_sides(ball_files / f"{mode}.obj", ring) for mode in ("follow", "boundary"))
    assert np.abs(followed[:, 0] / followed[:, 1] - 1).max() < 1e-9
    assert np.abs(borders[:, 0] / borders[:, 1] - 1).max() > 1e-3


def test_automatic_cones_know_what_seams_mean(lsgp, ball_files: Path) -> None:
    positions, faces = cube(6)
    edges = {(min(a, b), max(a, b)) for face in faces for a, b in pairwise([*face, face[0]])}
    ring = sorted(edge for edge in edges if not positions[list(edge), 2].any())
    (ball_files / "ring.json").write_text(json.dumps(ring))
    placed = {}
    for mode in ("boundary", "ignore"):
        done = lsgp(
            *("unwrap", "ball.obj", "-o", "out.obj", "--cones", "auto:3", "--report", "r.json"),
            *("--seam-edges", "ring.json", "--seams", mode),
        )
        assert done.code == 0
        placed[mode] = done.report("r.json")["cones"]
    # Three on the whole, or three on each half.
    assert {mode: len(cones) for mode, cones in placed.items()} == {"boundary": 6, "ignore": 3}


@pytest.mark.parametrize("preset", ["paint", "tile", "bake"])
def test_only_marked_edges_are_cut(lsgp, ball_files: Path, preset: str) -> None:
    positions, faces = cube(6)
    edges = {(min(a, b), max(a, b)) for face in faces for a, b in pairwise([*face, face[0]])}
    # The sides of the former cube.
    is_side = (np.abs(positions) == np.abs(positions).max()).sum(axis=1) > 1
    marked = sorted(edge for edge in edges if is_side[list(edge)].all() and _is_along_a_side(positions[list(edge)]))
    assert len(marked) == 12 * 6
    (ball_files / "sides.json").write_text(json.dumps(marked))
    options = ("unwrap", "ball.obj", "--preset", preset, "--seam-edges", "sides.json")
    for name, how in (("only", ("--seams", "exact")), ("usual", ())):
        assert lsgp(*options, "-o", f"{name}.obj", *how).code == 0
    assert cut_edges(ball_files / "only.obj") == set(marked) <= cut_edges(ball_files / "usual.obj")
    (ball_files / "none.json").write_text("[]")
    without = ("--seam-edges", "none.json", "--seams", "exact")
    refused = lsgp("unwrap", "ball.obj", "-o", "no.obj", "--preset", preset, *without)
    assert refused.code != 0 and "SEAMS_INCOMPLETE" in refused.err and not (ball_files / "no.obj").exists()


def _is_along_a_side(ends: np.ndarray) -> bool:
    """Whether both ends are on one side of a cube."""
    most = np.abs(ends).max()
    return bool(((np.abs(ends) == most).all(axis=0) & (ends[0] == ends[1])).sum() >= 2)


def test_straight_border_runs_straight_from_cone_to_cone(lsgp, tmp_path: Path) -> None:
    positions, faces = patch()
    (tmp_path / "in.obj").write_text(obj_text(positions, faces))
    corners = np.flatnonzero((np.isin(positions[:, :2], [0, 4])).all(axis=1)).tolist()
    (tmp_path / "corners.json").write_text(json.dumps({"cones": corners, "cone_angles": [math.pi / 2] * 4}))
    bend = {}
    for border in ("straight", "free"):
        done = lsgp("unwrap", "in.obj", "-o", f"{border}.obj", "--cones", "corners.json", "--border", border)
        assert done.code == 0
        mesh = read_mesh(tmp_path / f"{border}.obj", with_uv=True)
        place = dict(zip(mesh.corners.tolist(), mesh.corner_uv, strict=True))
        sides = [[v for v in place if positions[v, axis] == end] for axis in (0, 1) for end in (0, 4)]
        singular = [np.linalg.svd(np.array([place[v] for v in side]) - place[side[0]])[1] for side in sides]
        bend[border] = max(values[1] / values[0] for values in singular)
    assert bend["straight"] < 1e-9
    assert bend["free"] > 1e-3


# --- files of the shared folder -------------------------------------------------------------------------------------


def test_shared_cube_with_its_cones_file(lsgp, shared: Path, tmp_path: Path) -> None:
    mesh, cones = shared / "meshes" / "cube-768.obj", shared / "meshes" / "cube-768.cones.json"
    for rule in ("least-distortion", "manual"):
        done = lsgp("unwrap", mesh, "-o", "o.obj", "--cones", cones, "--prescription", rule, "--report", "r.json")
        assert (done.code, done.err) == (0, "")
        report = done.report("r.json")
        assert report["distortion"]["l2_stretch"] == pytest.approx(1, abs=1e-9)
        assert report["cone_angles"] == pytest.approx([1.5 * math.pi] * 8, abs=1e-9)
    assert (read_mesh(tmp_path / "o.obj").positions == read_mesh(mesh).positions).all()


def test_shared_moebius_strip_is_refused_by_name(lsgp, shared: Path) -> None:
    done = lsgp("unwrap", shared / "meshes" / "moebius.obj", "-o", "o.obj", "--report", "r.json")
    assert (done.code, done.report("r.json")["code"]) == (3, "NOT_ORIENTABLE")
