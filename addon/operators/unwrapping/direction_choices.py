# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist's choice of a direction of the texture means in the world."""

from __future__ import annotations

from ...jobs.tasks.directions import UP, DirectionChoice

AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": UP}


def chosen_direction(identifier: str, *, tiles: bool) -> DirectionChoice:
    """identifier: of the property of `DirectionProperty`. tiles: whether the UV map is for tiles."""
    if identifier == "AUTO":
        return DirectionChoice(UP if tiles else None, if_drawn=True)
    return DirectionChoice(AXES.get(identifier), by_edge=identifier == "EDGE")
