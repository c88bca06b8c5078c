# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects in edit mode on which the texture's upward direction is drawn together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy
import numpy as np

from ...mesh.texture_up import Directions
from .direction_session import DirectionSession
from .edit_history import EditHistory
from .picked_objects import PickedObject, PickedObjects, Sight
from .picking import PickedPlace

# Pixels between the places at which a stroke is followed over the surface.
STRIDE = 3.0
# Of a step's length: how far its middle may be off the surface; more than that is a jump to another part.
OFF_SURFACE = 0.25

Place = tuple[float, float]


class DrawnObject(PickedObject):
    """session: always begun."""

    def __init__(self, obj: bpy.types.Object) -> None:
        """Raises Refused."""
        super().__init__(obj)
        self.session = DirectionSession(obj, self.read)
        self.faces = self.read.drawn_triangles()[1]

    def is_along(self, sight: Sight, before: PickedPlace, after: PickedPlace) -> bool:
        """Whether a straight step from one place to another stays near the surface."""
        step = np.linalg.norm(after.place - before.place)
        return self.picker(sight).distance((before.place + after.place) / 2) <= OFF_SURFACE * step


class DrawnObjects(PickedObjects[DrawnObject]):
    """erases: whether the stroke removes directions."""

    def __init__(self, objects: Sequence[bpy.types.Object]) -> None:
        """Raises Refused."""
        super().__init__([DrawnObject(obj) for obj in objects])
        self.history = EditHistory(self._state, self._put)
        self._cursor: Place | None = None
        self._last: tuple[DrawnObject, PickedPlace] | None = None
        self.erases = False
        self._suspend_changes()

    @property
    def changed(self) -> list[DrawnObject]:
        """The objects whose directions differ from those at the start."""
        return [edited for edited in self._all if edited.session.changed]

    def begin_stroke(self, sight: Sight, cursor: Place, *, erases: bool) -> None:
        """Begin at a pixel."""
        self.history.begin("Erase" if erases else "Draw")
        self.erases = erases
        for edited in self._all:
            edited.session.begin_stroke()
        self._cursor, self._last = None, None
        self.draw_to(sight, cursor)

    def draw_to(self, sight: Sight, cursor: Place) -> None:
        """Go on in a straight line to another pixel."""
        for place in self._between(cursor):
            found = self.place_at(sight, *place)
            if found is not None and self.erases:
                edited, at = found
                edited.session.erase(int(edited.faces[at.triangle]))
            elif found is not None and self._last is not None:
                self._step(sight, *self._last, *found)
            self._last = found
        self._cursor = cursor

    def _step(
        self, sight: Sight, edited: DrawnObject, before: PickedPlace, other: DrawnObject, after: PickedPlace
    ) -> None:
        if other is not edited or not edited.is_along(sight, before, after):
            return
        faces = {int(edited.faces[place.triangle]) for place in (before, after)}
        for face in sorted(faces):
            edited.session.draw(face, (after.place - before.place) / len(faces))

    def _between(self, cursor: Place) -> Iterator[Place]:
        """Pixels from the last one, which is left out, to this one."""
        if self._cursor is None:
            yield cursor
            return
        start, way = np.array(self._cursor), np.subtract(cursor, self._cursor)
        count = max(int(np.ceil(np.hypot(*way) / STRIDE)), 1)
        yield from (tuple(start + way * (number / count)) for number in range(1, count + 1))

    def _state(self) -> dict[int, Directions]:
        return {edited.uid: dict(edited.session.directions) for edited in self._all}

    def _put(self, state: dict[int, Directions]) -> None:
        for edited in self._all:
            edited.session.put(state[edited.uid])

    def store(self) -> None:
        """Write what was changed to the meshes."""
        for edited in self.changed:
            edited.session.store()
