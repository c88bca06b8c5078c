# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh in edit mode whose cones are edited while its UV map follows.

Until the session is finished only the UV map changes, so that restoring it undoes everything. Connected parts are
unwrapped once their cones have been edited, and every island keeps the place, size and rotation that it had in the map
or got in the first step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import object_errors
from ...mesh import reports
from ...mesh.angles import require_attributes
from ...mesh.reader import readable_mesh
from ...mesh.region_read import Faces, Groups, build_region, require_editable
from ...mesh.stored_mesh import FrozenMesh
from ...mesh.subdivided import subdivide
from ..angles.angle_table import FollowedTable
from ..layouts.maps import report_on
from ..tasks.computation import Computation
from ..tasks.cuts import with_cut_costs
from ..tasks.unwrapped import Unwrapped
from ..tasks.unwrapping import UnwrapSettings, UnwrapTask, unwrap, unwrap_task
from ..uv_maps.texels import map_density
from .edited_cones import EditedCones
from .edited_layout import Layout, Placement
from .map_session import MapSession

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region
    from ..tasks.solving import Progress


# Triangles: twice as many as a preview reduces them to, so that it takes half the time.
PREVIEWED = 16_000
_DRAFT = {"repair": False, "overlaps": "keep", "mode": "conformal", "seamless": None}


@dataclass(frozen=True, slots=True)
class Step:
    """One state of the cones, to be solved, which touches nothing in Blender.

    triangles: those of the whole mesh that are part of it. solver: a `Preview` where the map is an approximate one.
    """

    triangles: NDArray[np.int64]
    task: UnwrapTask
    solver: lsgp.Solver | lsgp.Preview

    def solve(self, progress: Progress | None = None) -> Unwrapped:
        """Raises LsgpError."""
        return unwrap(self.task, progress, self.solver)


@dataclass(slots=True)
class _Scope:
    """The connected parts with edited cones: their triangles in the whole mesh, as a region, and its solver.

    preview: what makes that of large ones, once a cone was dragged.
    """

    parts: frozenset[int]
    triangles: NDArray[np.int64]
    region: Region
    solver: lsgp.Solver
    preview: Computation[lsgp.Preview] | None = None


class ConeSession(MapSession):
    """cones: the cones as they are edited."""

    def __init__(self, obj: bpy.types.Object, settings: UnwrapSettings) -> None:
        """Raises Refused, LsgpError."""
        require_editable(obj)
        require_attributes(obj.data)
        with readable_mesh(obj) as copy:
            mesh = FrozenMesh(copy)
            groups = Groups(settings.cone_group, settings.weight_group)
            subdivided = subdivide(obj, copy) if settings.subdivided else None
            region = build_region(obj, mesh, Faces.ALL, groups, subdivided)
        self._group = settings.cone_group
        task = unwrap_task(region, settings)
        self._whole = replace(task, region=with_cut_costs(task.region, task.cuts))
        self._part_of = _parts(region.surface)
        self.cones = EditedCones(region.cones, self._part_of)
        self._scope: _Scope | None = None
        self._shown: Unwrapped | None = None
        self._earlier = self._report = reports.find(obj.data)
        # Where islands stay; those of a map that was not made from cones have no place yet.
        known = self._whole.pinned if self._earlier is None else np.ones_like(self._whole.pinned)
        self._places = np.where(known[:, :, None], region.corner_uv, np.nan)
        super().__init__(obj, mesh)

    @property
    def region(self) -> Region:
        """All faces of the mesh."""
        return self._whole.region

    def table(self) -> FollowedTable:
        """The table of the cones as they are edited."""
        return FollowedTable(self._obj, self._whole.region.surface, self.cones.current)

    def angle(self, vertex: int) -> float | None:
        """The angle chosen for a cone, or computed for it in the last step; None where none is known."""
        return self.cones.angle(vertex) or self._computed_angles().get(vertex)

    def turn_angle(self, step: float, count: int) -> None:
        """Change the angle of the active cone to a multiple of ``step``, ``count`` multiples further."""
        now = self.angle(self.cones.active) or 2 * math.pi
        self.cones.set_angle(max(round(now / step) + count, 1) * step)

    def draft(self) -> Step:
        """The cones as they are, to be solved quickly: overlaps and flipped faces stay, and tiles do not match."""
        return self._step(**_DRAFT)

    def has_previews(self) -> bool:
        """Whether `preview` will serve instead of `draft` while a cone is dragged; makes what that takes."""
        scope = self._current_scope()
        if len(scope.triangles) < PREVIEWED or self._whole.pinned[scope.triangles].any():
            return False
        if scope.preview is None:
            surface = scope.region.surface
            scope.preview = Computation(lambda progress: native.lsgp.Preview(surface, progress=progress))
        return not (scope.preview.finished() and scope.preview.failed)

    def preview(self) -> Step | None:
        """As `draft`, but approximate and quicker still; None while what that takes is being made."""
        preview = self._current_scope().preview
        if not preview.finished():
            return None
        # Of a surface that has lost its symmetry.
        step = self._step(**_DRAFT, mirrored_cuts=False)
        return replace(step, solver=preview.outcome())

    def stop(self) -> None:
        """Stop making previews, and wait for the end."""
        if self._scope is not None and self._scope.preview is not None and not self._scope.preview.finished():
            self._scope.preview.stop()
            self._scope.preview.finished(None)
            self._scope.preview = None

    def show(self, step: Step, unwrapped: Unwrapped) -> None:
        """Write a solved step to the mesh."""
        places = self._places[step.triangles]
        self._places[step.triangles] = np.where(np.isnan(places), unwrapped.corner_uv, places)
        self._uv.write(unwrapped.region, unwrapped.result.solved, unwrapped.corner_uv)
        self._shown = unwrapped
        self._took(reports.joined(self._earlier, report_on(unwrapped), unwrapped.region))

    def show_before(self) -> None:
        """Write the map as it was before the session."""
        self._uv.reset()
        self._shown = None
        self._took(self._earlier)

    def _took(self, report: reports.Report | None) -> None:
        self.mesh.uv = self._uv.now
        self._report = report

    def report(self) -> reports.Report | None:
        """On the map as shown, without the cones that were removed since."""
        report = self._report
        if report is None:
            return None
        kept = [i for i, cone in enumerate(report.cones) if cone in self.cones]
        return replace(report, cones=[report.cones[i] for i in kept], cone_angles=[report.cone_angles[i] for i in kept])

    @property
    def stretch(self) -> float | None:
        """L2 stretch of the map as shown, 1 being none; None where it is not known."""
        return None if self._report is None else self._report.distortion["l2_stretch"]

    def restore(self) -> None:
        """Leave the mesh as it was before the session."""
        self._shown, self._report = None, self._earlier
        super().restore()

    def unwrap(self) -> Unwrapped:
        """Unwrap with all chosen options.

        Raises LsgpError and MemoryError where that is impossible; then the map is as before the session.
        """
        try:
            step = self._step()
            self.show(step, step.solve())
        except object_errors():
            self.restore()
            raise
        return self._shown

    def store(self) -> None:
        """Store the cones, and the report on the map where it was written."""
        self.cones.store(self._obj, self._group)
        report = self.report()
        if report is not None and (self._shown is not None or self._uv.is_changed):
            region = self._whole.region if self._shown is None else self._shown.region
            corner_uv = self._uv.now[region.triangle_loops].astype(np.float64)
            reports.store(self._obj.data, replace(report, texel_density=map_density(region, corner_uv)))

    def placement(self) -> Placement:
        """Where the islands are now and where they were before the session."""
        whole = self._whole.region
        edited = np.zeros(len(whole.triangle_loops), bool)
        if self._shown is not None:
            edited[self._scope.triangles] = True
        # Where the map is not one of ours, what else it has may be on anything.
        counts = edited if self._earlier is None else np.ones_like(edited)
        now, before = (self._layout(uv, counts) for uv in (self._uv.now, self._uv.before))
        return Placement(whole.surface.triangles, now, before, edited, self._whole.pinned, self._whole.aspect)

    def place(self, layout: Layout) -> None:
        """Write the coordinates of all islands of a layout."""
        self._uv.write(self._whole.region, layout.island >= 0, layout.corner_uv)
        self.mesh.uv = self._uv.now

    def _layout(self, loop_uv: NDArray[np.float32], counts: NDArray[np.bool_]) -> Layout:
        whole = self._whole.region
        uv = loop_uv[whole.triangle_loops].astype(np.float64)
        island = native.lsgp.measure_distortion(whole.surface, uv).island
        return Layout(uv, np.where(counts, island, -1).astype(np.int32))

    def _step(self, **draft: object) -> Step:
        scope = self._current_scope()
        task = replace(
            self._whole,
            region=replace(scope.region, corner_uv=self._places[scope.triangles]),
            cones=self.cones.current().on(scope.region.vertex_used),
            options=replace(self._whole.options, **draft),
            pinned=self._whole.pinned[scope.triangles],
            keep_placement=True,
        )
        return Step(scope.triangles, task, scope.solver)

    def _current_scope(self) -> _Scope:
        touched = self.cones.touched
        if self._scope is None or self._scope.parts != touched:
            self.stop()
            whole = self._whole.region
            surface = whole.surface
            inside = np.isin(self._part_of, list(touched))
            triangles = np.flatnonzero(inside[surface.triangles[:, 0]])
            own_edges = inside[surface.edges[:, 0]]
            surface = replace(
                surface,
                triangles=surface.triangles[triangles],
                edges=surface.edges[own_edges],
                cut_costs=None if surface.cut_costs is None else surface.cut_costs[own_edges],
                seams=surface.seams[inside[surface.seams[:, 0]]],
                directions=None if surface.directions is None else surface.directions[triangles],
                features=surface.features[inside[surface.features[:, 0]]],
            )
            region = replace(
                whole,
                surface=surface,
                triangle_loops=whole.triangle_loops[triangles],
                triangle_faces=whole.triangle_faces[triangles],
                vertex_used=inside & whole.vertex_used,
                drawn_up=None if whole.drawn_up is None else whole.drawn_up[triangles],
                along=whole.along[inside[whole.along[:, 0]]],
            )
            self._scope = _Scope(touched, triangles, region, native.lsgp.Solver(surface))
        return self._scope

    def _computed_angles(self) -> dict[int, float]:
        """The angles of the last step, and in all other parts those of the previous map."""
        computed = {}
        if self._earlier is not None:
            computed |= zip(self._earlier.cones, self._earlier.cone_angles, strict=True)
        if self._shown is not None:
            result = self._shown.result
            computed |= zip(result.cones.tolist(), result.cone_angles.tolist(), strict=True)
        return computed


def _parts(surface: lsgp.Surface) -> NDArray[np.int32]:
    """(n,) the connected part of each vertex, -1 for those without a triangle."""
    share_of = np.full(len(surface.positions), -1, np.int32)
    options = native.lsgp.Options(seams="ignore")
    for number, part in enumerate(native.lsgp.build_ledger(surface, [], None, options)):
        share_of[surface.triangles[part.triangles]] = number
    return share_of
