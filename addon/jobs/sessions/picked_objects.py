# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects in edit mode that are edited together with the mouse, and what of them is under a pixel."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, Protocol, TypeVar

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...core.screen import Screen
from ...mesh import changes
from ...mesh.reader import readable_mesh
from ...mesh.stored_mesh import FrozenMesh
from .picking import Hit, PickedPlace, Picker


@dataclass(frozen=True, slots=True)
class Sight:
    """What a view shows.

    screen_of: the projection of an object, None where the view does not show it. layout: whether UV maps are shown, as
    by a UV editor, instead of meshes. selected: whether only those of selected faces are.
    """

    screen_of: Callable[[bpy.types.Object], Screen | None]
    layout: bool = False
    selected: bool = False


class EditSession(Protocol):
    """What is edited of one mesh, until it is restored or stored.  mesh: with its current UVs."""

    mesh: FrozenMesh

    def doubt(self) -> None:
        """Something else may have changed the mesh."""

    def is_intact(self) -> bool:
        """Whether the mesh can still be written to."""

    def restore(self) -> None:
        """Leave the mesh as it was before the session."""


class PickedObject:
    """An object in edit mode.

    holds_layout: whether its map, which follows a drag in it, is picked as it was. session: once it has begun.
    """

    session: EditSession | None = None

    def __init__(self, obj: bpy.types.Object) -> None:
        self.obj, self.uid, self.name = obj, obj.data.session_uid, obj.name
        self.holds_layout = False
        self._layout_picker: Picker | None = None
        self._picked_uv: NDArray[np.float32] | None = None
        self._picked_selected = False

    @property
    def mesh(self) -> FrozenMesh:
        """The mesh with its current UVs."""
        return self.read if self.session is None else self.session.mesh

    @cached_property
    def read(self) -> FrozenMesh:
        """The mesh as it was when this was first asked for."""
        with readable_mesh(self.obj) as copy:
            return FrozenMesh(copy)

    def picker(self, sight: Sight) -> Picker | None:
        """For the mesh, or for its map as it is; None without a map."""
        if not sight.layout:
            return self._mesh_picker
        mesh = self.mesh
        is_current = self._picked_uv is mesh.uv and self._picked_selected == sight.selected
        if self._layout_picker is None or not (self.holds_layout or is_current):
            self._layout_picker = Picker.of_layout(mesh, selected=sight.selected)
            self._picked_uv, self._picked_selected = mesh.uv, sight.selected
        return self._layout_picker

    @cached_property
    def _mesh_picker(self) -> Picker:
        return Picker.of_mesh(self.mesh)


Edited = TypeVar("Edited", bound=PickedObject)
Picked = TypeVar("Picked", Hit, PickedPlace)


class PickedObjects(Generic[Edited]):
    """Several of them, and what was in Blender when they were first looked at."""

    def __init__(self, objects: Sequence[Edited]) -> None:
        self._all = list(objects)
        self._era = changes.era()

    @property
    def begun(self) -> list[Edited]:
        return [edited for edited in self._all if edited.session is not None]

    def is_intact(self) -> bool:
        """Whether all meshes can still be written to."""
        return self._in_edit_mode() and all(edited.session.is_intact() for edited in self.begun)

    def doubt(self) -> None:
        """Something else may have changed the meshes."""
        for edited in self.begun:
            edited.session.doubt()

    def restore(self) -> None:
        """Leave all meshes as they were."""
        for edited in self.begun:
            edited.session.restore()

    def end(self) -> None:
        """Nothing is edited any more."""
        for edited in self._all:
            changes.resume(edited.uid)

    def hold_layouts(self, held: bool) -> None:
        """Whether maps are picked as they are now, while they follow what is dragged."""
        for edited in self._all:
            edited.holds_layout = held

    def vertex_at(self, sight: Sight, x: float, y: float) -> tuple[Edited, Hit] | None:
        """The nearest vertex of the first triangle under a pixel, and its object; None where there is no triangle."""
        return self._first(sight, lambda picker, screen: picker.vertex_at(screen, x, y))

    def place_at(self, sight: Sight, x: float, y: float) -> tuple[Edited, PickedPlace] | None:
        """The place on the first triangle under a pixel, and its object; None where there is no triangle."""
        return self._first(sight, lambda picker, screen: picker.place_at(screen, x, y))

    def _first(self, sight: Sight, pick: Callable[[Picker, Screen], Picked | None]) -> tuple[Edited, Picked] | None:
        """What pick() finds in front of what it finds on other objects, and its object."""
        found = [(edited, pick(picker, screen)) for edited, picker, screen in self._shown(sight)]
        return min((one for one in found if one[1] is not None), key=lambda one: one[1].depth, default=None)

    def nearest(self, sight: Sight, pick: Callable[[Edited, Picker, Screen], Hit | None]) -> tuple[Edited, Hit] | None:
        """What pick() finds nearest in pixels and no other object hides, and its object."""
        found = [(edited, pick(edited, picker, screen)) for edited, picker, screen in self._shown(sight)]
        seen = [one for one in found if one[1] is not None and (sight.layout or not self._is_behind(one, sight))]
        return min(seen, key=lambda one: one[1].distance, default=None)

    def _is_behind(self, pick: tuple[Edited, Hit], sight: Sight) -> bool:
        """Whether another object hides a vertex."""
        own, hit = pick
        place = own.obj.matrix_world @ Vector(own.mesh.positions([hit.vertex])[0])
        return any(
            picker.hides(screen, np.array(edited.obj.matrix_world.inverted_safe() @ place))
            for edited, picker, screen in self._shown(sight)
            if edited is not own
        )

    def _shown(self, sight: Sight) -> Iterator[tuple[Edited, Picker, Screen]]:
        for edited in self._all:
            screen = sight.screen_of(edited.obj)
            picker = None if screen is None else edited.picker(sight)
            if picker is not None:
                yield edited, picker, screen

    def _suspend_changes(self) -> None:
        """Changes of the meshes are those of this editing until its end."""
        for edited in self._all:
            changes.suspend(edited.obj.data)

    def _in_edit_mode(self) -> bool:
        """Whether nothing has been undone and all objects are still in edit mode."""
        if changes.era() != self._era:
            return False
        try:
            return all(edited.obj.mode == "EDIT" for edited in self._all)
        except ReferenceError:
            # An object was removed.
            return False
