# SPDX-License-Identifier: GPL-3.0-or-later
"""STL, text and binary, through trimesh: triangles without vertices in common, which are joined where they touch."""

from __future__ import annotations

import io

import numpy as np

from .mesh_text import malformed
from .polygons import PolygonMesh
from .welding import weld


def read_stl(data: bytes) -> PolygonMesh:
    """The triangles of an STL file; corners at exactly the same place are one vertex.

    Raises InputError: MALFORMED_FILE.  Takes trimesh.
    """
    import trimesh

    try:
        mesh = trimesh.load(io.BytesIO(data), file_type="stl", force="mesh", process=False)
        corners = np.asarray(mesh.triangles, np.float64).reshape(-1, 3)
    except Exception as error:  # a reader's own errors are of many kinds
        raise malformed(f"no STL: {' '.join(str(error).split()) or type(error).__name__}.") from error
    if not len(corners):
        raise malformed("no STL, or one without triangles.")
    positions, index = weld(corners)
    return PolygonMesh(positions, index.astype(np.int32), np.full(len(corners) // 3, 3, np.int64))
