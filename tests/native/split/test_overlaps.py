# SPDX-License-Identifier: GPL-3.0-or-later
"""Layouts that overlap themselves: the reported overlaps, and the result of splitting."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from large_meshes import comb, of_polygons
from map_checks import only, pairs
from meshes import Mesh
from nightly import some_nightly
from overlap_check import overlaps
from result_check import undeclared_faults
from scipy.sparse import coo_matrix, csgraph
from shared_meshes import shared_mesh

PER_TURN = 40  # wedges
PLAIN = lsgp.Options()
SPLIT = lsgp.Options(overlaps="split")
SEAMLESS = lsgp.Options(seamless=lsgp.Seamless())
SEAMLESS_SPLIT = lsgp.Options(seamless=lsgp.Seamless(), overlaps="split")


def wound(wedges: int, radii: object = np.linspace(1, 2, 9), crease: int = 0) -> Mesh:
    """A flat sector of rings, wound around a cone in space without any stretch: PER_TURN wedges unroll to a full turn.

    Wedge k is bounded by the rulings k and k + 1, vertices k * len(radii) and so on.  crease: the ruling at which the
    rest of the strip is folded up by a right angle; 0: none.
    """
    radii = np.asarray(radii, float)
    sine = 0.5  # of the angle between the cone's axis and its rulings
    turn = np.arccos((np.cos(2 * np.pi / PER_TURN) - 1 + sine**2) / sine**2) * np.arange(wedges + 1)
    rulings = np.stack([sine * np.cos(turn), sine * np.sin(turn), np.full(wedges + 1, np.sqrt(1 - sine**2))], axis=1)
    if crease:
        axis, after = rulings[crease], rulings[crease + 1 :]
        rulings[crease + 1 :] = np.outer(after @ axis, axis) + np.cross(axis, after)
    n = len(radii)
    corner = (np.arange(wedges)[:, None] * n + np.arange(n - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + n + 1, corner + n], axis=1)
    return meshes.make(rulings[:, None] * radii[:, None], quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))


def ruling(mesh: Mesh, k: int, rings: int = 8) -> set[tuple[int, int]]:
    first = k * (rings + 1)
    return {(v, v + 1) for v in range(first, first + rings)}


def quads_of(mesh: Mesh) -> np.ndarray:
    """The edges of a mesh of quads cut into two triangles each, without the diagonals."""
    t = mesh.triangles.reshape(-1, 6)
    return np.unique(np.sort(t[:, [0, 1, 1, 2, 2, 5, 5, 0]].reshape(-1, 2), axis=1), axis=0).astype(np.int32)


def unrolled(wedges: int, options: lsgp.Options = PLAIN, **surface: object) -> lsgp.Result:
    mesh = wound(wedges)
    return lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, **surface), [], options=options)


def faults(mesh: Mesh, result: lsgp.Result, options: lsgp.Options) -> list[str]:
    return undeclared_faults(lsgp.Surface(mesh.positions, mesh.triangles), result, options)


def neighbors(mesh: Mesh, result: lsgp.Result) -> np.ndarray:
    """(m, 3) triangles beyond the three sides; their own where the layout ends."""
    tail, head, twin = oracle.halfedges(mesh.triangles)
    cut = pairs(result.cut_edges)
    ends = np.array([t < 0 or (min(a, b), max(a, b)) in cut for a, b, t in zip(tail, head, twin, strict=True)])
    own = np.arange(len(tail)) // 3
    return np.where(ends, own, twin // 3).reshape(-1, 3)


def islands(mesh: Mesh, result: lsgp.Result) -> np.ndarray:
    """Triangles joined across uncut edges share a number, (m,)."""
    beyond = neighbors(mesh, result)
    rows = np.repeat(np.arange(len(beyond)), 3)
    graph = coo_matrix((np.ones(beyond.size, bool), (rows, beyond.ravel())), (len(beyond),) * 2)
    return csgraph.connected_components(graph, directed=False)[1]


def regions(mesh: Mesh, result: lsgp.Result) -> int:
    """In how many places a layout lies on itself: pairs of triangles belong together if they share one and the others
    are neighbors."""
    m = len(mesh.triangles)
    found, area = overlaps(oracle.as_complex(result.corner_uv))
    found = found[area > 1e-9 * np.abs(oracle.signed_areas(result.corner_uv))[found].min(axis=1)]
    both = np.concatenate([found, found[:, ::-1]])
    keys = np.sort(both[:, 0] * m + both[:, 1])
    a, b = keys // m, keys % m
    beyond = neighbors(mesh, result)
    links = []
    for moved in [beyond[a, side] * m + b for side in range(3)] + [a * m + beyond[b, side] for side in range(3)]:
        at = np.searchsorted(keys, moved).clip(max=len(keys) - 1)
        hit = keys[at] == moved
        links.append(np.stack([np.flatnonzero(hit), at[hit]]))
    one, other = np.concatenate(links, axis=1)
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (len(keys),) * 2)
    return (csgraph.connected_components(graph, directed=False)[0] + 1) // 2  # (a, b) and (b, a)


def cut_length(mesh: Mesh, edges: np.ndarray) -> float:
    return float(np.linalg.norm(mesh.positions[edges[:, 1]] - mesh.positions[edges[:, 0]], axis=1).sum())


# --- what is reported -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("wedges", [PER_TURN - 1, PER_TURN, PER_TURN + 1, 50, 100])
def test_strip_of_more_than_a_turn_lies_on_itself_by_the_rest(wedges: int) -> None:
    mesh, result = wound(wedges), unrolled(wedges)
    # Every wedge lies on those whole turns away, triangle by triangle, as the strip was not stretched.
    covers = np.bincount(np.arange(wedges) % PER_TURN)
    on_others = np.flatnonzero(covers[np.arange(wedges) % PER_TURN] > 1)
    per_wedge = len(mesh.triangles) // wedges
    wanted = (on_others[:, None] * per_wedge + np.arange(per_wedge)).ravel()
    assert result.overlapping.tolist() == wanted.tolist()
    assert result.overlap_area == pytest.approx((covers * (covers - 1) / 2).sum() / wedges, abs=1e-9)
    assert faults(mesh, result, PLAIN) == []


def test_overlaps_are_warned_of_with_a_remedy() -> None:
    result = unrolled(50)
    warning = only(result.warnings, "OVERLAPPING_TRIANGLES")
    assert warning.elements.kind == "triangles"
    assert np.array_equal(warning.elements.indices, result.overlapping)
    assert str(len(result.overlapping)) in warning.message and "split" in warning.message
    assert unrolled(PER_TURN - 1).warnings == []


def test_wide_cone_lies_on_itself_at_its_own_vertex() -> None:
    # Ten triangles of an eighth of a turn about one vertex: two lie on two others, with which they share that vertex.
    rim = np.exp(2j * np.pi * np.arange(10) / 10)
    fan = [[0, 1 + k, 1 + (k + 1) % 10] for k in range(10)]
    mesh = meshes.make([[0, 0, 0], *np.stack([rim.real, rim.imag, np.zeros(10)], axis=1)], fan, [0])
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [0], [2.5 * np.pi])
    assert len(result.cut_edges) == 1
    assert result.overlap_area == pytest.approx(0.2, abs=1e-9)
    first = int(result.cut_edges.max()) - 1  # the triangle that begins at the cut
    assert set(result.overlapping) == {(first + k) % 10 for k in (0, 1, 8, 9)}
    assert faults(mesh, result, PLAIN) == []


def test_triangles_of_very_different_sizes() -> None:
    radii = np.geomspace(1e-6, 1, 60)
    mesh = wound(50, radii)
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [])
    area = np.abs(oracle.signed_areas(result.corner_uv))
    assert area.max() / area.min() > 1e11
    # Relative to each triangle, so as many of the small ones as of the large ones.
    assert len(result.overlapping) == 2 * 10 * 2 * 59
    assert result.overlap_area == pytest.approx(0.2, abs=1e-9)


@pytest.mark.parametrize("make", [meshes.cube, meshes.bumpy_sphere, meshes.saddle, meshes.cylinder, meshes.torus])
def test_layouts_beside_themselves_have_no_overlap(make: object) -> None:
    mesh = make()
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), mesh.cones)
    assert result.overlap_area == 0 and len(result.overlapping) == 0
    assert faults(mesh, result, PLAIN) == []


def pinned_square_and_ring(place: complex) -> tuple[Mesh, lsgp.Result]:
    """A flat ring of radii 1 and 2 in its place, and a square of side 0.2 around a place of its own."""
    angle, radius = np.meshgrid(2 * np.pi * np.arange(48) / 48, np.linspace(1, 2, 7), indexing="ij")
    z = (radius * np.exp(1j * angle)).ravel()
    k = (np.arange(48)[:, None] * 7 + np.arange(6)).ravel()
    quads = np.stack([k, k + 1, (k + 8) % len(z), (k + 7) % len(z)], axis=1)
    square = place + 0.1 * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
    n = len(z)
    z = np.concatenate([z, square])
    triangles = np.concatenate([quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), [[n, n + 1, n + 2], [n, n + 2, n + 3]]])
    mesh = meshes.make(np.stack([z.real, z.imag, np.where(np.arange(len(z)) < n, 0, 1)], axis=1), triangles)
    corners = np.array([0, 3 * len(quads), 3 * len(triangles) - 6, 3 * len(triangles) - 4])  # far from each other
    pins = lsgp.Pins(corners, oracle.as_uv(z[triangles.ravel()[corners]]))
    return mesh, lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [], pins=pins)


@pytest.mark.parametrize(("place", "area"), [(0, 0), (1.5, 0.04), (-1.5j, 0.04), (3, 0)])
def test_islands_within_islands(place: complex, area: float) -> None:
    # In the hole of the ring nothing lies on it; between its borders the square does, and no two borders cross.
    mesh, result = pinned_square_and_ring(place)
    assert result.overlap_area * np.abs(oracle.signed_areas(result.corner_uv)).sum() == pytest.approx(area, abs=1e-6)
    assert (len(result.overlapping) > 0) == (area > 0)
    assert faults(mesh, result, PLAIN) == []


# --- splitting made layouts ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("wedges", [50, 70, 100, 130])
@pytest.mark.parametrize("diagonals", [False, True])
def test_strip_is_split_into_no_more_turns_than_it_has(wedges: int, diagonals: bool) -> None:
    mesh = wound(wedges)
    result = unrolled(wedges, SPLIT, edges=None if diagonals else quads_of(mesh))
    assert faults(mesh, result, SPLIT) == [] and result.warnings == []
    # No part can be longer than a turn, and what parts the strip leads from its inner to its outer side.
    least = -(-wedges // PER_TURN)
    assert len(np.unique(islands(mesh, result))) == result.island.max() + 1 == least
    assert cut_length(mesh, result.cut_edges) == pytest.approx(least - 1, abs=1e-9)
    # Every part keeps its size.
    assert oracle.metric_gap(unrolled(wedges).corner_uv, result.corner_uv) <= 1e-9
    # Any two parts are related by one motion.
    beside = islands(mesh, result)
    tail, head, twin = oracle.halfedges(mesh.triangles)
    z = oracle.as_complex(result.corner_uv).ravel()
    after = np.arange(len(z)) // 3 * 3 + (np.arange(len(z)) + 1) % 3
    for part in range(least):
        for other in range(part):
            h = np.flatnonzero((twin >= 0) & (beside[np.arange(len(z)) // 3] == part))
            h = h[beside[twin[h] // 3] == other]
            if not len(h):
                continue
            left, right = np.stack([z[h], z[after[h]]]), np.stack([z[after[twin[h]]], z[twin[h]]])
            turn = (right[1] - right[0]) / (left[1] - left[0])
            assert np.abs(turn - turn[0]).max() <= 1e-9 and abs(abs(turn[0]) - 1) <= 1e-9
            assert np.ptp((right - turn[0] * left).view(float).reshape(-1, 2), axis=0).max() <= 1e-9
            assert pairs(np.stack([tail[h], head[h]], axis=1)) <= pairs(result.cut_edges)


def test_split_prefers_marked_seams() -> None:
    mesh = wound(50)
    seam = np.array(sorted(ruling(mesh, 17)), np.int32)
    parted = unrolled(50, SPLIT, seams=seam)
    assert pairs(parted.cut_edges) == ruling(mesh, 17)
    # In a seamless layout seams are no borders, and still the best place for a cut.
    wanted = lsgp.Options(overlaps="split", seamless=lsgp.Seamless(tiles=16))
    result = unrolled(50, wanted, seams=seam)
    assert pairs(result.cut_edges) == ruling(mesh, 17) and result.seamless.error == 0
    assert undeclared_faults(lsgp.Surface(mesh.positions, mesh.triangles, seams=seam), result, wanted) == []


@pytest.mark.parametrize("crease", [14, 29])
def test_split_prefers_sharp_edges(crease: int) -> None:
    mesh = wound(50, crease=crease)
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [], options=SPLIT)
    assert pairs(result.cut_edges) == ruling(mesh, crease)


@pytest.mark.parametrize("crease", [14, 29])
def test_split_keeps_to_the_cheap_side_whatever_is_sharp(crease: int) -> None:
    """From ruling 10 to 40 each parts the strip as well as any other; those of the crease's half are thrice as dear."""
    mesh, middle = wound(50, crease=crease), 25
    edges = meshes.edges_of(mesh.triangles)
    on_first_side = edges.max(axis=1) // 9 < middle
    is_dear = on_first_side == (crease < middle)
    for unit in (1e-3, 1.0, 1e3):  # what counts are the ratios
        surface = lsgp.Surface(mesh.positions, mesh.triangles, edges, cut_costs=np.where(is_dear, 3 * unit, unit))
        result = lsgp.parameterize(surface, [], options=SPLIT)
        assert len(result.overlapping) == 0 and result.island.max() == 1
        assert not pairs(result.cut_edges) & pairs(edges[is_dear])


def test_cuts_that_split_run_along_edges_that_may_be_cut() -> None:
    mesh = wound(100)
    allowed = quads_of(mesh)
    assert pairs(unrolled(100, SPLIT, edges=allowed).cut_edges) <= pairs(allowed)


def test_face_on_itself_cannot_be_split_and_is_reported() -> None:
    # All edges inside the strip are diagonals of one face, so to say.
    mesh = wound(50)
    tail, head, twin = oracle.halfedges(mesh.triangles)
    border = np.stack([tail, head], axis=1)[twin < 0].astype(np.int32)
    result = unrolled(50, SPLIT, edges=border)
    assert len(result.cut_edges) == 0 and len(result.overlapping) == len(unrolled(50).overlapping)
    warning = only(result.warnings, "OVERLAPPING_TRIANGLES")
    assert "of the same face" in warning.message and "Divide such faces" in warning.message
    assert "flipped" not in warning.message and "unpin" not in warning.message
    assert np.array_equal(np.sort(warning.elements.indices), result.overlapping)


def test_only_triangles_of_faces_on_themselves_are_left_and_named() -> None:
    """The outer half of a strip is one polygon that winds round more than once, the inner half are quads."""
    mesh, half, rings = wound(50), 4, 9
    radius = np.arange(len(mesh.positions)) % rings
    edges = quads_of(mesh)
    inside = (radius[edges] >= half).all(axis=1) & ~(radius[edges] == half).all(axis=1)
    tail, head, twin = oracle.halfedges(mesh.triangles)
    border = pairs(np.stack([tail, head], axis=1)[twin < 0])
    allowed = [
        edge for edge, is_inside in zip(edges.tolist(), inside, strict=True) if not is_inside or tuple(edge) in border
    ]
    result = unrolled(50, SPLIT, edges=np.array(allowed, np.int32))
    face = np.flatnonzero((radius[mesh.triangles] >= half).all(axis=1))
    warning = only(result.warnings, "OVERLAPPING_TRIANGLES")
    assert "of the same face" in warning.message
    named = warning.elements.indices
    assert len(named) and np.isin(named, face).all()
    both, shared = overlaps(result.corner_uv @ [1, 1j])
    assert np.isin(both[shared > 1e-12], named).all()


def test_specks_that_lie_on_the_rest_are_split_off() -> None:
    """A fan that winds around its tip more than once: from the third ruling on its triangles are 1e-24 as large."""
    lengths = np.array([1, 1, 1e-6] + 10 * [1e-12])
    sine, step = 0.5, np.deg2rad(50)
    turn = np.arccos((np.cos(step) - 1 + sine**2) / sine**2) * np.arange(len(lengths))
    rulings = np.stack([sine * np.cos(turn), sine * np.sin(turn), np.full(len(turn), np.sqrt(1 - sine**2))], axis=1)
    fan = [[0, i, i + 1] for i in range(1, len(lengths))]
    given = lsgp.Surface(np.concatenate([np.zeros((1, 3)), rulings * lengths[:, None]]), np.array(fan))
    assert len(lsgp.parameterize(given, []).overlapping)
    result = lsgp.parameterize(given, [], options=SPLIT)
    assert len(result.overlapping) == 0 and len(np.unique(result.island)) == 2


def test_pinned_islands_are_not_split() -> None:
    mesh, plain = wound(50), unrolled(50)
    corners = np.array([0, len(mesh.triangles)])
    pins = lsgp.Pins(corners, plain.corner_uv.reshape(-1, 2)[corners])
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [], options=SPLIT, pins=pins)
    assert len(result.cut_edges) == 0 and np.array_equal(result.overlapping, plain.overlapping)
    assert "unpin" in only(result.warnings, "OVERLAPPING_TRIANGLES").message


def test_parts_of_an_island_with_one_pin_stay_beside_it() -> None:
    mesh, place = wound(100), np.array([[5.25, -3.5]])
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    result = lsgp.parameterize(surface, [], options=SPLIT, pins=lsgp.Pins(np.array([3]), place))
    assert np.abs(result.corner_uv.reshape(-1, 2)[3] - place).max() <= 1e-9
    assert result.island.max() + 1 == 3 and len(result.overlapping) == 0
    assert faults(mesh, result, SPLIT) == []


def test_layouts_beside_themselves_are_not_split() -> None:
    mesh = meshes.bumpy_sphere()
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    kept, split = lsgp.parameterize(surface, mesh.cones), lsgp.parameterize(surface, mesh.cones, options=SPLIT)
    assert np.array_equal(kept.corner_uv, split.corner_uv) and np.array_equal(kept.cut_edges, split.cut_edges)


@pytest.mark.parametrize("seed", range(4))
def test_folds_of_different_parts_side_by_side_are_split_one_by_one(seed: int) -> None:
    """A ragged strip whose triangles are so thin that its layout is folded all over."""
    mesh = meshes.grid(20, 20)
    ragged = mesh.positions / 20 * [1, 1e-6, 0]
    ragged[:, 2] = np.random.default_rng(seed).normal(size=len(ragged)) * 0.1
    surface = lsgp.Surface(ragged, mesh.triangles)
    result = lsgp.parameterize(surface, [], options=SPLIT)
    assert result.solved.all() and np.isfinite(result.corner_uv).all()
    # What lies on itself still is beside a triangle that is flipped, where there is nothing to cut along.
    assert len(result.overlapping) == 0 or len(result.flipped) > 0


# --- cones of negative curvature ------------------------------------------------------------------------------------

GENUS_TWO = meshes.subdivide(meshes.double_torus())


def saddles(count: int) -> Mesh:
    """The surface of genus two with so many cones: more of them, the narrower its arms lie on each other."""
    surface = lsgp.Surface(GENUS_TWO.positions, GENUS_TWO.triangles)
    return GENUS_TWO._replace(cones=np.array(lsgp.place_cones(surface, count=count).cones, np.int32))


@cache
def made(count: int, seamless: bool, split: bool) -> lsgp.Result:
    mesh = saddles(count)
    options = lsgp.Options(seamless=lsgp.Seamless() if seamless else None, overlaps="split" if split else "keep")
    return lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), mesh.cones, options=options)


@pytest.mark.parametrize("seamless", [False, True])
@pytest.mark.parametrize("count", [8, 16, 24])
def test_saddles_are_split_with_exact_transitions(count: int, seamless: bool) -> None:
    mesh, kept, split = saddles(count), made(count, seamless, False), made(count, seamless, True)
    options = SEAMLESS_SPLIT if seamless else SPLIT
    assert faults(mesh, split, options) == [] and len(split.overlapping) == 0
    assert split.seams.sister_ratio_max <= 1 + 1e-9
    assert np.array_equal(split.cones, kept.cones) and np.array_equal(split.cone_angles, kept.cone_angles)
    if seamless:
        assert split.seamless.error == 0
    else:
        assert oracle.metric_gap(kept.corner_uv, split.corner_uv) <= 1e-9
    # Every place in which the layout lies on itself takes at most one cut, which leaves one part more.
    assert split.island.max() <= (regions(mesh, kept) if len(kept.overlapping) else 0)


# --- real meshes ----------------------------------------------------------------------------------------------------

# Islands at most, where splitting as little as every overlap asks for, place by place, would leave as many or more.
REAL = {
    ("bird", False): 2,
    ("bird", True): 2,
    ("hand-5k", False): 3,
    ("hand-5k", True): 3,
    ("elephant-genus3", False): 2,
}


@pytest.mark.many_solves
@pytest.mark.parametrize(
    ("name", "seamless"), some_nightly(REAL, ("bird", True), ("hand-5k", False), ("elephant-genus3", False))
)
def test_real_meshes_are_split_with_exact_transitions(name: str, seamless: bool) -> None:
    mesh = shared_mesh(name)
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    kept = lsgp.parameterize(surface, mesh.cones, options=SEAMLESS if seamless else PLAIN)
    options = SEAMLESS_SPLIT if seamless else SPLIT
    split = lsgp.parameterize(surface, mesh.cones, options=options)
    assert len(kept.overlapping) > 0 and len(split.overlapping) == 0
    assert faults(mesh, split, options) == []
    assert split.island.max() + 1 <= min(REAL[name, seamless], 1 + regions(mesh, kept))
    # Little is cut: each new cut is about as long as what it parts is wide.
    size = np.sqrt(oracle.triangle_areas(mesh.positions, mesh.triangles).sum())
    assert cut_length(mesh, split.cut_edges) - cut_length(mesh, kept.cut_edges) <= 0.5 * size
    if seamless:
        assert split.seamless.error == 0
    else:
        assert oracle.metric_gap(kept.corner_uv, split.corner_uv) <= 1e-9
    # No island is a sliver.
    area = np.bincount(split.island, oracle.triangle_areas(mesh.positions, mesh.triangles))
    assert area.min() >= 0.005 * area.sum()


@pytest.mark.parametrize("options", [SPLIT, SEAMLESS_SPLIT], ids=["conformal", "seamless"])
def test_cuts_that_split_overlaps_are_not_required_ones(options: lsgp.Options) -> None:
    strip = wound(60)
    surface = lsgp.Surface(strip.positions, strip.triangles)
    assert len(lsgp.parameterize(surface, [], None, PLAIN).cut_edges) == 0
    result = lsgp.parameterize(surface, [], None, options)
    assert len(result.cut_edges) > 0 and len(result.required_cuts) == 0
    ball = meshes.bumpy_sphere(2)
    whole = lsgp.parameterize(lsgp.Surface(ball.positions, ball.triangles), ball.cones, None, options)
    assert pairs(whole.required_cuts) == pairs(whole.cut_edges)


@pytest.mark.slow
def test_polygons_of_thousands_of_corners_come_apart_from_their_neighbors() -> None:
    """The faces beside such a pair make millions of pairs, of which few overlap."""
    given = of_polygons(comb(500))
    found = lsgp.auto_unwrap(given, pack="shelves")
    assert found.island.min() == 0 and found.island.max() > 0
    assert len(lsgp.overlapping_triangles(found.corner_uv)) == 0
    flat = np.ptp(given.positions[given.triangles][..., 2], axis=1) == 0
    low = given.positions[given.triangles[:, 0], 2] == 0
    assert all(len(np.unique(found.island[flat & side])) == 1 for side in (low, ~low))


@pytest.mark.slow
def test_a_band_of_a_hundred_turns_comes_apart_into_about_as_many_islands() -> None:
    """It lies on itself so often that it is halved before its overlaps are listed."""
    turns = 100
    mesh = wound(turns * PER_TURN, np.linspace(1, 2, 3))
    found = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), [], None, SPLIT)
    assert faults(mesh, found, SPLIT) == [] and found.warnings == []
    assert turns <= found.island.max() + 1 <= 1.1 * turns
