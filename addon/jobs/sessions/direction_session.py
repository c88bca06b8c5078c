# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing the texture's upward direction on a mesh in edit mode; nothing is written until the session is stored."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...mesh import changes
from ...mesh.reader import readable_mesh
from ...mesh.region_read import require_editable
from ...mesh.stored_mesh import FrozenMesh, StoredMesh
from ...mesh.texture_up import Directions, directions_in, require_up_attribute, write_directions

# Part of a step on a face that has to lie in its plane.
LEAST_INSIDE = 1e-3


class DirectionSession:
    """directions: as they are drawn. mesh: as it was at the start."""

    def __init__(self, obj: bpy.types.Object, mesh: FrozenMesh) -> None:
        """Raises Refused."""
        require_editable(obj)
        require_up_attribute(obj.data)
        self._obj, self.mesh = obj, mesh
        self._era, self._doubted = changes.era(), False
        self._start = directions_in(mesh)
        self.directions: Directions = dict(self._start)
        self._stroke: dict[int, NDArray[np.float64]] = {}

    @property
    def changed(self) -> bool:
        return self.directions != self._start

    def begin_stroke(self) -> None:
        """What is drawn from now on replaces what was drawn before on the same faces."""
        self._stroke = {}

    def draw(self, face: int, step: NDArray[np.float64]) -> None:
        """A stroke goes on over a face by a step, (3,); the direction there is that of all its steps together."""
        total = self._stroke.get(face, np.zeros(3)) + step
        self._stroke[face] = total
        normal = self.mesh.face_normals[face].astype(np.float64)
        inside = total - normal * (normal @ total)
        length = np.linalg.norm(inside)
        if length > LEAST_INSIDE * np.linalg.norm(total):
            # As the attribute stores it.
            self.directions[face] = tuple((inside / length).astype(np.float32).tolist())

    def erase(self, face: int) -> None:
        """Leave a face without direction."""
        self.directions.pop(face, None)

    def put(self, directions: Directions) -> None:
        """Go back or on to earlier directions."""
        self.directions = dict(directions)

    def store(self) -> None:
        """Write the directions to the mesh."""
        write_directions(self._obj.data, self.directions)

    # As every session

    def doubt(self) -> None:
        """Something else may have changed the mesh."""
        self._doubted = True

    def is_intact(self) -> bool:
        """Whether the mesh can still be written to."""
        if changes.era() != self._era:
            return False
        if self._doubted:
            with readable_mesh(self._obj) as copy:
                if not np.array_equal(StoredMesh(copy).loop_vertices, self.mesh.loop_vertices):
                    return False
            self._doubted = False
        return True

    def restore(self) -> None:
        """Nothing was written."""
