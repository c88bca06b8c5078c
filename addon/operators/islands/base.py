# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tools on selected islands share: reading maps, writing them, and what is told."""

from __future__ import annotations

import bpy

from ...core import findings, native
from ...jobs.uv_maps.islands import ChangedMap, Map, read_map, report_on_changed, transition_notes
from ...mesh import reports
from ...mesh.region_read import Faces, read_chosen, require_editable, require_uv_map
from ...mesh.targets import selects_by_uv, target_objects
from ...mesh.uv_write import write_uv
from ..shared.conclusion import conclude, for_each
from ..shared.polling import poll_computation, poll_edit_mesh


class IslandOperator:
    """Mix-in: works on the selected faces of meshes in edit mode, or those with all UVs selected in a UV editor."""

    bl_options = {"REGISTER", "UNDO"}
    nothing_selected = "No face is selected; select some first"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context) and poll_computation(cls, context)

    def read(self, context: bpy.types.Context, obj: bpy.types.Object) -> Map | None:
        """The map of an object; None where no face is selected.  Raises LsgpError, Refused."""
        return read_selected(context, obj)

    def change(self, found: Map, obj: bpy.types.Object) -> ChangedMap:
        """The map after what the operator does.  Raises LsgpError, Refused."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        def changed(obj: bpy.types.Object) -> ChangedMap | None:
            found = self.read(context, obj)
            return None if found is None else self.change(found, obj)

        return self.conclude_each(*for_each(target_objects(context), changed))

    def conclude_each(
        self, found: list[tuple[bpy.types.Object, ChangedMap | None]], failures: dict[str, Exception]
    ) -> set[str]:
        """Write the maps and report."""
        found = [(obj, changed) for obj, changed in found if changed is not None]
        if not found and not failures:
            self.report({"ERROR"}, self.nothing_selected)
        done, warnings = [], {}
        for obj, changed in found:
            findings.keep(obj, changed.region, changed.warnings)
            warnings[obj.name] = changed.warnings
            report = reports.find(obj.data)
            notes = changed.notes
            if changed.moved.any():
                # Measured before anything is written, as that may fail.
                measured = native.lsgp.measure_distortion(changed.region.surface, changed.corner_uv)
                notes = [*notes, *transition_notes(report, changed, measured)]
                report = report and report_on_changed(report, changed, measured)
                write_uv(obj, changed.region, changed.moved, changed.corner_uv)
                if report is not None:
                    reports.store(obj.data, report)
            done.append("; ".join([changed.done, *notes]))
        return conclude(self, done, warnings, failures)


def read_selected(context: bpy.types.Context, obj: bpy.types.Object, faces: Faces | None = None) -> Map | None:
    """faces: None: the selected ones of the editor.  Raises LsgpError, Refused."""
    require_editable(obj)
    require_uv_map(obj)
    selected = Faces.UV_SELECTED if selects_by_uv(context) else Faces.SELECTED
    chosen = read_chosen(obj, selected if faces is None else faces)
    return None if chosen is None else read_map(*chosen)
