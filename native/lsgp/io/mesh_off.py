# SPDX-License-Identifier: GPL-3.0-or-later
"""Object File Format (Geomview) as text: vertices and polygons; what else a vertex or face has is passed over."""

from __future__ import annotations

import re

import numpy as np

from .mesh_text import Rows, malformed, quoted, ranges
from .polygons import PolygonMesh, require_polygons

HEADER = re.compile(rb"(ST)?C?N?(4?)(n?)OFF$")


def read_off(data: bytes) -> PolygonMesh:
    """Polygons of an OFF, COFF, NOFF or STOFF file, with its counts on the header's line or the next.

    Raises InputError: MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE.
    """
    rows = Rows.split(data)
    vertex_count, face_count, begin = _read_counts(rows)
    for what, first, count in (("vertices", begin, vertex_count), ("faces", begin + vertex_count, face_count)):
        if len(rows.lines) < first + count:
            raise malformed(f"the file ends after {len(rows.lines) - first} of {count} {what}.")
    middle, end = begin + vertex_count, begin + vertex_count + face_count

    vertices = rows.select(slice(begin, middle))
    vertices.require_tokens(3, "a vertex with {} coordinates instead of 3.")
    positions = vertices.floats((vertices.starts[:, None] + np.arange(3)).ravel()).reshape(-1, 3)

    faces = rows.select(slice(middle, end))
    sizes = faces.integers(faces.starts)
    wrong = np.flatnonzero((sizes < 0) | (sizes >= faces.counts))
    if len(wrong):
        row = wrong[0]
        raise malformed(
            f"a face of {sizes[row]} corners that names {faces.counts[row] - 1} vertices.", int(faces.lines[row])
        )
    corners = faces.integers(ranges(faces.starts + 1, sizes))
    require_polygons(vertex_count, corners, sizes, lambda face: f" (line {faces.lines[face]})")
    extras = _extras(rows.token(0)) if vertex_count else ()
    if (faces.counts > sizes + 1).any():
        extras += ("face colors",)
    return PolygonMesh(positions, corners.astype(np.int32), sizes, extras=extras)


def _extras(keyword: bytes) -> tuple[str, ...]:
    """The data of vertices besides their position, according to the header."""
    header = HEADER.match(keyword)[0]
    letters = {b"ST": "texture coordinates", b"C": "vertex colors", b"N": "normals"}
    return tuple(name for letter, name in letters.items() if letter in header)


def _read_counts(rows: Rows) -> tuple[int, int, int]:
    """The numbers of vertices and faces, and the first row after them."""
    if not len(rows.lines):
        raise malformed("the file is empty.")
    keyword = rows.token(0)
    header = HEADER.match(keyword)
    if header is None:
        raise malformed(f"{quoted(keyword)} is not the header of an OFF file.", int(rows.lines[0]))
    if header[2] or header[3]:
        raise malformed("vertices with other than three dimensions cannot be unwrapped.", int(rows.lines[0]))
    has_more = rows.counts[0] > 1
    if has_more and rows.token(1).startswith(b"BINARY"):
        raise malformed("binary OFF is not read; use text.", int(rows.lines[0]))
    row = 0 if has_more else 1
    if len(rows.lines) == row:
        raise malformed("the file ends before its counts.")
    counts = rows.select(slice(row, row + 1))
    if has_more:
        counts = counts.without_first()
    counts.require_tokens(2, "counts of vertices and faces are needed.")
    vertex_count, face_count = counts.integers(counts.tokens()[:2]).tolist()
    if vertex_count < 0 or face_count < 0:
        raise malformed(f"{vertex_count} vertices and {face_count} faces are not valid counts.", int(rows.lines[row]))
    return vertex_count, face_count, row + 1
