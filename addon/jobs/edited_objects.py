# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects in edit mode whose cones are edited together, each in a session that begins when it is first touched."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ..core.errors import object_errors
from ..core.screen import Screen
from ..mesh import changes
from ..mesh.cones import marked_cones
from ..mesh.reader import readable_mesh
from ..mesh.stored_mesh import FrozenMesh
from . import angle_table
from .cone_session import ConeSession
from .edit_history import EditHistory
from .edited_cones import ConesState, EditedCones
from .finishing import finish
from .following import Follower
from .maps import PackSettings
from .picking import Hit, Picker
from .unwrapping import Unwrapped, UnwrapSettings


@dataclass(frozen=True, slots=True)
class Sight:
    """What a view shows.

    screen_of: the projection of an object, None where the view does not show it. layout: whether UV maps are shown, as
    by a UV editor, instead of meshes. selected: whether only those of selected faces are.
    """

    screen_of: Callable[[bpy.types.Object], Screen | None]
    layout: bool = False
    selected: bool = False


class EditedObject:
    """An object in edit mode.

    session, follower, start: once it has begun, and the cones of then. holds_layout: whether its map, which follows a
    cone that is dragged in it, is picked as it was.
    """

    def __init__(self, obj: bpy.types.Object, settings: UnwrapSettings) -> None:
        self.obj, self.uid, self.name = obj, obj.data.session_uid, obj.name
        self.session: ConeSession | None = None
        self.follower: Follower | None = None
        self.start: ConesState | None = None
        self.holds_layout = False
        self._settings = settings
        self._layout_picker: Picker | None = None
        self._picked_uv: NDArray[np.float32] | None = None
        self._picked_selected = False

    def begin(self) -> ConeSession:
        """The session, from now on.  Raises Refused, LsgpError."""
        if self.session is None:
            self.session = ConeSession(self.obj, self._settings)
            self.follower = Follower(self.session)
            self.start = self.session.cones.state()
            angle_table.follow(self.uid, self.session.table())
        return self.session

    def picker(self, sight: Sight) -> Picker | None:
        """For the mesh, or for its map as it is; None without a map."""
        if not sight.layout:
            return self._mesh_picker
        mesh = self._mesh
        is_current = self._picked_uv is mesh.uv and self._picked_selected == sight.selected
        if self._layout_picker is None or not (self.holds_layout or is_current):
            self._layout_picker = Picker.of_layout(mesh, selected=sight.selected)
            self._picked_uv, self._picked_selected = mesh.uv, sight.selected
        return self._layout_picker

    @cached_property
    def _mesh_picker(self) -> Picker:
        return Picker.of_mesh(self._mesh)

    def place(self, vertex: int) -> NDArray[np.float32]:
        """(3,) position of a vertex in the object's space."""
        return self._mesh.positions([vertex])[0]

    @property
    def _mesh(self) -> FrozenMesh:
        return self._read if self.session is None else self.session.mesh

    @cached_property
    def _read(self) -> FrozenMesh:
        with readable_mesh(self.obj) as copy:
            return FrozenMesh(copy)

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


class EditedObjects:
    """active: the object whose active cone gets angles; None for none."""

    def __init__(self, objects: Sequence[bpy.types.Object], settings: UnwrapSettings) -> None:
        """Raises Refused, LsgpError where there is only one object and it cannot be edited."""
        self._all = [EditedObject(obj, settings) for obj in objects]
        self.active: EditedObject | None = None
        self._era = changes.era()
        self.history = EditHistory(self._state, self._put)
        if len(self._all) == 1:
            self._all[0].begin()
        for edited in self._all:
            changes.suspend(edited.obj.data)

    @property
    def begun(self) -> list[EditedObject]:
        return [edited for edited in self._all if edited.session is not None]

    @property
    def changed(self) -> bool:
        """Whether any cones differ from those at the start."""
        return any(edited.session.cones.changed for edited in self.begun)

    def count(self) -> int:
        """How many cones there are."""
        return sum(len(edited.cones) for edited in self._all)

    def activate(self, edited: EditedObject) -> EditedObject | None:
        """Begin to edit an object; returns the one that has an active cone no more.  Raises Refused, LsgpError."""
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

    # Picking

    def hold_layouts(self, held: bool) -> None:
        """Whether maps are picked as they are now, while they follow a cone that is dragged."""
        for edited in self._all:
            edited.holds_layout = held

    def vertex_at(self, sight: Sight, x: float, y: float) -> Pick | None:
        """The nearest vertex of the first triangle under a pixel, and its object; None where there is no triangle."""
        found = [(edited, picker.vertex_at(screen, x, y)) for edited, picker, screen in self._shown(sight)]
        return min((pick for pick in found if pick[1] is not None), key=lambda pick: pick[1].depth, default=None)

    def cone_at(self, sight: Sight, x: float, y: float, radius: float) -> Pick | None:
        """The nearest cone to a pixel within a radius, in pixels, that no object hides, and its object."""
        found = [
            (edited, picker.cone_at(screen, edited.cones, x, y, radius))
            for edited, picker, screen in self._shown(sight)
        ]
        seen = [pick for pick in found if pick[1] is not None and (sight.layout or not self._is_behind(pick, sight))]
        return min(seen, key=lambda pick: pick[1].distance, default=None)

    def _is_behind(self, pick: Pick, sight: Sight) -> bool:
        """Whether another object hides a cone."""
        own, hit = pick
        place = own.obj.matrix_world @ Vector(own.place(hit.vertex))
        return any(
            picker.hides(screen, np.array(edited.obj.matrix_world.inverted_safe() @ place))
            for edited, picker, screen in self._shown(sight)
            if edited is not own
        )

    def _shown(self, sight: Sight) -> Iterator[tuple[EditedObject, Picker, Screen]]:
        for edited in self._all:
            screen = sight.screen_of(edited.obj)
            picker = None if screen is None else edited.picker(sight)
            if picker is not None:
                yield edited, picker, screen

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

    def is_intact(self) -> bool:
        """Whether all meshes can still be written to."""
        if changes.era() != self._era:
            return False
        try:
            in_mode = all(edited.obj.mode == "EDIT" for edited in self._all)
        except ReferenceError:
            # An object was removed.
            return False
        return in_mode and all(edited.session.is_intact() for edited in self.begun)

    def doubt(self) -> None:
        """Something else may have changed the meshes."""
        for edited in self.begun:
            edited.session.doubt()

    def follow(self) -> list[EditedObject]:
        """Bring the maps up to date; returns the objects of which a step was shown or failed."""
        return [edited for edited in self.begun if edited.follower.follow()]

    def stop(self) -> None:
        """Stop all computations."""
        for edited in self.begun:
            edited.follower.stop()

    def finish(self, placing: PackSettings) -> list[tuple[EditedObject, Unwrapped | Exception]]:
        """Unwrap the objects whose cones were changed, and store these; the map of each, or why there is none.

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
        for edited in self.begun:
            edited.session.restore()

    def end(self) -> None:
        """Nothing is edited any more."""
        for edited in self._all:
            angle_table.unfollow(edited.uid)
            changes.resume(edited.uid)
