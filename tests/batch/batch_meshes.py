# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of generated surfaces for the tests of batches."""

from __future__ import annotations

from meshes import Mesh


def off_text(mesh: Mesh) -> str:
    lines = ["OFF", f"{len(mesh.positions)} {len(mesh.triangles)} 0"]
    lines += [" ".join(map(repr, position)) for position in mesh.positions.tolist()]
    lines += [" ".join(map(str, [3, *triangle])) for triangle in mesh.triangles.tolist()]
    return "\n".join(lines) + "\n"


def obj_text(mesh: Mesh) -> str:
    lines = [" ".join(["v", *map(repr, position)]) for position in mesh.positions.tolist()]
    lines += [" ".join(["f", *(str(vertex + 1) for vertex in triangle)]) for triangle in mesh.triangles.tolist()]
    return "\n".join(lines) + "\n"
