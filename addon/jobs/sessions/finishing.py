# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of sessions of Edit Cones: maps with all chosen options, placed together, and everything stored."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.errors import object_errors
from ..layouts.maps import PackSettings, turned_for
from ..tasks.unwrapped import Unwrapped
from .cone_session import ConeSession
from .edited_layout import packed_where_needed


def finish(
    changed: Sequence[ConeSession], others: Sequence[ConeSession], placing: PackSettings
) -> list[Unwrapped | Exception]:
    """The map of each session whose cones were changed, or why there is none; its cones are stored in any case.

    others: sessions on meshes whose islands may have to make room. placing: how islands are packed where an edited one
    no longer fits into its place.
    """
    outcomes = [_unwrapped(session) for session in changed]
    done = [session for session, outcome in zip(changed, outcomes, strict=True) if not isinstance(outcome, Exception)]
    placed = [*done, *others]
    if done:
        try:
            settings = turned_for([session.region for session in placed], placing)
            layouts = packed_where_needed([session.placement() for session in placed], settings)
            for session, layout in zip(placed, layouts, strict=True):
                if layout is not None:
                    session.place(layout)
        except object_errors() as error:
            for session in done:
                session.restore()
            outcomes = [outcome if isinstance(outcome, Exception) else error for outcome in outcomes]
    for session in (*changed, *others):
        session.store()
    return outcomes


def _unwrapped(session: ConeSession) -> Unwrapped | Exception:
    try:
        return session.unwrap()
    except object_errors() as error:
        return error
