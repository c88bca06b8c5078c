# SPDX-License-Identifier: GPL-3.0-or-later
"""The cones of a whole mesh as a table: every connected part with its ledger and the angle of each of its cones.

Panels are drawn often, so tables are kept until their mesh changes; building one changes nothing in Blender.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np

from . import changes, identifiers, native
from .angles import ConeAngles, Kind, read_angles
from .mesh_read import read_triangles
from .reporting import counted

if TYPE_CHECKING:
    import lsgp

KIND_LABELS = {None: "Automatic", Kind.FOUND: "Automatic", Kind.PRESCRIBED: "Prescribed", Kind.SNAPPED: "Snapped"}

# Faces of a mesh whose table is built whenever it is needed; larger ones wait until they are asked to.
LARGEST_UNASKED = 10_000


@dataclass(frozen=True, slots=True)
class Settings:
    """What a table depends on beside the mesh: the group of the cones and the meaning of seams and borders."""

    group: str
    seams: str
    border: str

    def options(self) -> lsgp.Options:
        return native.lsgp.Options(seams=self.seams, border=self.border)


@dataclass(frozen=True, slots=True)
class Row:
    """One cone.  angle, curvature: in radians, None where they are found on unwrapping only; kind is None then too."""

    vertex: int
    angle: float | None
    kind: Kind | None
    curvature: float | None


@dataclass(frozen=True, slots=True)
class TablePart:
    """One connected part, its rows by vertex."""

    rows: list[Row]
    ledger: lsgp.LedgerPart


# By the mesh's session_uid, which stays the same through undo.
_tables: dict[int, tuple[tuple[int, int], Settings, list[TablePart]]] = {}


def current_table(obj: bpy.types.Object, settings: Settings, asked: bool = False) -> list[TablePart] | None:
    """The table of the mesh as it is now; None where that takes long and was not asked for."""
    now = (changes.version(obj.data), settings)
    *then, table = _tables.get(obj.data.session_uid, (None,))
    if then == [*now]:
        return table
    faces = len(bmesh.from_edit_mesh(obj.data).faces if obj.mode == "EDIT" else obj.data.polygons)
    if faces > LARGEST_UNASKED and not asked:
        return None
    count, triangles, seams = read_triangles(obj)
    # The ledger asks for no positions.
    surface = native.lsgp.Surface(np.zeros((count, 3)), triangles, seams=seams)
    table = build_table(surface, read_angles(obj, settings.group), settings.options())
    _tables[obj.data.session_uid] = (*now, table)
    return table


def last_settings(context: bpy.types.Context) -> Settings:
    """Those of the last unwrap, which the next one starts from."""
    last = context.window_manager.operator_properties_last(identifiers.UNWRAP)
    return Settings(last.vertex_group, last.seams.lower(), last.border.lower())


def build_table(surface: lsgp.Surface, cones: ConeAngles, options: lsgp.Options) -> list[TablePart]:
    """All connected parts of a surface. Cones that count in no part, as those on a free border, have no row."""
    held = cones.held(surface, options)
    table = []
    for ledger in native.lsgp.build_ledger(surface, held.cones, held.angles, options):
        rows = []
        for place, curvature in zip(ledger.cones.tolist(), ledger.curvature.tolist(), strict=True):
            angle = held.angles[place]
            known = angle is not None and not math.isnan(curvature)
            kind = held.kinds[place] if known else None
            rows.append(Row(int(held.cones[place]), angle, kind, curvature if known else None))
        table.append(TablePart(rows, ledger))
    return table


def verdict(part: lsgp.LedgerPart) -> str:
    """Whether a part's ledger closes, and if not, what to do."""
    automatic = len(part.automatic)
    if part.border_takes_up:
        return "The border takes up the rest"
    if part.complete:
        return "All curvature is assigned"
    if part.closes:
        return f"Left to {counted(automatic, 'automatic cone')}"
    if not len(part.cones):
        return "No cone: mark some, or place them"
    if automatic:
        return f"Not for {counted(automatic, 'automatic cone')} to take up: mark more"
    return "Does not add up: spread the rest, or change an angle"


def degrees(angle: float, signed: bool = False) -> str:
    """An angle as the panel shows it."""
    shown = round(math.degrees(angle), 1) + 0.0
    return f"{shown:+.1f}°" if signed else f"{shown:.1f}°"
