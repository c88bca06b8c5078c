# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own packer, applied to finished islands before anything is written.

The packer works on the selected UVs of meshes in edit mode. It gets copies in a separate scene, so that it only sees
the solved islands, whatever is selected, hidden or visible, and a failure leaves nothing behind.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import native, versions
from ...core.errors import Refused
from ...core.islands import Islands

LAYER = "UVMap"
REMEDY = "switch Pack Islands off"


def pack_once(
    parts: Sequence[Islands], margin_method: str, margin: float, turn: str | None
) -> list[NDArray[np.float64]]:
    """Pack the islands of all parts together into the unit square; returns the new corner_uv of each part.

    margin_method: of Blender's packer.  turn: how islands may be turned, as the packer calls it; None: not at all.
    The packer computes in single precision, so only the placement is taken from its result.  Raises Refused where
    Blender does not pack.
    """
    with _scratch_meshes(parts) as meshes:
        _run_packer(margin_method, margin, turn)
        bpy.ops.object.mode_set(mode="OBJECT")
        packed = [_read_uv(mesh) for mesh in meshes]
    return [_moved(part, uv) for part, uv in zip(parts, packed, strict=True)]


def _moved(part: Islands, packed: NDArray[np.float64]) -> NDArray[np.float64]:
    squeeze = native.lsgp.correct_aspect((1.0, 1.0), part.aspect)
    placed = native.lsgp.fit_placement(part.corner_uv / squeeze, packed / squeeze, part.island) * squeeze
    has_pins = np.zeros(int(part.island.max()) + 1, bool)
    has_pins[part.island[part.pinned.any(axis=1)]] = True
    return np.where(has_pins[part.island, None, None], part.corner_uv, placed)


def _run_packer(margin_method: str, margin: float, turn: str | None) -> None:
    turning = {"rotate": False} if turn is None else {"rotate": True, "rotate_method": turn}
    try:
        status = bpy.ops.uv.pack_islands(
            **turning, scale=True, margin_method=margin_method, margin=margin, pin=True, pin_method="LOCKED"
        )
    except RuntimeError as error:
        raise Refused(f"Blender's packer failed ({error}); {REMEDY}") from error
    if status != {"FINISHED"}:
        raise Refused(f"Blender's packer did nothing; {REMEDY}")


@contextmanager
def _scratch_meshes(parts: Sequence[Islands]) -> Iterator[list[bpy.types.Mesh]]:
    """Meshes in edit mode with these islands, fully selected, in a temporary scene and context."""
    scene = bpy.data.scenes.new("Cone Unwrap packing")
    layer = scene.view_layers[0]
    made: list[tuple[bpy.types.Object, bpy.types.Mesh]] = []
    images: list[tuple[bpy.types.Material, bpy.types.Image]] = []
    try:
        for part in parts:
            mesh = _scratch_mesh(part)
            obj = bpy.data.objects.new("Cone Unwrap packing", mesh)
            made.append((obj, mesh))
            scene.collection.objects.link(obj)
            obj.select_set(True, view_layer=layer)
            if part.aspect != 1.0:
                images.append(_image_material(part.aspect))
                mesh.materials.append(images[-1][0])
        first, objects = made[0][0], [obj for obj, _ in made]
        with bpy.context.temp_override(**_context_of(scene, objects)):
            # Makes the packer use the selection of the mesh in every version. Set outside this context, it would change
            # the UV selection of the artist's meshes in Blender 5.
            scene.tool_settings.use_uv_select_sync = True
            bpy.ops.object.mode_set(mode="EDIT")
            # Not by foreach_set on the meshes, which crashes Blender 5.0.1 on edges.
            bpy.ops.mesh.select_all(action="SELECT")
            try:
                yield [mesh for _, mesh in made]
            finally:
                if first.mode == "EDIT":
                    bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        bpy.data.batch_remove(
            [scene, *(block for pair in made for block in pair), *(block for pair in images for block in pair)]
        )


def _context_of(scene: bpy.types.Scene, objects: list[bpy.types.Object]) -> dict[str, object]:
    """A context in which these objects are selected, the first one is active, and edit mode is entered with them. It
    has no area: in one of images that shows no UV maps Blender 5.2 does not pack.
    """
    layer = scene.view_layers[0]
    layer.objects.active = objects[0]
    return {
        "area": None,
        "region": None,
        "scene": scene,
        "view_layer": layer,
        "object": objects[0],
        "active_object": objects[0],
        "edit_object": objects[0],
        "selected_objects": objects,
        "selected_editable_objects": objects,
    }


def _scratch_mesh(part: Islands) -> bpy.types.Mesh:
    """Triangles that share vertices only within an island, since shared UVs of shared vertices join islands."""
    keys, vertices = np.unique(
        part.triangles.astype(np.int64) + part.island[:, None] * (int(part.triangles.max()) + 1), return_inverse=True
    )
    mesh = bpy.data.meshes.new("Cone Unwrap packing")
    count = len(part.triangles)
    mesh.vertices.add(len(keys))
    mesh.loops.add(3 * count)
    mesh.polygons.add(count)
    mesh.loops.foreach_set("vertex_index", vertices.ravel().astype(np.int32))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    layer = mesh.uv_layers.new(name=LAYER)
    layer.uv.foreach_set("vector", part.corner_uv.ravel().astype(np.float32))
    if part.pinned.any():
        versions.set_pinned_loops(mesh, LAYER, part.pinned.ravel())
    return mesh


def _image_material(aspect: float) -> tuple[bpy.types.Material, bpy.types.Image]:
    """A material with an image of this aspect ratio, from which the packer takes it."""
    image = bpy.data.images.new("Cone Unwrap packing", 1, 1)
    image.display_aspect = (max(aspect, 1.0), max(1 / aspect, 1.0))
    material = bpy.data.materials.new("Cone Unwrap packing")
    if not versions.has_nodes(material):
        material.use_nodes = True
    nodes = material.node_tree.nodes
    node = nodes.new("ShaderNodeTexImage")
    node.image = image
    nodes.active = node
    return material, image


def _read_uv(mesh: bpy.types.Mesh) -> NDArray[np.float64]:
    uv = np.empty((len(mesh.polygons), 3, 2), np.float32)
    mesh.uv_layers[LAYER].uv.foreach_get("vector", uv.ravel())
    return uv.astype(np.float64)
