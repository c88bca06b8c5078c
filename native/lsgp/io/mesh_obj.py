# SPDX-License-Identifier: GPL-3.0-or-later
"""Wavefront OBJ: vertices, polygons and texture coordinates; all other statements are passed over."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..errors import Elements, InputError
from ..indexed_uv import index_corners
from .mesh_text import Rows, content_lines, malformed, quoted
from .polygons import PolygonMesh, require_polygons


def read_obj(data: bytes, with_uv: bool) -> PolygonMesh:
    """Polygons of an OBJ file; objects and groups together are one mesh, points, lines and curves are not read.

    with_uv: read the texture coordinates of the corners too; otherwise they are not checked at all.
    Raises InputError: MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE.
    """
    vertices, texture, faces, extras = _statements(data)
    vertices.require_tokens(3, "a vertex with {} coordinates instead of 3.")
    positions = vertices.floats((vertices.starts[:, None] + np.arange(3)).ravel()).reshape(-1, 3)

    # Each corner is v, v/vt, v//vn or v/vt/vn.
    heads = faces
    if b"/" in data:
        heads = Rows([token.partition(b"/")[0] for token in faces.tokens], faces.counts, faces.lines)
    indices = heads.integers(np.arange(len(heads.tokens)))
    corners = _from_zero(indices, faces, vertices)
    require_polygons(len(positions), corners, faces.counts, lambda face: f" (line {faces.lines[face]})")
    corner_uv = _corner_uv(texture, faces) if with_uv else None
    extras += ("vertex colours",) if (vertices.counts >= 6).any() else ()
    return PolygonMesh(positions, corners.astype(np.int32), faces.counts, corner_uv, extras)


def format_obj(mesh: PolygonMesh, corner_uv: NDArray[np.float64]) -> bytes:
    """OBJ text of the mesh: its vertices, their order and its polygons, with texture coordinates (c, 2) per corner.

    Corners of one vertex with the same coordinates share one vt. A polygon with a NaN at a corner is written without
    vt. Numbers are the shortest text that reads back as the same double.
    """
    vt, index, mapped = index_polygon_corners(mesh, corner_uv)
    text = [
        "v %r %r %r\n" * len(mesh.positions) % tuple(mesh.positions.ravel().tolist()),
        "vt %r %r\n" * len(vt) % tuple(vt.ravel().tolist()),
        *_face_lines(mesh, mapped, index + 1),
    ]
    return "".join(text).encode("ascii")


def index_polygon_corners(
    mesh: PolygonMesh, corner_uv: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_]]:
    """The coordinates (k, 2), each once for a vertex, the index into them of each corner (c,), -1 for none, and which
    polygons have them, (f,): those without a NaN at a corner."""
    missing = np.isnan(corner_uv).any(axis=1)
    polygon = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    mapped = np.bincount(polygon[missing], minlength=len(mesh.sizes)) == 0
    has_uv = mapped[polygon]
    vt, found = index_corners(mesh.corners[has_uv], corner_uv[has_uv])
    index = np.full(len(corner_uv), -1, np.int64)
    index[has_uv] = found
    return vt, index, mapped


def _face_lines(mesh: PolygonMesh, mapped: NDArray[np.bool_], vt: NDArray[np.int64]) -> list[str]:
    """One line a polygon, in order; runs of polygons that look alike are formatted together."""
    numbers = np.stack([mesh.corners.astype(np.int64) + 1, vt], axis=1).ravel().tolist()
    kind = mesh.sizes * 2 + mapped
    bounds = np.flatnonzero(np.diff(kind, prepend=-1, append=-1)).tolist()
    starts = np.append(mesh.starts, len(mesh.corners)).tolist()
    lines = []
    for begin, end in pairwise(bounds):
        corner, step = (" %d/%d", 1) if mapped[begin] else (" %d", 2)
        line = "f" + corner * int(mesh.sizes[begin]) + "\n"
        lines.append(line * (end - begin) % tuple(numbers[2 * starts[begin] : 2 * starts[end] : step]))
    return lines


def _statements(data: bytes) -> tuple[Rows, Rows, Rows, tuple[str, ...]]:
    """The v, vt and f statements without their keywords, and the keywords of all others."""
    texts, numbers = content_lines(data)
    if b"\\" in data:
        texts, numbers = _joined(texts, numbers)
    found: dict[bytes, tuple[list[bytes], list[int]]] = {b"v": ([], []), b"vt": ([], []), b"f": ([], [])}
    found[b"fo"] = found[b"f"]  # the old name of the statement
    others: set[bytes] = set()
    for text, number in zip(texts, numbers, strict=True):
        keyword, *rest = text.split(None, 1) or [b""]
        if not keyword:
            continue  # nothing but the mark of a continued line
        if keyword in found:
            lines = found[keyword]
            lines[0].append(rest[0] if rest else b"")
            lines[1].append(number)
        elif not keyword[:1].isalpha():
            raise malformed(f"{quoted(keyword)} does not begin a statement of an OBJ file.", number)
        else:
            others.add(keyword)
    extras = tuple(quoted(keyword)[1:-1] for keyword in sorted(others))
    return Rows.split(*found[b"v"]), Rows.split(*found[b"vt"]), Rows.split(*found[b"f"]), extras


def _joined(texts: list[bytes], numbers: list[int]) -> tuple[list[bytes], list[int]]:
    """Lines that end in a backslash joined with the next; the joined line has the number of its first."""
    joined: list[bytes] = []
    first: list[int] = []
    continued = False
    for text, number in zip(texts, numbers, strict=True):
        text = text.rstrip()
        ends_open = text.endswith(b"\\")
        text = text.removesuffix(b"\\")
        if continued:
            joined[-1] += b" " + text
        elif text:
            joined.append(text)
            first.append(number)
        continued = ends_open and (continued or bool(text))
    return joined, first


def _from_zero(indices: NDArray[np.int64], faces: Rows, defined: Rows) -> NDArray[np.int64]:
    """Indices as files count them (from 1, or backwards from -1, the last one defined above the face) from 0."""
    above = np.searchsorted(defined.lines, faces.lines)
    return np.where(indices < 0, np.repeat(above, faces.counts) + indices, indices - 1)


def _corner_uv(texture: Rows, faces: Rows) -> NDArray[np.float64]:
    """(c, 2) texture coordinates of the corners, NaN where a corner has none."""
    texture.require_tokens(1, "a texture vertex without coordinates.")
    uv = np.zeros((len(texture.counts), 2))
    uv[:, 0] = texture.floats(texture.starts)
    two = texture.counts > 1  # one coordinate alone is u
    uv[two, 1] = texture.floats(texture.starts[two] + 1)

    parts = [token.split(b"/", 2) for token in faces.tokens]
    names = Rows([part[1] if len(part) > 1 else b"" for part in parts], faces.counts, faces.lines)
    present = np.flatnonzero(np.fromiter(map(len, names.tokens), np.int64, len(names.tokens)))
    indices = np.zeros(len(names.tokens), np.int64)
    indices[present] = names.integers(present)
    indices = _from_zero(indices, faces, texture)[present]
    outside = (indices < 0) | (indices >= len(uv))
    if outside.any():
        wrong = np.unique(np.repeat(np.arange(len(faces.counts)), faces.counts)[present[outside]])
        raise InputError(
            "INDEX_OUT_OF_RANGE",
            f"{len(wrong)} faces name texture coordinates (vt) that are not among the {len(uv)} of the file; the first "
            f"is face {wrong[0]} (line {faces.lines[wrong[0]]}). Export the mesh again.",
            Elements("faces", wrong.astype(np.int32)),
        )
    corner_uv = np.full((len(names.tokens), 2), np.nan)
    corner_uv[present] = uv[indices]
    return corner_uv
