# SPDX-License-Identifier: GPL-3.0-or-later
"""Components whose creases carry part of their curvature end there if their maps gain by it."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import pairs, surface
from meshes import Mesh
from sanitized_run import many_solves
from zoo import closed

# Of what is not made, in hundredths of L2 stretch.
ERROR_OF_ESTIMATES = 0.15
BARRELS = [
    *((16, 6, 1.3), (24, 5, 1.3)),
    *many_solves((20, 9, 1.6), (32, 9, 1.3)),
]


def barrel(around: int, rings: int, height: float) -> Mesh:
    z = np.linspace(-1, 1, rings)
    return closed.lathe(1 - 0.25 * z**2, height * z, around, caps=(True, True))


def scaled(mesh: Mesh, size: float) -> Mesh:
    return meshes.make(size * mesh.positions, mesh.triangles)


# Of which creases alone decide where barrels end.
NO_STRIPS = lsgp.Weights(strips=0.0)


def compares_borders(result: lsgp.Result) -> bool:
    return any(choice.name == "boundaries at creases" for choice in result.choices)


def final_cost(result: lsgp.Result) -> float:
    """What the map costs, in hundredths of L2 stretch."""
    return [choice.cost for choice in result.choices if choice.is_best and choice.cost is not None][-1]


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize(("around", "rings", "height"), BARRELS)
def test_a_barrel_ends_at_its_rims(around: int, rings: int, height: float, preset: lsgp.Preset) -> None:
    mesh = barrel(around, rings, height)
    z = mesh.positions[:, 2]
    result = lsgp.auto_unwrap(surface(mesh), preset=preset)
    cones = lsgp.auto_unwrap(surface(mesh), preset=preset, creases=False)
    assert len(result.cones) == 0 < len(cones.cones)
    assert len(result.flipped) == 0 == len(result.overlapping)
    assert result.distortion.l2_stretch - 1 <= 0.5 * (cones.distortion.l2_stretch - 1)
    rims = {
        e for e in pairs(meshes.edges_of(mesh.triangles)) if abs(z[list(e)]).min() == height and np.ptp(z[[*e]]) == 0
    }
    middles = np.flatnonzero((abs(z) == height) & (np.linalg.norm(mesh.positions[:, :2], axis=1) == 0))
    rims = {e for e in rims if not set(e) & set(middles.tolist())}
    # The texture runs on across the cut between them, unless it is a border, too.
    assert rims <= pairs(result.borders) and len(result.borders) in (2 * around, 2 * around + rings - 1)


@pytest.mark.parametrize(("around", "neck"), [(16, 0.2), (20, 0.3), (32, 0.18)])
def test_a_bottle_ends_at_its_creases_and_needs_no_cones(around: int, neck: float) -> None:
    """With a narrow neck the pieces save less of the stretch than so many islands would be worth by that alone."""
    radius = np.array([0.5, 0.5, 0.45, 0.3, neck, neck, neck + 0.04, neck + 0.04])
    height = np.array([0, 1.2, 1.35, 1.55, 1.7, 2.1, 2.12, 2.2])
    bottle = surface(closed.lathe(radius, height, around, caps=(True, True)))
    found, cones = (lsgp.auto_unwrap(bottle, creases=creases, pack="shelves") for creases in (True, False))
    assert len(found.cones) == 0 < len(cones.cones)
    assert found.distortion.l2_stretch - 1 < 0.8 * (cones.distortion.l2_stretch - 1)


@pytest.mark.parametrize("rings", [5, 9, 12, 17])
def test_many_small_bends_make_no_flat_face(rings: int) -> None:
    """Across it, one rim would be beside the other, which bends alike."""
    mesh = barrel(24, rings, 1.0)
    assert len(lsgp.crease_borders(surface(mesh), least_share=0.5)) == 2 * 24 + rings - 1
    assert len(lsgp.crease_borders(surface(mesh))) == 0


def test_maps_are_compared_only_where_one_is_stretched_and_has_creases() -> None:
    for mesh, has_more in ((meshes.bumpy_sphere(3), False), (barrel(24, 5, 1.3), True)):
        assert compares_borders(lsgp.auto_unwrap(surface(mesh), pack="shelves", weights=NO_STRIPS)) == has_more


@pytest.mark.parametrize(
    ("mesh", "preset"),
    [
        (meshes.cube(3), "paint"),  # exact without borders
        (meshes.cube(3), "tile"),  # no map for creases
        (barrel(24, 5, 1.3), "paint"),  # better with borders
        (meshes.merge([barrel(24, 5, 1.3), scaled(barrel(24, 5, 1.3), 0.35)]), "paint"),  # of which one gains
    ],
    ids=["exact", "seamless", "bordered", "one of two"],
)
def test_progress_ends_at_one_whichever_maps_are_made(mesh: Mesh, preset: lsgp.Preset) -> None:
    told: list[float] = []
    lsgp.auto_unwrap(surface(mesh), preset=preset, pack="shelves", progress=told.append)
    assert told[-1] == 1.0 and told == sorted(told)


def extruded(profile: list[str], depth: int) -> Mesh:
    """Unit cubes, as many behind each other, where the profile has an x; their inner faces are not there."""
    return meshes.voxels(np.repeat(np.array([[c == "x" for c in row] for row in profile])[:, :, None], depth, axis=2))


FULLER = {
    "stairs": extruded(["x...", "xx..", "xxx.", "xxxx"], 6),
    "angle": extruded(["xxx", "x..", "x.."], 1),
    "channel": extruded(["xxx", "x.x", "x.x"], 8),
    "block": extruded(["x"], 2),
}


@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("name", FULLER)
def test_what_unfolds_exactly_through_cones_ends_at_creases_only_where_that_costs_less(
    name: str, preset: lsgp.Preset
) -> None:
    given = surface(FULLER[name])
    found, cones = (lsgp.auto_unwrap(given, preset=preset, creases=creases) for creases in (True, False))
    assert found.distortion.l2_stretch == pytest.approx(1, abs=1e-9)
    assert len(found.flipped) == 0 == len(found.overlapping)
    assert final_cost(found) <= final_cost(cones) + ERROR_OF_ESTIMATES


def test_each_component_is_judged_by_itself() -> None:
    """What is small beside others gets no islands of its own, where that is seen before and after the comparison."""
    large = barrel(24, 5, 1.3)
    assert len(lsgp.auto_unwrap(surface(scaled(large, 0.05))).borders)
    for size in (0.05, 0.35):
        both = surface(meshes.merge([meshes.bumpy_sphere(2), large, scaled(large, size)]))
        result = lsgp.auto_unwrap(both, pack="shelves", symmetric=False, weights=NO_STRIPS)
        ball = len(meshes.bumpy_sphere(2).positions)
        is_of_large = (result.borders >= ball) & (result.borders < ball + len(large.positions))
        assert is_of_large.all() and len(result.borders) == len(
            lsgp.auto_unwrap(surface(large), weights=NO_STRIPS).borders
        )
        assert result.cones.min() < ball and result.cones.max() >= ball + len(large.positions)


def test_what_the_artist_asks_for_is_not_compared() -> None:
    given = surface(barrel(24, 5, 1.3))
    placed = lsgp.place_cones(given)
    assert not len(lsgp.auto_unwrap(given, placed.cones).borders)
    assert not len(lsgp.auto_unwrap(given, count=6).borders)
    assert not len(lsgp.auto_unwrap(given, creases=False).borders)
    pins = lsgp.Pins([0, 1], [[0.0, 0.0], [0.1, 0.0]])
    assert not len(lsgp.auto_unwrap(given, pins=pins).borders)
    sides = replace(lsgp.preset_options("paint"), border="straight")
    assert not len(lsgp.auto_unwrap(given, options=sides).borders)
