# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of cone angles in the sidebar of the 3D view."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..core import findings, identifiers
from ..core.cone_angles import Kind
from ..core.errors import object_errors
from ..core.text import degrees
from ..jobs.angles.angle_table import Row, TablePart, TableSettings, current_table, last_settings, verdict
from ..overlay import cache
from ..overlay.content import Cone
from .panels import ConeUnwrapSubPanel
from .text import draw_wrapped

# A table with more rows or parts would not be readable.
MOST_ROWS = 100
MOST_PARTS = 8

# Of angles that unwrapping keeps; it chooses the others.
ICONS = {Kind.PRESCRIBED: "PINNED", Kind.SNAPPED: "SNAP_ON"}


class VIEW3D_PT_cone_angles(ConeUnwrapSubPanel, bpy.types.Panel):
    bl_label = "Cone Angles"
    bl_order = 10
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.mode in {"OBJECT", "EDIT_MESH"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = last_settings(context)
        try:
            table = current_table(context.object, settings)
        except object_errors() as error:
            draw_wrapped(layout, context, findings.explain(error), icon="ERROR")
            return
        if table is None:
            layout.label(text="This mesh is large")
            layout.operator(identifiers.UPDATE_TABLE, icon="FILE_REFRESH")
            return
        if not any(part.rows for part in table):
            layout.label(text="No cones are marked")
        else:
            self._draw_parts(layout, table, {cone.vertex: cone for cone in cache.entry(context.object).content.cones})
        self._draw_fixes(layout, settings)

    def _draw_parts(self, layout: bpy.types.UILayout, table: list[TablePart], imposed: dict[int, Cone]) -> None:
        shown = [part for part in table if part.rows or not part.ledger.closes]
        rows = MOST_ROWS
        for part in shown[:MOST_PARTS]:
            box = layout.box().column(align=True)
            if len(table) > 1:
                box.label(text=f"Component of {len(part.ledger.triangles):,} triangles")
            draw_ledger(box, part)
            if part.rows:
                draw_head(box)
            for row in part.rows[:rows]:
                draw_row(box, row, imposed.get(row.vertex))
            if len(part.rows) > rows:
                box.label(text=f"and {len(part.rows) - rows} more cones")
            rows -= min(rows, len(part.rows))
        if len(shown) > MOST_PARTS:
            layout.label(text=f"and {len(shown) - MOST_PARTS} more components")

    def _draw_fixes(self, layout: bpy.types.UILayout, settings: TableSettings) -> None:
        column = layout.column(align=True)
        operators = [
            column.operator(identifiers.SPREAD_REST),
            column.operator(identifiers.SPREAD_REST, text="Spread over Selected"),
            column.operator(identifiers.SNAP_ANGLES),
            column.operator(identifiers.SUGGEST),
            layout.operator(identifiers.PREVIEW),
        ]
        operators[1].selected = True
        for operator in operators:
            operator.vertex_group = settings.group
            operator.seams = settings.seams.upper()
            operator.border = settings.border.upper()


def draw_ledger(layout: bpy.types.UILayout, part: TablePart) -> None:
    ledger = part.ledger
    if not ledger.border_takes_up:
        layout.label(text=f"Assigned {degrees(ledger.assigned)} of {degrees(ledger.required)}")
        if not ledger.complete:
            layout.label(text=f"Missing {degrees(ledger.missing)}")
    layout.label(text=verdict(ledger), icon="CHECKMARK" if ledger.closes else "ERROR")


def columns(layout: bpy.types.UILayout) -> Iterator[bpy.types.UILayout]:
    """The three cells of a line of the table, from left to right."""
    rest = layout
    for factor in (0.44, 0.48):
        rest = rest.split(factor=factor, align=True)
        yield rest.column(align=True)
    yield rest.column(align=True)


def draw_head(layout: bpy.types.UILayout) -> None:
    for cell, title in zip(columns(layout), ("Cone", "Angle", "Curvature"), strict=True):
        cell.label(text=title)


def draw_row(layout: bpy.types.UILayout, row: Row, imposed: Cone | None) -> None:
    """imposed: the cone as the overlay shows it; where the angle is automatic, that of the last unwrap is shown."""
    known = row if row.angle is not None or imposed is None else imposed
    text = "—" if known.angle is None else ("~" if row.angle is None else "") + degrees(known.angle)
    place, angle, curvature = columns(layout)
    place.operator(identifiers.SELECT_ONE, text=row.place, emboss=False).vertex = row.vertex
    typed = angle.operator(identifiers.SET_ANGLE, text=text, icon=ICONS.get(row.kind, "NONE"))
    typed.vertex = row.vertex
    if known.angle is not None:
        typed.angle = known.angle
    curvature.label(text="" if known.curvature is None else degrees(known.curvature, signed=True))
