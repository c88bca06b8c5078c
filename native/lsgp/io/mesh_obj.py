# SPDX-License-Identifier: GPL-3.0-or-later
"""Wavefront OBJ: vertices, polygons and texture coordinates; all other statements are passed over."""

from __future__ import annotations

import os
import re

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..base.counted import counted
from ..errors import Elements, InputError
from ..indexed_uv import index_corners
from .mesh_text import Rows, malformed, quoted
from .polygons import PolygonMesh, require_polygons

MATERIALS = b"mtllib"
LINE_END = re.compile(rb"[\r\n]")
FACES = (b"f", b"fo")  # now and formerly
READ = (b"v", b"vt", *FACES)


def read_obj(data: bytes, with_uv: bool) -> PolygonMesh:
    """Polygons of an OBJ file; objects and groups together are one mesh, points, lines and curves are not read.

    with_uv: read the texture coordinates of the corners too; otherwise they are not checked at all.
    Raises InputError: MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE.
    """
    vertices, texture, faces, extras = _statements(data)
    vertices.require_tokens(3, "a vertex with {} coordinates instead of 3.")
    positions = vertices.floats((vertices.starts[:, None] + np.arange(3)).ravel()).reshape(-1, 3)

    heads = faces.parts(0)  # each corner is v, v/vt, v//vn or v/vt/vn
    indices = heads.integers(heads.tokens())
    corners = _from_zero(indices, faces, vertices)
    require_polygons(len(positions), corners, faces.counts, lambda face: f" (line {faces.lines[face]})")
    corner_uv = _corner_uv(texture, faces) if with_uv else None
    extras += ("vertex colors",) if (vertices.counts >= 6).any() else ()
    return PolygonMesh(positions, corners.astype(np.int32), faces.counts, corner_uv, extras, _material_files(data))


def _material_files(data: bytes) -> tuple[str, ...]:
    """The names in mtllib statements: each may be several, or one with spaces."""
    found: list[str] = []
    at = data.find(MATERIALS)
    while at >= 0:
        end = LINE_END.search(data, at)
        rest = data[at + len(MATERIALS) : end.start() if end else len(data)]
        found += map(os.fsdecode, dict.fromkeys([rest.strip(), *rest.split()]))
        at = data.find(MATERIALS, at + len(MATERIALS) + len(rest))
    return tuple(found)


def format_obj(mesh: PolygonMesh, corner_uv: NDArray[np.float64]) -> bytes:
    """OBJ text of the mesh: its vertices, their order and its polygons, with texture coordinates (c, 2) per corner.

    Corners of one vertex with the same coordinates share one vt. A polygon with a NaN at a corner is written without
    vt. Numbers are the shortest text that reads back as the same double.
    """
    vt, index, mapped = index_polygon_corners(mesh, corner_uv)
    vertices = mesh.corners.astype(np.int64) + 1
    return b"".join(
        [
            _lsgp.format_rows(b"v", mesh.positions, b"\n"),
            _lsgp.format_rows(b"vt", vt, b"\n"),
            _lsgp.format_faces(mesh.sizes, mapped, vertices, index + 1),
        ]
    )


def index_polygon_corners(
    mesh: PolygonMesh, corner_uv: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_]]:
    """The coordinates (k, 2), each once for a vertex, the index into them of each corner (c,), -1 for none, and which
    polygons have them, (f,): those without a NaN at a corner."""
    missing = np.isnan(corner_uv).any(axis=1)
    polygon = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    mapped = np.bincount(polygon[missing], minlength=len(mesh.sizes)) == 0
    if mapped.all():
        return *index_corners(mesh.corners, corner_uv), mapped
    has_uv = mapped[polygon]
    vt, found = index_corners(mesh.corners[has_uv], corner_uv[has_uv])
    index = np.full(len(corner_uv), -1, np.int64)
    index[has_uv] = found
    return vt, index, mapped


def _statements(data: bytes) -> tuple[Rows, Rows, Rows, tuple[str, ...]]:
    """The v, vt and f statements without their keywords, and the keywords of all others."""
    rows = Rows.split(data, continued=True)
    rows = rows.select(rows.counts > 0)  # some are nothing but the mark of a continued line
    keywords, kind = rows.keywords()
    others = [keyword for keyword in keywords if keyword not in READ]
    for keyword in others:
        if not keyword[:1].isalpha():
            line = int(rows.lines[np.argmax(kind == keywords.index(keyword))])
            raise malformed(f"{quoted(keyword)} does not begin a statement of an OBJ file.", line)

    def statements(*names: bytes) -> Rows:
        chosen = np.isin(kind, [place for place, keyword in enumerate(keywords) if keyword in names])
        return rows.select(chosen).without_first()

    extras = tuple(quoted(keyword)[1:-1] for keyword in sorted(others))
    return statements(b"v"), statements(b"vt"), statements(*FACES), extras


def _from_zero(indices: NDArray[np.int64], faces: Rows, defined: Rows) -> NDArray[np.int64]:
    """Indices as files count them (from 1, or backwards from -1, the last one defined above the face) from 0."""
    if (indices > 0).all():
        return indices - 1
    above = np.searchsorted(defined.lines, faces.lines)
    return np.where(indices < 0, np.repeat(above, faces.counts) + indices, indices - 1)


def _corner_uv(texture: Rows, faces: Rows) -> NDArray[np.float64]:
    """(c, 2) texture coordinates of the corners, NaN where a corner has none."""
    texture.require_tokens(1, "a texture vertex without coordinates.")
    uv = np.zeros((len(texture.counts), 2))
    uv[:, 0] = texture.floats(texture.starts)
    two = texture.counts > 1  # one coordinate alone is u
    uv[two, 1] = texture.floats(texture.starts[two] + 1)

    names = faces.parts(1)
    present = np.flatnonzero(names.begins < names.ends)
    indices = np.zeros(len(names.begins), np.int64)
    indices[present] = names.integers(present)
    indices = _from_zero(indices, faces, texture)[present]
    outside = (indices < 0) | (indices >= len(uv))
    if outside.any():
        wrong = np.unique(np.repeat(np.arange(len(faces.counts)), faces.counts)[present[outside]])
        raise InputError(
            "INDEX_OUT_OF_RANGE",
            f"{counted(len(wrong), 'face names', 'faces name')} texture coordinates (vt) that are not among the "
            f"{len(uv)} of the file; the first "
            f"is face {wrong[0]} (line {faces.lines[wrong[0]]}). Export the mesh again.",
            Elements("faces", wrong.astype(np.int32)),
        )
    corner_uv = np.full((len(names.begins), 2), np.nan)
    corner_uv[present] = uv[indices]
    return corner_uv
