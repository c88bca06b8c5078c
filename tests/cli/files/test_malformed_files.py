# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that break their format, or hold polygons that cannot be, are refused with the place of the fault."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp.errors import InputError
from lsgp.io.mesh_files import read_mesh
from lsgp.io.mesh_obj import read_obj
from lsgp.io.mesh_off import read_off
from lsgp.io.mesh_ply import read_ply
from polygon_meshes import PLY_FORMS, SQUARE_OBJ, obj_text, off_text, ply_bytes


def ply_header(*lines: str) -> bytes:
    return "\n".join(["ply", *lines, "end_header", ""]).encode()


VERTEX_HEADER = ("element vertex 3", "property float x", "property float y", "property float z")
FACE_HEADER = ("element face 1", "property list uchar int vertex_indices")
PLY_3 = b"0 0 0\n1 0 0\n0 1 0\n"
ASCII = "format ascii 1.0"
BINARY = "format binary_little_endian 1.0"
OFF_3 = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"

MALFORMED = {
    "obj two coordinates": ("a.obj", b"v 0 0 0\nv 1 0\n", "MALFORMED_FILE", "Line 2"),
    "obj no coordinates": ("a.obj", b"v\n", "MALFORMED_FILE", "Line 1"),
    "obj decimal comma": ("a.obj", b"v 0 0 0\nv 0,5 0 0\n", "MALFORMED_FILE", "Line 2: '0,5'"),
    "obj underscore": ("a.obj", b"# c\n\nv 1_0 0 0\n", "MALFORMED_FILE", "Line 3: '1_0'"),
    "obj word for an index": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2 x\n", "MALFORMED_FILE", "Line 5: 'x'"),
    "obj fraction for an index": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2 3.0\n", "MALFORMED_FILE", "Line 5: '3.0'"),
    "obj no vertex before the slash": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2 /3\n", "MALFORMED_FILE", "Line 5"),
    "obj index of 30 digits": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2 " + b"9" * 30, "MALFORMED_FILE", "Line 5"),
    "obj index of 5000 digits": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2 " + b"9" * 5000, "MALFORMED_FILE", "Line 5"),
    "obj bytes": ("a.obj", b"v 0 0 0\n\x00\x01\xff\xfe\n", "MALFORMED_FILE", "Line 2"),
    "obj bare numbers": ("a.obj", b"0 0 0\n1 0 0\n", "MALFORMED_FILE", "Line 1: '0'"),
    "obj line after a join": ("a.obj", b"v 0 \\\n0 0\nv 1 0 x\n", "MALFORMED_FILE", "Line 3: 'x'"),
    "obj index zero": (
        "a.obj",
        SQUARE_OBJ.encode() + b"f 1 2 3\nf 0 1 2\n",
        "INDEX_OUT_OF_RANGE",
        r"Face 1 \(line 6\)",
    ),
    "obj index too large": (
        "a.obj",
        SQUARE_OBJ.encode() + b"f 1 2 5\n",
        "INDEX_OUT_OF_RANGE",
        r"Face 0 \(line 5\).*: 4,",
    ),
    "obj index too far back": ("a.obj", b"v 0 0 0\nf -1 -2 -3\nv 1 0 0\nv 0 1 0\n", "INDEX_OUT_OF_RANGE", "line 2"),
    "obj no vertices": ("a.obj", b"f 1 2 3\n", "INDEX_OUT_OF_RANGE", "no vertices"),
    "obj two corners": ("a.obj", SQUARE_OBJ.encode() + b"f 1 2\n", "BAD_FACE", "line 5"),
    "obj no corners": ("a.obj", SQUARE_OBJ.encode() + b"f\nf 1 2 3\n", "BAD_FACE", "line 5"),
    "obj in two byte characters": ("a.obj", SQUARE_OBJ.encode("utf-16"), "MALFORMED_FILE", "Line 1"),
    "off empty": ("a.off", b"", "MALFORMED_FILE", "empty"),
    "off header": ("a.off", b"OOF\n1 1 1\n", "MALFORMED_FILE", "Line 1: 'OOF'"),
    "off four dimensions": ("a.off", b"4OFF\n1 1 1\n", "MALFORMED_FILE", "Line 1"),
    "off n dimensions": ("a.off", b"nOFF 5\n1 1 1\n", "MALFORMED_FILE", "Line 1"),
    "off binary": ("a.off", b"OFF BINARY\n\x00\x00\x00\x01", "MALFORMED_FILE", "binary"),
    "off no counts": ("a.off", b"OFF\n", "MALFORMED_FILE", "counts"),
    "off one count": ("a.off", b"OFF\n3\n", "MALFORMED_FILE", "Line 2"),
    "off word for a count": ("a.off", b"OFF\nthree 1 0\n", "MALFORMED_FILE", "Line 2: 'three'"),
    "off negative count": ("a.off", b"OFF\n3 -1 0\n", "MALFORMED_FILE", "Line 2"),
    "off cut short in vertices": ("a.off", b"OFF\n3 1 0\n0 0 0\n", "MALFORMED_FILE", "1 of 3 vertices"),
    "off cut short in faces": ("a.off", OFF_3.encode(), "MALFORMED_FILE", "0 of 1 faces"),
    "off enormous count": ("a.off", b"OFF\n9000000000000000000 1 0\n", "MALFORMED_FILE", "0 of 9000000000000000000"),
    "off two coordinates": ("a.off", b"OFF\n1 0 0\n\n0 0\n", "MALFORMED_FILE", "Line 4"),
    "off word for a coordinate": ("a.off", b"OFF\n1 0 0\n0 0 x\n", "MALFORMED_FILE", "Line 3: 'x'"),
    "off too few corners": ("a.off", (OFF_3 + "3 0 1\n").encode(), "MALFORMED_FILE", "Line 6: a face of 3 corners"),
    "off negative size": ("a.off", (OFF_3 + "-3 0 1 2\n").encode(), "MALFORMED_FILE", "Line 6"),
    "off fraction for an index": ("a.off", (OFF_3 + "3 0 1 2.0\n").encode(), "MALFORMED_FILE", "Line 6: '2.0'"),
    "off index too large": ("a.off", (OFF_3 + "3 0 1 3\n").encode(), "INDEX_OUT_OF_RANGE", "line 6"),
    "off negative index": ("a.off", (OFF_3 + "3 0 1 -1\n").encode(), "INDEX_OUT_OF_RANGE", "line 6.*-1"),
    "off two corners": ("a.off", (OFF_3 + "2 0 1\n").encode(), "BAD_FACE", "line 6"),
    "off no corners": ("a.off", (OFF_3 + "0\n").encode(), "BAD_FACE", "line 6"),
    "ply other": ("a.ply", b"solid stl\n", "MALFORMED_FILE", "ply"),
    "ply empty": ("a.ply", b"", "MALFORMED_FILE", "Line 1"),
    "ply no end": ("a.ply", b"ply\nformat ascii 1.0\n", "MALFORMED_FILE", "end_header"),
    "ply no format": ("a.ply", ply_header(*VERTEX_HEADER), "MALFORMED_FILE", "format"),
    "ply unknown format": ("a.ply", ply_header("format ebcdic 1.0"), "MALFORMED_FILE", "Line 2"),
    "ply unknown type": ("a.ply", ply_header(ASCII, "element vertex 1", "property quad x"), "MALFORMED_FILE", "Line 4"),
    "ply property of nothing": ("a.ply", ply_header(ASCII, "property float x"), "MALFORMED_FILE", "Line 3"),
    "ply negative count": ("a.ply", ply_header(ASCII, "element vertex -1"), "MALFORMED_FILE", "Line 3"),
    "ply list length by floats": (
        "a.ply",
        ply_header(ASCII, "element face 0", "property list float int vertex_indices"),
        "MALFORMED_FILE",
        "Line 4",
    ),
    "ply no z": ("a.ply", ply_header(ASCII, *VERTEX_HEADER[:3]), "MALFORMED_FILE", "x, y, z"),
    "ply no corner list": (
        "a.ply",
        ply_header(ASCII, "element face 1", "property int a") + b"1\n",
        "MALFORMED_FILE",
        "vertex_indices",
    ),
    "ply corners by floats": (
        "a.ply",
        ply_header(ASCII, "element face 1", "property list uchar float vertex_indices"),
        "MALFORMED_FILE",
        "floating",
    ),
    "ply faces twice": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER, *FACE_HEADER) + PLY_3 + b"3 0 1 2\n3 0 1 2\n",
        "MALFORMED_FILE",
        "several elements",
    ),
    "ply strips": ("a.ply", ply_header(ASCII, "element tristrips 1"), "MALFORMED_FILE", "strips"),
    "ply cut short": ("a.ply", ply_header(ASCII, *VERTEX_HEADER) + b"0 0 0\n", "MALFORMED_FILE", "1 of 3"),
    "ply short row": ("a.ply", ply_header(ASCII, *VERTEX_HEADER) + b"0 0 0\n1 0\n0 1 0\n", "MALFORMED_FILE", "Line 9"),
    "ply word": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER) + b"0 0 0\n1 0 x\n0 1 0\n",
        "MALFORMED_FILE",
        "Line 9: 'x'",
    ),
    "ply short list": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"3 0 1\n",
        "MALFORMED_FILE",
        "Line 13",
    ),
    "ply enormous list": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"9223372036854775807 0 1 2\n",
        "MALFORMED_FILE",
        "Line 13",
    ),
    "ply negative list": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"-1 0 1 2\n",
        "MALFORMED_FILE",
        "Line 13",
    ),
    "ply binary cut short": ("a.ply", ply_header(BINARY, *VERTEX_HEADER) + b"\0" * 35, "MALFORMED_FILE", "row 2 of 3"),
    "ply binary enormous count": (
        "a.ply",
        ply_header(BINARY, *VERTEX_HEADER).replace(b"vertex 3", b"vertex 999999999999999999") + b"\0" * 36,
        "MALFORMED_FILE",
        "row 3 of 999999999999999999",
    ),
    "ply binary face cut short": (
        "a.ply",
        ply_header(BINARY, *VERTEX_HEADER, *FACE_HEADER) + b"\0" * 36 + b"\x03\0\0\0\0\1\0\0\0",
        "MALFORMED_FILE",
        "row 0 of 1 of element 'face'",
    ),
    "ply binary no length": (
        "a.ply",
        ply_header(BINARY, *VERTEX_HEADER, *FACE_HEADER) + b"\0" * 36,
        "MALFORMED_FILE",
        "row 0",
    ),
    "ply binary enormous list": (
        "a.ply",
        ply_header(BINARY, *VERTEX_HEADER, "element face 1", "property list uint int vertex_indices")
        + b"\0" * 36
        + b"\xff" * 8,
        "MALFORMED_FILE",
        "row 0",
    ),
    "ply binary negative list": (
        "a.ply",
        ply_header(BINARY, *VERTEX_HEADER, "element face 1", "property list char int vertex_indices")
        + b"\0" * 36
        + b"\xff" * 8,
        "MALFORMED_FILE",
        "row 0",
    ),
    "ply index too large": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"3 0 1 3\n",
        "INDEX_OUT_OF_RANGE",
        "Face 0",
    ),
    "ply negative index": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"3 0 1 -1\n",
        "INDEX_OUT_OF_RANGE",
        "Face 0.*-1",
    ),
    "ply two corners": (
        "a.ply",
        ply_header(ASCII, *VERTEX_HEADER, *FACE_HEADER) + PLY_3 + b"2 0 1\n",
        "BAD_FACE",
        "Face 0",
    ),
    "other format": ("a.fbx", b"Kaydara", "UNKNOWN_FORMAT", "OBJ, OFF, PLY, glTF, GLB or STL"),
    "compressed": ("a.obj.gz", gzip.compress(b"v 0 0 0\n"), "UNKNOWN_FORMAT", "compressed.*gunzip"),
    "other format, empty": ("a", b"", "UNKNOWN_FORMAT", "OBJ, OFF, PLY, glTF, GLB or STL"),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_files_are_refused_with_their_place(tmp_path: Path, name: str) -> None:
    file_name, data, code, place = MALFORMED[name]
    (tmp_path / file_name).write_bytes(data)
    with pytest.raises(InputError, match=place) as caught:
        read_mesh(tmp_path / file_name)
    assert caught.value.code == code
    assert caught.value.message.endswith((".", "!"))
    if code in ("INDEX_OUT_OF_RANGE", "BAD_FACE"):
        assert caught.value.elements.kind == "faces"
        assert len(caught.value.elements.indices) == 1


@pytest.mark.parametrize(
    ("faces", "code", "named"),
    [("f 1/1 2/2 3/1\nf 1/1 2/1 3/1\n", "INDEX_OUT_OF_RANGE", [0]), ("f 1/0 2/1 3/1\n", "INDEX_OUT_OF_RANGE", [0])],
)
def test_texture_indices_matter_only_where_they_are_asked_for(faces: str, code: str, named: list[int]) -> None:
    text = SQUARE_OBJ + "vt 0 0\n" + faces
    assert read_obj(text.encode(), False).corner_uv is None
    with pytest.raises(InputError) as caught:
        read_obj(text.encode(), with_uv=True)
    assert (caught.value.code, caught.value.elements.indices.tolist()) == (code, named)


@settings(max_examples=300, deadline=None)
@given(st.binary(max_size=200), st.sampled_from(["obj", "off", "ply"]))
def test_any_bytes_are_read_or_refused(data: bytes, kind: str) -> None:
    starts = {
        "obj": SQUARE_OBJ.encode() + b"f 1 2 3\n",
        "off": b"OFF 3 2 0\n",
        "ply": ply_header(BINARY, *VERTEX_HEADER, *FACE_HEADER),
    }
    readers = {"obj": lambda d: read_obj(d, True), "off": read_off, "ply": read_ply}
    try:
        readers[kind](starts[kind] + data)
    except InputError as error:
        assert error.code in ("MALFORMED_FILE", "INDEX_OUT_OF_RANGE", "BAD_FACE")


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("a06_edges_in_face_2gon", "BAD_FACE"),
        ("c_index_out_of_range", "INDEX_OUT_OF_RANGE"),
        ("c_negative_vertex_id", "INDEX_OUT_OF_RANGE"),
    ],
)
@pytest.mark.parametrize("kind", ["obj", "off", "ply"])
def test_bad_faces_of_the_shared_cases(shared: Path, tmp_path: Path, name: str, code: str, kind: str) -> None:
    case = json.loads((shared / "bad" / f"{name}.json").read_text())
    path = tmp_path / f"bad.{kind}"
    if kind == "ply":
        path.write_bytes(ply_bytes(case["V"], case["F"], PLY_FORMS[1]))
    elif kind == "off":
        path.write_text(off_text(case["V"], case["F"]))
    else:
        path.write_text(obj_text(case["V"], case["F"]))
    with pytest.raises(InputError) as caught:
        read_mesh(path)
    assert caught.value.code == code
    assert caught.value.elements.kind == "faces"
