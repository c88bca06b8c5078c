# SPDX-License-Identifier: GPL-3.0-or-later
"""The cones of one mesh while they are edited; they are stored on the mesh only at the end."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.cone_angles import ConeAngles, Kind
from ...mesh import angles, cones

LEAST_ANGLE = math.radians(1.0)


@dataclass(frozen=True, slots=True)
class ConesState:
    """Angle and kind of each cone, the connected parts with edited ones and the active one; equal by the cones."""

    cones: dict[int, tuple[float | None, Kind]]
    touched: frozenset[int] = field(compare=False)
    active: int | None = field(compare=False)


class EditedCones:
    """active: the cone that angles are given to; None for none."""

    def __init__(self, marked: ConeAngles, share_of: NDArray[np.int32]) -> None:
        """marked: the cones to start with. share_of: (n,) the connected part of each vertex, -1 for none."""
        self.active: int | None = None
        self._before = {
            vertex: (angle, kind)
            for vertex, angle, kind in zip(marked.cones.tolist(), marked.angles, marked.kinds, strict=True)
        }
        self._cones = dict(self._before)
        self._part_of = share_of
        self._touched: set[int] = set()

    def __contains__(self, vertex: int) -> bool:
        return vertex in self._cones

    @property
    def vertices(self) -> list[int]:
        """Ascending."""
        return sorted(self._cones)

    @property
    def changed(self) -> bool:
        """Whether they differ from those at the start."""
        return self._cones != self._before

    @property
    def touched(self) -> frozenset[int]:
        """The connected parts with edited cones."""
        return frozenset(self._touched)

    def current(self) -> ConeAngles:
        """The cones with their angles."""
        vertices = self.vertices
        chosen = [self._cones[vertex] for vertex in vertices]
        return ConeAngles(np.array(vertices, np.int32), [angle for angle, _ in chosen], [kind for _, kind in chosen])

    def state(self) -> ConesState:
        return ConesState(dict(self._cones), self.touched, self.active)

    def put(self, state: ConesState) -> None:
        """Go back, or forward, to a state."""
        self._cones, self._touched, self.active = dict(state.cones), set(state.touched), state.active

    def add(self, vertex: int) -> None:
        """Add a cone with an automatic angle, unless there is one already, and make it the active one."""
        if vertex not in self._cones:
            self._touch(vertex)
            self._cones[vertex] = (None, Kind.PRESCRIBED)
        self.active = vertex

    def remove(self, vertex: int) -> None:
        self._touch(vertex)
        del self._cones[vertex]
        if self.active == vertex:
            self.active = None

    def move(self, vertex: int) -> bool:
        """Move the active cone with its angle to a vertex, unless there is a cone, or another connected part, which may
        merely be in front.  Returns whether it moved."""
        if vertex in self._cones or self._part_of[vertex] != self._part_of[self.active]:
            return False
        self._touch(vertex)
        self._cones[vertex] = self._cones.pop(self.active)
        self.active = vertex
        return True

    def angle(self, vertex: int) -> float | None:
        """In radians; None for automatic."""
        return self._cones[vertex][0]

    def is_automatic(self, vertex: int) -> bool:
        angle, kind = self._cones[vertex]
        return angle is None or kind == Kind.FOUND

    def set_angle(self, angle: float | None) -> None:
        """Set the angle of the active cone, None for automatic."""
        self._touch(self.active)
        self._cones[self.active] = (None if angle is None else max(angle, LEAST_ANGLE), Kind.PRESCRIBED)

    def store(self, obj: bpy.types.Object, group: str) -> None:
        """Write cones and angles to the mesh, where they differ from those at the start."""
        removed = sorted(self._before.keys() - self._cones.keys())
        if removed:
            cones.clear_cones(obj, group, removed)
        changed = [vertex for vertex in self.vertices if self._cones[vertex] != self._before.get(vertex)]
        if changed:
            cones.mark_cones(obj, group, changed)
        angles.forget_angles(obj, removed + [vertex for vertex in changed if self._cones[vertex][0] is None])
        chosen = [vertex for vertex in changed if self._cones[vertex][0] is not None]
        if chosen:
            values, kinds = zip(*(self._cones[vertex] for vertex in chosen), strict=True)
            angles.write_angles(obj, chosen, values, kinds)

    def _touch(self, vertex: int) -> None:
        """Angles computed for the previous cones of a part are not valid for its new ones."""
        part = int(self._part_of[vertex])
        if part in self._touched or part < 0:
            return
        self._touched.add(part)
        for cone, (_, kind) in self._cones.items():
            if self._part_of[cone] == part and kind == Kind.FOUND:
                self._cones[cone] = (None, Kind.PRESCRIBED)
