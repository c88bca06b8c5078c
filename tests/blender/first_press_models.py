# SPDX-License-Identifier: GPL-3.0-or-later
"""Typical first models for Auto Unwrap, made from Blender's own primitives and modifiers."""

from __future__ import annotations

import tempfile
from math import cos, pi, sin
from pathlib import Path

import bmesh
import bpy
import numpy as np


def _applied(obj: bpy.types.Object, *modifiers: str) -> bpy.types.Object:
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    for name in modifiers:
        bpy.ops.object.modifier_apply(modifier=name)
    return obj


def default_cube() -> list[bpy.types.Object]:
    bpy.ops.mesh.primitive_cube_add()
    return [bpy.context.object]


def suzanne() -> list[bpy.types.Object]:
    bpy.ops.mesh.primitive_monkey_add()
    return [bpy.context.object]


def without_half(obj: bpy.types.Object) -> bpy.types.Object:
    """The object with what lies at negative x cut off its mesh, and the modifiers that bring it back and smooth all."""
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    everything = [*bm.verts, *bm.edges, *bm.faces]
    # The threshold of Mesh > Bisect; without it vertices beside the plane leave faces without area there.
    bmesh.ops.bisect_plane(bm, geom=everything, dist=1e-4, plane_co=(0, 0, 0), plane_no=(1, 0, 0), clear_inner=True)
    bm.to_mesh(obj.data)
    bm.free()
    obj.modifiers.new("Mirror", "MIRROR")
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    return obj


def half_suzanne() -> list[bpy.types.Object]:
    """One half of the head, with Mirror and Subdivision Surface still on it."""
    return [without_half(suzanne()[0])]


def text() -> list[bpy.types.Object]:
    """Letters with depth, as Object > Convert > Mesh leaves them: sides apart from caps, and n-gons for these."""
    bpy.ops.object.text_add()
    bpy.context.object.data.body = "Cone8"
    bpy.context.object.data.extrude = 0.1
    bpy.context.object.data.resolution_u = 2
    bpy.ops.object.convert(target="MESH")
    return [bpy.context.object]


def screw() -> list[bpy.types.Object]:
    """A thread of four turns: a profile that a Screw modifier winds up."""
    mesh = bpy.data.meshes.new("Screw")
    profile = [(1.0, 0, 0), (1.2, 0, 0.1), (1.2, 0, 0.2), (1.0, 0, 0.3)]
    mesh.from_pydata(profile, [(0, 1), (1, 2), (2, 3)], [])
    obj = bpy.data.objects.new("Screw", mesh)
    bpy.context.collection.objects.link(obj)
    modifier = obj.modifiers.new("Screw", "SCREW")
    modifier.screw_offset, modifier.iterations, modifier.steps = 0.3, 4, 16
    return [_applied(obj, "Screw")]


def man() -> list[bpy.types.Object]:
    """A figure made by the Skin modifier, with Subdivision Surface still on it."""
    mesh = bpy.data.meshes.new("Man")
    half = [(0.5, 0, 0), (0.3, 0, 1), (0.2, 0, 2), (0.9, 0, 3.1), (1.6, 0, 3.0)]
    places = [(0, 0, 2.1), (0, 0, 3.2), (0, 0, 3.5), (0, 0, 4.1)]
    edges = [(0, 1), (1, 2), (2, 3)]
    for side in (1, -1):
        first = len(places)
        places += [(side * x, y, z) for x, y, z in half]
        edges += [(first, first + 1), (first + 1, first + 2), (first + 2, 0), (1, first + 3), (first + 3, first + 4)]
    mesh.from_pydata(places, edges, [])
    obj = bpy.data.objects.new("Man", mesh)
    bpy.context.collection.objects.link(obj)
    obj.modifiers.new("Skin", "SKIN")
    _applied(obj, "Skin")
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    return [obj]


def torus() -> list[bpy.types.Object]:
    bpy.ops.mesh.primitive_torus_add()
    return [bpy.context.object]


def cylinder() -> list[bpy.types.Object]:
    bpy.ops.mesh.primitive_cylinder_add()
    return [bpy.context.object]


def cone() -> list[bpy.types.Object]:
    bpy.ops.mesh.primitive_cone_add()
    return [bpy.context.object]


def beveled_block() -> list[bpy.types.Object]:
    """A block with a hole that a Boolean modifier cut, and all edges beveled."""
    bpy.ops.mesh.primitive_cylinder_add(radius=0.5, depth=4)
    drill = bpy.context.object
    bpy.ops.mesh.primitive_cube_add()
    block = bpy.context.object
    block.data.transform(np.diag([1.5, 1, 0.7, 1]))
    modifier = block.modifiers.new("Boolean", "BOOLEAN")
    modifier.object, modifier.operation = drill, "DIFFERENCE"
    bevel = block.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.05, 2
    _applied(block, "Boolean", "Bevel")
    bpy.data.objects.remove(drill)
    return [block]


def scan() -> list[bpy.types.Object]:
    """A lumpy stone with the noise of a scanner, written to a file and imported from there."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5)
    stone = bpy.context.object
    noise = np.random.default_rng(0)
    for vertex in stone.data.vertices:
        x, y, z = vertex.co
        lump = 0.25 * sin(3 * x + 1) * cos(2 * y - z) + 0.12 * sin(7 * z + 2 * y) + 0.004 * noise.standard_normal()
        vertex.co *= 1 + lump
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder, "scan.ply"))
        bpy.ops.wm.ply_export(filepath=file, export_selected_objects=True, export_uv=False, export_normals=False)
        bpy.data.objects.remove(stone)
        bpy.ops.wm.ply_import(filepath=file)
    return [bpy.context.object]


def kit() -> list[bpy.types.Object]:
    """One object of thirty loose parts of four kinds and many sizes."""
    for i in range(30):
        place, size = (3 * cos(i * pi / 15), 3 * sin(i * pi / 15), 0.4 * (i % 5)), 0.1 + 0.02 * i
        kind = i % 4
        if kind == 0:
            bpy.ops.mesh.primitive_cube_add(size=size, location=place)
        elif kind == 1:
            bpy.ops.mesh.primitive_cylinder_add(vertices=8, radius=size / 2, depth=size, location=place)
        elif kind == 2:
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=size / 2, location=place)
        else:
            bpy.ops.mesh.primitive_torus_add(
                major_segments=8, minor_segments=4, major_radius=size, minor_radius=size / 4, location=place
            )
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.join()
    return [bpy.context.object]


def mirrored() -> list[bpy.types.Object]:
    """One half of a ball, with Mirror and then Subdivision Surface still on it, beside a smaller one without."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.3, location=(3, 0, 0))
    small = bpy.context.object
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    half = without_half(bpy.context.object)
    small.select_set(True)
    return [half, small]


def one_material() -> list[bpy.types.Object]:
    """Three meshes with one material, two of them scaled in object mode."""
    material, objects = bpy.data.materials.new("Shared"), []
    for i, scale in enumerate([(1, 1, 1), (3, 3, 3), (0.4, 0.4, 0.4)]):
        bpy.ops.mesh.primitive_torus_add(major_segments=10, minor_segments=5, location=(4 * i, 0, 0))
        bpy.context.object.scale = scale
        bpy.context.object.data.materials.append(material)
        objects.append(bpy.context.object)
    for obj in objects:
        obj.select_set(True)
    return objects


def scaled_copies() -> list[bpy.types.Object]:
    """Three objects of one mesh with other scales, one of them unequal along the axes, beside a mesh of its own."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, location=(0, 6, 0))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8)
    first = bpy.context.object
    objects = [first]
    for i, scale in enumerate([(2, 2, 2), (0.5, 0.5, 0.5)], 1):
        copy = bpy.data.objects.new(f"Copy {i}", first.data)
        copy.scale, copy.location.x = scale, 5.0 * i
        bpy.context.collection.objects.link(copy)
        objects.append(copy)
    for obj in bpy.context.collection.objects:
        obj.select_set(True)
    return [*objects, bpy.context.collection.objects["Cylinder"]]


MODELS = (
    default_cube,
    suzanne,
    half_suzanne,
    text,
    screw,
    torus,
    cylinder,
    cone,
    beveled_block,
    scan,
    man,
    kit,
    mirrored,
    one_material,
    scaled_copies,
)
