# SPDX-License-Identifier: GPL-3.0-or-later
"""One press gives every part of everything selected the same texel density in the world, as the modifiers show it."""

import bpy
import first_press_models
import numpy as np
import pytest
from nightly import nightly
from one_blender import one_blender

pytestmark = pytest.mark.slow


def half_man():
    """A cube beside it, whose flat faces lose nothing."""
    (man,) = first_press_models.man()
    man.modifiers.clear()
    bpy.ops.mesh.primitive_cube_add(location=(5, 0, 0))
    return [first_press_models.without_half(man), bpy.context.object]


def screw():
    """A cube beside it, so that there are two parts to compare."""
    parts = first_press_models.screw()
    bpy.ops.mesh.primitive_cube_add(location=(5, 0, 0))
    return [*parts, bpy.context.object]


def kit():
    """Twelve blocks, balls and cylinders of different sizes in one mesh."""
    random = np.random.RandomState(3)
    adders = (
        bpy.ops.mesh.primitive_cube_add,
        lambda **given: bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8, **given),
        lambda **given: bpy.ops.mesh.primitive_cylinder_add(vertices=12, **given),
    )
    for i in range(12):
        adders[i % 3](location=(4 * i, 0, 0), scale=random.uniform(0.3, 1.5, 3))
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.join()
    return [bpy.context.object]


def scaled():
    """Three objects with one material, scaled alike in all directions, by different amounts."""
    made, material = [], bpy.data.materials.new("Shared")
    adders = (bpy.ops.mesh.primitive_monkey_add, bpy.ops.mesh.primitive_cube_add, bpy.ops.mesh.primitive_torus_add)
    for i, (add, scale) in enumerate(zip(adders, (0.5, 2.0, 1.3), strict=True)):
        add(location=(5 * i, 0, 0))
        bpy.context.object.scale = (scale, scale, scale)
        bpy.context.object.data.materials.append(material)
        made.append(bpy.context.object)
    bpy.context.view_layer.update()
    return made


def cages():
    """A coarse cube and a fine ball in one mesh, and half a scaled ball with Mirror, all made round; a cube stays."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, location=(4, 0, 0))
    ball = bpy.context.object
    bpy.ops.mesh.primitive_cube_add()
    cage = bpy.context.object
    ball.select_set(True)
    bpy.ops.object.join()
    cage.modifiers.new("Subdivision", "SUBSURF").levels = 3
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, location=(0, 8, 0))
    half = first_press_models.without_half(bpy.context.object)
    half.scale = (2, 2, 2)
    bpy.ops.mesh.primitive_cube_add(location=(4, 8, 0))
    bpy.context.view_layer.update()
    return [cage, half, bpy.context.object]


MODELS = {
    "half man": half_man,
    "cages": cages,
    "text": first_press_models.text,
    "screw": screw,
    "kit": kit,
    "kit of thirty": first_press_models.kit,
    "scaled objects": scaled,
}
# In every Blender: what Mirror and Subdivision Surface make.
SAMPLE = [("half man", "PAINT"), ("cages", "PAINT")]
SAMPLE_IN_ONE = [("kit", "PAINT"), ("screw", "BAKE"), ("scaled objects", "BAKE")]
CASES = [(name, preset) for name in MODELS for preset in ("PAINT", "BAKE")]
PARAMETERS = [
    *SAMPLE,
    *one_blender(*SAMPLE_IN_ONE),
    *nightly(*(case for case in CASES if case not in (*SAMPLE, *SAMPLE_IN_ONE))),
]


def part_of_vertices(mesh):
    """Connected vertices have the same number."""
    ends = np.array([edge.vertices[:] for edge in mesh.edges])
    part = np.arange(len(mesh.vertices))
    while True:
        lower = part.copy()
        np.minimum.at(lower, ends[:, 0], part[ends[:, 1]])
        np.minimum.at(lower, ends[:, 1], part[ends[:, 0]])
        lower = lower[lower]
        if (lower == part).all():
            return part
        part = lower


def densities(obj):
    """The square roots of UV area over area in the world, of each connected part as it is shown."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    places = np.array([obj.matrix_world @ vertex.co for vertex in mesh.vertices])
    uv = np.array([loop.uv[:] for loop in mesh.uv_layers.active.data])
    vertices = np.array([triangle.vertices[:] for triangle in mesh.loop_triangles])
    loops = np.array([triangle.loops[:] for triangle in mesh.loop_triangles])
    part = part_of_vertices(mesh)[vertices[:, 0]]
    corners, flat = places[vertices], np.pad(uv, ((0, 0), (0, 1)))[loops]
    area, uv_area = (
        np.bincount(part, np.linalg.norm(np.cross(of[:, 1] - of[:, 0], of[:, 2] - of[:, 0]), axis=1))
        for of in (corners, flat)
    )
    evaluated.to_mesh_clear()
    return np.sqrt(uv_area[area > 0] / area[area > 0])


@pytest.mark.parametrize(("name", "preset"), PARAMETERS)
def test_all_parts_have_one_density(name, preset):
    bpy.ops.object.select_all(action="DESELECT")
    objects = MODELS[name]()
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in objects)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset) == {"FINISHED"}
    found = np.concatenate([densities(obj) for obj in objects])
    assert found == pytest.approx(np.median(found), rel=0.01)


def test_a_density_is_read_and_set_as_the_modifiers_show_it():
    objects = cages()
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in objects)
    bpy.ops.uv.cone_auto_unwrap(preset="PAINT")
    assert bpy.ops.uv.cone_texel_get(use_image=False, texture_size=512) == {"FINISHED"}
    shown = np.concatenate([densities(obj) for obj in objects])
    assert bpy.context.scene.cone_unwrap_texels.density == pytest.approx(512 * np.median(shown), rel=0.01)
    assert bpy.ops.uv.cone_texel_set(use_image=False, texture_size=512, density=77) == {"FINISHED"}
    shown = np.concatenate([densities(obj) for obj in objects])
    assert shown == pytest.approx(77 / 512, rel=0.01)
