# SPDX-License-Identifier: GPL-3.0-or-later
"""What artists press Auto Unwrap on first, made from Blender's own primitives and modifiers."""

from __future__ import annotations

from math import cos, pi, sin

import bpy


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
    """A figure by the Skin modifier, with Subdivision Surface still on it."""
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


def kit() -> list[bpy.types.Object]:
    """One object of twelve loose parts of four kinds and many sizes."""
    for i in range(12):
        place, size = (3 * cos(i * pi / 6), 3 * sin(i * pi / 6), 0.4 * (i % 5)), 0.1 + 0.05 * i
        kind = i % 4
        if kind == 0:
            bpy.ops.mesh.primitive_cube_add(size=size, location=place)
        elif kind == 1:
            bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=size / 2, depth=size, location=place)
        elif kind == 2:
            bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=size / 2, location=place)
        else:
            bpy.ops.mesh.primitive_torus_add(
                major_segments=12, minor_segments=6, major_radius=size, minor_radius=size / 4, location=place
            )
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.join()
    return [bpy.context.object]


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


MODELS = (default_cube, suzanne, text, screw, man, kit, scaled_copies)
