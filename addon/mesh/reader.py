# SPDX-License-Identifier: GPL-3.0-or-later
"""The one way to read a mesh.

In edit mode the data is in a bmesh, which gives no access to whole arrays; a copy of the mesh does. So there are two
readers: `EditedMesh` for a few elements of a mesh in edit mode, and `StoredMesh` for everything else.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from .edited_mesh import EditedMesh
from .mesh_reader import MeshReader
from .stored_mesh import StoredMesh


def reader(mesh: bpy.types.Mesh) -> MeshReader:
    """The reader for the mode that the mesh is in."""
    return EditedMesh(mesh) if mesh.is_editmode else StoredMesh(mesh)


@contextmanager
def readable_mesh(obj: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The current mesh. In edit mode it is a copy, because Blender hides the attributes of a mesh in edit mode."""
    if obj.mode != "EDIT":
        yield obj.data
        return
    obj.update_from_editmode()
    copy = obj.data.copy()
    try:
        yield copy
    finally:
        bpy.data.meshes.remove(copy)
