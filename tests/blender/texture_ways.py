# SPDX-License-Identifier: GPL-3.0-or-later
"""Which way directions on a mesh run in its UV map, as Blender stores it."""

import bmesh
import bpy
import numpy as np
from scenes import edit

STORED = 1e-4  # radians, in single precision


def way_of(obj, direction, *, in_world=True):
    """(f,) complex: what the map makes of a direction at each face, of unit length there; 0 where it is across it."""
    if in_world:
        direction = np.array(obj.matrix_world.to_3x3().inverted()) @ direction
    mesh = obj.data
    uv = np.empty((len(mesh.loops), 2), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv.ravel())
    out = []
    for face in mesh.polygons:
        place = np.array([mesh.vertices[v].co for v in face.vertices][:3])
        z = uv[face.loop_start : face.loop_start + 3] @ [1, 1j]
        edges = place[1:] - place[0]
        normal = np.cross(*edges)
        inside = direction - normal * (normal @ direction) / (normal @ normal)
        image = complex(np.linalg.lstsq(edges.T, inside, rcond=None)[0] @ (z[1:] - z[0]))
        out.append(image / abs(image) if np.linalg.norm(inside) > 1e-3 * np.linalg.norm(direction) else 0)
    return np.array(out)


def off(image, rotation_order=1):
    angle = np.angle(image[image != 0] / 1j)
    turn = 2 * np.pi / rotation_order
    return np.abs(angle - turn * np.round(angle / turn)).max()


def select_edge(obj, vertices):
    edit(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    edge = bm.edges.get([bm.verts[v] for v in vertices])
    bm.select_history.clear()
    bm.select_history.add(edge)
    bmesh.update_edit_mesh(obj.data)
