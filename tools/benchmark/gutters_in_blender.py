# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's noise texture baked onto one surface by Cycles, for `gutter_table.py`; needs a Python with bpy.

    python tools/benchmark/gutters_in_blender.py SURFACE.npz SIZE MARGIN IMAGES.npz

SURFACE.npz: positions (n, 3), triangles (m, 3), corner_uv (m, 3, 2). IMAGES.npz receives images (SIZE, SIZE), the first
row on top: `empty` without a margin, `covered`, which texels that has, and `extend` and `adjacent`, with the margins of
these types.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from bpy_program import run_as_program

SCALE, DETAIL = 2.0, 2.0


def add_surface(positions: np.ndarray, triangles: np.ndarray, corner_uv: np.ndarray) -> bpy.types.Object:
    """The active and selected object, with a map and a material."""
    mesh = bpy.data.meshes.new("surface")
    mesh.from_pydata(positions.tolist(), [], triangles.tolist())
    mesh.uv_layers.new(name="uv").uv.foreach_set("vector", corner_uv.astype(np.float32).ravel())
    surface = bpy.data.objects.new("surface", mesh)
    bpy.context.scene.collection.objects.link(surface)
    bpy.context.view_layer.objects.active = surface
    surface.select_set(True)
    mesh.materials.append(bpy.data.materials.new("noise"))
    return surface


def add_noise(material: bpy.types.Material, size: int) -> bpy.types.Image:
    """Give the material a solid noise texture; returns the image that it is baked to."""
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    place, noise, light, out, target = (
        nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "TexNoise", "Emission", "OutputMaterial", "TexImage")
    )
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = SCALE, DETAIL
    links.new(place.outputs["Object"], noise.inputs["Vector"])
    links.new(noise.outputs[0], light.inputs["Color"])
    links.new(light.outputs[0], out.inputs["Surface"])
    target.image = bpy.data.images.new("baked", size, size, alpha=True, float_buffer=True)
    target.image.colorspace_settings.name = "Non-Color"
    nodes.active = target
    return target.image


def bake(image: bpy.types.Image, margin: int, kind: str, *, clear: bool = True) -> np.ndarray:
    """(height, width, 4), the top row first."""
    bpy.ops.object.bake(type="EMIT", margin=margin, margin_type=kind, use_clear=clear)
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[::-1]


def main(source: str, size: str, margin: str, target: str) -> None:
    import addon_utils  # installed with bpy

    arrays = np.load(source)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("cycles")
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    surface = add_surface(arrays["positions"], arrays["triangles"], arrays["corner_uv"])
    image = add_noise(surface.active_material, int(size))
    # Noise is never below 0.
    image.pixels.foreach_set(np.full(len(image.pixels), -1.0, np.float32))
    empty = bake(image, 0, "EXTEND", clear=False)[..., 0]
    covered = empty >= 0
    found = {kind.lower().split("_")[0]: bake(image, int(margin), kind) for kind in ("EXTEND", "ADJACENT_FACES")}
    np.savez(
        target,
        empty=np.where(covered, empty, 0),
        covered=covered,
        **{name: pixels[..., 0] for name, pixels in found.items()},
    )


if __name__ == "__main__":
    run_as_program(lambda: main(*sys.argv[1:]))
