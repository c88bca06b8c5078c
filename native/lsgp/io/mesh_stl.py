# SPDX-License-Identifier: GPL-3.0-or-later
"""STL, text and binary: triangles without vertices in common, which are joined where they touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .mesh_text import Rows, malformed
from .polygons import PolygonMesh
from .welding import weld

# A binary file: a text of any kind, the number of triangles, and these.
TEXT_LENGTH, COUNT = 80, np.dtype("<u4")
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
BEGIN = TEXT_LENGTH + COUNT.itemsize
LOOP, VERTEX = b"outer", b"vertex"


def read_stl(data: bytes) -> PolygonMesh:
    """The triangles of an STL file, in text those of all its solids; corners at exactly the same place are one vertex.

    Raises InputError: MALFORMED_FILE.
    """
    is_text = data.lstrip()[:5].lower() == b"solid" and len(data) != _binary_length(data)
    corners = _read_text(data) if is_text else _read_binary(data)
    if not len(corners):
        raise malformed("an STL file without triangles.")
    positions, index = weld(corners)
    return PolygonMesh(positions, index.astype(np.int32), np.full(len(corners) // 3, 3, np.int64))


def _binary_length(data: bytes) -> int:
    """The length of the file if it is binary, which is how both kinds are told apart: some binary ones begin with the
    word of text."""
    if len(data) < BEGIN:
        return BEGIN
    return BEGIN + TRIANGLE.itemsize * int(np.frombuffer(data, COUNT, 1, TEXT_LENGTH)[0])


def _read_binary(data: bytes) -> NDArray[np.float64]:
    length = _binary_length(data)
    if len(data) < length:
        count = (length - BEGIN) // TRIANGLE.itemsize
        raise malformed(
            f"no text that begins with 'solid', and {len(data)} bytes where {count} triangles take {length}."
        )
    triangles = np.frombuffer(data[:length], TRIANGLE, offset=BEGIN)
    with np.errstate(invalid="ignore"):  # a NaN of any kind
        return triangles["corners"].astype(np.float64).reshape(-1, 3)


def _read_text(data: bytes) -> NDArray[np.float64]:
    """Every statement on a line of its own; others than loops and their vertices are passed over."""
    rows = Rows.split(data, comments=False)
    keywords, kind = rows.keywords()
    lower = [keyword.lower() for keyword in keywords]
    is_loop, is_vertex = (
        np.isin(kind, [place for place, keyword in enumerate(lower) if keyword == name]) for name in (LOOP, VERTEX)
    )
    loops = np.flatnonzero(is_loop)
    sizes = np.bincount(np.cumsum(is_loop)[is_vertex], minlength=len(loops) + 1)
    if sizes[0]:
        raise malformed("a vertex outside of a loop.", int(rows.lines[np.argmax(is_vertex)]))
    wrong = np.flatnonzero(sizes[1:] != 3)
    if len(wrong):
        raise malformed(f"a loop of {sizes[1 + wrong[0]]} vertices instead of 3.", int(rows.lines[loops[wrong[0]]]))
    vertices = rows.select(is_vertex).without_first()
    vertices.require_tokens(3, "a vertex with {} coordinates instead of 3.")
    return vertices.floats((vertices.starts[:, None] + np.arange(3)).ravel()).reshape(-1, 3)
