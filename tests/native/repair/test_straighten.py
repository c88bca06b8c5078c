# SPDX-License-Identifier: GPL-3.0-or-later
"""Sides of a layout that are nearly straight come out exactly straight and along u and v, where that costs hardly any
stretch; isometric maps, round holes and all transitions stay as they are."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import zoo
from map_checks import assert_angles_met, assert_exact_transitions, surface
from meshes import Mesh
from zoo import closed

LOW_STRETCH = lsgp.Options(mode="low-stretch")


def barrel(around: int = 24, along: int = 6, bulge: float = 0.06) -> Mesh:
    """The side of a barrel, widest in the middle."""
    height = np.linspace(0, 2, along + 1)
    return closed.lathe(1 + bulge * np.sin(np.pi * height / 2), height, around, caps=(False, False))


def panel(cells: int = 12, bulge: float = 1.0) -> Mesh:
    """A rectangle that is bulged into a dome, its border straight in space."""
    return meshes.grid(
        cells, cells + 4, lambda x, y: bulge * np.sin(np.pi * x / cells) * np.sin(np.pi * y / (cells + 4))
    )


def sheet(shear: float, bulge: float = 0.0) -> Mesh:
    """A trapezoid whose upright sides lean by `shear` radians to each other."""
    mesh = panel(8, bulge)
    positions = mesh.positions.copy()
    positions[:, 0] *= 1 + shear * positions[:, 1] / 8
    return mesh._replace(positions=positions)


NEARLY_RECTANGLES = {"barrel": barrel(), "panel": panel(), "saddle": meshes.saddle(8, 0.04)}
every_shape = pytest.mark.parametrize("name", NEARLY_RECTANGLES)


def unwrapped(mesh: Mesh, straighten: bool = True) -> lsgp.Result:
    return lsgp.parameterize(surface(mesh), (), options=replace(LOW_STRETCH, straighten=straighten))


@cache
def of(name: str, straighten: bool = True) -> lsgp.Result:
    return unwrapped(NEARLY_RECTANGLES[name], straighten)


def outline(mesh: Mesh, result: lsgp.Result) -> np.ndarray:
    """(s, 2) complex: both ends of every edge at which the layout ends."""
    z = result.corner_uv[..., 0] + 1j * result.corner_uv[..., 1]
    twin = oracle.halfedges(oracle.cut_open(mesh.triangles, result.cut_edges).corner)[2]
    return np.stack([z, np.roll(z, -1, axis=1)], axis=-1).reshape(-1, 2)[twin < 0]


def share_along_axes(mesh: Mesh, result: lsgp.Result) -> float:
    """Of the outline's length, with both ends at the same u or v to the last bits."""
    along = np.diff(outline(mesh, result), axis=1)[:, 0]
    length = np.abs(along)
    return float(length[np.minimum(np.abs(along.real), np.abs(along.imag)) < 1e-14].sum() / length.sum())


@every_shape
def test_a_surface_with_four_nearly_straight_sides_becomes_a_rectangle(name: str) -> None:
    mesh = NEARLY_RECTANGLES[name]
    assert share_along_axes(mesh, of(name, False)) < 0.2
    ends = outline(mesh, of(name))
    sides = [ends.real == edge for edge in (ends.real.min(), ends.real.max())]
    sides += [ends.imag == edge for edge in (ends.imag.min(), ends.imag.max())]
    assert np.logical_or.reduce([both.all(axis=1) for both in sides]).all()


@every_shape
def test_straight_sides_cost_hardly_any_stretch_and_keep_the_map_valid(name: str) -> None:
    mesh, straight, natural = NEARLY_RECTANGLES[name], of(name), of(name, False)
    assert_angles_met(mesh, straight)
    assert_exact_transitions(mesh, straight)
    np.testing.assert_array_equal(straight.cut_edges, natural.cut_edges)
    stretched = oracle.distortion(mesh.positions, mesh.triangles, straight.corner_uv)["l2_stretch"]
    assert natural.distortion.l2_stretch < stretched < natural.distortion.l2_stretch + 0.002


def test_a_rectangle_has_the_least_energy_among_its_neighbors() -> None:
    """Vertices may slide along their side, sides may move, and nothing that they can do lowers the energy."""
    mesh, result = NEARLY_RECTANGLES["panel"], of("panel")
    uv = np.zeros((len(mesh.positions), 2))
    uv[mesh.triangles] = result.corner_uv
    low, high = uv.min(axis=0), uv.max(axis=0)
    least = oracle.symmetric_dirichlet(mesh.positions, mesh.triangles, result.corner_uv)
    rng = np.random.default_rng(5)
    for size in (1e-3, 1e-2):
        for _ in range(20):
            moved = uv + size * rng.normal(size=uv.shape) * (high - low) / 12
            for axis in (0, 1):
                for edge in (low, high):
                    on_side = uv[:, axis] == edge[axis]
                    moved[on_side, axis] = edge[axis] + size * rng.normal() * (high - low)[axis] / 12
            tried = oracle.symmetric_dirichlet(mesh.positions, mesh.triangles, moved[mesh.triangles])
            assert tried > least - 1e-6


@pytest.mark.parametrize("shear", [0.01, 0.05, 0.1])
def test_an_isometric_map_keeps_the_angles_of_the_surface(shear: float) -> None:
    mesh = sheet(shear)
    result = unwrapped(mesh)
    assert result.distortion.l2_stretch == pytest.approx(1, abs=1e-12)
    assert share_along_axes(mesh, result) > 0.2  # one pair of its sides is parallel


@pytest.mark.parametrize("shear", [0.01, 0.05, 0.2])
@pytest.mark.parametrize("bulge", [0.05, 0.5, 1.5])
def test_the_cost_is_bounded_however_far_sides_are_from_right_angles(shear: float, bulge: float) -> None:
    mesh = sheet(shear, bulge)
    natural, straight = (unwrapped(mesh, on).distortion.l2_stretch for on in (False, True))
    excess = natural - 1
    assert straight < natural + min(max(0.1 * excess, 0.002), 20 * excess) + 2e-6


def test_digits_that_a_file_has_lost_do_not_bend_sides() -> None:
    mesh = meshes.transform(closed.lathe(np.ones(5), np.linspace(0, 1, 5), 40, caps=(False, False)), seed=3)
    rounded = mesh._replace(positions=np.round(mesh.positions, 4))
    assert share_along_axes(rounded, unwrapped(rounded, False)) < 0.5
    assert share_along_axes(rounded, unwrapped(rounded)) == 1


@pytest.mark.parametrize(("around", "along"), [(48, 8), (160, 30), (400, 20)])
def test_sides_of_a_cut_along_the_axes_match_to_the_last_digits(around: int, along: int) -> None:
    """Angle sums along many vertices make quarter turns only up to their rounding."""
    mesh = barrel(around, along, 0.02)
    rough = mesh._replace(positions=mesh.positions + np.random.default_rng(1).normal(0, 1e-4, mesh.positions.shape))
    seams = unwrapped(rough).seams
    assert max(seams.sister_ratio_max - 1, seams.rotation_residual, seams.translation_residual) < 1e-14


def test_round_borders_stay_as_they_are() -> None:
    ring = closed.lathe(np.array([0.4, 0.7, 1.0]), np.array([0.25, 0.15, 0]), 48, caps=(False, False))
    np.testing.assert_array_equal(unwrapped(ring).corner_uv, unwrapped(ring, False).corner_uv)


def test_sides_that_would_overlap_are_not_straightened() -> None:
    box = closed.beveled_box(4, 0.15, (1, 1.5, 2))  # a net of faces with narrow gaps between them
    result = lsgp.auto_unwrap(surface(box), preset="bake", pack="shelves")
    assert len(result.overlapping) == 0 and len(result.flipped) == 0


@pytest.mark.parametrize(
    "name", ["noise-ball-levels=2-amount=1-seed=1", "ball-with-handles-levels=2-handles=8-seed=1", "mixture-seed=15"]
)
def test_straight_sides_do_not_overlap_where_sides_of_a_cut_coincide(name: str) -> None:
    result = lsgp.auto_unwrap(surface(zoo.member(name).mesh()), preset="paint")
    assert len(result.overlapping) == 0


@pytest.mark.parametrize("pack", ["tight", "shelves"])
def test_presets_lay_parts_of_machines_along_u_and_v(pack: str) -> None:
    """Everything but the round ends of a capped barrel and the inside of a hollow pipe."""
    radius, height = 1 + 0.06 * np.sin(np.linspace(0, np.pi, 7)), np.linspace(0, 2, 7)
    capped = closed.lathe(radius, height, 24, caps=(True, True))
    whole = replace(lsgp.preset_options("paint"), compact="off")
    result = lsgp.auto_unwrap(surface(capped), preset="paint", pack=pack, options=whole)
    is_side = (capped.triangles < 7 * 24).all(axis=1)
    on_side = result.corner_uv[is_side]
    low, high = on_side.min(axis=(0, 1)), on_side.max(axis=(0, 1))
    natural = lsgp.auto_unwrap(surface(capped), preset="paint", pack=pack, options=replace(whole, straighten=False))

    def at_the_rims(uv: np.ndarray) -> np.ndarray:
        """Which rims are straight along u or v."""
        out = []
        for ring in (0, 6):
            corners = uv[is_side][(capped.triangles[is_side] // 24) == ring]
            out.append(np.ptp(corners, axis=0).min() < 1e-12)
        return np.array(out)

    assert at_the_rims(result.corner_uv).all() and not at_the_rims(natural.corner_uv).any()
    uv_area = np.abs(oracle.signed_areas(on_side)).sum()
    assert uv_area == pytest.approx(np.prod(high - low))  # the whole of its box


def folded_sheet(cells: int = 12) -> Mesh:
    """Two halves of a sheet that meet at a sharp ridge, one of them domed."""
    middle = cells / 2
    return meshes.grid(
        cells,
        cells + 2,
        lambda x, y: (
            0.6 * np.abs(x - middle)
            + np.where(x > middle, np.sin(np.pi * (x - middle) / middle) * np.sin(np.pi * y / (cells + 2)), 0)
        ),
    )


def test_creases_inside_become_straight_as_well() -> None:
    mesh = folded_sheet()
    middle = mesh.positions[:, 0].max() / 2
    bends = []
    for on in (True, False):
        result = unwrapped(mesh, on)
        on_ridge = result.corner_uv[mesh.positions[mesh.triangles][..., 0] == middle]
        bends.append(np.ptp(on_ridge, axis=0).min())
        assert len(result.flipped) == 0
    assert bends[0] < 1e-14
    assert bends[1] > 1e-4


def test_cuts_that_make_islands_compact_are_straight_too() -> None:
    mesh = barrel(48, 8, 0.1)
    options = replace(LOW_STRETCH, straighten=True, compact="full", overlaps="split")
    result = lsgp.parameterize(surface(mesh), (), options=options)
    assert len(np.unique(result.island)) > 1
    assert share_along_axes(mesh, result) == 1
    assert_angles_met(mesh, result)
    assert_exact_transitions(mesh, result)


@pytest.mark.parametrize("straighten", [True, False])
def test_squares_of_a_cross_lie_along_the_axes(straighten: bool) -> None:
    """Five faces of a cube, whose smallest box lies at 45 degrees, and the sixth beside them."""
    mesh = closed.box(1, (1, 1, 1))
    edges = meshes.edges_of(mesh.triangles)
    is_side = (np.ptp(mesh.positions[edges], axis=1) > 0).sum(axis=1) == 1  # no diagonal
    whole = surface(mesh, edges=edges[is_side])
    hidden = replace(whole, cut_costs=lsgp.cut_costs(whole, (0, -1, 0)))
    options = replace(lsgp.preset_options("paint"), straighten=straighten)
    result = lsgp.parameterize(hidden, range(8), options=options)
    assert sorted(np.bincount(result.island)) == [2, 10]
    assert (share_along_axes(mesh, result) == 1) == straighten
