# SPDX-License-Identifier: GPL-3.0-or-later
"""`pad_image`: what lies beyond cuts is in the gutters, and covered texels stay."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from gutter_checks import (
    bake,
    both_sides,
    difference_across_cuts,
    difference_of_neighbors,
    inset,
    lookup,
    smeared,
    unwrapped,
)
from map_checks import surface
from scipy.spatial import cKDTree

SIZE, MARGIN = 256, 8
BALL = meshes.bumpy_sphere(2)
MESHES = {
    "ball": meshes.bumpy_sphere(3),
    "flower": meshes.flower(3),
    "torus": meshes.torus(),
    "open": meshes.hill(),
    "box": meshes.cube(4, (1, 1.5, 2)),
}
# Two triangles of the unit square, taken apart: the right one is turned by half a turn and moved.
PAIR = surface(meshes.make([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [3, 2, 1]]))
PAIR_UV = np.array(
    [[[0.1, 0.1], [0.4, 0.1], [0.1, 0.4]], [[0.6, 0.6], [0.9, 0.6], [0.6, 0.9]]],
)


@pytest.mark.parametrize("name", ["ball", "flower", "torus", "box"])
def test_lookups_at_both_sides_of_cuts_agree(name: str) -> None:
    whole, uv = unwrapped(MESHES[name])
    uv = inset(uv, MARGIN / SIZE)
    image, covered = bake(whole, uv, SIZE)
    padded = lsgp.pad_image(image, whole, uv, MARGIN)
    neighbors = difference_of_neighbors(image, covered)
    ours = difference_across_cuts(whole, uv, padded, 2)
    other = difference_across_cuts(whole, uv, smeared(image, covered, MARGIN), 2)
    assert max(ours) <= 1.2 * neighbors
    assert ours[0] < other[0] / 2 and ours[1] < other[1] / 4


@pytest.mark.parametrize("name", ["ball", "flower", "torus"])
def test_maps_whose_cuts_have_edges_of_two_lengths_gain_as_well(name: str) -> None:
    whole, uv = unwrapped(MESHES[name])
    x, y = uv[..., 0], uv[..., 1]
    uv = uv + 0.03 * np.stack([np.sin(9 * y + 5 * x), np.cos(11 * x + 5 * y)], axis=-1)
    uv = inset((uv - uv.min()) / np.ptp(uv), MARGIN / SIZE)
    assert _largest_ratio_of_copies(whole, uv) > 1.2
    image, covered = bake(whole, uv, SIZE)
    padded = lsgp.pad_image(image, whole, uv, MARGIN)
    ours = difference_across_cuts(whole, uv, padded, 2)
    other = difference_across_cuts(whole, uv, smeared(image, covered, MARGIN), 2)
    assert max(ours) <= 1.2 * difference_of_neighbors(image, covered)
    assert ours[0] < other[0] / 2 and ours[1] < other[1] / 3


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_covered_texels_stay_and_gutters_are_filled(name: str) -> None:
    whole, uv = unwrapped(MESHES[name])
    uv = inset(uv, MARGIN / SIZE)
    image, covered = bake(whole, uv, SIZE)
    given = image.copy()
    padded = lsgp.pad_image(image, whole, uv, MARGIN)
    assert (image == given).all() and (padded[covered] == image[covered]).all()
    distance = _distance_to_edges(uv)
    assert (padded[~covered & (distance < MARGIN - 0.1)] > 0).all()
    assert (padded[~covered & (distance > MARGIN + 0.1)] == 0).all()


def test_a_gutter_holds_exactly_what_is_beyond_the_transition() -> None:
    size = 64
    # A linear function of the surface, which bilinear sampling keeps, brought to texels through each triangle.
    image = np.zeros((size, size))
    rows, columns = np.mgrid[:size, :size]
    u, v = (columns + 0.5) / size, 1 - (rows + 0.5) / size
    on_left = u + v < 0.45
    image[on_left] = (2 * (u - 0.1) / 0.3 + (v - 0.1) / 0.3)[on_left]
    # Of the right triangle: corner 3 is at (0.6, 0.6), corner 2 to its right and corner 1 above it.
    image[~on_left] = (3 - 2 * (u - 0.6) / 0.3 - (v - 0.6) / 0.3)[~on_left]
    padded = lsgp.pad_image(image, PAIR, PAIR_UV, 4)
    # Beyond the edge from corner 1 to corner 2, away from its ends and from texels that touch the border.
    past = (u + v - 0.5) / np.sqrt(2) * size
    along = (v - u) / 2
    beyond = (past > 2) & (past < 4) & (np.abs(along) < 0.08)
    assert beyond.sum() > 10
    expected = 2 * (u - 0.1) / 0.3 + (v - 0.1) / 0.3
    np.testing.assert_allclose(padded[beyond], expected[beyond], atol=1e-12)


def test_a_mirrored_part_is_an_end_of_the_surface() -> None:
    mirrored = PAIR_UV.copy()
    mirrored[1] = mirrored[1][:, ::-1]
    image = np.random.default_rng(1).random((64, 64))
    apart = surface(meshes.triangle_soup(meshes.make(PAIR.positions, PAIR.triangles)))
    assert (lsgp.pad_image(image, PAIR, mirrored, 4) == lsgp.pad_image(image, apart, mirrored, 4)).all()
    assert (lsgp.pad_image(image, PAIR, PAIR_UV, 4) != lsgp.pad_image(image, apart, PAIR_UV, 4)).any()


# A square whose sides lie along texels, (10, 10) to (30, 30) of 40.
SHEET = surface(meshes.grid(3, 3))


def _sheet_uv() -> np.ndarray:
    return 0.25 + 0.5 * _flat(SHEET)


def _on_sheet(image: np.ndarray) -> np.ndarray:
    """The image where the sheet covers it, else 0."""
    kept = np.zeros_like(image)
    kept[10:30, 10:30] = image[10:30, 10:30]
    return kept


def _gutter(width: int) -> np.ndarray:
    """(40, 40), which texels are beside the sheet, no farther than so many rows and columns."""
    beside = np.zeros((40, 40), bool)
    beside[10 - width : 30 + width, 10 - width : 30 + width] = True
    beside[10:30, 10:30] = False
    return beside


def test_where_the_surface_ends_noise_is_continued_by_the_nearest_covered_texel() -> None:
    image = _on_sheet(np.random.default_rng(2).random((40, 40)))
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 5)
    places = np.argwhere(_on_sheet(np.ones((40, 40))) > 0)
    filled = (padded != 0) & (image == 0)
    assert filled.sum() > 400
    # Of texels as near as each other either will do.
    for i, j in np.argwhere(filled):
        squares = ((places - (i, j)) ** 2).sum(axis=1)
        assert padded[i, j] in image[tuple(places[squares == squares.min()].T)]


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32", "float64"])
def test_where_the_surface_ends_a_plane_goes_on_for_eight_texels(dtype: str) -> None:
    rows, columns = np.mgrid[:40, :40]
    plane = 100 + 2.0 * columns - 3.0 * rows
    # Channels alike but for their range: in the second, extreme texels leave room for the plane.
    wide = plane.copy()
    wide[19:21, 19:21] = [[0, 255], [0, 255]]
    image = np.stack([_on_sheet(plane), _on_sheet(wide)], axis=2).astype(dtype)
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 12)
    inside = plane[10:30, 10:30]
    near = _gutter(5)
    np.testing.assert_allclose(padded[near, 1], plane[near], atol=1e-3 if dtype[0] == "f" else 0.5)
    clipped = np.clip(plane, inside.min(), inside.max())
    np.testing.assert_allclose(padded[near, 0], clipped[near], atol=1e-3 if dtype[0] == "f" else 0.5)
    # Left of the sheet, texel by texel away from it.
    left = padded[20, :10, 1].astype(float)[::-1]
    np.testing.assert_allclose(left[:8], plane[20, 2:10][::-1], atol=0.5)
    assert left[8] == left[9] == left[7]


def test_where_the_surface_ends_edges_in_the_image_do_not_ring() -> None:
    rows, columns = np.mgrid[:40, :40]
    image = _on_sheet(np.where((rows // 7 + columns // 7) % 2, 0.8, 0.2))
    image[12, 12] = 1
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 5)
    assert set(np.unique(padded)) == {0.0, 0.2, 0.8, 1.0}


def test_where_the_surface_ends_lookups_are_nearer_to_the_content_than_with_the_nearest_texel() -> None:
    rows, columns = np.mgrid[:40, :40]
    content = 0.5 + 0.2 * np.sin(0.17 * columns + 0.1 * rows) + 0.2 * np.cos(0.13 * rows)
    image, covered = _on_sheet(content), _on_sheet(np.ones((40, 40))) > 0
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 8)
    share = np.linspace(0.25, 0.75, 100)
    ends = np.concatenate(
        [np.stack([other, share][::turn], axis=1) for turn in (1, -1) for other in (0 * share + 0.25, 0 * share + 0.75)]
    )

    def error(kind: np.ndarray) -> float:
        return float(np.abs(lookup(kind, ends) - lookup(content, ends)).mean())

    assert error(padded) < error(smeared(image, covered, 8)) / 3


def test_where_the_surface_ends_values_that_are_no_numbers_stay_where_they_are() -> None:
    rows, columns = np.mgrid[:40, :40]
    image = _on_sheet(2.0 * columns - rows)
    image[11, 11], image[28, 28] = np.nan, np.inf
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 5)
    assert np.isfinite(padded[_gutter(5)]).all()


def test_where_the_surface_ends_normals_keep_their_length() -> None:
    rows, columns = np.mgrid[:40, :40]
    x, y = 0.03 * (columns - 20.0), 0.02 * (rows - 20.0)
    normals = np.stack([x, y, np.sqrt(1 - x**2 - y**2)], axis=2)
    image = _on_sheet(0.5 + 0.5 * normals)
    padded = lsgp.pad_image(image, SHEET, _sheet_uv(), 5, normal_map=True)
    gutter = _gutter(3)
    found = 2 * padded[gutter] - 1
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1, atol=1e-9)
    plain = 2 * lsgp.pad_image(image, SHEET, _sheet_uv(), 5)[gutter] - 1
    assert np.abs(np.linalg.norm(plain, axis=1) - 1).max() > 1e-3
    # Two components leave the third to the shader, and are no longer than a unit.
    steep = _on_sheet(0.5 + 0.5 * np.stack([0.095 * (columns - 20.0), 0 * rows], axis=2))
    pair = lsgp.pad_image(steep, SHEET, _sheet_uv(), 5, normal_map=True)[gutter]
    assert np.linalg.norm(2 * pair - 1, axis=1).max() <= 1 + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32", "float64"])
@pytest.mark.parametrize("channels", [None, 1, 2, 3, 4])
def test_type_and_shape_are_kept_and_channels_padded_alike(dtype: str, channels: int | None) -> None:
    whole, uv = unwrapped(BALL)
    image, _ = bake(whole, uv, 64)
    scale = np.iinfo(dtype).max if dtype[0] == "u" else 1
    given = np.round(image * scale) if dtype[0] == "u" else image
    given = given.astype(dtype)
    expected = lsgp.pad_image(given, whole, uv, 4)
    if channels is not None:
        given = np.repeat(given[..., None], channels, axis=2)
        expected = np.repeat(expected[..., None], channels, axis=2)
    padded = lsgp.pad_image(given, whole, uv, 4)
    assert (padded.dtype, padded.shape) == (given.dtype, given.shape)
    assert (padded == expected).all()
    exact = lsgp.pad_image(given / scale, whole, uv, 4) * scale
    assert np.abs(padded - exact).max() <= (0.5 + 1e-6 if dtype[0] == "u" else 1e-6)


def test_normals_are_turned_with_the_map() -> None:
    """A field of directions that runs on across cuts: of the gradient of the baked function in texture space."""
    whole, uv = unwrapped(MESHES["ball"])
    uv = inset(uv, MARGIN / SIZE)
    smooth, covered = bake(whole, uv, SIZE)
    smooth = lsgp.pad_image(smooth, whole, uv, MARGIN)
    down, right = np.gradient(smooth)
    image = np.full((SIZE, SIZE, 3), 0.5)
    image[covered, 0], image[covered, 1] = 0.5 + 5 * right[covered], 0.5 - 5 * down[covered]
    left, other, turn = both_sides(whole, uv, 1 / SIZE)

    def mismatch(padded: np.ndarray, sign: float) -> float:
        here, there = (lookup(padded, side) @ [1, 1j, 0] - (0.5 + 0.5j) for side in (left, other))
        return float(np.abs(here * np.exp(1j * sign * turn) - there).mean())

    turned = lsgp.pad_image(image, whole, uv, MARGIN, normal_map=True)
    plain = lsgp.pad_image(image, whole, uv, MARGIN)
    assert np.abs(turn).max() > 0.5
    assert mismatch(turned, 1) < mismatch(plain, 1) / 5
    assert mismatch(turned, 1) < mismatch(turned, -1) / 5
    assert (turned[..., 2] == plain[..., 2]).all()
    assert (turned[covered] == image[covered]).all()


def test_flat_normals_stay_flat() -> None:
    whole, uv = unwrapped(BALL)
    image = np.full((64, 64, 3), 0.5)
    np.testing.assert_allclose(lsgp.pad_image(image, whole, uv, 4, normal_map=True), image, atol=1e-12)


def test_without_a_margin_nothing_changes() -> None:
    whole, uv = unwrapped(BALL)
    image, _ = bake(whole, uv, 64)
    assert (lsgp.pad_image(image, whole, uv, 0) == image).all()


def test_triangles_without_coordinates_are_ends_of_the_surface() -> None:
    whole, uv = unwrapped(BALL)
    part = uv.copy()
    part[::2] = np.nan
    image, _ = bake(whole, uv, 64)
    kept = lsgp.Surface(whole.positions, whole.triangles[1::2])
    assert (lsgp.pad_image(image, whole, part, 4) == lsgp.pad_image(image, kept, uv[1::2], 4)).all()


def test_images_need_not_be_square() -> None:
    whole, uv = unwrapped(BALL)
    uv = inset(uv, 0.05)
    image, _ = bake(whole, uv, 128)
    wide = np.concatenate([image, np.zeros_like(image)], axis=1)
    padded = lsgp.pad_image(wide, whole, uv * [0.5, 1], 4)
    np.testing.assert_allclose(padded[:, :128], lsgp.pad_image(image, whole, uv, 4), atol=1e-9)
    assert (padded[:, 128:] == 0).all()


@pytest.mark.parametrize(
    ("change", "code", "told"),
    [
        ({"image": np.zeros((8, 8), np.int32)}, "WRONG_DTYPE", "int32"),
        ({"image": np.zeros((8, 8), bool)}, "WRONG_DTYPE", "bool"),
        ({"image": np.zeros((8, 8, 5))}, "WRONG_SHAPE", "(8, 8, 5)"),
        ({"image": np.zeros((8, 8, 0))}, "WRONG_SHAPE", "(8, 8, 0)"),
        ({"image": np.zeros((0, 8))}, "WRONG_SHAPE", "(0, 8)"),
        ({"image": np.zeros(8)}, "WRONG_SHAPE", "(8,)"),
        ({"image": np.zeros((8, 8)), "normal_map": True}, "WRONG_SHAPE", "two channels"),
        ({"margin": -1}, "WRONG_PARAMETER", "0 or more"),
        ({"margin": float("nan")}, "WRONG_PARAMETER", "0 or more"),
        ({"margin": float("inf")}, "WRONG_PARAMETER", "0 or more"),
        ({"corner_uv": PAIR_UV[:1]}, "WRONG_SHAPE", "(1, 3, 2)"),
        ({"corner_uv": PAIR_UV * np.nan}, "NO_UV", "Unwrap"),
        ({"corner_uv": PAIR_UV + 0.2}, "ISLANDS_OUTSIDE", "1 of 2 triangles"),
        ({"corner_uv": PAIR_UV - 0.2}, "ISLANDS_OUTSIDE", "-0.1"),
        ({"corner_uv": PAIR_UV * np.inf}, "ISLANDS_OUTSIDE", "inf"),
    ],
)
def test_what_cannot_be_padded_is_refused(change: dict, code: str, told: str) -> None:
    call = {"image": np.zeros((8, 8, 3)), "surface": PAIR, "corner_uv": PAIR_UV, "margin": 2}
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.pad_image(**call | change)
    assert caught.value.code == code and told in caught.value.message


def test_a_seamless_layout_that_repeats_is_refused_with_its_triangles() -> None:
    whole = surface(BALL)
    uv = lsgp.parameterize(whole, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless(tiles=6))).corner_uv
    with pytest.raises(lsgp.InputError, match="seamless ones need no gutters") as caught:
        lsgp.pad_image(np.zeros((64, 64)), whole, uv, 4)
    outside = ((uv < -1e-6) | (uv > 1 + 1e-6)).any(axis=(1, 2))
    assert caught.value.elements.kind == "triangles"
    assert caught.value.elements.indices.tolist() == np.flatnonzero(outside).tolist()


def _largest_ratio_of_copies(whole: lsgp.Surface, uv: np.ndarray) -> float:
    """Of the lengths of the two copies of an edge."""
    length: dict[tuple[int, int], list[float]] = {}
    for triangle, corners in zip(whole.triangles.tolist(), uv, strict=True):
        for c in range(3):
            edge = min(triangle[c], triangle[c - 1]), max(triangle[c], triangle[c - 1])
            length.setdefault(edge, []).append(float(np.linalg.norm(corners[c] - corners[c - 1])))
    return max(max(copies) / min(copies) for copies in length.values())


def _flat(whole: lsgp.Surface) -> np.ndarray:
    """(m, 3, 2), from above, in the unit square."""
    places = whole.positions[:, :2]
    return ((places - places.min(axis=0)) / np.ptp(places, axis=0))[whole.triangles]


def _distance_to_edges(uv: np.ndarray) -> np.ndarray:
    """(SIZE, SIZE), pixels from the center of each texel to the nearest of many points on edges."""
    share = np.linspace(0, 1, 200)[:, None]
    ends = np.roll(uv, -1, axis=1).reshape(-1, 1, 2)
    points = (uv.reshape(-1, 1, 2) * (1 - share) + ends * share).reshape(-1, 2) * SIZE
    rows, columns = np.mgrid[:SIZE, :SIZE]
    return cKDTree(points).query(np.stack([columns + 0.5, SIZE - rows - 0.5], axis=-1))[0]
