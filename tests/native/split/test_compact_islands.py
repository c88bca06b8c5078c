# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that are cut so that they fill a square: what that changes, what it preserves, and when it is not done."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import partial

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import zoo
from map_checks import pairs
from meshes import Mesh
from nightly import nightly
from result_check import undeclared_faults
from sanitized_run import many_solves
from scipy.spatial import ConvexHull
from test_overlaps import quads_of
from zoo import closed, swept

COMPACT = lsgp.Options(compact="full")
FILL = 0.62  # of the square, what packed islands usually take


def flat(cells: np.ndarray) -> Mesh:
    """Unit squares of a plane, two triangles each, where cells, (rows, columns), are true."""
    rows, columns = np.nonzero(cells)
    width = cells.shape[1] + 1
    first = rows * width + columns
    quads = np.stack([first, first + 1, first + width + 1, first + width], axis=1)
    used, inverse = np.unique(quads, return_inverse=True)
    positions = np.stack([used % width, used // width, np.zeros(len(used))], axis=1)
    return meshes.make(positions, inverse.reshape(-1, 4)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))


def cells_of(shape: str, n: int = 12) -> np.ndarray:
    cells = np.ones((n, n), bool)
    y, x = np.mgrid[:n, :n]
    match shape:
        case "strip":
            return np.ones((3, 60), bool)
        case "corner":
            cells[3:, 3:] = False
        case "cross":
            cells = (abs(2 * x - n + 1) < 4) | (abs(2 * y - n + 1) < 4)
        case "ring":
            cells[2:-2, 2:-2] = False
        case "comb":
            cells[2:, x[0] % 4 > 1] = False
    return cells


def unwrap(mesh: Mesh, options: lsgp.Options, **surface: object) -> lsgp.Result:
    return lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, **surface), mesh.cones, options=options)


def island_points(result: lsgp.Result) -> list[np.ndarray]:
    return [result.corner_uv[result.island == i].reshape(-1, 2) for i in range(result.island.max() + 1)]


def uv_area(result: lsgp.Result) -> float:
    first, second = (result.corner_uv[:, i] - result.corner_uv[:, 0] for i in (1, 2))
    return float(abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum()) / 2


def sides_of_smallest_box(points: np.ndarray) -> np.ndarray:
    hull = points[ConvexHull(points).vertices] @ [1, 1j]
    turned = hull / np.exp(1j * np.angle(np.roll(hull, -1) - hull))[:, None]
    sides = np.stack([np.ptp(turned.real, axis=1), np.ptp(turned.imag, axis=1)], axis=1)
    return sides[sides.prod(axis=1).argmin()]


def taken(result: lsgp.Result) -> float:
    """What the islands take of a square for their own area, each halfway between its hull and its smallest box."""
    return sum(map(demand, island_points(result))) / uv_area(result)


def demand(points: np.ndarray) -> float:
    return (ConvexHull(points).volume + sides_of_smallest_box(points).prod()) / 2


def lengths(result: lsgp.Result) -> np.ndarray:
    sides = np.linalg.norm(result.corner_uv - np.roll(result.corner_uv, 1, axis=1), axis=2)
    return sides / np.sqrt(uv_area(result))


# Of division/island_division.cpp: of an island, in areas, and of cuts, in square roots of the area by length.
PRICE_OF_ISLAND, PRICE_OF_CUT = 0.01, 0.15


@pytest.mark.parametrize(
    ("shape", "width", "most"), [("corner", 3, 1.01), ("cross", 4, 1.1), ("ring", 2, 1.4), ("comb", 2, 1.3)]
)
@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
def test_islands_with_arms_become_convex_ones(shape: str, width: int, most: float, mode: str) -> None:
    """As far as it is worth a cut across an arm, and an island; how many a ring falls into hangs on rounding."""
    mesh = flat(cells_of(shape))
    # Without this, the border of a ring is opened to a strip.
    options = lsgp.Options(mode=mode, loop_turning={0: 2 * np.pi}) if shape == "ring" else lsgp.Options(mode=mode)
    plain, compact = unwrap(mesh, options), unwrap(mesh, replace(options, compact="full"))
    assert taken(plain) > 1.4
    assert taken(compact) <= most
    area = uv_area(compact)
    price = area * (PRICE_OF_ISLAND + PRICE_OF_CUT * width / np.sqrt(cells_of(shape).sum()))
    for i, points in enumerate(island_points(compact)):
        own = uv_area(replace(compact, corner_uv=compact.corner_uv[compact.island == i]))
        assert demand(points) - own <= price
    assert lengths(compact) == pytest.approx(lengths(plain), abs=1e-9)
    assert compact.island.max() < 8
    assert undeclared_faults(lsgp.Surface(mesh.positions, mesh.triangles), compact) == []


@pytest.mark.parametrize(("shape", "cut"), [("strip", True), ("corner", True), ("cross", False), ("comb", False)])
def test_sparing_cuts_only_what_wastes_most(shape: str, cut: bool) -> None:
    mesh = flat(cells_of(shape))
    plain, sparing, full = (unwrap(mesh, lsgp.Options(compact=compact)) for compact in ("off", "sparing", "full"))
    islands = [int(result.island.max()) + 1 for result in (plain, sparing, full)]
    assert islands == sorted(islands) and islands[0] < islands[2]
    assert (islands[1] > islands[0]) == cut
    assert lengths(sparing) == pytest.approx(lengths(plain), abs=1e-9)


def test_sparing_leaves_no_strip_much_longer_than_the_square() -> None:
    for length in (20, 50, 100, 200):
        sparing = unwrap(flat(np.ones((3, length), bool)), lsgp.Options(compact="sparing"))
        longest = max(sides_of_smallest_box(points).max() for points in island_points(sparing))
        assert longest < 1.5 * np.sqrt(uv_area(sparing) / FILL)


@pytest.mark.parametrize("spikes", [6, *nightly(8, 10, 16, marks=[pytest.mark.many_solves])])
def test_no_piece_has_a_texel_density_of_its_own(spikes: int) -> None:
    """Tips of spikes, which are stretched most, are not cut off, though that would fill the square better."""
    mesh = closed.spiked_sphere(2, spikes, 10)
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    cones = lsgp.place_cones(surface).cones
    options = lsgp.Options(mode="low-stretch", overlaps="split")
    plain, compact = (lsgp.parameterize(surface, cones, options=replace(options, compact=c)) for c in ("off", "full"))
    assert compact.island.max() > plain.island.max()
    areas = oracle.triangle_areas(surface.positions, surface.triangles)
    shares = areas / areas.sum()
    of_triangles, of_pieces = (np.abs(oracle.signed_areas(result.corner_uv)) for result in (plain, compact))
    unevenness = np.abs(np.log(of_triangles / of_triangles.sum() / shares)).max()
    pieces = np.bincount(compact.island, of_pieces) / of_pieces.sum() / np.bincount(compact.island, shares)
    whole = {frozenset(np.flatnonzero(plain.island == i).tolist()) for i in range(plain.island.max() + 1)}
    is_cut_off = [frozenset(np.flatnonzero(compact.island == i).tolist()) not in whole for i in range(len(pieces))]
    # At most half of that of the island it was cut from, which is less uneven as a whole than its worst triangle.
    assert np.abs(np.log(pieces[is_cut_off])).max() <= 0.5 * unevenness


@pytest.mark.parametrize("compact", ["sparing", "full"])
@pytest.mark.parametrize("height", [0.005, 0.02])
def test_no_narrow_island_keeps_the_others_small(height: float, compact: str) -> None:
    """The edge of a thin disk, opened, is a strip three times as long as the disk is wide and of hardly any area."""
    disk = closed.lathe(np.ones(2), height * np.arange(2), 60, caps=(True, True))
    surface = lsgp.Surface(disk.positions, disk.triangles)
    surface = replace(surface, borders=lsgp.crease_borders(surface))
    plain, cut = (lsgp.parameterize(surface, (), None, lsgp.Options(compact=each)) for each in ("off", compact))
    boxes = [sides_of_smallest_box(points) for points in island_points(plain)]
    assert max(box.max() for box in boxes) > 1.9 * np.sqrt(uv_area(plain) / FILL)
    boxes = [sides_of_smallest_box(points) for points in island_points(cut)]
    assert max(box.max() for box in boxes) < 1.5 * np.sqrt(uv_area(cut) / FILL)
    assert len(boxes) <= 6  # two disks, and few pieces of the strip
    assert min(box.max() for box in boxes) > 0.1 * np.sqrt(uv_area(cut) / FILL)
    assert lengths(cut) == pytest.approx(lengths(plain), abs=1e-9)


@pytest.mark.parametrize("compact", ["sparing", "full"])
def test_components_with_marked_seams_stay_whole(compact: str) -> None:
    mesh = flat(np.ones((3, 40), bool))
    both = meshes.make(
        np.concatenate([mesh.positions, mesh.positions + np.array([0, 10, 0])]),
        np.concatenate([mesh.triangles, mesh.triangles + len(mesh.positions)]),
    )
    result = unwrap(both, lsgp.Options(compact=compact), seams=[[41, 82]])
    with_seam, without = (len(np.unique(islands)) for islands in np.split(result.island, 2))
    assert with_seam == 1 and without > 1


def test_strips_become_no_longer_than_the_square() -> None:
    compact = unwrap(flat(cells_of("strip")), COMPACT)
    longest = max(sides_of_smallest_box(points).max() for points in island_points(compact))
    assert longest < np.sqrt(uv_area(compact) / FILL)
    # Straight across: each cut is as long as the strip is wide.
    assert len(compact.cut_edges) == 3 * compact.island.max()


def test_a_share_of_the_square_is_one_of_a_larger_one() -> None:
    strip = flat(cells_of("strip"))
    counts = [unwrap(strip, replace(COMPACT, square_share=share)).island.max() + 1 for share in (4, 1, 0.2, 0.05)]
    assert counts[0] > counts[1] > counts[2] > counts[3] == 1


WHOLE = {
    "square": flat(np.ones((8, 8), bool)),
    "hill": meshes.hill(8, 1.0),
    "triangle": meshes.grid(1, 1),
}


@pytest.mark.parametrize("name", WHOLE)
def test_compact_islands_stay_whole(name: str) -> None:
    mesh = WHOLE[name]
    assert unwrap(mesh, COMPACT).corner_uv.tobytes() == unwrap(mesh, lsgp.Options()).corner_uv.tobytes()


def coarse_ball(around: int, rings: int) -> Mesh:
    polar = np.linspace(np.pi, 0, rings + 1)
    return closed.lathe(np.sin(polar).round(12), np.cos(polar), around, caps=(False, False))


COARSE = {
    "icosphere": meshes.icosphere(1),
    "ball of 8 by 6": coarse_ball(8, 6),
    "ball of 7 by 5": coarse_ball(7, 5),
    "square ring": meshes.torus(8, 4, 1.0, 0.4),
    "ring of 9 by 5": meshes.torus(9, 5, 1.0, 0.4),
}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, *many_solves(1), *nightly(2, 3, marks=[pytest.mark.many_solves])])
@pytest.mark.parametrize("name", COARSE)
def test_no_scraps_are_cut_off_coarse_round_shapes(name: str, seed: int) -> None:
    mesh = meshes.transform(COARSE[name], seed)
    result = lsgp.auto_unwrap(lsgp.Surface(mesh.positions, mesh.triangles), preset="bake")
    area = oracle.triangle_areas(mesh.positions, mesh.triangles)
    share = np.bincount(result.island, area) / area.sum()
    # Of the ball of 56 triangles, three at a pole are .04 of the area.
    is_small = np.flatnonzero((np.bincount(result.island) <= 4) & (share < 0.03))
    assert share.min() >= 0.01
    # Only those that end at sharp edges alone, as on the square ring.
    sides = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    sharp = {
        tuple(edge) for edge in lsgp.feature_edges(lsgp.Surface(mesh.positions, mesh.triangles), angle=0.5).tolist()
    }
    for island in is_small.tolist():
        count = Counter(tuple(sorted(side)) for side in sides[np.repeat(result.island == island, 3)].tolist())
        assert {side for side, times in count.items() if times == 1} <= sharp


def test_cuts_run_along_sharp_edges() -> None:
    mesh = flat(np.ones((3, 13), bool))
    crease = mesh.positions[:, 0] == 7
    assert not crease[unwrap(mesh, COMPACT).cut_edges].any()
    bent = meshes.make(mesh.positions.copy(), mesh.triangles)
    beyond = bent.positions[:, 0] > 7
    bent.positions[beyond] = np.stack(
        [np.full(beyond.sum(), 7.0), mesh.positions[beyond, 1], mesh.positions[beyond, 0] - 7], axis=1
    )
    assert crease[unwrap(bent, COMPACT).cut_edges].all()


@pytest.mark.parametrize("column", [6, 7])
def test_cuts_run_where_they_cost_least(column: int) -> None:
    mesh = flat(np.ones((3, 13), bool))
    edges = meshes.edges_of(mesh.triangles)
    is_cheap = (mesh.positions[:, 0] == column)[edges].all(axis=1)
    result = unwrap(mesh, COMPACT, edges=edges, cut_costs=np.where(is_cheap, 0.2, 1.0))
    assert pairs(result.cut_edges) == pairs(edges[is_cheap])


def test_faces_of_polygons_are_not_cut() -> None:
    mesh = flat(cells_of("cross"))
    quads = quads_of(mesh)
    cut = unwrap(mesh, COMPACT, edges=quads).cut_edges
    assert len(cut) > 0
    assert pairs(cut) <= pairs(quads)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "gear-teeth=6-depth=0.15-layers=1",
        "ring-around=14-along=8-major=2",
        "holed-plate-across=2-along=1-bend=0.3",
        *many_solves(
            "pipe-around=8-along=10-bend=1.5-caps=True",
            "tunneled-plate-across=2-along=1-thickness=1",
        ),
        *nightly(
            "mixed-parts-count=5-spread=2-seed=0",
            "scale-shape=ball-exponent=-6",
            "bumpy-ball-levels=1-height=0.25",
            "box-cells=3-size=1x10x1",
            "polygon-box-cells=3-size=1x1x1",
            marks=[pytest.mark.many_solves],
        ),
    ],
)
@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
def test_the_map_is_the_same_but_for_its_islands(name: str, mode: str) -> None:
    member = zoo.member(name)
    mesh = member.mesh()
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    options = lsgp.Options(mode=mode, overlaps="split")
    # Whether cones are symmetric is decided by the islands, too.
    unwrapped = partial(lsgp.auto_unwrap, surface, symmetric=False, creases=False)
    plain = unwrapped(options=options)
    compact = unwrapped(options=replace(options, compact="full"))
    assert undeclared_faults(surface, compact) == []
    assert lengths(compact) == pytest.approx(lengths(plain), rel=1e-9, abs=1e-12)
    assert pairs(plain.cut_edges) <= pairs(compact.cut_edges)
    assert compact.overlapping.tolist() == []
    assert taken(compact) <= taken(plain)
    again = unwrapped(options=replace(options, compact="full"))
    assert again.corner_uv.tobytes() == compact.corner_uv.tobytes()


@pytest.mark.parametrize("count", [1, 2])
def test_components_with_pins_keep_their_islands(count: int) -> None:
    mesh = flat(cells_of("strip"))
    plain = unwrap(mesh, lsgp.Options())
    pins = lsgp.Pins(np.arange(count), plain.corner_uv.reshape(-1, 2)[:count])
    whole = lsgp.Surface(mesh.positions, mesh.triangles)
    pinned, compact = (lsgp.parameterize(whole, (), None, options, pins) for options in (lsgp.Options(), COMPACT))
    assert compact.corner_uv.tobytes() == pinned.corner_uv.tobytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"square_share": 0.0}, "share of the square"),
        ({"square_share": 100.5}, "share of the square"),
        ({"square_share": float("nan")}, "share of the square"),
        ({"compact": "full", "seamless": lsgp.Seamless()}, "compact"),
    ],
)
def test_what_makes_no_sense_is_refused(options: dict[str, object], words: str) -> None:
    with pytest.raises(lsgp.InputError, match=words) as refused:
        unwrap(meshes.cube(2), lsgp.Options(**options))
    assert refused.value.code == "WRONG_PARAMETER"


@pytest.mark.parametrize("taper", [0.0, 0.15])
def test_a_long_strip_is_divided_whatever_the_texel_density_of_its_pieces(taper: float) -> None:
    """Coils of coarse tubes, of which one grows wider: the stretch of its strip rises from one end to the other."""
    t = np.linspace(0, 1, 25)
    path = np.stack([2.4 * np.cos(4.2 * np.pi * t), 2.4 * np.sin(4.2 * np.pi * t), 4 * t], axis=1)
    tube = swept.sweep(path, swept.circle(0.055, 23), closed=False, caps=False)
    middle = np.repeat(path, 23, axis=0)
    wider = middle + (1 + taper * np.repeat(t, 23))[:, None] * (tube.positions - middle)
    result = lsgp.auto_unwrap(lsgp.Surface(wider, tube.triangles))
    assert uv_area(result) > 0.25 and 3 < len(island_points(result)) < 15
