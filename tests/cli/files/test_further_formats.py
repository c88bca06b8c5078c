# SPDX-License-Identifier: GPL-3.0-or-later
"""Formats that need other packages, PLY with texture coordinates and STL; and the errors without these packages."""

from __future__ import annotations

import io
import struct
import time
from pathlib import Path

import numpy as np
import pytest
from lsgp.cli import main
from lsgp.errors import InputError
from lsgp.io import optional_packages
from lsgp.io.mesh_files import read_mesh, read_mesh_file, write_mesh_file
from lsgp.io.mesh_formats import formats_table
from lsgp.io.mesh_ply import read_ply
from lsgp.io.mesh_stl import read_stl
from lsgp.io.welding import weld
from polygon_meshes import PLY_FORMS, bumpy_ball, cube, faces_of, obj_text, off_text, patch, ply_bytes, stl_files


def split_uv(file) -> np.ndarray:
    """Coordinates of the triangles' corners with a cut, no short decimals."""
    uv = file.mesh.positions[file.triangulation.triangles][..., :2] / 7
    uv[: len(uv) // 2] += 100
    return uv


# --- PLY ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", PLY_FORMS)
@pytest.mark.parametrize("made", [patch, lambda: cube(2)], ids=["mixed", "quads"])
def test_a_ply_keeps_polygons_properties_and_what_refers_to_vertices(tmp_path: Path, form: str, made) -> None:
    plyfile = pytest.importorskip("plyfile")
    positions, faces = made()
    (tmp_path / "in.ply").write_bytes(ply_bytes(positions, faces, form, extras=True))
    file = read_mesh_file(tmp_path / "in.ply")
    uv = split_uv(file)
    assert write_mesh_file(tmp_path / "out.ply", file, uv) == []
    old, new = (plyfile.PlyData.read(tmp_path / f"{name}.ply") for name in ("in", "out"))
    assert (new.text, new.comments) == (old.text, old.comments)
    assert [element.name for element in new] == [element.name for element in old]
    assert [row["shutter"] for row in new["camera"]] == [7]
    assert new["camera"]["view"][0].tolist() == [0.5, 1.5]
    count = len(positions)
    for name in old["vertex"].data.dtype.names:
        assert (new["vertex"][name][:count] == old["vertex"][name]).all()
    assert (new["face"]["flags"] == -1).all() and "texcoord" not in new["face"].data.dtype.names

    again = read_mesh(tmp_path / "out.ply")
    assert len(again.positions) > count
    assert (again.positions[again.corners] == file.mesh.positions[file.mesh.corners]).all()
    assert (again.sizes == file.mesh.sizes).all()
    stored = np.stack([new["vertex"]["s"], new["vertex"]["t"]], axis=1)[again.corners]
    assert (stored == file.triangulation.to_polygon_corners(uv, len(again.corners))).all()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"property int flags", b"property int fl\xe4gs"),
        (b"\n-1 ", b"\n99999999999 "),
        (b"ascii 1.0", b"ascii 2.0"),
    ],
)
def test_a_ply_that_its_writer_does_not_read_is_refused(tmp_path: Path, old: bytes, new: bytes) -> None:
    pytest.importorskip("plyfile")
    for made in (patch, lambda: cube(2)):
        data = ply_bytes(*made(), extras=True)
        assert old in data
        (tmp_path / "in.ply").write_bytes(data.replace(old, new))
        file = read_mesh_file(tmp_path / "in.ply")
        with pytest.raises(InputError, match=r"plyfile.*Write OBJ") as caught:
            write_mesh_file(tmp_path / "out.ply", file, split_uv(file))
        assert caught.value.code == "MALFORMED_FILE" and not (tmp_path / "out.ply").exists()


@pytest.mark.parametrize("with_rows_of_equal_length", [False, True])
def test_further_lines_of_a_comment_stay_comments(tmp_path: Path, with_rows_of_equal_length: bool) -> None:
    plyfile = pytest.importorskip("plyfile")
    data = ply_bytes(*(cube(2) if with_rows_of_equal_length else patch()), extras=True)
    (tmp_path / "in.ply").write_bytes(data.replace(b"comment made for a test", b"comment made\nfor a\n\n test"))
    file = read_mesh_file(tmp_path / "in.ply")
    write_mesh_file(tmp_path / "out.ply", file, split_uv(file))
    assert plyfile.PlyData.read(tmp_path / "out.ply").comments[:3] == ["made", "for a", "test"]


@pytest.mark.parametrize("source", [b"ply\nformat ascii 1.0\nend_header\n", b"OFF\n0 0 0\n"])
def test_a_mesh_without_vertices_is_no_ply(tmp_path: Path, source: bytes) -> None:
    pytest.importorskip("plyfile")
    path = tmp_path / ("a.off" if source.startswith(b"OFF") else "a.ply")
    path.write_bytes(source)
    with pytest.raises(InputError) as caught:
        write_mesh_file(tmp_path / "out.ply", read_mesh_file(path), np.empty((0, 3, 2)))
    assert caught.value.code == "EMPTY_MESH"


def test_a_text_ply_of_equal_polygons_keeps_its_numbers_in_few_digits(tmp_path: Path) -> None:
    plyfile = pytest.importorskip("plyfile")
    positions, faces = cube(2)
    header = f"""ply
format ascii 1.0
comment kept
element vertex {len(positions)}
property double x
property double y
property double z
property float q
element face {len(faces)}
property uint tag
property list uchar int vertex_indices
element edge 0
property int vertex1
end_header
"""
    rows = [f"{x / 3:.17g} {y / 7:.17g} {z:.17g} {i / 10}" for i, (x, y, z) in enumerate(positions)]
    rows += [f"{2**32 - 1 - i} 4 {' '.join(map(str, face))}" for i, face in enumerate(faces)]
    (tmp_path / "in.ply").write_text(header + "\n".join(rows) + "\n")
    file = read_mesh_file(tmp_path / "in.ply")
    uv = split_uv(file)
    assert write_mesh_file(tmp_path / "out.ply", file, uv) == []
    found = plyfile.PlyData.read(tmp_path / "out.ply")
    assert found.comments == ["kept"]
    old = found["vertex"].data[: len(positions)]
    assert [old[axis].tolist() for axis in "xyz"] == file.mesh.positions.T.tolist()
    assert (old["q"] == np.arange(len(positions), dtype="f4") / np.float32(10)).all()
    first = (tmp_path / "out.ply").read_text().split("end_header\n")[1].split()
    numbers = [*file.mesh.positions[0].tolist(), 0.0, *(found["vertex"][name][0].item() for name in "st")]
    assert first[:6] == [repr(number) for number in numbers]  # the shortest digits
    assert found["face"]["tag"].tolist() == [2**32 - 1 - i for i in range(len(faces))]
    corners = np.concatenate(list(found["face"]["vertex_indices"]))
    stored = np.stack([found["vertex"]["s"], found["vertex"]["t"]], axis=1)[corners]
    assert (stored == file.triangulation.to_polygon_corners(uv, len(corners))).all()


def test_elements_without_properties_take_no_rows_of_others(tmp_path: Path) -> None:
    plyfile = pytest.importorskip("plyfile")
    positions, faces = cube(1)
    header = f"""ply
format ascii 1.0
element vertex {len(positions)}
property float x
property float y
property float z
element nothing 2
element face {len(faces)}
property list uchar int vertex_indices
element edge 2
property int vertex1
end_header
"""
    rows = [f"{x} {y} {z}" for x, y, z in positions] + ["", ""]
    rows += [f"4 {' '.join(map(str, face))}" for face in faces] + ["5", "7"]
    (tmp_path / "in.ply").write_text(header + "\n".join(rows) + "\n")
    file = read_mesh_file(tmp_path / "in.ply")
    assert write_mesh_file(tmp_path / "out.ply", file, split_uv(file)) == []
    found = plyfile.PlyData.read(tmp_path / "out.ply")
    assert found["edge"]["vertex1"].tolist() == [5, 7]
    assert len(found["face"].data) == len(faces) and found["nothing"].count == 2


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_binary_ply_of_equal_polygons_keeps_numbers_around_its_lists(tmp_path: Path, order: str) -> None:
    plyfile = pytest.importorskip("plyfile")
    positions, faces = cube(2)
    vertices = np.array([(*p, 0.5 * i) for i, p in enumerate(positions)], f"{order}f8,{order}f8,{order}f8,{order}f8")
    rows = [(i % 7, 4, face, -i) for i, face in enumerate(faces)]
    table = np.array(
        rows, [("group", "u1"), ("count", f"{order}u2"), ("list", f"{order}i4", (4,)), ("tag", f"{order}i2")]
    )
    header = f"""ply
format binary_{"little" if order == "<" else "big"}_endian 1.0
comment kept
element face {len(faces)}
property uchar group
property list ushort int vertex_index
property short tag
element vertex {len(positions)}
property double x
property double y
property double z
property double q
end_header
"""
    (tmp_path / "in.ply").write_bytes(header.encode() + table.tobytes() + vertices.tobytes())
    file = read_mesh_file(tmp_path / "in.ply")
    uv = split_uv(file)
    assert write_mesh_file(tmp_path / "out.ply", file, uv) == []
    new = plyfile.PlyData.read(tmp_path / "out.ply")
    assert [element.name for element in new] == ["face", "vertex"] and new.comments == ["kept"]
    assert new["face"].ply_property("vertex_index").len_dtype == "u2"
    assert (new["face"]["group"] == table["group"]).all() and (new["face"]["tag"] == table["tag"]).all()
    corners = np.concatenate(list(new["face"]["vertex_index"]))
    for axis, name in enumerate("xyz"):
        assert (new["vertex"][name][corners] == file.mesh.positions[file.mesh.corners, axis]).all()
    stored = np.stack([new["vertex"]["s"], new["vertex"]["t"]], axis=1)[corners]
    assert (stored == file.triangulation.to_polygon_corners(uv, len(corners))).all()


def test_faces_without_coordinates_are_at_the_origin_of_a_ply_or_keep_theirs(tmp_path: Path) -> None:
    plyfile = pytest.importorskip("plyfile")
    (tmp_path / "in.obj").write_text(obj_text(*cube(2)))
    file = read_mesh_file(tmp_path / "in.obj")
    uv = split_uv(file)
    write_mesh_file(tmp_path / "solved.ply", file, uv)
    uv[-1] = np.nan
    (finding,) = write_mesh_file(tmp_path / "out.ply", file, uv)
    assert (finding.code, finding.message[:7]) == ("UNSOLVED_AT_ORIGIN", "1 face ")
    assert write_mesh_file(tmp_path / "kept.ply", read_mesh_file(tmp_path / "solved.ply"), uv) == []
    for name, expected in (("out", [0, 0]), ("kept", None)):
        data = plyfile.PlyData.read(tmp_path / f"{name}.ply")
        last = data["face"]["vertex_indices"][-1]
        stored = np.stack([data["vertex"]["s"], data["vertex"]["t"]], axis=1)[last]
        old = np.array(cube(2)[0])[cube(2)[1][-1]][:, :2] / 7
        assert (stored == (old if expected is None else expected)).all()


def test_unwrap_writes_ply_to_a_file_and_a_stream(tmp_path: Path, lsgp) -> None:
    pytest.importorskip("plyfile")
    (tmp_path / "in.ply").write_bytes(ply_bytes(*bumpy_ball(3), "binary_little_endian"))
    assert lsgp("unwrap", "in.ply", "-o", "out.ply").code == 0
    assert b"property double s" in (tmp_path / "out.ply").read_bytes()


# --- STL ------------------------------------------------------------------------------------------------------------


TETRAHEDRON = (
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)


@pytest.mark.parametrize("kind", ["binary", "text"])
def test_an_stl_is_welded_where_its_corners_are_at_the_same_place(tmp_path: Path, lsgp, kind: str) -> None:
    positions, faces = bumpy_ball(4)
    triangles = np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))])
    (tmp_path / "in.stl").write_bytes(stl_files(positions, triangles)[kind])
    mesh = read_mesh(tmp_path / "in.stl")
    assert len(mesh.positions) == len(positions)
    assert (mesh.positions[mesh.corners] == positions[triangles].astype("f4").reshape(-1, 3)).all()
    assert lsgp("unwrap", "in.stl", "-o", "out.obj").code == 0


@pytest.mark.parametrize("kind", ["binary", "text"])
def test_an_stl_is_read_as_trimesh_reads_it(kind: str) -> None:
    trimesh = pytest.importorskip("trimesh")
    data = stl_files(bumpy_ball(3)[0], np.array([[0, 1, 2], [2, 1, 3], [0, 5, 4]]))[kind]
    expected = trimesh.load(io.BytesIO(data), file_type="stl", force="mesh", process=False).triangles
    mesh = read_stl(data)
    assert (mesh.positions[mesh.corners] == expected.reshape(-1, 3)).all()


def test_an_stl_is_told_by_its_length_and_read_in_any_spelling() -> None:
    files = stl_files(*TETRAHEDRON)
    expected = read_stl(files["binary"])
    spellings = {
        "a header like text": b"solid" + files["binary"][5:],
        "further bytes": files["binary"] + b"more",
        "capitals": files["text"].upper(),
        "line ends": files["text"].replace(b"\n", b"\r\n").replace(b"vertex", b"\t vertex"),
        "two solids": files["text"] + b"solid vertex\nendsolid vertex\n",
    }
    for name, data in spellings.items():
        mesh = read_stl(data)
        assert np.array_equal(mesh.positions, expected.positions), name
        assert np.array_equal(mesh.corners, expected.corners), name


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"\x01\x02", "2 bytes where 0 triangles take 84"),
        (b"", "0 bytes"),
        (b"solid\n", "without triangles"),
        (bytes(84), "without triangles"),
        (bytes(80) + b"\xff" * 4, "4294967295 triangles"),
        (bytes(80) + b"\1\0\0\0" + bytes(49), "133 bytes where 1 triangles take 134"),
        (b"solid a\nvertex 0 0 0\n", "Line 2"),
        (b"solid a\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop", "Line 2: a loop of 2"),
        (b"solid a\nouter loop\nvertex 0 0\nvertex 1 0 0\nvertex 1 1 0", "Line 3: a vertex with 2"),
        (b"solid a\nouter loop\nvertex 0 0 x\nvertex 1 0 0\nvertex 1 1 0", "Line 3: 'x'"),
    ],
)
def test_an_stl_that_is_none_is_refused(data: bytes, said: str) -> None:
    with pytest.raises(InputError, match=said) as caught:
        read_stl(data)
    assert caught.value.code == "MALFORMED_FILE"


def test_only_places_that_are_exactly_the_same_are_one() -> None:
    near = np.nextafter(1.0, 2.0)
    places = np.array([[1, 0, 0], [near, 0, 0], [1, -0.0, 0], [np.nan, 0, 0], [np.nan, 0, 0], [0, 0, 0], [near, 0, 0]])
    welded, index = weld(places)
    assert index.tolist() == [0, 1, 0, 2, 3, 4, 1]
    assert np.array_equal(welded, places[[0, 1, 3, 4, 5]] + 0.0, equal_nan=True)


# --- what is not installed, and what does not fit -------------------------------------------------------------------


def test_what_a_format_takes_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(optional_packages, "find_spec", lambda name: None)
    Path("in.obj").write_text(obj_text(*patch()))
    assert main(["unwrap", "in.obj", "-o", "out.ply"]) == 2
    assert "'out.ply' takes the package plyfile; pip install 'lsgp[formats]'" in capsys.readouterr().err
    assert main(["--formats"]) == 0
    table = capsys.readouterr().out
    assert table == formats_table() + "\n"
    assert [line.split()[:2] for line in table.splitlines()[1:]] == [
        *[["OBJ", "yes"], ["OFF", "yes"], ["PLY", "yes"], ["glTF", "yes"], ["GLB", "yes"], ["STL", "yes"]]
    ]


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("a.ply", ply_bytes(*patch(), extras=True), ["vertex red", "vertex quality", "face flags", "element camera"]),
        ("a.off", off_text(*patch()).replace("OFF", "COFF", 1).encode(), ["vertex colors"]),
        ("b.off", (off_text(*patch()).rstrip() + " 255 0 0\n").encode(), ["face colors"]),
    ],
)
def test_what_an_obj_cannot_hold_is_said(tmp_path: Path, lsgp, name: str, data: bytes, said: list[str]) -> None:
    (tmp_path / name).write_bytes(data)
    done = lsgp("unwrap", name, "-o", "out.obj", "--report", "report.json")
    (warning,) = [w for w in done.report()["warnings"] if w["code"] == "CONTENT_NOT_KEPT"]
    assert all(what in warning["message"] for what in said)
    assert warning["message"] in done.err
    assert done.code == 0


def test_files_are_not_written_over_or_with_other_shapes(tmp_path: Path) -> None:
    (tmp_path / "in.obj").write_text(obj_text(*patch()))
    before = (tmp_path / "in.obj").read_bytes()
    file = read_mesh_file(tmp_path / "in.obj")
    uv = split_uv(file)
    for path, coordinates, code in (
        ("in.obj", uv, "WRONG_PARAMETER"),
        ("out.fbx", uv, "WRONG_PARAMETER"),
        ("out.obj", uv[1:], "WRONG_SHAPE"),
    ):
        with pytest.raises(InputError) as caught:
            write_mesh_file(tmp_path / path, file, coordinates)
        assert caught.value.code == code
    assert (tmp_path / "in.obj").read_bytes() == before
    write_mesh_file(tmp_path / "in.obj", file, uv, in_place=True)
    again = read_mesh_file(tmp_path / "in.obj", with_uv=True)
    assert (again.triangle_uv == uv).all()
    assert faces_of(again.mesh) == faces_of(file.mesh)


# --- PLY tables and headers -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", PLY_FORMS)
def test_a_header_line_that_lacks_its_keyword_comment_is_passed_over(form: str) -> None:
    data = ply_bytes(*patch(), form)
    mesh = read_ply(data.replace(b"comment made for a test", b"made for a test\nby hand: 1 2\nTextureFile a.png"))
    assert faces_of(mesh) == patch()[1]


@pytest.mark.slow
@pytest.mark.parametrize("form", PLY_FORMS)
def test_reading_a_header_takes_time_in_proportion_to_its_properties(form: str) -> None:
    def seconds(count: int) -> float:
        more = b"".join(b"property uchar p%d\n" % i for i in range(count))
        header, end, body = ply_bytes(np.eye(3), [[0, 1, 2]], form).partition(b"end_header\n")
        where = header.index(b"element face")
        rows = (
            body.splitlines(keepends=True) if form == "ascii" else [body[i : i + 24] for i in (0, 24, 48)] + [body[72:]]
        )
        value = b" 0" * count if form == "ascii" else bytes(count)
        rows = [row.rstrip(b"\n") + value + b"\n" * (form == "ascii") for row in rows[:3]] + rows[3:]
        data = header[:where] + more + header[where:] + end + b"".join(rows)
        best = []
        for _ in range(3):
            begin = time.process_time()
            assert len(read_ply(data).positions) == 3
            best.append(time.process_time() - begin)
        return min(best)

    # A quadratic time would be 64 times as long, a proportional one 8 times, and more on a busy machine.
    assert seconds(40_000) < 28 * seconds(5_000)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", ["float", "double"])
def test_a_signaling_nan_is_a_place_like_others(tmp_path: Path, kind: str) -> None:
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
        + "".join(f"property {kind} {axis}\n" for axis in "xyz")
        + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    nan = {"float": b"\1\0\x80\x7f", "double": b"\1\0\0\0\0\0\xf0\x7f"}[kind]
    (tmp_path / "a.ply").write_bytes(header.encode() + nan * 9 + struct.pack("<B3i", 3, 0, 1, 2))
    assert np.isnan(read_mesh_file(tmp_path / "a.ply").mesh.positions).all()


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("count_type", ["char", "uchar", "short", "ushort", "int", "uint"])
def test_rows_with_lists_of_different_lengths_are_read_as_they_stand(order: str, count_type: str) -> None:
    """Beside lists of other things, which are passed over."""
    rng = np.random.default_rng(1)
    faces = [rng.integers(0, 9, rng.integers(3, 7)).tolist() for _ in range(50)]
    code = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I"}[count_type]
    form = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    header = (
        f"ply\nformat {form} 1.0\nelement vertex 9\nproperty list {count_type} double more\nproperty float x\n"
        f"property double y\nproperty short z\nelement face {len(faces)}\nproperty uchar flag\n"
        f"property list {count_type} ushort vertex_indices\nproperty list uchar float weights\nend_header\n"
    ).encode()
    vertices = b"".join(
        struct.pack(f"{order}{code}{i % 3}dfdh", i % 3, *[0.5] * (i % 3), i, i / 2, -i) for i in range(9)
    )
    rows = b"".join(
        struct.pack(
            f"{order}B{code}{len(face)}HB{len(face) % 3}f", 7, len(face), *face, len(face) % 3, *[1] * (len(face) % 3)
        )
        for face in faces
    )
    mesh = read_ply(header + vertices + rows)
    assert faces_of(mesh) == faces
    assert (mesh.positions == np.arange(9.0)[:, None] * [1, 0.5, -1]).all()
    for cut in range(1, len(vertices + rows), 7):
        with pytest.raises(InputError, match="ends in row"):
            read_ply((header + vertices + rows)[:-cut])


def test_a_million_lists_of_different_lengths_take_no_longer_than_equal_ones() -> None:
    def seconds(change: bytes) -> float:
        rows = struct.pack("<B3i", 3, 0, 1, 2) * 300_000 + change
        header = (
            "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 300001\nproperty list uchar int vertex_indices\nend_header\n"
        )
        data = header.encode() + np.eye(3, dtype="<f4").tobytes() + rows
        begin = time.process_time()
        assert len(read_ply(data).sizes) == 300_001
        return time.process_time() - begin

    # Row by row in Python they took a hundred times as long.
    equal = min(seconds(struct.pack("<B3i", 3, 0, 1, 2)) for _ in range(3))
    assert min(seconds(struct.pack("<B4i", 4, 0, 1, 2, 0)) for _ in range(3)) < 20 * equal
