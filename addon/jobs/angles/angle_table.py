# SPDX-License-Identifier: GPL-3.0-or-later
"""The cones of a whole mesh as a table: every connected part with its ledger and the angle of each of its cones.

Panels are redrawn often, so tables are cached until their mesh changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core import identifiers, native
from ...core.cone_angles import ConeAngles, Kind
from ...core.per_mesh import kept_by_mesh
from ...core.places import place_names
from ...core.text import counted
from ...mesh import changes
from ...mesh.angles import angles_in
from ...mesh.reader import reader

if TYPE_CHECKING:
    import lsgp

# Meshes with more faces get their table only on request.
LARGEST_UNASKED = 10_000


@dataclass(frozen=True, slots=True)
class TableSettings:
    """What a table depends on besides the mesh: the vertex group of the cones and the meaning of seams and borders."""

    group: str
    seams: str
    border: str

    def options(self) -> lsgp.Options:
        return native.lsgp.Options(seams=self.seams, border=self.border)


@dataclass(frozen=True, slots=True)
class Row:
    """One cone.  angle, curvature: in radians; these and the kind are None where unwrapping computes them.

    place: where it is seen on the model.
    """

    vertex: int
    angle: float | None
    kind: Kind | None
    curvature: float | None
    place: str = ""


@dataclass(frozen=True, slots=True)
class TablePart:
    """One connected part; rows sorted by vertex."""

    rows: list[Row]
    ledger: lsgp.LedgerPart


_tables: dict[int, tuple[tuple[int, int], TableSettings, list[TablePart]]] = kept_by_mesh()


class FollowedTable:
    """The table of a mesh whose cones are edited and not stored yet."""

    def __init__(self, obj: bpy.types.Object, surface: lsgp.Surface, cones: Callable[[], ConeAngles]) -> None:
        """surface: the whole mesh of the object. cones: returns the cones as they are now."""
        self._obj, self._surface, self._cones = obj, surface, cones
        self._known: tuple[object, list[TablePart]] | None = None

    def current(self, settings: TableSettings) -> list[TablePart]:
        """Built only if the cones have changed."""
        cones = self._cones()
        now = cones.cones.tolist(), cones.angles, cones.kinds, settings
        if self._known is None or self._known[0] != now:
            self._known = now, _named(build_table(self._surface, cones, settings.options()), self._obj)
        return self._known[1]


# By session_uid of the mesh.
_followed: dict[int, FollowedTable] = {}


def follow(uid: int, table: FollowedTable) -> None:
    """Show this table of a mesh, named by its session_uid, until `unfollow`."""
    _followed[uid] = table


def unfollow(uid: int) -> None:
    """Show the table of what is stored on the mesh again."""
    _followed.pop(uid, None)


def current_table(
    obj: bpy.types.Object, settings: TableSettings, *, on_request: bool = False
) -> list[TablePart] | None:
    """The table of the current mesh; None where building it takes long and was not requested."""
    followed = _followed.get(obj.data.session_uid)
    if followed is not None:
        return followed.current(settings)
    now = (changes.version(obj.data), settings)
    *then, table = _tables.get(obj.data.session_uid, (None,))
    if then == [*now]:
        return table
    mesh = reader(obj.data)
    vertices, _, faces = mesh.size()
    if faces > LARGEST_UNASKED and not on_request:
        return None
    # The ledger needs no positions.
    surface = native.lsgp.Surface(np.zeros((vertices, 3)), mesh.all_triangles(), seams=mesh.seams(), may_collapse=True)
    table = build_table(surface, angles_in(obj, settings.group, mesh), settings.options())
    table = _named(table, obj)
    _tables[obj.data.session_uid] = (*now, table)
    return table


def _named(table: list[TablePart], obj: bpy.types.Object) -> list[TablePart]:
    """The table with its rows named by their places on the object."""
    places = reader(obj.data).positions([row.vertex for part in table for row in part.rows])
    following = iter(place_names(places, obj.bound_box))
    return [replace(part, rows=[replace(row, place=next(following)) for row in part.rows]) for part in table]


def last_settings(context: bpy.types.Context) -> TableSettings:
    """Those of the last unwrap, which are the defaults of the next one."""
    last = context.window_manager.operator_properties_last(identifiers.UNWRAP)
    return TableSettings(last.vertex_group, last.seams.lower(), last.border.lower())


def build_table(surface: lsgp.Surface, cones: ConeAngles, options: lsgp.Options) -> list[TablePart]:
    """All connected parts of a surface.  Cones that no part counts, such as those on a free boundary, have no row."""
    cones = cones.without_stale(surface, options)
    table = []
    for ledger in native.lsgp.build_ledger(surface, cones.cones, cones.angles, options):
        rows = []
        for place, curvature in zip(ledger.cones.tolist(), ledger.curvature.tolist(), strict=True):
            angle = cones.angles[place]
            known = angle is not None and not math.isnan(curvature)
            kind = cones.kinds[place] if known else None
            rows.append(Row(int(cones.cones[place]), angle, kind, curvature if known else None))
        table.append(TablePart(rows, ledger))
    return table


def verdict(part: lsgp.LedgerPart) -> str:
    """Whether the ledger of a part closes, and if not, what to do."""
    automatic = len(part.automatic)
    if part.border_takes_up:
        return "The boundary takes up the rest"
    if part.complete:
        return "All curvature is assigned"
    if part.closes:
        return f"Left to {counted(automatic, 'automatic cone')}"
    if not len(part.cones):
        return "No cone: mark some, or place them"
    if automatic:
        return f"Too much for {counted(automatic, 'automatic cone')}: mark more"
    return "Does not add up: spread the rest, or change an angle"
