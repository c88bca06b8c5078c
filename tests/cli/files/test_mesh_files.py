# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading OBJ, OFF and PLY, and writing OBJ: everything as it was in the file, or a refusal that names the place."""

from __future__ import annotations

import itertools
import os
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp.errors import InputError
from lsgp.io.mesh_files import read_mesh
from lsgp.io.mesh_obj import format_obj, read_obj
from lsgp.io.mesh_off import read_off
from lsgp.io.mesh_ply import read_ply
from lsgp.io.whole_files import write_whole
from polygon_meshes import (
    PLY_FORMS,
    SQUARE,
    SQUARE_OBJ,
    cube,
    faces_of,
    obj_text,
    off_text,
    patch,
    ply_bytes,
    polygon_mesh,
)
from systems import make_link


def read_text(text: str, with_uv: bool = False):
    return read_obj(text.encode(), with_uv)


# --- OBJ ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        SQUARE_OBJ + "f 1 2 3\nf 1 3 4\n",
        SQUARE_OBJ + "f -4 -3 -2\nf -4 -2 -1\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n",
        "f 1 2 3\n" + SQUARE_OBJ + "f 1 3 4\n",
        "vt 0 0\nvn 0 0 1\n" + SQUARE_OBJ + "f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
        SQUARE_OBJ + "f 1//1 2//1 3//1\nf 1//9 3//9 4//9\n",
        SQUARE_OBJ + "f 1/7/1 2/8/1 3/9/1\nf 1/ 3/ 4\n",
        (SQUARE_OBJ + "f 1 2 3\nf 1 3 4\n").replace("\n", "\r\n"),
        (SQUARE_OBJ + "f 1 2 3\nf 1 3 4\n").replace("\n", "\r"),
        "\ufeff# made\n" + SQUARE_OBJ + "f 1 2 3 # first\n#f 1 2 4\n\n  f\t1 3\t4  ",
        SQUARE_OBJ + "f 1 \\\n2 3\nf 1\\\n 3 \\\r\n 4\n",
        "mtllib a/b #c\no square\ng x y\ns off\nusemtl C:\\stone\n"
        + SQUARE_OBJ
        + "vp 1\nl 1 2\np 1\nfo 1 2 3\nf 1 3 4\nend",
        "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0 0 0 0 1\nf 1 2 3\nf 1 3 4\n",
        "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\nf 1 3 4\n",
        "v +0 -0 0.\nv 1.e0 0 .0\nv 1E+0 1e-0 0\nv 0 10e-1 0\nf 1 2 3\nf +1 3 4\n",
    ],
    ids=itertools.count(),
)
def test_obj_spellings_of_one_square(text: str) -> None:
    mesh = read_text(text)
    assert mesh.positions.tolist() == SQUARE
    assert faces_of(mesh) == [[0, 1, 2], [0, 2, 3]]
    assert (mesh.positions.dtype, mesh.corners.dtype) == (np.float64, np.int32)


def test_obj_texture_coordinates() -> None:
    text = SQUARE_OBJ + "vt 0.5 0.25 9\nvt 0.75\nf 1/1 2/2/1 3\nvt 1 1\nf 1/-1 3/1/ 4/-3/1\n"
    mesh = read_text(text, with_uv=True)
    expected = [[0.5, 0.25], [0.75, 0], [np.nan, np.nan], [1, 1], [0.5, 0.25], [0.5, 0.25]]
    assert np.array_equal(mesh.corner_uv, expected, equal_nan=True)
    assert np.isnan(read_text(SQUARE_OBJ + "f 1 2 3", with_uv=True).corner_uv).all()


def test_obj_without_faces_or_vertices_is_read() -> None:
    assert (len(read_text("").positions), len(read_text("# nothing\n").sizes)) == (0, 0)
    mesh = read_text(SQUARE_OBJ, with_uv=True)
    assert (mesh.positions.shape, mesh.corners.shape, mesh.corner_uv.shape) == ((4, 3), (0,), (0, 2))


def test_obj_numbers_that_are_not_finite_are_left_to_the_library() -> None:
    positions = read_text("v nan 0 0\nv 1e999 0 0\nv -inf 0 0\nf 1 2 3\n").positions
    assert np.array_equal(positions[:, 0], [np.nan, np.inf, -np.inf], equal_nan=True)


@pytest.mark.slow
def test_obj_of_100k_triangles_reads_well_under_a_second(tmp_path: Path) -> None:
    positions, faces = cube(92)
    halves = [half for a, b, c, d in faces for half in ([a, b, c], [a, c, d])]
    assert len(halves) > 100_000
    path = tmp_path / "large.obj"
    path.write_text(obj_text(positions, halves))
    seconds = []
    for _ in range(3):
        begin = time.process_time()
        mesh = read_mesh(path)
        seconds.append(time.process_time() - begin)
    assert mesh.corners.tolist() == [vertex for half in halves for vertex in half]
    assert min(seconds) < 0.8


# --- OFF ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
        "OFF 4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0.5 0.5 0.5 1\n",
        "OFF\n4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 7\n3 0 2 3\n",
        "# c\nOFF # OFF\n\n#\n4 2 0 # counts\n0 0 0 # 0\n\n1 0 0\n1 1 0\n  0 1 0\n3\t0 1 2\n3 0 2 3 # end",
        "COFF\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 1 1 1\n0 1 0 9 9 9 9\n3 0 1 2\n3 0 2 3\n",
        "NOFF\r\n4 2 0\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n1 1 0 0 0 1\r\n0 1 0 0 0 1\r\n3 0 1 2\r\n3 0 2 3\r\n",
        "STOFF\n4 2 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2\n3 0 2 3\n",
        "STCNOFF 4 2 0\n0 0 0 1 1\n1 0 0 1 1\n1 1 0 1 1\n0 1 0 1 1\n3 0 1 2\n3 0 2 3\n",
    ],
    ids=itertools.count(),
)
def test_off_spellings_of_one_square(text: str) -> None:
    mesh = read_off(text.encode())
    assert mesh.positions.tolist() == SQUARE
    assert faces_of(mesh) == [[0, 1, 2], [0, 2, 3]]


# --- PLY ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", PLY_FORMS)
@pytest.mark.parametrize("extras", [False, True])
@pytest.mark.parametrize("list_name", ["vertex_indices", "vertex_index"])
@pytest.mark.parametrize("made", [patch, lambda: cube(2)], ids=["mixed", "quads"])
def test_ply_forms(form: str, extras: bool, list_name: str, made) -> None:
    positions, faces = made()
    mesh = read_ply(ply_bytes(positions, faces, form, list_name=list_name, extras=extras))
    assert (mesh.positions == positions).all()
    assert faces_of(mesh) == faces


@pytest.mark.parametrize("form", PLY_FORMS)
@pytest.mark.parametrize("count", ["char", "uchar", "short", "ushort", "int", "uint"])
@pytest.mark.parametrize("index", ["char", "uchar", "short", "ushort", "int", "uint"])
def test_ply_integer_types(form: str, count: str, index: str) -> None:
    positions, faces = patch()
    mesh = read_ply(ply_bytes(positions, faces, form, count=count, index=index))
    assert faces_of(mesh) == faces


@pytest.mark.parametrize("form", PLY_FORMS)
@pytest.mark.parametrize("coordinate", ["float", "double", "short"])
def test_ply_coordinate_types(form: str, coordinate: str) -> None:
    positions, faces = cube(3, size=6.0 if coordinate == "short" else 0.7)
    if coordinate != "double":
        positions = positions.astype({"float": np.float32, "short": np.int16}[coordinate]).astype(float)
    assert (read_ply(ply_bytes(positions, faces, form, coordinate)).positions == positions).all()


@pytest.mark.parametrize("ending", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("form", PLY_FORMS)
def test_ply_line_endings_of_the_header(form: str, ending: bytes) -> None:
    positions, faces = cube(2)
    data = ply_bytes(positions, faces, form)
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    body = data[begin:].replace(b"\n", ending) if form == "ascii" else data[begin:]
    mesh = read_ply(data[:begin].replace(b"\n", ending) + body)
    assert (mesh.positions == positions).all()
    assert faces_of(mesh) == faces


def test_ply_without_faces_is_read() -> None:
    assert len(read_ply(ply_bytes(np.array(SQUARE), [])).sizes) == 0
    assert len(read_ply(ply_bytes(np.array(SQUARE), [], PLY_FORMS[1])).positions) == 4


def test_ply_index_that_needs_all_32_bits_is_out_of_range_not_negative() -> None:
    with pytest.raises(InputError, match="4294967295"):
        read_ply(ply_bytes(np.array(SQUARE), [[0, 1, 2**32 - 1]], PLY_FORMS[1], index="uint"))


# --- all formats ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("made", [patch, lambda: cube(3)], ids=["mixed", "quads"])
def test_all_formats_hold_the_same_mesh(tmp_path: Path, made) -> None:
    positions, faces = made()
    positions = positions / 3
    contents = {
        "a.obj": obj_text(positions, faces).encode(),
        "A.OBJ": obj_text(positions, faces).encode(),
        "a.off": off_text(positions, faces).encode(),
        "a.ply": ply_bytes(positions, faces, PLY_FORMS[2]),
        "ply": ply_bytes(positions, faces),
        "off.data": off_text(positions, faces).encode(),
    }
    for name, data in contents.items():
        (tmp_path / name).write_bytes(data)
        mesh = read_mesh(tmp_path / name)
        assert (mesh.positions == positions).all(), name
        assert faces_of(mesh) == faces, name


# --- writing --------------------------------------------------------------------------------------------------------


@settings(max_examples=200, deadline=None)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=12, max_size=12), st.integers(0, 2**32 - 1))
def test_doubles_read_back_as_the_same_doubles(numbers: list[float], seed: int) -> None:
    mesh = polygon_mesh(np.reshape(numbers, (4, 3)), [[0, 1, 2, 3], [3, 2, 1]])
    uv = np.random.default_rng(seed).normal(size=(7, 2)) * 10.0 ** np.random.default_rng(seed).integers(-300, 300)
    again = read_obj(format_obj(mesh, uv), True)
    assert again.positions.tobytes() == mesh.positions.tobytes()
    assert faces_of(again) == [[0, 1, 2, 3], [3, 2, 1]]
    assert (again.corner_uv == uv).all()


def test_vt_are_shared_by_corners_of_one_vertex_with_the_same_place() -> None:
    mesh = polygon_mesh(SQUARE, [[0, 1, 2], [0, 2, 3]])
    #      0       1       2         0       2 elsewhere   3 where 0 is
    uv = [[0.0, 0], [1, 0], [1, 1], [-0.0, 0], [1, 1.0000000000000002], [0, 0]]
    text = format_obj(mesh, np.array(uv)).decode()
    assert text == (
        "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 1.0 1.0 0.0\nv 0.0 1.0 0.0\n"
        "vt 0.0 0.0\nvt 1.0 0.0\nvt 1.0 1.0\nvt 1.0 1.0000000000000002\nvt 0.0 0.0\n"
        "f 1/1 2/2 3/3\nf 1/1 3/4 4/5\n"
    )


def test_faces_without_coordinates_are_written_without() -> None:
    positions, faces = patch()
    mesh = polygon_mesh(positions, faces)
    rng = np.random.default_rng(0)
    uv = rng.random((len(mesh.corners), 2))
    missing = rng.random(len(faces)) < 0.4
    polygon = np.repeat(np.arange(len(faces)), mesh.sizes)
    uv[missing[polygon]] = np.nan
    uv[np.flatnonzero(polygon == 1)[2]] = np.nan  # one corner missing is a face missing
    missing[1] = True
    text = format_obj(mesh, uv).decode()
    lines = [line for line in text.splitlines() if line.startswith("f")]
    assert ["/" in line for line in lines] == (~missing).tolist()
    again = read_obj(text.encode(), True)
    assert faces_of(again) == faces
    assert (again.corner_uv[~missing[polygon]] == uv[~missing[polygon]]).all()
    assert np.isnan(again.corner_uv[missing[polygon]]).all()


def test_a_file_is_replaced_as_a_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "out.obj"
    target.write_text("before")
    mesh = polygon_mesh(SQUARE, [[0, 1, 2, 3]])

    def fail(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", fail)
        with pytest.raises(OSError, match="No space"):
            write_whole(target, format_obj(mesh, np.zeros((4, 2))))
    assert target.read_text() == "before"
    assert os.listdir(tmp_path) == ["out.obj"]
    write_whole(target, format_obj(mesh, np.zeros((4, 2))))
    assert target.read_text().startswith("v 0.0 0.0 0.0\n")
    assert os.listdir(tmp_path) == ["out.obj"]


def test_links_and_devices_are_written_to_not_replaced(tmp_path: Path) -> None:
    mesh = polygon_mesh(SQUARE, [[0, 1, 2, 3]])
    (tmp_path / "real.obj").write_text("before")
    make_link(tmp_path / "link.obj", "real.obj")
    make_link(tmp_path / "null", os.devnull)
    write_whole(tmp_path / "link.obj", format_obj(mesh, np.zeros((4, 2))))
    write_whole(tmp_path / "null", format_obj(mesh, np.zeros((4, 2))))
    assert (tmp_path / "link.obj").is_symlink()
    assert (tmp_path / "real.obj").read_text().startswith("v 0.0")
    assert not Path(os.devnull).is_file()


# --- files of the shared folder -------------------------------------------------------------------------------------


def test_shared_meshes_are_read_as_their_list_says(shared: Path) -> None:
    rows = [line.split(",") for line in (shared / "meshes" / "index.csv").read_text().splitlines()[1:]]
    assert len(rows) >= 18
    for row in rows:
        mesh = read_mesh(shared / "meshes" / row[0])
        vertices, triangles, largest = (int(n) for n in _counts(row))
        found = (len(mesh.positions), int((mesh.sizes - 2).sum()), int(mesh.sizes.max()))
        assert found == (vertices, triangles, largest), row[0]


def _counts(row: list[str]) -> list[str]:
    """vertices, triangles, max_polygon: the first three numbers in a row (texts before them may hold commas)."""
    numbers = [i for i, cell in enumerate(row) if cell.isdigit()]
    first = next(i for i in numbers if i + 1 in numbers and i + 2 in numbers)
    return row[first : first + 3]
