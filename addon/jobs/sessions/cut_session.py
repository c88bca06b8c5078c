# SPDX-License-Identifier: GPL-3.0-or-later
"""The cuts of one mesh while they are moved by hand.

No map is computed: a piece of the layout moves rigidly from one side of a cut to the other.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import cut_kinds, native
from ...core.errors import Refused
from ...core.identifiers import CONE_GROUP
from ...mesh import reports
from ...mesh.reader import readable_mesh
from ...mesh.region_read import Faces, Groups, build_region, require_editable, require_uv_map
from ...mesh.stored_mesh import FrozenMesh
from ..tasks.cuts import CutChoice, with_cut_costs
from .map_session import MapSession

if TYPE_CHECKING:
    import lsgp

    from ...core.cone_angles import ConeAngles

# Radians by which the angles about a vertex miss a full turn if it is a cone; coordinates have single precision.
CONE = 0.01
OUTSIDE = 1e-5
# Of a coordinate in single precision, relative to the largest one.
ROUNDING = 8 * float(np.finfo(np.float32).eps)


@dataclass(frozen=True, slots=True)
class CutsState:
    """The cuts as vertices from node to node, the vertices that each was dragged to, and the triangles with other
    coordinates than at the start, with these. Equal by the cuts."""

    paths: tuple[tuple[int, ...], ...]
    pulls: tuple[frozenset[int], ...] = field(compare=False)
    triangles: NDArray[np.int64] = field(compare=False)
    corner_uv: NDArray[np.float64] = field(compare=False)


@dataclass(slots=True)
class _Grip:
    """A part of a cut that is dragged: its cut, the vertices before and after it, and what moves it.

    corner_uv: the layout without the drag. triangles: those with other coordinates now.
    """

    number: int
    before: tuple[int, ...]
    after: tuple[int, ...]
    pulls: frozenset[int]
    grabbed: lsgp.GrabbedCut
    aspect: NDArray[np.float64]
    corner_uv: NDArray[np.float64]
    vertex: int
    triangles: NDArray[np.int32]


class CutSession(MapSession):
    """paths: the cuts, each as vertices from node to node. active: the number of the cut that is dragged or under the
    cursor; None for none. overlapping: faces, as last looked for.
    """

    def __init__(self, obj: bpy.types.Object, choice: CutChoice) -> None:
        """Raises Refused, LsgpError."""
        require_editable(obj)
        require_uv_map(obj)
        with readable_mesh(obj) as copy:
            mesh = FrozenMesh(copy)
            region = build_region(obj, mesh, Faces.ALL, Groups(cones=CONE_GROUP))
        # Whoever drags a cut sees where it runs: it takes the short way there, not one around the front.
        self._region = with_cut_costs(region, replace(choice, front=None))
        self._mover = native.lsgp.CutMover(self._region.surface)
        self._earlier = reports.find(obj.data)
        super().__init__(obj, mesh)
        self._start_uv, self._corner_uv = region.corner_uv, region.corner_uv.copy()
        # The triangles whose coordinates may differ from those at the start.
        self._touched = np.empty(0, np.int32)
        cuts = native.lsgp.measure_distortion(region.surface, region.corner_uv).cut_edges
        self._nodes = self._cones(cuts)
        self.paths = tuple(tuple(path.tolist()) for path in native.lsgp.split_into_paths(cuts, self._nodes))
        if not self.paths:
            raise Refused("no edge is cut in the UV map; unwrap the mesh first")
        self._first_kinds = _kinds_of(self.paths, self._earlier)
        self._pulls: tuple[frozenset[int], ...] = (frozenset(),) * len(self.paths)
        self.active: int | None = None
        self._grip: _Grip | None = None
        self._begun_with = self.state()
        self.overlapping = self._overlapping()
        self._was_inside = _is_inside(self._start_uv)

    def _cones(self, cuts: NDArray[np.int32]) -> NDArray[np.int32]:
        """The vertices that end cuts: marked cones, those of the last unwrap, and those with a cone's angle."""
        triangles = self._region.surface.triangles
        z = self._start_uv.view(np.complex128)[..., 0]
        with np.errstate(invalid="ignore", divide="ignore"):
            angles = np.abs(np.angle((np.roll(z, 1, axis=1) - z) / (np.roll(z, -1, axis=1) - z)))
        sums = np.bincount(triangles.ravel(), np.nan_to_num(angles).ravel(), len(self._region.surface.positions))
        on_cuts = np.unique(cuts)
        found = on_cuts[np.abs(sums[on_cuts] - 2 * np.pi) > CONE]
        known = [] if self._earlier is None else self._earlier.cones
        return np.unique(np.concatenate([found, self._region.own_cones.cones, known]).astype(np.int32))

    # Dragging

    def grab(self, number: int, step: int, vertex: int) -> None:
        """Begin to drag a cut between the next vertices that it was dragged to before.

        step: the edge that is dragged, counted along the cut. vertex: its end there; if the cut was dragged to it
        before, that is done anew.  Raises LsgpError.
        """
        path, pulls = self.paths[number], self._pulls[number] - {vertex}
        if path[0] == path[-1]:
            path, step = _opened_opposite(path, step)
        first = max((i for i in range(step + 1) if path[i] in pulls), default=0)
        last = min((i for i in range(step + 1, len(path)) if path[i] in pulls), default=len(path) - 1)
        cuts = np.concatenate([np.c_[one[:-1], one[1:]] for one in self.paths])
        grabbed, aspect = self._grabbed(cuts, path[first : last + 1])
        self.active = number
        self._grip = _Grip(
            number,
            path[:first],
            path[last + 1 :],
            pulls,
            grabbed,
            aspect,
            self._corner_uv.copy(),
            vertex,
            self._touched[:0],
        )

    def _grabbed(self, cuts: NDArray[np.int32], path: tuple[int, ...]) -> tuple[lsgp.GrabbedCut, NDArray[np.float64]]:
        """Grab in UV coordinates, or failing that in the image's proportions: islands may be for an image that is not
        square."""
        square, image = np.ones(2), np.array([self._region.image_aspect, 1.0])
        try:
            return self._mover.grab(self._corner_uv, cuts, path, self._nodes), square
        except native.lsgp.TopologyError:
            if self._region.image_aspect == 1:
                raise
            return self._mover.grab(self._corner_uv * image, cuts, path, self._nodes), image

    def drag(self, vertex: int) -> bool:
        """Route the held cut through a vertex; returns whether that changed anything.

        Raises Refused and LsgpError if that is impossible; then the cut stays where it was last.
        """
        grip = self._grip
        if vertex == grip.vertex:
            return False
        moved = grip.grabbed.through(vertex, single=True)
        if self._region.pinned[moved.triangles].any():
            raise Refused("a pinned UV would move; unpin it first")
        grip.vertex = vertex
        before, grip.triangles = grip.triangles, moved.triangles
        self._corner_uv[before] = grip.corner_uv[before]
        self._corner_uv[moved.triangles] = moved.corner_uv / grip.aspect
        path = grip.before + tuple(moved.path.tolist()) + grip.after
        self.paths = _replaced(self.paths, grip.number, path)
        self._pulls = _replaced(self._pulls, grip.number, (grip.pulls & set(path)) | {vertex})
        self._touched = np.union1d(self._touched, moved.triangles)
        self._write(np.union1d(before, moved.triangles))
        return True

    def drop(self) -> None:
        """Let go of the cut, and look for faces that overlap now."""
        self._grip = None
        self.overlapping = self._overlapping()

    @property
    def cones(self) -> ConeAngles:
        """The marked ones."""
        return self._region.cones

    def _overlapping(self) -> list[int]:
        """The faces that overlap others by more than rounding to single precision explains."""
        uv = self._corner_uv
        middle = uv.mean(axis=1, keepdims=True)
        (a, b), digit = np.moveaxis(uv[:, 1:] - uv[:, :1], 1, 0), ROUNDING * np.nanmax(np.abs(uv), initial=0.0)
        sizes = np.sqrt(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
        shares = np.minimum(digit / np.maximum(sizes, digit), 0.5)[:, None, None]
        found = native.lsgp.overlapping_triangles(uv + shares * (middle - uv))
        return np.unique(self._region.triangle_faces[found]).tolist()

    @property
    def leaves_tile(self) -> bool:
        """Whether the map was within a tile and no longer is."""
        return self._was_inside and not _is_inside(self._corner_uv[self._touched])

    # All cuts

    @property
    def changed(self) -> bool:
        """Whether the cuts differ from those at the start."""
        return self.paths != self._begun_with.paths

    @property
    def moved_count(self) -> int:
        """How many cuts differ from those at the start."""
        return sum(now != then for now, then in zip(self.paths, self._begun_with.paths, strict=True))

    def state(self) -> CutsState:
        return CutsState(self.paths, self._pulls, self._touched, self._corner_uv[self._touched])

    def put(self, state: CutsState) -> None:
        """Go back, or forward, to a state."""
        if state.paths == self.paths:
            return
        self._grip = None
        self.paths, self._pulls = state.paths, state.pulls
        changed = np.union1d(self._touched, state.triangles)
        self._corner_uv[self._touched] = self._start_uv[self._touched]
        self._corner_uv[state.triangles] = state.corner_uv
        self._touched = state.triangles
        self._write(changed)
        self.drop()

    def report(self) -> reports.Report | None:
        """On the map as shown; None where none was known."""
        if self._earlier is None or not self.changed:
            return self._earlier
        overlaps = {} if self.overlapping else {"overlap_area": 0.0}
        paths = [list(path) for path in self.paths]
        return replace(self._earlier, paths=paths, kinds=self.kinds(), overlapping=self.overlapping, **overlaps)

    def kinds(self) -> list[str]:
        """Of the cuts as they are; empty where the last unwrap is not known."""
        return [
            kind if now == then else cut_kinds.MOVED
            for kind, now, then in zip(self._first_kinds, self.paths, self._begun_with.paths, strict=False)
        ]

    def store(self) -> None:
        """Store the report on the map where it was changed."""
        report = self.report()
        if report is not None and self._uv.is_changed:
            reports.store(self._obj.data, report)

    def _write(self, triangles: NDArray[np.int32]) -> None:
        """Write the coordinates of these triangles."""
        self._uv.write_loops(self._region.triangle_loops[triangles].ravel(), self._corner_uv[triangles].reshape(-1, 2))
        self.mesh.uv = self._uv.now


def _is_inside(corner_uv: NDArray[np.float64]) -> bool:
    return not ((corner_uv < -OUTSIDE) | (corner_uv > 1 + OUTSIDE)).any()


def _kinds_of(paths: tuple[tuple[int, ...], ...], report: reports.Report | None) -> list[str]:
    """The kind of each path: that of most of its edges in a report; empty if the report does not know it."""
    if report is None or not report.kinds:
        return []
    known = {frozenset(edge): kind for kind in cut_kinds.KINDS for edge in report.edges_of(kind)}
    counts = [Counter(known.get(frozenset(edge), cut_kinds.ADDED) for edge in pairwise(path)) for path in paths]
    return [max(cut_kinds.KINDS, key=count.__getitem__) for count in counts]


def _replaced(items: tuple, number: int, item: object) -> tuple:
    return (*items[:number], item, *items[number + 1 :])


def _opened_opposite(path: tuple[int, ...], step: int) -> tuple[tuple[int, ...], int]:
    """A closed path, from and to the vertex half way round from an edge, and the number of that edge in it."""
    ring = path[:-1]
    start = (step + 1 + len(ring) // 2) % len(ring)
    return (*ring[start:], *ring[: start + 1]), (step - start) % len(ring)
