# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches of maps as strips, grids and rectangles; lengths and places are computed again from the mesh."""

import lsgp
import numpy as np
import pytest

COLUMNS, ROWS = 12, 6


def bent_grid(columns=COLUMNS, rows=ROWS):
    """A wavy sheet of quads, as a surface whose edges are those of the quads, the vertices by column and row, and the
    two triangles of each quad by column and row."""
    place = np.stack(np.meshgrid(np.arange(columns + 1), np.arange(rows + 1), indexing="ij"), -1).reshape(-1, 2)
    x, y = place.T / columns
    positions = np.stack([x + 0.1 * np.sin(6 * y), y + 0.15 * np.sin(5 * x), 0.2 * np.cos(4 * x) * np.sin(3 * y)], 1)
    number = np.arange(len(place)).reshape(columns + 1, rows + 1)
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    a, b, c, d = (corner.ravel() for corner in corners)
    triangles = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1).reshape(-1, 3)
    edges = np.concatenate([np.stack(pair, 1) for pair in ((a, b), (b, c), (c, d), (d, a))])
    surface = lsgp.Surface(positions, triangles, edges=edges)
    return surface, number, np.arange(len(triangles)).reshape(columns, rows, 2)


def mapped(surface):
    return lsgp.parameterize(surface, []).corner_uv


def at(surface, corner_uv, vertices):
    """(k, 2) where vertices are in a map that is not cut."""
    where = np.full((len(surface.positions), 2), np.nan)
    where[surface.triangles] = corner_uv
    return where[vertices]


def area(corner_uv):
    first, second = np.moveaxis(corner_uv[:, 1:] - corner_uv[:, :1], 1, 0)
    return (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2


def middle(corner_uv):
    weights = area(corner_uv)
    return (weights[:, None] * corner_uv.mean(axis=1)).sum(0) / weights.sum()


def mean_lengths(surface, lines):
    """(k,) the mean width on the surface of the quads between one line of vertices and the next: of each the mean of
    both sides."""
    lengths = np.linalg.norm(np.diff(surface.positions[lines], axis=0), axis=2)
    return (lengths[:, 1:] + lengths[:, :-1]).mean(axis=1) / 2


@pytest.mark.parametrize("shape", ["grid", "even-grid"])
def test_grid_has_straight_lines_at_the_spacing_that_was_asked_for(shape):
    surface, number, quads = bent_grid()
    before = mapped(surface)
    shaped = lsgp.shape_patches(surface, before, quads.ravel(), shape)
    uv = at(surface, shaped.corner_uv, number.ravel()).reshape(*number.shape, 2)
    across, up = (0, 1) if np.ptp(uv[:, 0, 0]) > np.ptp(uv[:, 0, 1]) else (1, 0)
    assert np.ptp(uv[..., across], axis=1).max() < 1e-12
    assert np.ptp(uv[..., up], axis=0).max() < 1e-12
    widths = abs(np.diff(uv[:, 0, across]))
    heights = abs(np.diff(uv[0, :, up]))
    columns, rows = mean_lengths(surface, number), mean_lengths(surface, number.T)
    if shape == "even-grid":
        columns, rows = np.full(COLUMNS, columns.mean()), np.full(ROWS, rows.mean())
    scale = widths.sum() / columns.sum()
    np.testing.assert_allclose(widths, scale * columns, rtol=1e-9)
    np.testing.assert_allclose(heights, scale * rows, rtol=1e-9)
    assert (shaped.patches, shaped.warnings) == (1, [])
    assert area(shaped.corner_uv).sum() == pytest.approx(area(before).sum())
    np.testing.assert_allclose(middle(shaped.corner_uv), middle(before), atol=1e-12)


def test_rectangle_has_its_corners_and_lengths_and_no_flips():
    surface, number, quads = bent_grid()
    before = mapped(surface)
    shaped = lsgp.shape_patches(surface, before, quads.ravel(), "rectangle")
    uv = at(surface, shaped.corner_uv, number.ravel()).reshape(*number.shape, 2)
    low, high = shaped.corner_uv.min(axis=(0, 1)), shaped.corner_uv.max(axis=(0, 1))
    for line in (number[0], number[-1], number[:, 0], number[:, -1]):
        side = at(surface, shaped.corner_uv, line)
        along = int(np.ptp(side, axis=0).argmax())
        assert np.ptp(side[:, 1 - along]) < 1e-12
        assert np.ptp(side[:, along]) == pytest.approx((high - low)[along])
        lengths = np.linalg.norm(np.diff(surface.positions[line], axis=0), axis=1)
        steps = abs(np.diff(side[:, along]))
        np.testing.assert_allclose(steps / steps.sum(), lengths / lengths.sum(), rtol=1e-9)
    assert (area(shaped.corner_uv) > 0).all()
    assert area(shaped.corner_uv).sum() == pytest.approx(area(before).sum())
    # Inside, less stretch than the grid with the same corners.
    stretch = [
        lsgp.measure_distortion(surface, lsgp.shape_patches(surface, before, quads.ravel(), shape).corner_uv).distortion
        for shape in ("rectangle", "even-grid")
    ]
    assert stretch[0].l2_stretch < stretch[1].l2_stretch
    assert uv.shape == (COLUMNS + 1, ROWS + 1, 2)


def test_rectangle_takes_the_corners_that_are_given():
    surface, number, quads = bent_grid()
    corners = [number[2, 0], number[-3, 0], number[-1, -1], number[0, -1]]
    shaped = lsgp.shape_patches(surface, mapped(surface), quads.ravel(), "rectangle", corners=corners)
    where = at(surface, shaped.corner_uv, corners)
    low, high = shaped.corner_uv.min(axis=(0, 1)), shaped.corner_uv.max(axis=(0, 1))
    nearest = [min(np.linalg.norm(p - (x, y)) for x in (low[0], high[0]) for y in (low[1], high[1])) for p in where]
    assert max(nearest) < 1e-12
    with pytest.raises(lsgp.InputError, match="3 corners") as caught:
        lsgp.shape_patches(surface, mapped(surface), quads.ravel(), "rectangle", corners=corners[:3])
    assert caught.value.code == "SHAPE_IMPOSSIBLE"


def test_rest_of_an_island_follows_a_straight_row():
    surface, _, quads = bent_grid()
    row = quads[:, 3].ravel()
    shaped = lsgp.shape_patches(surface, mapped(surface), row, "strip")
    height = np.ptp(shaped.corner_uv[row].reshape(-1, 2), axis=0).min()
    values = np.unique(shaped.corner_uv[row].reshape(-1, 2)[:, 1].round(12))
    assert len(values) == 2
    assert np.ptp(values) == pytest.approx(height)
    measured = lsgp.measure_distortion(surface, shaped.corner_uv)
    assert measured.island.max() == 0
    assert len(measured.flipped) == len(shaped.warnings) == 0
    assert measured.distortion.l2_stretch < 1.1
    assert len(shaped.moved) == len(surface.triangles)


def test_mirrored_island_stays_mirrored():
    surface, _, quads = bent_grid()
    before = mapped(surface) * (-1, 1)
    for chosen, shape in ((quads.ravel(), "grid"), (quads[:, 2].ravel(), "strip"), (quads.ravel(), "rectangle")):
        shaped = lsgp.shape_patches(surface, before, chosen, shape)
        assert (area(shaped.corner_uv) < 0).all()


def test_pins_stay_where_they_are_or_the_patch_is_left():
    surface, number, quads = bent_grid()
    before = mapped(surface)
    chosen = quads.ravel()
    one = np.flatnonzero(surface.triangles.ravel() == number[4, 3])
    shaped = lsgp.shape_patches(surface, before, chosen, "grid", pinned=one)
    assert np.array_equal(shaped.corner_uv.reshape(-1, 2)[one], before.reshape(-1, 2)[one])
    two = np.flatnonzero(np.isin(surface.triangles.ravel(), [number[4, 3], number[0, 5]]))
    with pytest.raises(lsgp.InputError, match="Unpin") as caught:
        lsgp.shape_patches(surface, before, chosen, "grid", pinned=two)
    assert caught.value.code == "SHAPE_IMPOSSIBLE"
    # Those of the faces beside it stay as well.
    beside = np.flatnonzero(surface.triangles.ravel() == number[0, 0])
    row = lsgp.shape_patches(surface, before, quads[:, 4].ravel(), "strip", pinned=beside)
    np.testing.assert_allclose(row.corner_uv.reshape(-1, 2)[beside], before.reshape(-1, 2)[beside], atol=1e-12)


def test_what_is_no_grid_is_refused_with_its_faces():
    surface, _, quads = bent_grid()
    before = mapped(surface)
    with pytest.raises(lsgp.InputError, match="no single row") as caught:
        lsgp.shape_patches(surface, before, quads.ravel(), "strip")
    assert caught.value.elements.indices.tolist() == quads.ravel().tolist()
    with pytest.raises(lsgp.InputError, match="no quads"):
        lsgp.shape_patches(surface, before, quads.ravel()[:-1], "grid")
    # Three quads about a vertex.
    corner = lsgp.Surface(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1], [1, 0, 1]],
        [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 1]],
        edges=[[0, 1], [1, 2], [2, 3], [3, 0], [3, 4], [4, 5], [5, 0], [5, 6], [6, 1]],
    )
    with pytest.raises(lsgp.InputError, match="not four of them"):
        lsgp.shape_patches(corner, lsgp.parameterize(corner, []).corner_uv, np.arange(6), "grid")


def test_patch_that_cannot_is_left_beside_one_that_can():
    surface, _, quads = bent_grid()
    before = mapped(surface)
    chosen = np.concatenate([quads[:, 0].ravel(), quads[:5, 3:5].ravel()])
    shaped = lsgp.shape_patches(surface, before, chosen, "strip")
    assert shaped.patches == 1
    (finding,) = shaped.warnings
    assert finding.code == "SHAPE_IMPOSSIBLE"
    assert finding.elements.indices.tolist() == sorted(quads[:5, 3:5].ravel().tolist())


def test_faces_with_a_hole_are_no_rectangle_but_follow():
    surface, _, quads = bent_grid()
    before = mapped(surface)
    kept = np.setdiff1d(np.arange(len(surface.triangles)), quads[5:7, 2:4].ravel())
    with pytest.raises(lsgp.InputError, match="hole"):
        lsgp.shape_patches(surface, before, kept, "rectangle")
    uv = np.full(before.shape, np.nan)
    uv[kept] = before[kept]
    shaped = lsgp.shape_patches(surface, uv, quads[:, 0].ravel(), "strip")
    measured = lsgp.measure_distortion(surface, shaped.corner_uv)
    assert (measured.island.max(), len(measured.cut_edges), len(measured.flipped)) == (0, 0, 0)
    assert np.isnan(shaped.corner_uv).any(axis=(1, 2)).sum() == len(surface.triangles) - len(kept)


def test_numbers_of_vertices_do_not_matter():
    surface, _, quads = bent_grid()
    order = np.random.default_rng(3).permutation(len(surface.positions))
    rank = np.argsort(order)
    other = lsgp.Surface(surface.positions[order], rank[surface.triangles], edges=rank[surface.edges])
    before = mapped(surface)
    for shape in ("grid", "rectangle"):
        found = [lsgp.shape_patches(one, before, quads.ravel(), shape).corner_uv for one in (surface, other)]
        np.testing.assert_allclose(*found, atol=1e-9)
