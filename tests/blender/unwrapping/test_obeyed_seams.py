# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap cuts marked seams alone where they suffice, or nothing else at all, and names what is missing."""

import bmesh
import bpy
import pytest
from logged import logged, refused
from scenes import UvMap, add_object, add_sphere, edges_where, edit, mark_seams, snapshot

PRESETS = ["PAINT", "TILE", "BAKE"]
SIDES, RINGS = 12, 4


def add_can():
    """A closed cylinder with polygons as ends, its rims and one line along it."""

    def build(bm):
        bmesh.ops.create_cone(bm, cap_ends=True, segments=SIDES, radius1=1, radius2=1, depth=2)
        upright = [edge for edge in bm.edges if abs(edge.verts[0].co.z - edge.verts[1].co.z) > 1]
        bmesh.ops.subdivide_edges(bm, edges=upright, cuts=RINGS - 1)

    can = add_object("Can", build)
    rims = edges_where(can, lambda place: abs(abs(place[2]) - 1) < 1e-5)
    first = can.data.vertices[0].co
    line = edges_where(can, lambda place: abs(place[0] - first.x) + abs(place[1] - first.y) < 1e-5)
    assert (len(rims), len(line)) == (2 * SIDES, RINGS)
    return can, rims, line


@pytest.mark.parametrize("seams", ["FOLLOW", "EXACT"])
@pytest.mark.parametrize("preset", PRESETS)
def test_seams_that_suffice_are_all_that_is_cut(preset, seams):
    can, rims, line = add_can()
    mark_seams(can, rims | line)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset, seams=seams) == {"FINISHED"}
    uv_map = UvMap(can)
    assert uv_map.split_edges() == rims | line and uv_map.islands() == 3


# With Tile the texture is upright on the wall, which no ring can be.
@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_the_edges_that_are_missing_are_selected(preset):
    can, rims, _ = add_can()
    mark_seams(can, rims)
    with logged() as codes:
        assert bpy.ops.uv.cone_auto_unwrap(preset=preset, seams="EXACT") == {"FINISHED"}
    assert "SEAMS_INCOMPLETE" in codes and UvMap(can).split_edges() == rims
    edit(can, select="DESELECT")
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    chosen = {tuple(sorted(v.index for v in e.verts)) for e in bmesh.from_edit_mesh(can.data).edges if e.select}
    assert len(chosen) == RINGS and not chosen & rims
    bpy.ops.mesh.mark_seam()
    with logged() as codes:
        bpy.ops.mesh.select_all(action="SELECT")
        assert bpy.ops.uv.cone_auto_unwrap(preset=preset, seams="EXACT") == {"FINISHED"}
    assert "SEAMS_INCOMPLETE" not in codes
    bpy.ops.object.mode_set(mode="OBJECT")
    assert UvMap(can).split_edges() == rims | chosen


def test_what_no_seam_opens_is_refused_and_nothing_changes():
    ball = add_sphere()
    before = snapshot(ball)
    with refused("SEAMS_INCOMPLETE", match="no marked seam opens it"):
        bpy.ops.uv.cone_auto_unwrap(seams="EXACT")
    assert snapshot(ball) == before


def test_the_meaning_of_seams_is_offered_in_words_of_artists_and_old_values_still_hold():
    items = bpy.ops.uv.cone_auto_unwrap.get_rna_type().properties["seams"].enum_items
    assert [items[name].name for name in ("EXACT", "FOLLOW", "IGNORE")] == [
        "Mine Only",
        "Mine and Automatic",
        "Ignore",
    ]
    # Keymaps of earlier versions hold numbers.
    assert [items[name].value for name in ("FOLLOW", "BOUNDARY", "IGNORE")] == [0, 1, 2]
