# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that name a vertex twice cost themselves at most, not the file."""

from __future__ import annotations

import numpy as np
import pytest
from command import uv_of
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lsgp.errors import InputError
from lsgp.io.mesh_files import triangulated
from lsgp.io.repeated_corners import without_repeated_corners
from polygon_meshes import cube, faces_of, obj_text, patch, polygon_mesh

PLACES = np.random.default_rng(1).random((8, 3))


@pytest.mark.parametrize(
    ("face", "kept"),
    [
        ([0, 1, 2], [0, 1, 2]),
        ([0, 1, 1, 2], [0, 1, 2]),
        ([0, 1, 2, 0], [1, 2, 0]),
        ([3, 3, 3, 1, 1, 2, 2, 3], [1, 2, 3]),
        ([0, 1, 1], None),
        ([4, 4, 4, 4], None),
        ([0, 1, 0, 2], None),
        ([0, 1, 2, 3, 2, 4], None),
        ([0, 1, 2, 0, 3, 4], None),
        ([0, 1, 1, 2, 3, 1], None),
    ],
)
def test_neighbors_that_are_one_vertex_become_one_corner_and_other_faces_go(face: list, kept: list | None) -> None:
    mesh = polygon_mesh(PLACES, [[5, 6, 7], face])
    triangulation, findings = triangulated(mesh)
    assert set(triangulation.polygon.tolist()) == {0, 1} - ({1} if kept is None else set())
    if kept is not None:
        assert faces_of(without_repeated_corners(mesh).mesh) == [[5, 6, 7], kept]
    codes = [finding.code for finding in findings]
    assert codes == ([] if kept == face else [code_of(face, kept)])
    assert all(finding.elements.indices.tolist() == [1] for finding in findings)
    assert all(finding.elements.kind == "faces" for finding in findings)


def code_of(face: list, kept: list | None) -> str:
    return "FACES_LEFT_OUT" if kept is None else "REPEATED_CORNERS"


def plate(holes: int, corners: int, seed: int) -> tuple[np.ndarray, list[list[int]]]:
    """A closed plate with a row of holes: its top and bottom are one face each, edges to and fro join every hole to the
    outline or to the hole before it, and every wall is a quad."""
    turn = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    ring = 0.4 * np.stack([-np.cos(turn), np.sin(turn)], axis=1)  # clockwise, from the left
    outline = np.array([[-1, 0], [-1, -1], [holes, -1], [holes, 1], [-1, 1]], float)
    rings = [outline, *(ring + np.array([k, 0.0]) for k in range(holes))]
    flat = np.concatenate(rings)
    firsts = np.cumsum([0, *map(len, rings)])
    loops = [list(range(firsts[k], firsts[k + 1])) for k in range(len(rings))]
    # Every hole is entered at its left corner, from the outline's first or from the right corner of the hole before.
    middle = corners // 2
    inner: list[int] = []
    for loop in reversed(loops[1:]):
        inner = [*loop[: middle + 1], *([*inner, loop[middle]] if inner else []), *loop[middle + 1 :], loop[0]]
    top = [loops[0][0], *inner, *loops[0]]
    n = len(flat)
    positions = np.concatenate([np.c_[flat, np.full(n, 0.3)], np.c_[flat, np.zeros(n)]])
    walls = [[a, a + n, b + n, b] for loop in loops for a, b in zip(loop, loop[1:] + loop[:1], strict=True)]
    faces = [top, [v + n for v in reversed(top)], *walls]
    turned, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return positions @ turned.T, faces


@pytest.mark.parametrize(("holes", "corners"), [(1, 4), (1, 16), (3, 8), (2, 600)])
def test_a_face_with_holes_that_edges_join_to_its_outline_is_cut_into_triangles(holes: int, corners: int) -> None:
    positions, faces = plate(holes, corners, holes + corners)
    mesh = polygon_mesh(positions, faces)
    triangulation, findings = triangulated(mesh)
    assert findings == ()
    assert len(triangulation.triangles) == sum(len(face) - 2 for face in faces)
    a, b, c = positions[triangulation.triangles].transpose(1, 0, 2)
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    hole = 0.5 * corners * 0.4**2 * np.sin(2 * np.pi / corners)
    for face in (0, 1):
        assert areas[triangulation.polygon == face].sum() == pytest.approx(2 * (holes + 1) - holes * hole)
    edges = np.sort(np.stack([triangulation.triangles, np.roll(triangulation.triangles, -1, axis=1)], axis=2), axis=2)
    assert set(np.unique(edges.reshape(-1, 2), axis=0, return_counts=True)[1].tolist()) == {2}


def test_a_plate_with_holes_gets_coordinates_everywhere(lsgp, tmp_path) -> None:
    positions, faces = plate(2, 8, 1)
    (tmp_path / "in.obj").write_text(obj_text(positions, faces))
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--preset", "paint", "--report", "report.json")
    assert (done.code, done.report()["missing"]) == (0, None)
    assert not np.isnan(uv_of(tmp_path / "out.obj")).any()


def test_a_file_of_nothing_but_such_faces_is_refused() -> None:
    with pytest.raises(InputError) as caught:
        triangulated(polygon_mesh(PLACES, [[0, 1, 1], [2, 3, 2]]))
    assert (caught.value.code, caught.value.elements.indices.tolist()) == ("BAD_FACE", [0, 1])


@settings(max_examples=200, deadline=None, derandomize=True)
@example([[4, 1, 7, 4, 5, 7], [4, 1, 7, 4, 5, 7]])  # of which one triangle may be made twice, from the same corners
@given(st.lists(st.lists(st.integers(0, 7), min_size=1, max_size=7), min_size=1, max_size=6))
def test_triangles_are_in_the_numbering_of_the_file_and_every_used_corner_gets_its_value(faces: list) -> None:
    mesh = polygon_mesh(PLACES, [*faces, [0, 1, 2]])
    triangulation, findings = triangulated(mesh)
    assert (mesh.corners[triangulation.corner] == triangulation.triangles).all()
    assert (triangulation.triangles != np.roll(triangulation.triangles, 1, axis=1)).all()
    owner = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    assert (owner[triangulation.corner] == triangulation.polygon[:, None]).all()
    left_out = [i for finding in findings if finding.code == "FACES_LEFT_OUT" for i in finding.elements.indices]
    assert sorted(set(range(len(mesh.sizes))) - set(triangulation.polygon.tolist())) == left_out
    values = triangulation.to_polygon_corners(PLACES[triangulation.triangles], len(mesh.corners))
    expected = np.where(np.isin(owner, left_out)[:, None], np.nan, PLACES[mesh.corners])
    assert np.array_equal(values, expected, equal_nan=True)


def test_sixteen_bad_faces_of_many_leave_a_map_of_the_others(lsgp, tmp_path) -> None:
    positions, faces = patch(8)
    bad = [[face[0], face[0], *face[1:]] for face in faces[:8]] + [[face[0], face[1], face[0]] for face in faces[8:16]]
    (tmp_path / "in.obj").write_text(obj_text(positions, bad[:8] + faces[8:] + bad[8:]))
    (tmp_path / "good.obj").write_text(obj_text(positions, faces))
    for name in ("in", "good"):
        done = lsgp("unwrap", f"{name}.obj", "-o", f"{name}_out.obj", "--report", f"{name}.json")
        assert done.code == 0
        assert ("8 faces without coordinates and without triangles or area, 0 % of the area" in done.out) == (
            name == "in"
        )
        strict = lsgp("unwrap", f"{name}.obj", "-o", f"{name}_out.obj", "--strict")
        assert (strict.code, "refused: FACES_LEFT_OUT" in strict.err) == ((3, True) if name == "in" else (0, False))
    missing = done.report("in.json")["missing"]
    assert missing == {
        "faces": [],
        "area_percent": 0.0,
        "impossible": list(range(len(faces), len(faces) + 8)),
        "impossible_area_percent": 0.0,
    }
    warnings = {w["code"]: w["elements"] for w in done.report("in.json")["warnings"]}
    assert warnings["REPEATED_CORNERS"] == {"kind": "faces", "indices": list(range(8))}
    assert warnings["FACES_LEFT_OUT"] == {"kind": "faces", "indices": list(range(len(faces), len(faces) + 8))}
    uv, good = uv_of(tmp_path / "in_out.obj"), uv_of(tmp_path / "good_out.obj")
    assert np.isnan(uv[-24:]).all() and not np.isnan(uv[:-24]).any()
    assert {tuple(row) for row in uv[:-24].tolist()} == {tuple(row) for row in good.tolist()}


def test_closed_surfaces_with_a_repeated_corner_stay_closed(lsgp, tmp_path) -> None:
    positions, faces = cube(2)
    faces[5] = [faces[5][0], *faces[5]]
    (tmp_path / "in.obj").write_text(obj_text(positions, faces))
    done = lsgp("unwrap", "in.obj", "-o", "out.obj", "--report", "report.json")
    assert done.code == 0
    assert [warning["code"] for warning in done.report()["warnings"]] == ["REPEATED_CORNERS"]
    assert not np.isnan(uv_of(tmp_path / "out.obj")).any()
