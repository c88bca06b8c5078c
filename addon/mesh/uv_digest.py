# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells whether a UV map is still the one that a result belongs to, by a digest that is quick to compute."""

from __future__ import annotations

import hashlib

import bpy
import numpy as np

from .reader import reader

# Faces in the digest, spread evenly over the mesh: reading all of them takes too long in edit mode.
FACES = 512


def uv_digest(mesh: bpy.types.Mesh) -> str:
    """A digest of the mesh's size, the active UV layer, and the corners and UVs of a sample of faces.

    It is the same in edit mode and in object mode, and after undo and redo.
    """
    # First, as access to the bmesh invalidates references to layers.
    layer = mesh.uv_layers.active.name if mesh.uv_layers.active is not None else None
    elements = reader(mesh)
    size = elements.size()
    corners, uv = elements.corners(range(0, size[2], max(1, size[2] // FACES)))
    digest = hashlib.blake2b(repr((size, layer)).encode(), digest_size=16)
    digest.update(np.array(corners, np.int32))
    digest.update(uv)
    return digest.hexdigest()
