# SPDX-License-Identifier: GPL-3.0-or-later
"""New texture coordinates in an OBJ file leave all else in it as it was, byte for byte."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsgp.io.mesh_obj import read_obj
from lsgp.io.mesh_obj_edit import edit_obj
from nightly import EVERYTHING
from polygon_meshes import cube, faces_of, obj_text
from systems import is_wine

ENDINGS = (b"\n", b"\r\n", b"\r")
# What an OBJ may have that tells nothing of texture coordinates; bytes beyond ASCII are of no known encoding.
OTHER_STATEMENTS = (
    b"",
    b"   ",
    b"\t# vt 1 2",
    b"# gr\xfc\xdfe \xff\x00 50 %d f 1/1 2/2 3/3",
    b"# C:\\",
    b"mtllib C:\\a b.mtl%s",
    b"o body \xe7\xab\x8b",
    b"g left arm",
    b"s 1",
    b"s off",
    b"usemtl stone#vt",
    b"vn 0 0 1",
    b"v 9 8 7 0.5 0.25 1.0",
    b" v 1e3 +2 -.5 # far",
    b"vp 0.5 0.5",
    b"l 1 2 3",
    b"l -1 -2 # vt",
    b"p 1",
    b"fog 1/2",
    b"vtx 1 2",
    b"v 1 \\",  # goes on in the next
    b"cstype bezier",
)
SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def square(text: bytes) -> bytes:
    return SQUARE + text


def numbered(count: int) -> np.ndarray:
    """Coordinates of corners that are all different and have no short decimals."""
    return np.arange(2.0 * count).reshape(-1, 2) / 7 + 100


def edited(data: bytes, unsolved: Iterable[int] = ()) -> tuple[bytes, np.ndarray]:
    """The text with new coordinates and those coordinates, NaN at the corners of the faces that are not solved."""
    mesh = read_obj(data, False)
    uv = numbered(len(mesh.corners))
    uv[np.isin(np.repeat(np.arange(len(mesh.sizes)), mesh.sizes), list(unsolved))] = np.nan
    return edit_obj(data, mesh, uv), uv


@pytest.mark.parametrize(
    ("faces", "expected"),
    [
        (b"f 1 2 3", b"f 1/1 2/2 3/3"),
        (b"f 1/9 2/8 3/7", b"f 1/1 2/2 3/3"),
        (b"f 1/ 2/ 3/", b"f 1/1 2/2 3/3"),
        (b"f 1//1 2//1 3//-1", b"f 1/1/1 2/2/1 3/3/-1"),
        (b"f 1/9/1 2/-1/1 3//1", b"f 1/1/1 2/2/1 3/3/1"),
        (b"f 1 2/1 3/1/1", b"f 1/1 2/2 3/3/1"),
        (b"fo -4 -3\t-2  ", b"fo -4/1 -3/2\t-2/3  "),
        (b" f 1 2 3 # 1/1", b" f 1/1 2/2 3/3 # 1/1"),
        (b"f 1 2 3#%d", b"f 1/1 2/2 3/3#%d"),
        (b"f \\\n1/2 2\\\n# 7/7\n\n 3/ \\\n", b"f \\\n1/1 2/2\\\n# 7/7\n\n 3/3 \\\n"),
        (b"f\\\n1 2 3", b"f\\\n1/1 2/2 3/3"),
        (b"f 1/%s 2/x 3/7/%d", b"f 1/1 2/2 3/3/%d"),
        (b"f 1/1/1/1 2 3", b"f 1/1/1/1 2/2 3/3"),
        (b"f\v1 2\f3", b"f\v1/1 2/2\f3/3"),
    ],
    ids=itertools.count(),
)
def test_corners_of_any_spelling_refer_to_the_new_coordinates(faces: bytes, expected: bytes) -> None:
    result, uv = edited(square(faces))
    lines = b"".join(b"vt %r %r\n" % (u, v) for u, v in uv.tolist())
    assert result == SQUARE + lines + expected


def test_new_coordinates_stand_where_the_first_old_ones_stood_or_above_the_first_face() -> None:
    lines = b"vt 100.0 100.14285714285714\nvt 100.28571428571429 100.42857142857143\n"
    lines += b"vt 100.57142857142857 100.71428571428571\n"
    assert edited(square(b"vt 1 2\nvn 0 0 1\nf 1 2 3\nvt 3\n"))[0] == square(lines + b"vn 0 0 1\nf 1/1 2/2 3/3\n")
    assert edited(square(b"s 1\r\nf 1 2 3\r\n"))[0] == square(b"s 1\r\n" + lines.replace(b"\n", b"\r\n")) + (
        b"f 1/1 2/2 3/3\r\n"
    )
    assert edited(b"\xef\xbb\xbff 1 2 3\n" + SQUARE)[0] == b"\xef\xbb\xbf" + lines + b"f 1/1 2/2 3/3\n" + SQUARE


def test_coordinates_on_several_lines_go_but_for_comments_between_them() -> None:
    result, _ = edited(square(b"vt 1 \\\n# kept\n  2 # of it\n\nf 1 2 3\n"))
    assert b"vt 1 " not in result
    assert b"# kept\n\nf 1/1" in result


def test_faces_without_new_coordinates_keep_theirs() -> None:
    old = b"vt .5 0.50 # a\nvt 0 0\nvt 1 1 9\nf 1/1/1 2/-1/1 3/1/1\nf 1/2 3 4/9\nf 1/2 2/2 3/2\n"
    result, _ = edited(square(old), unsolved=[0, 1])
    tail = b"vt .5 0.50 # a\nvt 0 0\nvt 1 1 9\nf 1/4/1 2/6/1 3/4/1\nf 1/5 3 4\nf 1/1 2/2 3/3\n"
    assert result.endswith(tail)
    assert result.count(b"vt") == 6


def test_coordinates_that_lines_refer_to_stay() -> None:
    result, _ = edited(square(b"vt 0 0\nvt 1 1\nl 1/2 2/-1\nl 1 2\nf 1/1 2/2 3/1\n"))
    assert result.endswith(b"vt 1 1\nl 1/4 2/4\nl 1 2\nf 1/1 2/2 3/3\n")
    assert b"vt 0 0" not in result


def test_nothing_solved_changes_nothing() -> None:
    data = square(b"vt 0 0\nvt 1 1\nf 1/1 2/2 3/1\nl 1/1 2/2\n")
    assert edited(data, unsolved=[0])[0] == data


# --- random files ---------------------------------------------------------------------------------------------------


@st.composite
def obj_files(draw: st.DrawFn) -> tuple[bytes, int]:
    """An OBJ text of any order, spelling and line ending, and how many faces it has."""
    ending = draw(st.sampled_from(ENDINGS))
    lines = [b"v %d %d 0" % (i, i * i) for i in range(4)]
    vertices, coordinates, faces = 4, 0, 0

    def reference(count: int) -> bytes:
        number = draw(st.integers(1, count))
        return b"%d" % (number if draw(st.booleans()) else number - count - 1)

    def corner(vertex: int) -> bytes:
        number = b"%d" % (vertex if draw(st.booleans()) else vertex - vertices - 1)
        texture = reference(coordinates) if coordinates and draw(st.booleans()) else b""
        form = draw(st.sampled_from([b"%s", b"%s/%s", b"%s/%s/%s", b"%s//%s"]))
        return form % (number, texture, b"-1")[: form.count(b"%s")] if form != b"%s//%s" else form % (number, b"1")

    def broken_up(text: bytes) -> bytes:
        kind = draw(st.integers(0, 9))
        if kind == 0:
            return text.replace(b" ", b" \\" + ending + b"\t")
        if kind == 1:
            return text.replace(b" ", b"\t ") + b"  # %d vt"
        if kind == 2:
            return b" " + text + b"\t"
        return text

    for _ in range(draw(st.integers(0, 25))):
        kind = draw(st.sampled_from(["other", "v", "vt", "f", "f", "f", "l"]))
        if kind == "other":
            lines.append(draw(st.sampled_from(OTHER_STATEMENTS)))
            vertices += lines[-1].split()[:1] == [b"v"] and not lines[-1].endswith(b"\\")
            if lines[-1].endswith(b"\\") and not lines[-1].startswith(b"#"):
                lines.append(b"2 3")
                vertices += 1
        elif kind == "v":
            lines.append(broken_up(b"v %r 1 2" % draw(st.floats(-9, 9))))
            vertices += 1
        elif kind == "vt":
            lines.append(broken_up(draw(st.sampled_from([b"vt 0.5 0.250", b"vt 1", b"vt .1 -2e-1 0", b"vt 7 7 7"]))))
            coordinates += 1
        elif kind == "l":
            lines.append(broken_up(b"l " + b" ".join(corner(v) for v in (1, 2, 3))))
        else:
            some = draw(st.lists(st.integers(1, vertices), min_size=3, max_size=6, unique=True))
            lines.append(broken_up(draw(st.sampled_from([b"f ", b"fo "])) + b" ".join(map(corner, some))))
            faces += 1
    end = ending if draw(st.booleans()) else b""
    mark = b"\xef\xbb\xbf" if draw(st.booleans()) else b""
    return mark + ending.join(lines) + end, faces


def statements(data: bytes) -> list[list[bytes]]:
    """The tokens of each statement, read in the plainest way."""
    found: list[list[bytes]] = []
    goes_on = False
    for line in data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n"):
        text = line.split(b"#")[0].rstrip()
        if not text:
            continue
        tokens = text.removesuffix(b"\\").split()
        if goes_on:
            found[-1] += tokens
        else:
            found.append(tokens)
        goes_on = text.endswith(b"\\")
    return found


def meaning(data: bytes) -> tuple[list, list, list]:
    """Statements without coordinates; the tokens of faces and lines without their references to coordinates; and the
    coordinates, as they are written, that each of these refers to."""
    others, corners, texture = [], [], []
    total = [tokens[1:] for tokens in statements(data) if tokens[0] == b"vt"]
    above = 0
    for keyword, *tokens in statements(data):
        if keyword == b"vt":
            above += 1
        elif keyword in (b"f", b"fo", b"l"):
            parts = [[*token.split(b"/"), b"", b""] for token in tokens]
            corners.append([keyword, *((part[0], part[2]) for part in parts)])
            numbers = [int(part[1]) if part[1] else None for part in parts]
            texture.append([None if n is None else total[n - 1 if n > 0 else above + n] for n in numbers])
        else:
            others.append([keyword, *tokens])
    return others, corners, texture


def other_lines(data: bytes) -> list[bytes]:
    """Lines, with their endings, on which no statement with references to coordinates begins or goes on."""
    kept, goes_on = [], False
    for line in data.removeprefix(b"\xef\xbb\xbf").splitlines(keepends=True):
        text = line.split(b"#")[0].rstrip()
        keyword = text.removesuffix(b"\\").split()[:1]
        if (goes_on and text) or keyword in ([b"vt"], [b"f"], [b"fo"], [b"l"]):
            goes_on = text.endswith(b"\\")
        else:
            kept.append(line)
    return kept


@pytest.mark.slow
@settings(max_examples=500 if EVERYTHING else 150, deadline=None)
@given(obj_files(), st.data())
def test_random_files_differ_in_nothing_but_texture_coordinates(made: tuple[bytes, int], data: st.DataObject) -> None:
    before, faces = made
    unsolved = data.draw(st.sets(st.integers(0, faces - 1))) if faces else set()
    after, uv = edited(before, unsolved)
    assert after[:3] == before[:3]
    (others, corners, texture), (new_others, new_corners, new_texture) = meaning(before), meaning(after)
    assert (new_others, new_corners) == (others, corners)
    assert other_lines(after) == other_lines(before)
    expected = iter([[b"%r" % u, b"%r" % v] for u, v in uv.tolist()])
    face = itertools.count()
    for statement, old, new in zip(corners, texture, new_texture, strict=True):
        if statement[0] == b"l":
            assert new == old
            continue
        wanted = [next(expected) for _ in new]
        assert new == (old if next(face) in unsolved else wanted)
    mesh, again = read_obj(before, False), read_obj(after, True)
    assert again.positions.tobytes() == mesh.positions.tobytes()
    assert faces_of(again) == faces_of(mesh)
    solved = ~np.isnan(uv)
    assert (again.corner_uv[solved] == uv[solved]).all()
    assert edit_obj(after, again, uv) == after


@pytest.mark.slow
@pytest.mark.skipif(is_wine(), reason="`re` grows its memory by realloc, which takes several times as long in Wine 8")
def test_100k_triangles_take_well_under_a_second() -> None:
    positions, faces = cube(92)
    halves = [half for a, b, c, d in faces for half in ([a, b, c], [a, c, d])]
    data = obj_text(positions, halves).encode() + b"vn 0 0 1\n"
    data = data.replace(b"\nf ", b"\nvt 0 0\nf ", 1)
    mesh = read_obj(data, False)
    uv = np.random.default_rng(0).random((len(positions), 2))[mesh.corners]
    begin = time.process_time()
    result = edit_obj(data, mesh, uv)
    assert time.process_time() - begin < 0.8
    assert len(halves) > 100_000
    assert (read_obj(result, True).corner_uv == uv).all()
