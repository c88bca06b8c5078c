# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects in edit mode whose cones are edited together, each in a session that begins when it is first touched."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import bpy

from ...core.errors import object_errors
from ...mesh.cones import marked_cones
from ..angles import angle_table
from ..layouts.maps import PackSettings
from ..tasks.unwrapped import Unwrapped
from ..tasks.unwrapping import UnwrapSettings
from .cone_session import ConeSession
from .edit_history import EditHistory
from .edited_cones import ConesState, EditedCones
from .finishing import finish
from .following import Follower
from .picked_objects import PickedObject, PickedObjects, Sight
from .picking import Hit


class EditedObject(PickedObject):
    """session, follower, start: once it has begun, and the cones of then."""

    def __init__(self, obj: bpy.types.Object, settings: UnwrapSettings) -> None:
        super().__init__(obj)
        self.session: ConeSession | None = None
        self.follower: Follower | None = None
        self.start: ConesState | None = None
        self._settings = settings

    def begin(self) -> ConeSession:
        """The session, from now on.  Raises Refused, LsgpError."""
        if self.session is None:
            self.session = ConeSession(self.obj, self._settings)
            self.follower = Follower(self.session)
            self.start = self.session.cones.state()
            angle_table.follow(self.uid, self.session.table())
        return self.session

    @property
    def cones(self) -> list[int]:
        return self._marked if self.session is None else self.session.cones.vertices

    @cached_property
    def _marked(self) -> list[int]:
        return marked_cones(self.obj, self._settings.cone_group).tolist()


@dataclass(frozen=True, slots=True)
class EditState:
    """The cones of the objects, by their meshes' session_uid, where they differ from those at the start; the active
    object's. Equal by the cones."""

    cones: dict[int, ConesState]
    active: int | None = field(compare=False)


Pick = tuple[EditedObject, Hit]


class EditedObjects(PickedObjects[EditedObject]):
    """active: the object whose active cone gets angles; None for none."""

    def __init__(self, objects: Sequence[bpy.types.Object], settings: UnwrapSettings) -> None:
        """Raises Refused, LsgpError where there is only one object and it cannot be edited."""
        super().__init__([EditedObject(obj, settings) for obj in objects])
        self.active: EditedObject | None = None
        self.history = EditHistory(self._state, self._put)
        if len(self._all) == 1:
            self._all[0].begin()
        self._suspend_changes()

    @property
    def changed(self) -> bool:
        """Whether any cones differ from those at the start."""
        return any(edited.session.cones.changed for edited in self.begun)

    def count(self) -> int:
        """How many cones there are."""
        return sum(len(edited.cones) for edited in self._all)

    def activate(self, edited: EditedObject) -> EditedObject | None:
        """Begin to edit an object; returns the one that no longer has an active cone.  Raises Refused, LsgpError."""
        edited.begin()
        before, self.active = self.active, edited
        if before is None or before is edited:
            return None
        before.session.cones.active = None
        return before

    @property
    def active_cones(self) -> EditedCones | None:
        """Those of the active object, if one of them is active."""
        if self.active is None or self.active.session.cones.active is None:
            return None
        return self.active.session.cones

    def cone_at(self, sight: Sight, x: float, y: float, radius: float) -> Pick | None:
        """The nearest cone to a pixel within a radius, in pixels, that no object hides, and its object."""
        return self.nearest(sight, lambda edited, picker, screen: picker.cone_at(screen, edited.cones, x, y, radius))

    # All sessions

    def _state(self) -> EditState:
        states = {edited.uid: edited.session.cones.state() for edited in self.begun}
        kept = {edited.uid: states[edited.uid] for edited in self.begun if states[edited.uid] != edited.start}
        return EditState(kept, None if self.active is None else self.active.uid)

    def _put(self, state: EditState) -> None:
        for edited in self.begun:
            wanted = state.cones.get(edited.uid, edited.start)
            edited.follower.outdated |= edited.session.cones.state() != wanted
            edited.session.cones.put(wanted if edited.uid == state.active else replace(wanted, active=None))
        self.active = next((edited for edited in self._all if edited.uid == state.active), None)

    def follow(self) -> list[EditedObject]:
        """Bring the maps up to date; returns the objects of which a step was shown or failed."""
        return [edited for edited in self.begun if edited.follower.follow()]

    def stop(self) -> None:
        """Stop all computations."""
        for edited in self.begun:
            edited.follower.stop()

    def finish(self, placing: PackSettings) -> list[tuple[EditedObject, Unwrapped | Exception]]:
        """Unwrap the objects whose cones were changed, and store these; returns the map of each, or why there is none.

        placing: as of `finishing.finish`.
        """
        changed = [edited for edited in self.begun if edited.session.cones.changed]
        others = []
        for edited in self._all:
            if edited not in changed:
                with suppress(*object_errors()):
                    edited.begin().restore()
                    others.append(edited.session)
        return list(zip(changed, finish([edited.session for edited in changed], others, placing), strict=True))

    def restore(self) -> None:
        """Leave all meshes as they were."""
        self.stop()
        super().restore()

    def end(self) -> None:
        """Nothing is edited any more."""
        for edited in self._all:
            angle_table.unfollow(edited.uid)
        super().end()
