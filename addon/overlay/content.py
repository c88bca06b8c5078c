# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay shows of one mesh, as arrays in the mesh's own space."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import native
from ..core.identifiers import CONE_GROUP
from ..jobs.tasks.directions import UP
from ..mesh.angles import read_angles
from ..mesh.reader import reader
from ..mesh.texture_up import directions_in

if TYPE_CHECKING:
    from ..core.cone_angles import ConeAngles
    from ..jobs.sessions.cone_session import ConeSession
    from ..jobs.sessions.cut_session import CutSession
    from ..mesh.mesh_reader import MeshReader
    from ..mesh.reports import Report
    from ..mesh.texture_up import Directions

FloatArray = NDArray[np.float32]

CutSides = tuple[FloatArray, FloatArray]
"""Segments along both sides of a cut, (s, 2, 3), and the same in the layout, (s, 2, 2)."""

EdgeFaces = dict[tuple[int, int], list[int]]
"""The faces beside edges."""

# Distance of the two lines of a cut from it, one on each side, relative to its mean edge length; and at most, as they
# would float over large faces otherwise, relative to the diagonal of the box around all cuts.
SIDE_OFFSET, MOST_OFFSET = 0.12, 0.006

# Length of an arrow relative to the side of a square of its face's area, and of its head relative to the arrow.
ARROW, HEAD = 0.6, 0.3
# Faces on which the axes of the texture are drawn at most, and their length relative to such a side.
MOST_AXES, AXIS = 1000, 0.35

# The least angle, in radians, by which a map is told to miss a direction; less is shown as 0.
NOTICEABLE = math.radians(0.05)

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
    flipped, overlapping: (t, 3, 3) triangles. up_lines: (s, 2, 3) arrows along the directions drawn on faces, and
    along_lines: the same along marked edges. missed_places: (d, 3) the middles of those that the map misses noticeably,
    and missed_by: (d,) by how much, in radians. active: the vertex of the active cone, None for none. active_path: the
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
    up_lines: FloatArray = field(default_factory=lambda: np.empty((0, 2, 3), np.float32))
    along_lines: FloatArray = field(default_factory=lambda: np.empty((0, 2, 3), np.float32))
    missed_places: FloatArray = field(default_factory=lambda: np.empty((0, 3), np.float32))
    missed_by: list[float] = field(default_factory=list)
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
    drawn, edges = directions_in(mesh), _marked_edges(mesh)
    missed = _missed(report, mesh, drawn, edges)
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
        up_lines=_arrows(mesh, drawn),
        along_lines=_edge_arrows(obj, mesh, edges),
        missed_places=np.array([place for place, _ in missed], np.float32).reshape(-1, 3),
        missed_by=[error for _, error in missed],
    )


def with_directions(content: Content, mesh: MeshReader, directions: Directions) -> Content:
    """What to show of a mesh while directions are drawn on it."""
    nothing = Content()
    return replace(
        content,
        up_lines=_arrows(mesh, directions),
        missed_places=nothing.missed_places,
        missed_by=nothing.missed_by,
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
    most = _most_offset(session.mesh, session.paths)
    for path in session.paths:
        if path not in drawn:
            drawn[path] = _sides_of(session.mesh, list(path), most)
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
    most = _most_offset(mesh, paths)
    lines, uvs = zip(*(_sides_of(mesh, path, most) for path in paths), strict=True)
    numbers = np.repeat(np.arange(len(paths), dtype=np.int32), [len(segments) for segments in lines])
    return np.concatenate(lines), numbers, np.concatenate(uvs)


def _most_offset(mesh: MeshReader, paths: Iterable[Sequence[int]]) -> float:
    vertices = sorted({vertex for path in paths for vertex in path})
    return MOST_OFFSET * float(np.linalg.norm(np.ptp(mesh.positions(vertices), axis=0))) if vertices else 0.0


def _sides_of(mesh: MeshReader, path: list[int], most: float) -> CutSides:
    """Segments along both sides of a path, offset by so much at most into the adjacent faces, and their UVs."""
    lines, uvs = [], []
    places = mesh.positions(path)
    steps = np.diff(places, axis=0)
    offset = min(SIDE_OFFSET * np.linalg.norm(steps, axis=1).mean(), most)
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


def _arrows(mesh: MeshReader, directions: Directions) -> FloatArray:
    """(3k, 2, 3): a shaft and the two sides of a head over the middle of each face."""
    lines = []
    for face, up in directions.items():
        middle, normal, size = _frame(mesh, face)
        lines += _arrow(middle, ARROW * size * np.array(up, np.float32), normal)
    return np.array(lines, np.float32).reshape(-1, 2, 3)


def _marked_edges(mesh: MeshReader) -> EdgeFaces:
    edges: EdgeFaces = {}
    for first, last, face in mesh.along_sides().tolist():
        edges.setdefault((first, last), []).append(face)
    return edges


def _edge_arrows(obj: bpy.types.Object, mesh: MeshReader, edges: EdgeFaces) -> FloatArray:
    """(3k, 2, 3): as above, on each edge."""
    ends = mesh.positions([vertex for edge in edges for vertex in edge]).reshape(-1, 2, 3)
    in_world = (ends[:, 1] - ends[:, 0]) @ np.array(obj.matrix_world.to_3x3()).T
    is_upward = native.part("edge_directions").is_upward(in_world, np.array(UP)) if edges else []
    lines = []
    for (first, last), faces, upward in zip(ends, edges.values(), is_upward, strict=True):
        normal = np.sum([_frame(mesh, face)[1] for face in faces], axis=0)
        normal /= max(np.linalg.norm(normal), np.finfo(np.float32).tiny)
        lines += _arrow((first + last) / 2, ARROW * (last - first) * (1 if upward else -1), normal)
    return np.array(lines, np.float32).reshape(-1, 2, 3)


def _arrow(middle: FloatArray, shaft: FloatArray, normal: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """A shaft and the two sides of a head, across the normal."""
    across, tip = np.cross(normal, shaft), middle + shaft / 2
    heads = [(tip, tip - HEAD * shaft + side * HEAD * across) for side in (0.6, -0.6)]
    return [(middle - shaft / 2, tip), *heads]


def texture_axes(mesh: MeshReader) -> tuple[FloatArray, FloatArray]:
    """(k, 2, 3) each: from the middle of faces, spread evenly over their numbers, the way u and the way v increases;
    their lengths are in the ratio of the derivatives. None for faces without area in the UV map."""
    count = mesh.size()[2]
    axes = []
    for face in range(0, count, max(-(-count // MOST_AXES), 1)):
        vertices, uv = mesh.corners([face])
        if not len(uv):
            break
        corners = mesh.positions(vertices)
        # The linear map from texture to surface that fits the corners best.
        found, _, rank, _ = np.linalg.lstsq(uv - uv.mean(axis=0), corners - corners.mean(axis=0), rcond=None)
        if rank == 2:
            middle, _, size = _frame(mesh, face)
            axes.append([(middle, middle + way) for way in found * (AXIS * size / np.linalg.norm(found, axis=1).max())])
    u, v = np.array(axes, np.float32).reshape(-1, 2, 2, 3).swapaxes(0, 1)
    return u, v


def _missed(
    report: Report | None, mesh: MeshReader, drawn: Directions, edges: EdgeFaces
) -> list[tuple[FloatArray, float]]:
    """The middles of faces that are still drawn on, and of edges that are still marked, and by how much the map misses
    them."""
    if report is None:
        return []
    errors = dict(zip(report.drawn, report.drawn_errors, strict=True))
    missed = [(_frame(mesh, face)[0], errors[face]) for face in errors if face in drawn and errors[face] > NOTICEABLE]
    for edge, faces in edges.items():
        error = max((errors[face] for face in faces if face in errors and face not in drawn), default=0.0)
        if error > NOTICEABLE:
            missed.append((mesh.positions(edge).mean(axis=0), error))
    return missed


def _frame(mesh: MeshReader, face: int) -> tuple[FloatArray, FloatArray, float]:
    """The middle of a face, its normal, and the side of a square of its area."""
    corners = _triangles(mesh, [face])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    areas = np.linalg.norm(normals, axis=1)
    whole = max(areas.sum(), np.finfo(np.float32).tiny)
    middle = areas @ corners.mean(axis=1) / whole
    return middle, normals.sum(axis=0) / whole, float(np.sqrt(whole))


def _triangles(mesh: MeshReader, faces: list[int]) -> FloatArray:
    vertices = np.array(mesh.triangles(faces), int).reshape(-1)
    return mesh.positions(vertices.tolist()).reshape(-1, 3, 3)
