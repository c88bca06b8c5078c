# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of errors and warnings: true, once each, in degrees, by severity, with codes in the log alone."""

import re

import bpy
import numpy as np
import pytest
from installed import addon
from logged import logged, refused
from scenes import add_cone_cube, add_grid, add_object, add_sphere, corners, edit, select_elements

findings, wording = addon.core.findings, addon.core.wording
Severity = findings.Severity
lsgp = addon.core.native.lsgp


def finding(code="NOT_SYMMETRIC", message="Something is off. Mend it.", vertices=()):
    return lsgp.Finding(code, message, lsgp.Elements("vertices", np.array(vertices, np.int32)))


@pytest.mark.parametrize(
    ("message", "shown"),
    [
        (
            "The 8 cone angles leave a curvature of 630 degrees in sum, but this surface requires 720 degrees.",
            "The 8 cone angles leave a curvature of 630° in sum, but this surface requires 720°.",
        ),
        ("A curvature of -45 degrees has to go somewhere.", "A curvature of -45° has to go somewhere."),
        ("A part was left as it is (TOO_FEW_CONES): Mark cones.", "A part was left as it is: Mark cones."),
        ("Its L2 stretch is 9.95139, 1 being none.", "Its stretch is 9.951, 1 being none."),
        ("Mark cones, or place them automatically.", "Mark cones, or use Auto Unwrap."),
        ("12 triangles overlap others in the layout.", "12 triangles overlap others in the layout."),
    ],
)
def test_the_librarys_sentences_are_put_into_an_artists_words(message, shown):
    assert wording.for_artists(message) == shown


def test_the_same_sentence_is_said_once_with_a_count():
    alike = [finding()] * 19
    assert findings.in_groups({"Teapot": alike}) == [
        (Severity.ATTENTION, "Teapot: Something is off. Mend it. (19 times)")
    ]
    many = {f"Part {number}": [finding()] for number in range(5)}
    assert findings.in_groups(many) == [
        (Severity.ATTENTION, "Part 0, Part 1, Part 2 and 2 more objects: Something is off. Mend it.")
    ]


def test_the_most_severe_comes_last():
    error = lsgp.SolverError("SOLVER_FAILED", "It failed.")
    lines = findings.in_groups({"A": [error], "B": [finding("SPLIT_VERTEX", "Parts touch."), finding()]})
    assert [severity for severity, _ in lines] == [Severity.INFORMATION, Severity.ATTENTION, Severity.BROKEN]


def test_kept_findings_are_grouped_with_all_their_elements():
    cube = add_cone_cube()
    region = addon.mesh.region_read.read_region(cube, addon.mesh.region_read.Faces.ALL, addon.mesh.region_read.Groups())
    findings.keep(cube, region, [finding(vertices=[3]), finding("SPLIT_VERTEX", "Parts touch."), finding(vertices=[5])])
    first, second = findings.last(cube)
    assert (first.times, first.elements.vertices.tolist()) == (2, [3, 5])
    assert (second.times, second.severity) == (1, Severity.INFORMATION)


def test_vertices_that_are_not_selected_are_not_called_isolated(reports):
    grid = add_grid()
    edit(grid)
    select_elements(grid, "faces", [0, 1, 2])
    reports()
    for call in (bpy.ops.uv.cone_unwrap, bpy.ops.uv.cone_auto_unwrap, bpy.ops.mesh.cone_place):
        assert call() == {"FINISHED"}
        assert "belong" not in reports()
        assert findings.last(grid) == []


def test_vertices_without_faces_are_information(reports):
    def build(bm):
        bm.faces.new([bm.verts.new(place) for place in ((0, 0, 0), (1, 0, 0), (0, 1, 0))])
        bm.verts.new((5, 5, 5))
        bm.loops.layers.uv.new("UVMap")

    obj = add_object("Loose", build)
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    said = reports()
    assert "Info: Loose: 1 vertex belongs to no face" in said and "Warning" not in said
    (kept,) = findings.last(obj)
    assert kept.severity == Severity.INFORMATION and kept.elements.vertices.tolist() == [3]


def half_with_touching_pieces():
    """Two faces on one side of the plane across X that touch each other in it, at a single vertex."""

    def build(bm):
        places = [(0, 0, 0), (0, -1, 0), (1, -1, 0), (1, 1, 0), (0, 1, 0)]
        own = [bm.verts.new((x, y + 3, z + 3)) for x, y, z in places]
        for numbers in ((0, 1, 2), (0, 3, 4)):
            bm.faces.new([own[i] for i in numbers])

    return add_object("Half", build)


@pytest.mark.parametrize("preset", ["PAINT", "TILE", "BAKE"])
def test_nothing_is_said_of_vertices_at_which_a_half_touches_its_image(preset, reports):
    half = half_with_touching_pieces()
    plane = bpy.data.objects.new("Plane", None)
    bpy.context.collection.objects.link(plane)

    def is_told():
        bpy.context.view_layer.update()
        reports()
        assert bpy.ops.uv.cone_auto_unwrap(preset=preset) == {"FINISHED"}
        told = "1 vertex separate pieces of the surface touch" in reports()
        assert told == any("touch" in found.text for found in findings.last(half))
        return told

    assert is_told()
    mirror = half.modifiers.new("Mirror", "MIRROR")
    assert not is_told()
    mirror.use_mirror_merge = False
    assert is_told()
    mirror.use_mirror_merge, mirror.use_axis = True, (False, True, True)
    assert is_told()
    # The plane of another object, which the half may lie beside.
    mirror.use_axis, mirror.mirror_object = (True, False, False), plane
    half.location.x = plane.location.x = 2
    assert not is_told()
    plane.location.x = 1
    assert is_told()


def test_codes_are_in_the_log_and_not_in_reports(reports):
    add_sphere()
    reports()
    with refused("TOO_FEW_CONES", "720°"):
        bpy.ops.uv.cone_unwrap()
    assert not re.search(r"[A-Z]+_[A-Z]+", reports())


def test_one_map_has_one_stretch(reports):
    bpy.ops.mesh.primitive_monkey_add()
    reports()
    with logged() as codes:
        bpy.ops.uv.cone_unwrap()
    assert codes == ["NO_CONES_MARKED"]
    said = reports()
    (stretched,), (percent,) = re.findall(r"stretched: (\d+\.\d+)", said), re.findall(r"([\d.]+) % stretch", said)
    assert float(stretched) == pytest.approx(1 + float(percent) / 100, rel=1e-2)


def test_cones_are_named_by_what_is_wrong_with_them_in_degrees():
    cube = add_cone_cube()
    edit(cube)
    with refused("CONE_ANGLE_RANGE", r"^(?!.* degrees\b)"):
        bpy.ops.mesh.cone_set_angle(vertex=corners(cube)[0], angle=30.0)
