# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones of one mesh in edit mode while they are edited: picked, added, moved, taken away, given angles.

Until the session is finished only the UV map changes, so that putting that back undoes everything. Connected parts are
unwrapped once their cones are edited, and every island keeps the place, size and turn it had in the map or got in the
first step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from . import angles, cones, gathering, mesh_read, mesh_write, native, reports
from .angles import ConeAngles, Kind
from .overlay.content import build_content
from .overlay.readers import FrozenMesh
from .unwrapping import Task, Unwrapped, unwrap

if TYPE_CHECKING:
    import lsgp

    from .mesh_read import Region
    from .overlay.content import Content
    from .screen import Screen
    from .unwrapping import Progress

# Share of the mesh's size by which a cone may lie behind what hides it.
BEHIND = 1e-3
LEAST_ANGLE = math.radians(1.0)


@dataclass(frozen=True, slots=True)
class Step:
    """One state of the cones, to be solved; touches nothing of Blender's.  triangles: those of the whole mesh in it."""

    triangles: NDArray[np.int64]
    task: Task
    solver: lsgp.Solver

    def solve(self, progress: Progress | None = None) -> Unwrapped:
        """Raises LsgpError."""
        return unwrap(self.task, progress, self.solver)


class ConeSession:
    """active: the cone that angles are given to; None for none."""

    def __init__(self, obj: bpy.types.Object, region: Region, settings: gathering.Settings) -> None:
        """region: all faces of the mesh.  Raises Refused."""
        angles.require_attributes(obj.data)
        self.active: int | None = None
        self._obj, self._group = obj, settings.group
        self._whole = gathering.gather(obj, region, settings)
        marked = angles.read_angles(obj, settings.group)
        self._before = {
            vertex: (angle, kind)
            for vertex, angle, kind in zip(marked.cones.tolist(), marked.angles, marked.kinds, strict=True)
        }
        self._cones = dict(self._before)
        self._part_of = _parts(region.surface)
        self._touched: set[int] = set()
        self._scope: tuple[NDArray[np.int64], Region, lsgp.Solver] | None = None
        self._shown: Unwrapped | None = None
        self._earlier = self._report = reports.find(obj.data)
        # Where islands are to stay; those of a map that is none from cones have no place yet.
        known = self._whole.pinned if self._earlier is None else np.ones_like(self._whole.pinned)
        self._places = np.where(known[:, :, None], region.corner_uv, np.nan)
        with mesh_read.readable_mesh(obj) as mesh:
            self._mesh = FrozenMesh(mesh)
        self._uv = mesh_write.EditedUv(obj.data)
        self._points = self._mesh.all_positions()
        self._triangles, _ = self._mesh.all_triangles()
        self._tree = BVHTree.FromPolygons(self._points.tolist(), self._triangles.tolist(), all_triangles=True)
        self._size = float(np.linalg.norm(np.ptp(self._points, axis=0)))

    # Picking

    def vertex_at(self, screen: Screen, x: float, y: float) -> int | None:
        """The vertex of the face under a pixel that is nearest to it there; None where there is no face."""
        origin, direction = screen.ray(x, y)
        place, _, triangle, _ = self._tree.ray_cast(origin, direction)
        if place is None:
            return None
        vertices = self._triangles[triangle]
        return int(vertices[np.linalg.norm(self._points[vertices] - np.array(place), axis=1).argmin()])

    def cone_at(self, screen: Screen, x: float, y: float, radius: float) -> int | None:
        """The cone nearest to a pixel, within a radius and not hidden by the mesh; None where there is none."""
        vertices = np.array(sorted(self._cones), int)
        pixels = screen.pixels(self._points[vertices])
        distances = np.hypot(pixels[:, 0] - x, pixels[:, 1] - y)
        for row in np.argsort(distances, kind="stable").tolist():
            if not distances[row] <= radius:
                return None
            if self._is_seen(screen, vertices[row], pixels[row]):
                return int(vertices[row])
        return None

    def _is_seen(self, screen: Screen, vertex: int, pixel: NDArray) -> bool:
        origin, direction = screen.ray(pixel[0], pixel[1])
        place, _, _, distance = self._tree.ray_cast(origin, direction)
        own = np.linalg.norm(self._points[vertex] - origin)
        return place is None or distance > own - BEHIND * self._size

    # Editing

    @property
    def cones(self) -> list[int]:
        """The cones' vertices, ascending."""
        return sorted(self._cones)

    @property
    def changed(self) -> bool:
        """Whether anything was edited."""
        return self._cones != self._before

    def add(self, vertex: int) -> None:
        """A cone with an automatic angle, which becomes the active one."""
        if vertex not in self._cones:
            self._touch(vertex)
            self._cones[vertex] = (None, Kind.PRESCRIBED)
        self.active = vertex

    def remove(self, vertex: int) -> None:
        self._touch(vertex)
        del self._cones[vertex]
        if self.active == vertex:
            self.active = None

    def move(self, vertex: int) -> bool:
        """Move the active cone with its angle to a vertex, unless one is there.  Returns whether that changed it."""
        if vertex in self._cones:
            return False
        self._touch(vertex)
        self._touch(self.active)
        self._cones[vertex] = self._cones.pop(self.active)
        self.active = vertex
        return True

    def angle(self, vertex: int) -> float | None:
        """The angle chosen for a cone, or found for it in the last step; None where none is known."""
        return self._cones[vertex][0] or self._found().get(vertex)

    def is_automatic(self, vertex: int) -> bool:
        angle, kind = self._cones[vertex]
        return angle is None or kind == Kind.FOUND

    def set_angle(self, angle: float | None) -> None:
        """Of the active cone; None for automatic."""
        self._touch(self.active)
        self._cones[self.active] = (None if angle is None else max(angle, LEAST_ANGLE), Kind.PRESCRIBED)

    def turn_angle(self, step: float, count: int) -> None:
        """Change the angle of the active cone to the multiple of a step that is so many further."""
        now = self.angle(self.active) or 2 * math.pi
        self.set_angle(max(round(now / step) + count, 1) * step)

    def _touch(self, vertex: int) -> None:
        """Angles found for the part's cones as they were are those of other cones now."""
        part = int(self._part_of[vertex])
        if part in self._touched or part < 0:
            return
        self._touched.add(part)
        self._scope = None
        for cone, (_, kind) in self._cones.items():
            if self._part_of[cone] == part and kind == Kind.FOUND:
                self._cones[cone] = (None, Kind.PRESCRIBED)

    # Unwrapping

    def draft(self) -> Step:
        """The cones as they are, to be solved quickly: overlaps and flipped faces stay, and tiles do not match."""
        return self._step(repair=False, overlaps="keep", mode="conformal", seamless=None)

    def show(self, step: Step, unwrapped: Unwrapped) -> None:
        """Write a solved step to the mesh."""
        places = self._places[step.triangles]
        self._places[step.triangles] = np.where(np.isnan(places), unwrapped.corner_uv, places)
        self._uv.write(unwrapped.region, unwrapped.result.solved, unwrapped.corner_uv)
        self._mesh.uv = self._uv.now
        self._shown = unwrapped
        self._report = reports.joined(self._earlier, reports.report_on(unwrapped), unwrapped)

    def content(self) -> Content:
        """What the overlay is to show of all this."""
        return replace(build_content(self._obj, self.report(), self._mesh, self.marked()), active=self.active)

    def report(self) -> reports.Report | None:
        """On the map as it is shown, without the cones that are none any more."""
        report = self._report
        if report is None:
            return None
        kept = [i for i, cone in enumerate(report.cones) if cone in self._cones]
        return replace(report, cones=[report.cones[i] for i in kept], cone_angles=[report.cone_angles[i] for i in kept])

    @property
    def stretch(self) -> float | None:
        """L2, 1 being none, of the map as it is shown; None where nothing is known of it."""
        return None if self._report is None else self._report.distortion["l2_stretch"]

    def marked(self) -> ConeAngles:
        """The cones as they are, by vertex."""
        vertices = self.cones
        chosen = [self._cones[vertex] for vertex in vertices]
        return ConeAngles(np.array(vertices, np.int32), [angle for angle, _ in chosen], [kind for _, kind in chosen])

    def put_back(self) -> None:
        """Leave the mesh as it was."""
        self._uv.put_back()

    def finish(self) -> Unwrapped:
        """Unwrap with everything that was asked for and store the cones; all is one change.

        Raises LsgpError where that cannot be: the map is as before the session then, and the cones are stored.
        """
        try:
            step = self._step()
            self.show(step, step.solve())
        except native.lsgp.LsgpError:
            self.put_back()
            raise
        finally:
            self._store()
        reports.store(self._obj.data, self.report())
        return self._shown

    def _step(self, **draft: object) -> Step:
        triangles, region, solver = self._scoped()
        task = replace(
            self._whole,
            region=replace(region, corner_uv=self._places[triangles]),
            cones=self.marked().on(region.vertex_used),
            options=replace(self._whole.options, **draft),
            pinned=self._whole.pinned[triangles],
            keep_placement=True,
        )
        return Step(triangles, task, solver)

    def _scoped(self) -> tuple[NDArray[np.int64], Region, lsgp.Solver]:
        """The triangles of the parts that are edited, as a region, and the solver of that."""
        if self._scope is None:
            whole = self._whole.region
            inside = np.isin(self._part_of, list(self._touched))
            triangles = np.flatnonzero(inside[whole.surface.triangles[:, 0]])
            surface = whole.surface
            surface = replace(
                surface,
                triangles=surface.triangles[triangles],
                edges=surface.edges[inside[surface.edges[:, 0]]],
                seams=surface.seams[inside[surface.seams[:, 0]]],
            )
            region = replace(
                whole,
                surface=surface,
                triangle_loops=whole.triangle_loops[triangles],
                triangle_faces=whole.triangle_faces[triangles],
                vertex_used=inside & whole.vertex_used,
            )
            self._scope = triangles, region, native.lsgp.Solver(surface)
        return self._scope

    def _found(self) -> dict[int, float]:
        """The angles of the last step, and those of the map there was of other parts."""
        found = {}
        if self._earlier is not None:
            found |= zip(self._earlier.cones, self._earlier.cone_angles, strict=True)
        if self._shown is not None:
            result = self._shown.result
            found |= zip(result.cones.tolist(), result.cone_angles.tolist(), strict=True)
        return found

    def _store(self) -> None:
        """Write the cones and their angles."""
        obj, group = self._obj, self._group
        removed = sorted(self._before.keys() - self._cones.keys())
        if removed:
            cones.clear_cones(obj, group, removed)
        changed = [vertex for vertex in self.cones if self._cones[vertex] != self._before.get(vertex)]
        if changed:
            cones.mark_cones(obj, group, changed)
        angles.forget_angles(obj, removed + [vertex for vertex in changed if self._cones[vertex][0] is None])
        chosen = [vertex for vertex in changed if self._cones[vertex][0] is not None]
        if chosen:
            values, kinds = zip(*(self._cones[vertex] for vertex in chosen), strict=True)
            angles.write_angles(obj, chosen, values, kinds)


def _parts(surface: lsgp.Surface) -> NDArray[np.int32]:
    """(n,) the connected part of each vertex, -1 for those without a triangle."""
    part_of = np.full(len(surface.positions), -1, np.int32)
    options = native.lsgp.Options(seams="ignore")
    for number, part in enumerate(native.lsgp.build_ledger(surface, [], None, options)):
        part_of[surface.triangles[part.triangles]] = number
    return part_of
