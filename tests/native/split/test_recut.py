# SPDX-License-Identifier: GPL-3.0-or-later
"""Other cuts for the same cones, with which a layout overlaps itself less: islands that need not be split."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import pairs
from meshes import Mesh
from scipy.sparse import coo_matrix, csgraph
from test_overlaps import GENUS_TWO, cut_length, faults

SURFACES = {"double torus": GENUS_TWO, "flower": meshes.flower(3, 0.6)}


@cache
def with_cones(name: str, count: int) -> Mesh:
    mesh = SURFACES[name]
    placed = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles), count=count)
    return mesh._replace(cones=np.array(placed.cones, np.int32))


def unwrap(mesh: Mesh, overlaps: str, seamless: bool = False, **surface: object) -> lsgp.Result:
    options = lsgp.Options(seamless=lsgp.Seamless() if seamless else None, overlaps=overlaps)
    return lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, **surface), mesh.cones, options=options)


# Splitting alone leaves two or three islands.
@pytest.mark.parametrize(
    ("name", "count", "seamless"),
    [
        ("double torus", 16, False),
        ("double torus", 20, False),
        ("flower", 24, False),
        ("flower", 16, True),
        ("flower", 20, True),
    ],
)
def test_layouts_come_apart_in_one_island(name: str, count: int, seamless: bool) -> None:
    mesh = with_cones(name, count)
    kept, split = unwrap(mesh, "keep", seamless), unwrap(mesh, "split", seamless)
    assert len(kept.overlapping) > 0
    assert len(split.overlapping) == 0 and split.island.max() == 0
    assert cut_length(mesh, split.cut_edges) <= 1.25 * cut_length(mesh, kept.cut_edges)
    # The same map of the same cones, which all are on the cuts.
    options = lsgp.Options(seamless=lsgp.Seamless() if seamless else None, overlaps="split")
    assert faults(mesh, split, options) == []
    assert np.array_equal(split.cones, kept.cones) and np.array_equal(split.cone_angles, kept.cone_angles)
    assert set(split.cones.tolist()) <= set(split.cut_edges.ravel().tolist())
    assert split.seams.sister_ratio_max <= 1 + 1e-9
    if seamless:
        assert split.seamless.error == 0
    else:
        assert oracle.metric_gap(kept.corner_uv, split.corner_uv) <= 1e-9


@pytest.mark.slow
@pytest.mark.many_solves
def test_most_layouts_come_apart_in_one_island() -> None:
    """Which ones do not can depend on the last digits of the map."""
    islands = []
    for name, seamless in (("double torus", False), ("flower", False), ("flower", True)):
        for mesh in (with_cones(name, count) for count in range(14, 31, 2)):
            if len(unwrap(mesh, "keep", seamless).overlapping) > 0:
                islands.append(int(unwrap(mesh, "split", seamless).island.max()) + 1)
    assert len(islands) >= 24 and islands.count(1) >= 0.85 * len(islands)


@pytest.mark.parametrize("seamless", [False, True])
def test_pieces_move_rigidly_and_their_seams_fit_in_single_precision(seamless: bool) -> None:
    """Between the old and the new cuts the coordinates differ by one motion for each piece, at one scale for all."""
    mesh = with_cones("flower", 24)
    kept, split = unwrap(mesh, "keep", seamless), unwrap(mesh, "split", seamless)
    tail, head, twin = oracle.halfedges(mesh.triangles)
    cut = pairs(kept.cut_edges) | pairs(split.cut_edges)
    open_ = np.array([(min(a, b), max(a, b)) in cut for a, b in zip(tail, head, strict=True)])
    joined = np.flatnonzero(~open_ & (twin >= 0))
    graph = coo_matrix((np.ones(len(joined)), (joined // 3, twin[joined] // 3)), (len(mesh.triangles),) * 2)
    count, piece = csgraph.connected_components(graph, directed=False)
    assert count > 1
    before, after = (oracle.as_complex(result.corner_uv) for result in (kept, split))
    # Seamless coordinates are rounded to numbers of float32, so that their sums are exact.
    rounding = 2.0**-22 if seamless else 1e-9
    factors = []
    for one in range(count):
        z, w = before[piece == one].ravel(), after[piece == one].ravel()
        factor = np.vdot(z - z.mean(), w - w.mean()) / np.vdot(z - z.mean(), z - z.mean())
        assert np.abs(w - w.mean() - factor * (z - z.mean())).max() <= rounding * np.ptp(after.real)
        factors.append(factor)
    assert np.ptp(np.abs(factors)) <= 10 * rounding * np.abs(factors[0])
    assert len(np.unique(np.round(factors, 6))) > 1  # some have turned against others
    # Judged in single precision.
    options = lsgp.Options(seamless=lsgp.Seamless() if seamless else None, overlaps="split")
    assert faults(mesh, split, options) == []


def test_other_cuts_run_along_edges_that_may_be_cut() -> None:
    mesh = with_cones("flower", 24)
    edges = meshes.edges_of(mesh.triangles)
    allowed = edges[np.random.default_rng(5).random(len(edges)) < 0.9]
    split = unwrap(mesh, "split", edges=allowed)
    assert pairs(split.cut_edges) <= pairs(allowed) and len(split.overlapping) == 0


def test_other_cuts_keep_to_where_they_are_cheap() -> None:
    mesh = with_cones("double torus", 20)
    edges = meshes.edges_of(mesh.triangles)
    is_dear = mesh.positions[edges].mean(axis=1)[:, 2] < -0.1
    surface = {"edges": edges, "cut_costs": np.where(is_dear, 20.0, 1.0)}
    kept, split = unwrap(mesh, "keep", **surface), unwrap(mesh, "split", **surface)
    assert len(kept.overlapping) > 0 and not pairs(kept.cut_edges) & pairs(edges[is_dear])
    assert split.island.max() == 0 and not pairs(split.cut_edges) & pairs(edges[is_dear])


@pytest.mark.parametrize("name", SURFACES)
def test_marked_seams_stay(name: str) -> None:
    mesh = with_cones(name, 24)
    kept = unwrap(mesh, "keep")
    seams = kept.cut_edges[kept.cut_edges.sum(axis=1) % 3 > 0]
    assert pairs(seams) <= pairs(unwrap(mesh, "split", seams=seams).cut_edges)


def test_cuts_that_are_not_free_stay_and_the_layout_is_split() -> None:
    mesh = with_cones("double torus", 40)  # with so many, in several islands
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    straight = lsgp.Options(overlaps="split", prescription="straightness")
    assert lsgp.parameterize(surface, mesh.cones, options=straight).island.max() > 0
    pinned = lsgp.Pins(np.array([3]), np.array([[5.25, -3.5]]))
    options = lsgp.Options(overlaps="split")
    assert lsgp.parameterize(surface, mesh.cones, options=options, pins=pinned).island.max() > 0
