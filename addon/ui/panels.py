# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar of the 3D view, and that of the UV editor, which has most of it."""

from __future__ import annotations

import bpy

from ..core import findings, identifiers, native
from ..core.cut_kinds import KINDS
from ..core.preferences import preferences
from ..core.text import counted
from ..mesh import distortion, reports, texture
from ..mesh.image_aspect import active_image
from ..mesh.texel_settings import density_unit, texel_settings, texture_size
from ..overlay.heat import SCALES
from ..overlay.settings import settings
from . import tables
from .text import draw_table, draw_wrapped

ICONS = {
    findings.Severity.INFORMATION: "INFO",
    findings.Severity.ATTENTION: "ERROR",
    findings.Severity.BROKEN: "CANCEL",
}


class ConeUnwrapPanel:
    """Mix-in: the place of all panels."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Cone Unwrap"


class ConeUnwrapSubPanel(ConeUnwrapPanel):
    """Mix-in: a panel that needs a mesh as active object and the computing library."""

    bl_parent_id = "VIEW3D_PT_cone_unwrap"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return not native.PROBLEM and context.object is not None and context.object.type == "MESH"


class VIEW3D_PT_cone_unwrap(ConeUnwrapPanel, bpy.types.Panel):
    """The tools; contains the other panels."""

    bl_label = "Cone Unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if native.PROBLEM:
            draw_wrapped(layout, context, native.PROBLEM, icon="ERROR")
            return
        # For the progress of long runs.
        layout.operator_context = "INVOKE_DEFAULT"
        column = layout.column()
        column.scale_y = 1.6
        column.operator(identifiers.AUTO_UNWRAP, icon="UV")
        layout.operator(identifiers.UNWRAP)
        layout.operator(identifiers.PACK)
        active = context.object
        report = reports.current(active.data) if active is not None and active.type == "MESH" else None
        if report is not None:
            draw_wrapped(layout, context, tables.in_one_line(report))


class VIEW3D_PT_cone_unwrap_islands(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Islands"
    bl_order = 3
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_DEFAULT"
        for names in (("STRAIGHTEN", "RECTIFY", "GRID"), ("STITCH", "RIP")):
            row = column.row(align=True)
            for name in names:
                row.operator(getattr(identifiers, name), text=name.title())
        row = column.row(align=True)
        for by, text in (("MODEL", "Upright"), ("EDGE", "By Edge")):
            row.operator(identifiers.ORIENT, text=text).by = by
        for sides in (("LEFT", "CENTER", "RIGHT"), ("TOP", "MIDDLE", "BOTTOM")):
            row = column.row(align=True)
            for side in sides:
                row.operator(identifiers.ALIGN, text=side.title()).side = side


class VIEW3D_PT_cone_unwrap_cones(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Cones"
    bl_order = 7
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_DEFAULT"
        row = column.row(align=True)
        row.operator(identifiers.MARK).clear = False
        row.operator(identifiers.MARK, text="Clear Cone").clear = True
        row = column.row(align=True)
        row.operator(identifiers.SELECT)
        row.operator(identifiers.PLACE)
        column.operator(identifiers.EDIT, icon="EMPTY_SINGLE_ARROW")
        column.operator(identifiers.EDIT_CUTS, icon="EDGESEL")


class VIEW3D_PT_cone_unwrap_up(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Texture Up"
    bl_order = 8
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_DEFAULT"
        column.operator(identifiers.DRAW_UP, icon="GREASEPENCIL")
        row = column.row(align=True)
        row.operator(identifiers.MARK_UP, text="From Edges").clear = False
        row.operator(identifiers.MARK_UP, text="Clear").clear = True


class VIEW3D_PT_cone_unwrap_problems(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Problems"
    bl_order = 5

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(findings.last(context.object))

    def draw(self, context: bpy.types.Context) -> None:
        for number, found in enumerate(findings.last(context.object)):
            box = self.layout.box()
            times = f" ({found.times} times)" if found.times > 1 else ""
            draw_wrapped(box, context, found.text + times, icon=ICONS[found.severity])
            if found.elements.count():
                operator = box.operator(identifiers.SELECT_REPORTED, text="Select", icon="RESTRICT_SELECT_OFF")
                operator.finding = number


class VIEW3D_PT_cone_unwrap_quality(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Quality"
    bl_order = 30
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(context.object.data.cone_unwrap_report)

    def draw(self, context: bpy.types.Context) -> None:
        mesh = context.object.data
        report = reports.current(mesh)
        if report is None:
            draw_wrapped(self.layout, context, "The UV map has changed since it was unwrapped from cones", icon="INFO")
            return
        islands, cones = counted(report.islands, "island"), counted(len(report.cones), "cone")
        draw_wrapped(self.layout, context, f"{counted(report.faces, 'face')}, {islands}, {cones}")
        kept = texel_settings(context.scene)
        size = texture_size(context.object, use_image=kept.use_image, typed=kept.texture_size)
        rows = [*tables.quality_rows(report), *tables.texel_rows(report, context.scene, size)]
        draw_table(self.layout, tables.QUALITY_HEADER, rows)


class VIEW3D_PT_cone_unwrap_seams(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Seam Certificate"
    bl_order = 40
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        report = reports.current(context.object.data)
        return report is not None and report.certificate is not None

    def draw(self, context: bpy.types.Context) -> None:
        certificate = reports.current(context.object.data).certificate
        exact = certificate["error_texels"] < 1
        draw_wrapped(self.layout, context, tables.seam_summary(certificate), icon="CHECKMARK" if exact else "ERROR")
        rows = tables.seam_rows(certificate)
        if rows:
            draw_table(self.layout, tables.SEAM_HEADER, rows, first=0.3)
        rest = len(certificate["cuts"]) - len(rows)
        if rest:
            self.layout.label(text=f"and {counted(rest, 'more cut', 'more cuts')}, none worse")


class VIEW3D_PT_cone_unwrap_overlay(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Overlay"
    bl_order = 50
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(settings(context), "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        chosen = settings(context)
        layout = self.layout
        layout.active = chosen.show
        grid = layout.grid_flow(columns=2, even_columns=True, align=True)
        for name in ("cones", "angles", "cuts", "flipped", "overlapping", "up", "axes"):
            part = grid.row()
            part.active = name != "angles" or chosen.cones
            part.prop(chosen, name, text={"flipped": "Flipped", "overlapping": "Overlapping"}.get(name))
        column = layout.column()
        column.active = chosen.cuts
        column.row(align=True).prop(chosen, "cut_colors", expand=True)
        report = reports.current(context.object.data)
        if chosen.cut_colors == "KIND" and report is not None:
            for kind, (label, _) in KINDS.items():
                row = column.row()
                row.label(text=f"{label}: {counted(len(report.edges_of(kind)), 'edge')}")
                if preferences() is not None:
                    row.prop(preferences(), f"{kind}_cut", text="")


class VIEW3D_PT_cone_unwrap_distortion(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Distortion"
    bl_order = 60
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, chosen, mesh = self.layout, settings(context), context.object.data
        row = layout.row(align=True)
        row.operator(identifiers.MEASURE, text="Measure").clear = False
        if not distortion.is_measured(mesh):
            return
        row.operator(identifiers.MEASURE, text="Clear").clear = True
        layout.row(align=True).prop(chosen, "distortion", expand=True)
        if not distortion.is_current(mesh):
            draw_wrapped(layout, context, "The UV map has changed; measure it again", icon="INFO")
        elif chosen.distortion.lower() in SCALES:
            scale = SCALES[chosen.distortion.lower()]
            draw_wrapped(layout, context, f"{scale.label}: {', '.join(scale.ends)}")


class VIEW3D_PT_cone_unwrap_texels(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Texel Density"
    bl_order = 65
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, kept = self.layout, texel_settings(context.scene)
        layout.operator_context = "INVOKE_DEFAULT"
        layout.prop(kept, "use_image")
        image = active_image(context.object) if kept.use_image else None
        if image is not None:
            layout.label(text=f"{image.name}: {image.size[0]} x {image.size[1]} px", icon="IMAGE_DATA")
        # Further selected objects may have no image.
        layout.prop(kept, "texture_size", text="Texture Size" if image is None else "Without Image")
        layout.prop(kept, "density", text=f"Density ({density_unit(context.scene)})")
        row = layout.row(align=True)
        row.operator(identifiers.TEXEL_GET, text="Get")
        row.operator(identifiers.TEXEL_SET, text="Set")
        row.operator(identifiers.TEXEL_SELECT, text="Select")
        layout.prop(context.object, "cone_unwrap_density_weight")


class VIEW3D_PT_cone_unwrap_texture(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Texture"
    bl_order = 70
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_DEFAULT"
        row = layout.row(align=True)
        row.operator(identifiers.TEXTURE_SHOW, text="Checker").pattern = "CHECKER"
        row.operator(identifiers.TEXTURE_SHOW, text="Asymmetric").pattern = "ASYMMETRIC"
        if texture.is_shown(context.object):
            layout.operator(identifiers.TEXTURE_SHOW, text="Remove").clear = True
        layout.operator(identifiers.EXTEND_IMAGE)


PANELS = (
    VIEW3D_PT_cone_unwrap,
    VIEW3D_PT_cone_unwrap_islands,
    VIEW3D_PT_cone_unwrap_problems,
    VIEW3D_PT_cone_unwrap_cones,
    VIEW3D_PT_cone_unwrap_up,
    VIEW3D_PT_cone_unwrap_quality,
    VIEW3D_PT_cone_unwrap_seams,
    VIEW3D_PT_cone_unwrap_overlay,
    VIEW3D_PT_cone_unwrap_distortion,
    VIEW3D_PT_cone_unwrap_texels,
    VIEW3D_PT_cone_unwrap_texture,
)


def _in_uv_editor(panel: type[bpy.types.Panel]) -> type[bpy.types.Panel]:
    """The same panel in the sidebar of the UV editor."""

    def poll(_cls: type[bpy.types.Panel], context: bpy.types.Context) -> bool:
        own = getattr(panel, "poll", None)
        space = context.space_data
        return space is not None and space.show_uvedit and (own is None or own(context))

    def name_of(idname: str) -> str:
        return idname.replace("VIEW3D", "IMAGE")

    members = {"bl_space_type": "IMAGE_EDITOR", "poll": classmethod(poll), "__doc__": panel.__doc__}
    if hasattr(panel, "bl_parent_id"):
        members["bl_parent_id"] = name_of(panel.bl_parent_id)
    bases = (panel.__mro__[1], bpy.types.Panel)
    names = ("bl_label", "bl_order", "bl_options", "draw", "draw_header")
    own = {name: value for name, value in vars(panel).items() if name in names}
    return type(name_of(panel.__name__), bases, {**own, **members})


UV_EDITOR_PANELS = tuple(
    map(
        _in_uv_editor,
        (
            VIEW3D_PT_cone_unwrap,
            VIEW3D_PT_cone_unwrap_islands,
            VIEW3D_PT_cone_unwrap_problems,
            VIEW3D_PT_cone_unwrap_quality,
            VIEW3D_PT_cone_unwrap_seams,
            VIEW3D_PT_cone_unwrap_overlay,
            VIEW3D_PT_cone_unwrap_texels,
        ),
    )
)
