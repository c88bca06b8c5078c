# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of operators on cone angles. Like the table, they work on whole meshes, whatever is selected."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ...core import findings, native
from ...core.cone_angles import ConeAngles
from ...core.errors import Refused, object_errors
from ...core.preferences import chosen_threads
from ...core.region import Region
from ...mesh.angles import require_attributes
from ...mesh.region_read import Faces, Groups, read_region
from ...mesh.targets import target_objects
from ..shared.conclusion import conclude
from ..shared.polling import ComputingOperator
from ..shared.properties import BORDERS, SEAMS, BorderProperty, ConeGroupProperty, SeamsProperty

if TYPE_CHECKING:
    import lsgp


class AngleOperator(ConeGroupProperty, SeamsProperty, BorderProperty, ComputingOperator):
    """Base: runs ``change`` on every target object and reports.

    shown: the properties that can be adjusted, in order; the cone group follows.
    """

    shown: tuple[str, ...] = ()

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in self.shown:
            if name == "seams":
                self.draw_seams(layout)
            else:
                layout.prop(self, name)
        self.draw_vertex_group(layout, context)

    def library_options(self, **more: Any) -> lsgp.Options:
        seams, border = SEAMS[self.seams][0], BORDERS[self.border][0]
        return native.lsgp.Options(seams=seams, border=border, threads=chosen_threads(), **more)

    def objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return target_objects(context)

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        """Compute and write; returns what was done, for the report, and warnings.  Raises LsgpError, Refused."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        done: list[str] = []
        warnings: dict[str, list[Any]] = {}
        failures: dict[str, Any] = {}
        for obj in self.objects(context):
            region = None
            try:
                region = read_region(obj, Faces.ALL, Groups(cones=self.vertex_group))
                require_attributes(obj.data)
                said, warnings[obj.name] = self.change(obj, region, region.own_cones)
                done.append(f"{obj.name}: {said}")
                findings.keep(obj, region, warnings[obj.name])
            except object_errors() as error:
                failures[obj.name] = error
                findings.keep(obj, region, [error])
        return conclude(self, done, warnings, failures)

    def require_cones(self, cones: ConeAngles) -> None:
        """Raise Refused where there is none."""
        if not len(cones.cones):
            raise Refused(f'no cone is marked in the vertex group "{self.vertex_group}"; use Mark Cone or Place Cones')
