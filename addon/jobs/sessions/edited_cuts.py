# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects in edit mode whose cuts are edited together, each in a session that begins when it is first touched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...core.errors import object_errors
from ...core.screen import Screen
from ..tasks.cuts import CutChoice
from .cut_session import CutSession, CutsState
from .edit_history import EditHistory
from .picked_objects import PickedObject, PickedObjects, Sight
from .picking import Hit, Picker


class CutObject(PickedObject):
    """session, start: once it has begun, and its cuts of then. drawn: what the overlay has drawn of its cuts."""

    def __init__(self, obj: bpy.types.Object, choice: CutChoice) -> None:
        super().__init__(obj)
        self.session: CutSession | None = None
        self.start: CutsState | None = None
        self.drawn: dict[tuple[int, ...], Any] = {}
        self._choice = choice

    def begin(self) -> CutSession:
        """The session, from now on.  Raises Refused, LsgpError."""
        if self.session is None:
            self.session = CutSession(self.obj, self._choice)
            self.start = self.session.state()
        return self.session

    def nearest_cut(self, picker: Picker, screen: Screen, place: tuple[float, float], radius: float) -> Hit | None:
        """The nearest edge of a cut within a radius, in pixels, its number counted through all cuts."""
        if self.session is None:
            return None
        pairs = np.concatenate([np.c_[path[:-1], path[1:]] for path in self.session.paths])
        return picker.edge_at(screen, pairs, place, radius)


Pick = tuple[CutObject, Hit]


@dataclass(frozen=True, slots=True)
class CutsOfObjects:
    """The cuts of the objects, by their meshes' session_uid, where they differ from those at the start."""

    cuts: dict[int, CutsState]


class CutObjects(PickedObjects[CutObject]):
    """held: the object with the cut that is dragged; None for none."""

    def __init__(self, objects: Sequence[bpy.types.Object], choice: CutChoice) -> None:
        """Raises Refused, LsgpError where no object can be edited.  failures: of the others, by name."""
        super().__init__([CutObject(obj, choice) for obj in objects])
        self.held: CutObject | None = None
        self.failures: dict[str, Exception] = {}
        for edited in self._all:
            try:
                edited.begin()
            except object_errors() as error:
                self.failures[edited.name] = error
        if not self.begun:
            raise next(iter(self.failures.values()))
        self.history = EditHistory(self._state, self._put)
        self._suspend_changes()

    @property
    def changed(self) -> list[CutObject]:
        """The objects whose cuts differ from those at the start."""
        return [edited for edited in self.begun if edited.session.changed]

    def cut_at(self, sight: Sight, place: tuple[float, float], radius: float) -> Pick | None:
        """The edge of the nearest cut within a radius, in pixels, that no object hides, and its object."""
        return self.nearest(sight, lambda edited, picker, screen: edited.nearest_cut(picker, screen, place, radius))

    def highlight(self, pick: Pick | None) -> list[CutObject]:
        """Make the cut at an edge the active one; returns the objects of which something else is active now."""
        shown = []
        for edited in self.begun:
            session = edited.session
            active = place_of(session, pick[1].edge)[0] if pick is not None and pick[0] is edited else None
            if active != session.active:
                session.active = active
                shown.append(edited)
        return shown

    def grab(self, pick: Pick) -> None:
        """Begin to drag the cut at an edge.  Raises LsgpError."""
        edited, hit = pick
        edited.session.grab(*place_of(edited.session, hit.edge), hit.vertex)
        self.held = edited

    def drop(self) -> None:
        if self.held is not None:
            self.held.session.drop()
            self.held = None

    # All sessions

    def _state(self) -> CutsOfObjects:
        states = {edited.uid: edited.session.state() for edited in self.begun}
        return CutsOfObjects({edited.uid: states[edited.uid] for edited in self.begun if edited.session.changed})

    def _put(self, state: CutsOfObjects) -> None:
        self.held = None
        for edited in self.begun:
            edited.session.put(state.cuts.get(edited.uid, edited.start))

    def store(self) -> None:
        """Store the reports on the maps that were changed."""
        for edited in self.changed:
            edited.session.store()


def place_of(session: CutSession, edge: int) -> tuple[int, int]:
    """The cut of an edge that is counted through all cuts, and its number along it."""
    first = np.cumsum([0, *(len(path) - 1 for path in session.paths)])
    number = int(np.searchsorted(first, edge, side="right")) - 1
    return number, edge - int(first[number])
