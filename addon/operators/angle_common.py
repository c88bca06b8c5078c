# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators on cone angles share: they look at whole meshes, whatever is selected, as the table does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from .. import findings, mesh_read, native, reporting
from ..angles import ConeAngles, read_angles, require_attributes
from .common import BORDERS, SEAMS, BorderProperty, ConeGroupProperty, SeamsProperty, poll_computation, require_all

if TYPE_CHECKING:
    import lsgp

    from ..mesh_read import Region


class AngleOperator(ConeGroupProperty, SeamsProperty, BorderProperty):
    """Mix-in: runs ``change`` on every target object, and reports.

    shown: the properties that can be adjusted, in order, before the cone group.
    """

    shown: tuple[str, ...] = ()

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in self.shown:
            layout.prop(self, name)
        self.draw_vertex_group(layout, context)

    def library_options(self, **more: Any) -> lsgp.Options:
        return native.lsgp.Options(seams=SEAMS[self.seams][0], border=BORDERS[self.border][0], **more)

    def objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return mesh_read.target_objects(context)

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        """Compute and write; what was done, for the report, and warnings.  Raises LsgpError, Refused."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        done: list[str] = []
        warnings: dict[str, list[Any]] = {}
        failures: dict[str, Any] = {}
        for obj in self.objects(context):
            region = None
            try:
                region = require_all(obj)
                require_attributes(obj.data)
                cones = read_angles(obj, self.vertex_group).on(region.vertex_used)
                said, warnings[obj.name] = self.change(obj, region, cones)
                done.append(f"{obj.name}: {said}")
                findings.keep(obj, region, warnings[obj.name])
            except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
                failures[obj.name] = error
                findings.keep(obj, region, [error])
        return reporting.conclude(self, done, warnings, failures)

    def require_cones(self, cones: ConeAngles) -> None:
        """Raises Refused where there is none."""
        if not len(cones.cones):
            raise reporting.Refused(
                f'no cone is marked in the vertex group "{self.vertex_group}"; use Mark Cone or Place Cones'
            )
