# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap with defaults on typical first models: even density, no overlaps, a report of one line."""

import bpy
import numpy as np
import pytest
from first_press_models import MODELS, kit, scan, screw, suzanne, text
from installed import addon
from scenes import UvMap, covered_twice

pytestmark = pytest.mark.slow

cuts = addon.jobs.tasks.cuts
Faces, Groups = addon.mesh.region_read.Faces, addon.mesh.region_read.Groups
# In every Blender: primitives, modifiers that stay on the object or were applied, materials and shared meshes.
LARGE = (suzanne, text, screw, scan, kit)
PRESETS = ("PAINT", "BAKE", "TILE")


def cases(*presets):
    """Models with presets: each with one of PRESETS at every change."""
    return [
        pytest.param(
            model,
            preset,
            id=f"{preset}-{model.__name__}",
            marks=[
                *([] if preset == PRESETS[number % len(PRESETS)] else [pytest.mark.nightly]),
                *([pytest.mark.one_blender] if model in LARGE or preset == "BAKE" else []),
            ],
        )
        for preset in presets
        for number, model in enumerate(MODELS)
    ]


def unwrapped(model, preset, reports):
    """The objects, their maps, one for each mesh, and the report."""
    objects = model()
    bpy.context.view_layer.update()
    reports()
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset) == {"FINISHED"}
    return objects, {obj.data: UvMap(obj) for obj in reversed(objects)}, reports()


def densities_of(obj, uv_map):
    """Lengths in the map by lengths on the subdivided surface in the world, of each island and of all of them, and by
    how much those of the islands differ from that, relative, the root mean square over the surface."""
    region = addon.mesh.region_read.read_region(obj, Faces.ALL, Groups("uv_cones"), subdivided=True)
    places = region.surface.positions[uv_map.vertex[uv_map.triangles]] * region.object_scale
    areas = np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1) / 2
    island = np.unique(np.array(uv_map.island_of_face())[uv_map.face_of_triangle], return_inverse=True)[1]
    in_map = np.abs(uv_map._areas())
    area_of_island = np.bincount(island, areas)
    islands, whole = np.sqrt(np.bincount(island, in_map) / area_of_island), float(np.sqrt(in_map.sum() / areas.sum()))
    return islands, whole, float(np.sqrt(np.average((islands / whole - 1) ** 2, weights=area_of_island)))


def creases_of(obj):
    """The edges at which hard parts end, with cuts where they usually run."""
    region = addon.mesh.region_read.read_region(obj, Faces.ALL, Groups("uv_cones"), subdivided=True)
    region = cuts.with_cut_costs(region, cuts.CutChoice())
    edges = addon.core.native.lsgp.auto_unwrap(region.surface, preset="tile", sharp=region.sharp).borders
    found = {tuple(sorted(edge)) for edge in edges.tolist()}
    return {tuple(sorted(edge)) for edge in region.mesh_edges.tolist() if tuple(sorted(region.stitched[edge])) in found}


@pytest.mark.parametrize(("model", "preset"), cases("PAINT", "BAKE"))
def test_densities_are_alike_nothing_overlaps_and_one_line_is_said(model, preset, reports):
    objects, maps, said = unwrapped(model, preset, reports)
    # Of objects that share a mesh the first decides, whose scale is 1.
    found = [densities_of(obj, maps[obj.data]) for obj in {obj.data: obj for obj in reversed(objects)}.values()]
    islands, wholes, differences = zip(*found, strict=True)
    densities = np.concatenate(islands)
    # Islands have one scale, and what is left of stretch differs between them.
    assert densities.max() / densities.min() < 1.06 and max(differences) < 0.02
    assert max(wholes) / min(wholes) < 1.01
    for uv_map in maps.values():
        assert uv_map.uv.min() >= 0 and uv_map.uv.max() <= 1
        assert uv_map.flipped() == uv_map.overlapping() == set()
    assert covered_twice(maps.values()) == 0
    assert len(said.strip().splitlines()) == 1 and said.startswith("Info: ")


@pytest.mark.parametrize(("model", "preset"), cases("TILE"))
def test_tiles_meet_nothing_is_flipped_and_one_line_is_said(model, preset, reports):
    objects, maps, said = unwrapped(model, preset, reports)
    for obj in objects:
        uv_map = maps[obj.data]
        assert uv_map.flipped() == set()
        assert uv_map.tile_error(but=creases_of(obj)) == 0
    # Of parts of many sizes the smallest may have smaller tiles, which is said as well.
    first, *others = said.strip().splitlines()
    assert first.startswith("Info: ") and all("Tiles are up to" in other for other in others)
