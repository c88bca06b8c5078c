# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that name a vertex twice cost themselves at most, not the file."""

from __future__ import annotations

import numpy as np
import pytest
from command import uv_of
from hypothesis import given, settings
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
        ([0, 1, 2, 0, 3, 4], None),
        ([0, 1, 1, 2, 3, 1], None),
    ],
)
def test_neighbors_that_are_one_vertex_become_one_corner_and_other_faces_go(face: list, kept: list | None) -> None:
    usable = without_repeated_corners(polygon_mesh(PLACES, [[5, 6, 7], face]))
    assert faces_of(usable.mesh) == [[5, 6, 7]] + ([kept] if kept else [])
    codes = [finding.code for finding in usable.findings]
    expected = ["FACES_LEFT_OUT"] if kept is None else ["REPEATED_CORNERS"]
    assert codes == ([] if kept == face else expected)
    assert all(finding.elements.indices.tolist() == [1] for finding in usable.findings)
    assert all(finding.elements.kind == "faces" for finding in usable.findings)


def test_a_file_of_nothing_but_such_faces_is_refused() -> None:
    with pytest.raises(InputError) as caught:
        triangulated(polygon_mesh(PLACES, [[0, 1, 1], [2, 3, 2]]))
    assert (caught.value.code, caught.value.elements.indices.tolist()) == ("BAD_FACE", [0, 1])


@settings(max_examples=200, deadline=None)
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
