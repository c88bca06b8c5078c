# SPDX-License-Identifier: GPL-3.0-or-later
"""Only the marked seams are cut, and besides them what charts need: the charts of a surface, and the presets."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes, only, pairs, surface
from result_check import undeclared_faults
from test_seams import CUBE, capped_cylinder, islands_of, ring
from zoo.swept import circle, sweep

PRESETS = ("paint", "bake", "tile")
EXACT = lsgp.Options(seams="exact")


def cylinder(*, rims: bool = True, line: bool = True) -> lsgp.Surface:
    """A closed cylinder of 16 sides with some of its seams."""
    mesh, of_rims, of_line = capped_cylinder()
    empty = np.empty((0, 2), np.int32)
    return surface(mesh, seams=np.concatenate([of_rims if rims else empty, of_line if line else empty]))


def torus_with_ring() -> lsgp.Surface:
    mesh = meshes.torus(16, 10)
    edges = meshes.edges_of(mesh.triangles)
    on = (np.abs(mesh.positions[:, 1]) < 1e-9) & (mesh.positions[:, 0] > 0)
    return surface(mesh, seams=edges[on[edges].all(axis=1)])


def beside(one: lsgp.Surface, mesh: meshes.Mesh) -> lsgp.Surface:
    """A surface and a mesh without seams at some distance."""
    return lsgp.Surface(
        np.concatenate([one.positions, mesh.positions + 10]),
        np.concatenate([one.triangles, mesh.triangles + len(one.positions)]),
        seams=one.seams,
    )


def preset(name: str, seams: str) -> lsgp.Options:
    return replace(lsgp.preset_options(name), seams=seams)


@pytest.mark.parametrize("seams", ["exact", "follow"])
@pytest.mark.parametrize("name", PRESETS)
def test_seams_that_suffice_are_all_that_is_cut(name: str, seams: str) -> None:
    marked = cylinder()
    result = lsgp.auto_unwrap(marked, preset=name, options=preset(name, seams))
    assert pairs(result.cut_edges) == pairs(marked.seams) and len(result.cones) == 0
    assert islands_of(result) == 3 and result.distortion.l2_stretch <= 1 + 1e-5
    assert set(result.cut_kinds) == {"seam"}
    assert not {"CUTS_ADDED", "SEAMS_INCOMPLETE"} & set(codes(result.warnings))


@pytest.mark.parametrize("name", PRESETS)
def test_a_developable_wall_is_a_rectangle_and_its_caps_are_regular(name: str) -> None:
    around, along = 16, 6
    path = np.linspace([0, 0, 0], [0, 0, 2], along + 1)
    mesh = sweep(path, circle(1.0, around), closed=False, caps=True)
    rim, line = np.arange(around), around * np.arange(along)
    rims = [np.stack([at + rim, at + np.roll(rim, -1)], 1) for at in (0, around * along)]
    marked = surface(mesh, seams=np.concatenate([*rims, np.stack([line, line + around], 1)]))
    result = lsgp.auto_unwrap(marked, preset=name)
    assert pairs(result.cut_edges) == pairs(marked.seams) and islands_of(result) == 3
    z, outer = oracle.as_complex(result.corner_uv), pairs(marked.seams)
    for island in range(3):
        own = np.flatnonzero(result.island == island)
        corners = [(f, c, (c + 1) % 3) for f in own for c in range(3)]
        sides = np.array([z[f, d] - z[f, c] for f, c, d in corners if pairs([mesh.triangles[f, [c, d]]]) <= outer])
        if len(own) == around:
            assert np.ptp(np.abs(sides)) <= 1e-5 * np.abs(sides).max()
        else:
            quarters = np.angle(sides / sides[0]) / (np.pi / 2)
            assert np.abs(quarters - np.round(quarters)).max() <= 1e-6


@pytest.mark.parametrize("name", PRESETS)
def test_a_tube_between_seams_gets_the_one_cut_that_it_lacks(name: str) -> None:
    rims = cylinder(line=False)
    result = lsgp.auto_unwrap(rims, preset=name)
    extra = pairs(result.cut_edges) - pairs(rims.seams)
    assert len(extra) == 6 and len(result.cones) == 0 and result.distortion.l2_stretch <= 1 + 1e-5
    assert pairs(only(result.warnings, "CUTS_ADDED").elements.indices) == extra
    of_kind = {kind: set() for kind in ("seam", "required")}
    for path, kind in zip(result.cut_paths, result.cut_kinds, strict=True):
        of_kind[kind] |= pairs(np.stack([path[:-1], path[1:]], axis=1))
    assert of_kind == {"seam": pairs(rims.seams), "required": extra}


@pytest.mark.parametrize("name", PRESETS)
def test_only_the_seams_are_cut_though_a_ring_is_stretched_and_the_cut_it_lacks_is_named(name: str) -> None:
    rims = cylinder(line=False)
    result = lsgp.auto_unwrap(rims, preset=name, options=preset(name, "exact"))
    assert pairs(result.cut_edges) == pairs(rims.seams) and result.solved.all()
    missing = pairs(only(result.warnings, "SEAMS_INCOMPLETE").elements.indices)
    assert len(missing) == 6 and not missing & pairs(rims.seams)
    # With these edges marked as well nothing is missing.
    whole = replace(rims, seams=np.array(sorted(pairs(rims.seams) | missing), np.int32))
    again = lsgp.auto_unwrap(whole, preset=name, options=preset(name, "exact"))
    assert "SEAMS_INCOMPLETE" not in codes(again.warnings) and again.distortion.l2_stretch <= 1 + 1e-5


def test_a_washer_lacks_nothing() -> None:
    """A hole about which the metric turns once is no fault of the seams."""
    flat = meshes.hill(12, height=0)
    middle = flat.positions[flat.triangles].mean(axis=1)[:, :2]
    plate = meshes.compact(meshes.make(flat.positions, flat.triangles[np.abs(middle - 6).max(axis=1) > 2]))
    edge = meshes.edges_of(plate.triangles)[:1]
    marked = surface(plate, seams=edge)
    [chart] = lsgp.measure_charts(marked)
    assert not chart.is_disk and chart.borders == 2 and len(chart.missing) == 0
    result = lsgp.auto_unwrap(marked, options=preset("paint", "exact"))
    assert "SEAMS_INCOMPLETE" not in codes(result.warnings) and result.distortion.l2_stretch <= 1 + 1e-6


@pytest.mark.parametrize("name", PRESETS)
def test_handles_that_seams_leave_are_refused_with_the_loops_that_open_them(name: str) -> None:
    mesh = meshes.subdivide(meshes.double_torus())
    marked = surface(mesh, seams=meshes.edges_of(mesh.triangles)[:1])
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.auto_unwrap(marked, preset=name, options=preset(name, "exact"))
    assert caught.value.code == "SEAMS_INCOMPLETE" and caught.value.elements.kind == "edges"
    missing = caught.value.elements.indices
    assert not pairs(missing) & pairs(marked.seams)
    opened = replace(marked, seams=np.concatenate([marked.seams, missing]))
    assert [chart.is_disk for chart in lsgp.measure_charts(opened)] == [True]


def test_a_ring_that_opens_one_handle_of_a_torus_lacks_the_other() -> None:
    marked = torus_with_ring()
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.parameterize(marked, [], options=EXACT)
    assert caught.value.code == "SEAMS_INCOMPLETE"
    opened = replace(marked, seams=np.concatenate([marked.seams, caught.value.elements.indices]))
    result = lsgp.parameterize(opened, [], options=EXACT)
    assert pairs(result.cut_edges) == pairs(opened.seams) and result.flipped.size == 0


def test_a_closed_part_without_seams_is_refused_and_named() -> None:
    ball = meshes.bumpy_sphere(2)
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.auto_unwrap(surface(ball), options=preset("paint", "exact"))
    assert caught.value.code == "SEAMS_INCOMPLETE" and caught.value.elements.kind == "triangles"
    both = beside(cylinder(), ball)
    result = lsgp.auto_unwrap(both, options=preset("paint", "exact"))
    finding = only(result.warnings, "SEAMS_INCOMPLETE")
    assert set(finding.elements.indices.tolist()) == set(np.flatnonzero(~result.solved).tolist())
    assert pairs(result.cut_edges) == pairs(both.seams)


def test_handles_of_one_part_are_named_where_the_others_have_a_map() -> None:
    both = beside(cylinder(), meshes.subdivide(meshes.double_torus()))
    result = lsgp.auto_unwrap(both, options=preset("paint", "exact"))
    assert only(result.warnings, "SEAMS_INCOMPLETE").elements.kind == "edges"
    assert not result.solved.all() and pairs(result.cut_edges) == pairs(both.seams)


def test_cones_on_seams_that_join_them_need_no_further_cut_and_others_are_refused() -> None:
    joined = lsgp.find_cuts(surface(CUBE), CUBE.cones).edges
    result = lsgp.parameterize(surface(CUBE, seams=joined), CUBE.cones, options=EXACT)
    assert pairs(result.cut_edges) == pairs(joined) and len(result.cones) == 8
    assert result.seams.sister_ratio_max <= 1 + 1e-9  # the texture runs on across them
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.parameterize(surface(CUBE, seams=ring(CUBE)), CUBE.cones, options=EXACT)
    assert caught.value.code == "SEAMS_INCOMPLETE" and "cones" in str(caught.value)


def test_no_cones_are_placed_where_only_seams_may_be_cut() -> None:
    marked = cylinder()
    for call in (
        lambda: lsgp.place_cones(marked, seams="exact"),
        lambda: lsgp.cone_gains(marked, seams="exact"),
        lambda: lsgp.auto_unwrap(marked, options=preset("paint", "exact"), count=4),
    ):
        with pytest.raises(lsgp.InputError) as caught:
            call()
        assert caught.value.code == "WRONG_PARAMETER"


def test_overlaps_are_told_and_not_split_where_only_seams_may_be_cut() -> None:
    tape = meshes.make(*_spiral_ramp())
    marked = surface(tape, seams=[[1, 4]])
    exact = lsgp.auto_unwrap(marked, options=preset("paint", "exact"))
    assert pairs(exact.cut_edges) == pairs(marked.seams)
    assert exact.overlapping.size > 0 and "OVERLAPPING_TRIANGLES" in codes(exact.warnings)
    split = lsgp.auto_unwrap(marked)
    assert split.overlapping.size == 0 and len(split.cones) == 0


def _spiral_ramp(turns: float = 1.6, steps: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """A ramp that winds around an axis more than once: developable, and its map lies on itself."""
    angle = 2 * np.pi * turns * np.linspace(0, 1, steps + 1)
    rise = 0.05 * angle
    rims = [np.stack([r * np.cos(angle), r * np.sin(angle), rise], axis=1) for r in (1.0, 1.25, 1.5)]
    positions = np.stack(rims, axis=1).reshape(-1, 3)
    first = (3 * np.arange(steps)[:, None] + [0, 1]).reshape(-1, 1)
    triangles = np.concatenate([first + np.array(corners) for corners in ([0, 1, 4], [0, 4, 3])])
    return positions, triangles.astype(np.int32)


@pytest.mark.parametrize("name", PRESETS[:2])
def test_cones_are_placed_in_the_chart_that_needs_them_alone(name: str) -> None:
    """A ball with a belt of seams high up: its cap is good, the rest is not."""
    ball = meshes.bumpy_sphere(3)
    edges = meshes.edges_of(ball.triangles)
    above = ball.positions[ball.triangles].mean(axis=1)[:, 2] > 0.75 * ball.positions[:, 2].max()
    tail, head, twin = oracle.halfedges(ball.triangles)
    borders = (above[np.arange(len(tail)) // 3]) & ~above[twin // 3]
    belt = np.stack([tail[borders], head[borders]], axis=1)
    assert pairs(belt) <= pairs(edges)
    marked = surface(ball, seams=belt)
    good, bad = sorted(lsgp.measure_charts(marked, preset(name, "exact")), key=lambda chart: chart.l2_stretch)
    assert good.l2_stretch <= 1.05 < bad.l2_stretch
    result = lsgp.auto_unwrap(marked, preset=name)
    of_cap = set(ball.triangles[good.triangles].ravel().tolist())
    assert len(result.cones) > 0 and not of_cap & set(result.cones.tolist())
    within = {pair for pair in pairs(result.cut_edges) - pairs(belt) if set(pair) <= of_cap}
    assert within == set() and pairs(belt) <= pairs(result.cut_edges)


def test_charts_tell_what_they_are() -> None:
    charts = lsgp.measure_charts(cylinder(line=False))
    assert [(chart.euler, chart.borders, chart.is_disk) for chart in charts].count((0, 2, False)) == 1
    assert sorted(len(chart.triangles) for chart in charts) == [16, 16, 192]
    assert sorted(len(chart.missing) for chart in charts) == [0, 0, 6]
    assert all(chart.is_mapped and chart.flipped == chart.overlapping == 0 for chart in charts)
    [whole] = lsgp.measure_charts(surface(meshes.bumpy_sphere(1)))
    assert (whole.euler, whole.borders, whole.is_mapped, whole.l2_stretch) == (2, 0, False, np.inf)


@pytest.mark.parametrize("name", PRESETS)
def test_maps_along_seams_alone_declare_all_their_faults(name: str) -> None:
    for marked in (cylinder(), cylinder(line=False)):
        options = preset(name, "exact")
        result = lsgp.auto_unwrap(marked, preset=name, options=options)
        assert undeclared_faults(marked, result, options) == []


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize(
    "more",
    [
        {"symmetric": False},
        {"creases": False},
        {"target": 1.01},
        {"pack": "shelves"},
        {"weights": lsgp.Weights(islands=0, cuts=0)},
    ],
)
def test_nothing_else_that_is_asked_for_adds_cuts(name: str, more: dict) -> None:
    marked = cylinder()
    if name == "tile" and "pack" in more:
        return
    for seams in ("exact", "follow"):
        result = lsgp.auto_unwrap(marked, preset=name, options=preset(name, seams), **more)
        assert pairs(result.cut_edges) == pairs(marked.seams) and len(result.cones) == 0


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("with_what", ["strokes", "features", "pins"])
def test_only_the_seams_are_cut_with_strokes_features_and_pins(name: str, with_what: str) -> None:
    marked = cylinder()
    options = preset(name, "exact")
    pins = None
    if with_what == "strokes":
        up = np.tile([0.0, 0.0, 1.0], (len(marked.triangles), 1))
        marked, options = replace(marked, directions=up), replace(options, follow_strokes=True)
    elif with_what == "features":
        [wall] = [chart.triangles for chart in lsgp.measure_charts(marked) if len(chart.triangles) > 16]
        edges = np.array(sorted(pairs(meshes.edges_of(marked.triangles[wall])) - pairs(marked.seams)), np.int32)
        across = np.ptp(marked.positions[edges], axis=1)
        marked = replace(marked, features=edges[(across[:, :2] < 0.05).all(axis=1)][:6])
        assert len(marked.features) == 6
    else:
        pins = lsgp.Pins(np.array([0, 60]), np.array([[0.0, 0.0], [0.5, 0.5]]))
    if pins is not None and name == "tile":
        with pytest.raises(lsgp.InputError, match="seamless layout"):
            lsgp.auto_unwrap(marked, preset=name, options=options, pins=pins)
        return
    result = lsgp.auto_unwrap(marked, preset=name, options=options, pins=pins)
    assert pairs(result.cut_edges) == pairs(marked.seams) and len(result.cones) == 0
    if with_what == "strokes":
        assert result.direction_error is not None and result.direction_error < 0.05
    elif with_what == "features":
        assert result.features is not None
        assert result.features.share == 1 or "FEATURES_RELEASED" in codes(result.warnings)
    elif pins is not None:
        np.testing.assert_allclose(result.corner_uv.reshape(-1, 2)[pins.corners], pins.uv, atol=1e-9)
