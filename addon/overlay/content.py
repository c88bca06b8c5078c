# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay shows of one mesh, as arrays in the mesh's own space."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.identifiers import CONE_GROUP
from ..mesh.angles import read_angles
from ..mesh.reader import reader

if TYPE_CHECKING:
    from ..core.cone_angles import ConeAngles
    from ..jobs.sessions.cone_session import ConeSession
    from ..jobs.sessions.cut_session import CutSession
    from ..mesh.mesh_reader import MeshReader
    from ..mesh.reports import Report

FloatArray = NDArray[np.float32]

CutSides = tuple[FloatArray, FloatArray]
"""Segments along both sides of a cut, (s, 2, 3), and the same in the layout, (s, 2, 2)."""

# Distance of the two lines of a cut from it, one on each side, relative to its mean edge length.
SIDE_OFFSET = 0.12

# Of the lines of the active cut, relative to others.
ACTIVE_WIDTH = 2.0


@dataclass(frozen=True, slots=True)
class Cone:
    """A marked or imposed cone.

    angle: radians, None where unwrapping chooses it. curvature: by how much it is less than a full turn, on a border
    less than half a turn; None where the angle is.
    """

    vertex: int
    angle: float | None
    curvature: float | None


@dataclass(frozen=True, slots=True)
class Content:
    """cone_places: (k, 3) positions of the cones. cone_uv: (c, 2) all their places in the layout, and cone_rows: (c,)
    which of the cones each is of. cut_lines: (s, 2, 3) segments along both sides of every cut, and cut_paths: (s,) the
    number of the path that each belongs to. cut_uv: (s, 2, 2) the same segments in the layout.
    kinds: of each path one of `cut_kinds`; empty where they are not known.
    flipped, overlapping: (t, 3, 3) triangles. active: the vertex of the active cone, None for none. active_path: the
    number of the path that is drawn wider, None for none.
    """

    cones: list[Cone] = field(default_factory=list)
    cone_places: FloatArray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    cone_uv: FloatArray = field(default_factory=lambda: np.empty((0, 2), np.float32))
    cone_rows: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))
    cut_lines: FloatArray = field(default_factory=lambda: np.empty((0, 2, 3), np.float32))
    cut_paths: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, np.int32))
    cut_uv: FloatArray = field(default_factory=lambda: np.empty((0, 2, 2), np.float32))
    flipped: FloatArray = field(default_factory=lambda: np.empty((0, 3, 3), np.float32))
    overlapping: FloatArray = field(default_factory=lambda: np.empty((0, 3, 3), np.float32))
    active: int | None = None
    active_path: int | None = None
    kinds: list[str] = field(default_factory=list)

    def cut_widths(self) -> Iterator[tuple[str, NDArray[np.bool_], float]]:
        """The segments drawn with one width: a name, (s,) which they are, and the width relative to the usual one."""
        active = self.cut_paths == self.active_path
        for name, rows, size in (("cuts", ~active, 1.0), ("active cut", active, ACTIVE_WIDTH)):
            if rows.any():
                yield name, rows, size


def build_content(
    obj: bpy.types.Object,
    report: Report | None,
    mesh: MeshReader | None = None,
    marked: ConeAngles | None = None,
) -> Content:
    """What to show of the object's mesh.  report: the current one, if any.

    mesh: its reader; by default one for its mode. marked: cones and angles that are not stored yet; by default those
    that are.
    """
    mesh = reader(obj.data) if mesh is None else mesh
    found = find_cones(obj, report, mesh, marked)
    vertices = [cone.vertex for cone in found]
    cone_rows, cone_uv = mesh.vertex_uv(vertices)
    lines, numbers, uv = _cut_sides(mesh, [] if report is None else report.paths)
    return Content(
        cones=found,
        cone_places=mesh.positions(vertices),
        cone_uv=cone_uv,
        cone_rows=cone_rows,
        cut_lines=lines,
        cut_paths=numbers,
        cut_uv=uv,
        kinds=[] if report is None else report.kinds,
        flipped=_triangles(mesh, [] if report is None else report.flipped),
        overlapping=_triangles(mesh, [] if report is None else report.overlapping),
    )


def session_content(obj: bpy.types.Object, session: ConeSession) -> Content:
    """What to show of a mesh while its cones are edited."""
    content = build_content(obj, session.report(), session.mesh, session.cones.current())
    return replace(content, active=session.cones.active)


def cuts_content(
    obj: bpy.types.Object, session: CutSession, drawn: dict[tuple[int, ...], CutSides] | None = None
) -> Content:
    """What to show of a mesh while its cuts are edited.

    drawn: the sides of cuts by their vertices, which stay the same while others move; receives those that are not there
    yet.
    """
    report = session.report()
    drawn = {} if drawn is None else drawn
    for path in session.paths:
        if path not in drawn:
            drawn[path] = _sides_of(session.mesh, list(path))
    sides = [drawn[path] for path in session.paths]
    without = None if report is None else replace(report, paths=[])
    return replace(
        build_content(obj, without, session.mesh, session.cones),
        cut_lines=np.concatenate([lines for lines, _ in sides]),
        cut_uv=np.concatenate([uv for _, uv in sides]),
        cut_paths=np.repeat(np.arange(len(sides), dtype=np.int32), [len(lines) for lines, _ in sides]),
        active_path=session.active,
        kinds=session.kinds(),
    )


def find_cones(
    obj: bpy.types.Object,
    report: Report | None,
    mesh: MeshReader | None = None,
    marked: ConeAngles | None = None,
) -> list[Cone]:
    """The marked cones and those of the report, by vertex; an imposed angle takes precedence over a prescribed one."""
    mesh = reader(obj.data) if mesh is None else mesh
    marked = read_angles(obj, CONE_GROUP) if marked is None else marked
    angles = dict(zip(marked.cones.tolist(), marked.angles, strict=True))
    if report is not None:
        angles |= dict(zip(report.cones, report.cone_angles, strict=True))
    vertices = sorted(angles)
    full = [math.pi if border else 2 * math.pi for border in mesh.on_border(vertices)]
    return [
        Cone(v, angles[v], None if angles[v] is None else turn - angles[v])
        for v, turn in zip(vertices, full, strict=True)
    ]


def _cut_sides(mesh: MeshReader, paths: list[list[int]]) -> tuple[FloatArray, NDArray[np.int32], FloatArray]:
    """Segments along both sides of every path; their paths; and their UVs."""
    if not paths:
        return np.empty((0, 2, 3), np.float32), np.empty(0, np.int32), np.empty((0, 2, 2), np.float32)
    lines, uvs = zip(*(_sides_of(mesh, path) for path in paths), strict=True)
    numbers = np.repeat(np.arange(len(paths), dtype=np.int32), [len(segments) for segments in lines])
    return np.concatenate(lines), numbers, np.concatenate(uvs)


def _sides_of(mesh: MeshReader, path: list[int]) -> CutSides:
    """Segments along both sides of a path, offset into the adjacent faces, and their UVs."""
    lines, uvs = [], []
    places = mesh.positions(path)
    steps = np.diff(places, axis=0)
    offset = SIDE_OFFSET * np.linalg.norm(steps, axis=1).mean()
    for side in (1, -1):
        pairs = [pair[::side] for pair in pairwise(path)]
        inward = _unit(np.cross(mesh.side_normals(pairs), side * steps))
        uv = mesh.side_uv(pairs)[:, ::side]
        moved = places + offset * _along_path(inward, closed=path[0] == path[-1])
        present = ~np.isnan(inward).any(axis=1)
        lines.append(np.stack([moved[:-1], moved[1:]], axis=1)[present])
        uvs.append(uv[present])
    return np.concatenate(lines).astype(np.float32), np.concatenate(uvs)


def _along_path(inward: FloatArray, *, closed: bool) -> FloatArray:
    """(k + 1, 3) directions at the vertices of a path: means of the (k, 3) directions of the edges that meet there."""
    inward = np.nan_to_num(inward)
    before, after = np.vstack([inward[:1], inward]), np.vstack([inward, inward[-1:]])
    if closed:
        before[0], after[-1] = inward[-1], inward[0]
    return np.nan_to_num(_unit(before + after))


def _unit(vectors: FloatArray) -> FloatArray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _triangles(mesh: MeshReader, faces: list[int]) -> FloatArray:
    vertices = np.array(mesh.triangles(faces), int).reshape(-1)
    return mesh.positions(vertices.tolist()).reshape(-1, 3, 3)
