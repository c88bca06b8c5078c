# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of the paper's 7.1 against singular value decompositions, and for maps whose figures are known."""

from __future__ import annotations

import dataclasses

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from map_checks import pairs, surface, unwrap

MAPPED = {
    "bumpy sphere": meshes.bumpy_sphere(2),
    "flower": meshes.flower(2),
    "hill": meshes.hill(),
    "two holes": meshes.disk_with_holes(12, 2),
}


def flat_uv(mesh: meshes.Mesh, matrix: object = ((1, 0), (0, 1))) -> np.ndarray:
    return mesh.positions[mesh.triangles][..., :2] @ np.array(matrix, float).T


def figures(measurement: lsgp.Measurement | lsgp.Result) -> dict[str, float]:
    return dataclasses.asdict(measurement.distortion)


@pytest.mark.parametrize("method", ["lsgp", "lscm"])
@pytest.mark.parametrize("name", MAPPED)
def test_figures_of_a_map_are_the_oracles(name: str, method: str) -> None:
    mesh = MAPPED[name]
    result = unwrap(mesh, method=method)
    expected = oracle.distortion(mesh.positions, mesh.triangles, result.corner_uv)
    assert figures(result) == pytest.approx(expected, rel=1e-9)
    assert figures(lsgp.measure_distortion(surface(mesh), result.corner_uv)) == pytest.approx(expected, rel=1e-9)


def test_figures_of_an_arbitrary_layout_are_the_oracles() -> None:
    mesh = meshes.bumpy_sphere(1)
    rng = np.random.default_rng(11)
    uv = mesh.positions[mesh.triangles][..., :2] + 0.1 * rng.normal(size=(len(mesh.triangles), 3, 2))
    uv[oracle.signed_areas(uv) < 0] = uv[oracle.signed_areas(uv) < 0][:, ::-1]
    expected = oracle.distortion(mesh.positions, mesh.triangles, uv)
    assert expected["quasi_conformal"] > 2
    assert figures(lsgp.measure_distortion(surface(mesh), uv)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    "matrix, quasi_conformal, l2",
    [
        (((1, 0), (0, 1)), 1, 1),
        (((0, -7), (7, 0)), 1, 1),
        (((2, 0), (0, 1)), 2, np.sqrt(1.25)),
        (((1, 1), (0, 1)), (3 + np.sqrt(5)) / 2, np.sqrt(1.5)),
    ],
    ids=["identity", "turned and scaled", "twice as wide", "sheared"],
)
def test_known_figures_of_linear_maps(matrix: object, quasi_conformal: float, l2: float) -> None:
    mesh = meshes.grid(4, 3)
    found = figures(lsgp.measure_distortion(surface(mesh), flat_uv(mesh, matrix)))
    expected = {"quasi_conformal": quasi_conformal, "quasi_conformal_area_weighted": quasi_conformal, "l2_stretch": l2}
    expected |= {"area": 1, "area_p10": 1, "area_p90": 1}
    assert found == pytest.approx(expected, rel=1e-12)


def test_known_area_figures() -> None:
    """Two equal squares, one mapped twice as long: a half of the area takes 4/5 of the plane."""
    mesh = meshes.merge([meshes.grid(1, 1), meshes.grid(1, 1)])
    uv = flat_uv(mesh)
    uv[2:] *= 2
    found = figures(lsgp.measure_distortion(surface(mesh), uv))
    assert found["area"] == pytest.approx((0.5 / 0.2 + 0.5 / 0.8) / 2, rel=1e-12)
    assert found["area_p10"] == pytest.approx(0.5 / 0.8, rel=1e-12)
    assert found["area_p90"] == pytest.approx(0.5 / 0.2, rel=1e-12)
    assert found["l2_stretch"] == pytest.approx(np.sqrt(0.5 * (1 + 0.25) * 2.5), rel=1e-12)
    assert found["quasi_conformal"] == pytest.approx(1, rel=1e-12)


@settings(max_examples=10)
@given(angle=st.floats(0, 6.28), scale=st.floats(1e-3, 1e3), u=st.floats(-50, 50), v=st.floats(-50, 50))
def test_similarities_change_no_figure(angle: float, scale: float, u: float, v: float) -> None:
    mesh = MAPPED["flower"]
    rng = np.random.default_rng(5)
    uv = oracle.as_uv(np.exp(mesh.positions[mesh.triangles][..., 0] + 1j * mesh.positions[mesh.triangles][..., 1]))
    uv += 0.01 * rng.normal(size=uv.shape)
    moved = oracle.as_uv(oracle.as_complex(uv) * scale * np.exp(1j * angle) + complex(u, v))
    one, two = (lsgp.measure_distortion(surface(mesh), x) for x in (uv, moved))
    assert figures(two) == pytest.approx(figures(one), rel=1e-6)
    assert two.flipped.tolist() == one.flipped.tolist()


def test_rounding_does_not_hide_in_the_mean() -> None:
    """Weighted and plain mean differ where distortion sits on small triangles."""
    mesh = meshes.merge([meshes.grid(1, 1), meshes.make([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])])
    uv = flat_uv(mesh)
    uv[:2, :, 0] *= 3
    found = figures(lsgp.measure_distortion(surface(mesh), uv))
    assert found["quasi_conformal"] == pytest.approx((3 + 3 + 1) / 3)
    assert found["quasi_conformal_area_weighted"] == pytest.approx((3 * 1 + 40.5) / 41.5)


def test_triangles_without_coordinates_are_left_out() -> None:
    mesh = meshes.merge([meshes.hill(6), meshes.grid(3, 3)])
    uv = flat_uv(mesh)
    hill = len(meshes.hill(6).triangles)
    uv[hill:, 1, 0] = np.nan
    found = lsgp.measure_distortion(surface(mesh), uv)
    expected = oracle.distortion(mesh.positions, mesh.triangles[:hill], uv[:hill])
    assert figures(found) == pytest.approx(expected, rel=1e-9)
    assert (found.island[hill:] == -1).all() and (found.island[:hill] == 0).all()
    assert found.flipped.size == 0


# --- seams of given coordinates -------------------------------------------------------------------------------------


@pytest.mark.parametrize("last", [1e150, 1e300, 5e307])
def test_figures_beside_coordinates_of_any_size_are_numbers(last: float) -> None:
    mesh = meshes.grid(2, 2)
    uv = flat_uv(mesh)
    uv[3] *= last
    found = lsgp.measure_distortion(surface(mesh), uv)
    assert not np.isnan(list(figures(found).values())).any()
    assert len(np.unique(found.island)) == 2 and np.isfinite(found.seams.rotation_residual)
    if last < 1e200:  # beyond, the other triangles have no area
        assert figures(found)["quasi_conformal"] == pytest.approx(1) and found.flipped.size == 0


@pytest.mark.parametrize("image", [0.5, [[0.0, 0], [1, 1], [2, 2]]], ids=["point", "line"])
def test_a_triangle_without_area_in_the_plane_makes_figures_infinite(image: object) -> None:
    mesh = meshes.grid(2, 2)
    uv = flat_uv(mesh)
    uv[3] = image
    found = figures(lsgp.measure_distortion(surface(mesh), uv))
    assert [name for name, value in found.items() if not np.isinf(value)] == ["area_p10"]
    assert np.isfinite(found["area_p10"])


@pytest.mark.parametrize("mesh", [meshes.moebius_strip(8, 1), meshes.klein_bottle(6, 5)], ids=["strip", "bottle"])
def test_islands_of_a_surface_with_one_side(mesh: meshes.Mesh) -> None:
    """Its triangles one by one, as similar triangles; joined in pairs; and all in one point, which has one side."""
    count = len(mesh.triangles)
    p = mesh.positions[mesh.triangles]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    x = (a * b).sum(axis=1) / np.linalg.norm(a, axis=1)
    y = np.linalg.norm(np.cross(a, b), axis=1) / np.linalg.norm(a, axis=1)
    uv = np.zeros((count, 3, 2))
    uv[:, 1, 0], uv[:, 2] = np.linalg.norm(a, axis=1), np.stack([x, y], axis=1)
    uv += 100 * np.arange(count)[:, None, None]
    alone = lsgp.measure_distortion(surface(mesh), uv)
    assert sorted(alone.island) == list(range(count)) and alone.flipped.size == 0
    assert figures(alone)["l2_stretch"] == pytest.approx(1)
    edges = np.unique(np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True)
    assert pairs(alone.cut_edges) == pairs(edges[0][edges[1] == 2])
    point = lsgp.measure_distortion(surface(mesh), np.zeros((count, 3, 2)))
    assert sorted(point.island) == list(range(count)) and len(point.flipped) == count and len(point.cut_edges) == 0


def test_a_strip_with_one_side_that_is_cut_once_is_one_island() -> None:
    strip = meshes.moebius_strip(8, 1)
    place = np.stack([np.arange(16) // 2, np.arange(16) % 2], axis=1).astype(float)
    uv = place[strip.triangles]
    last = (strip.triangles >= 14).any(axis=1) & (strip.triangles < 2).any(axis=1)
    uv[last] = np.where(strip.triangles[last, :, None] < 2, [8, 1] - uv[last] * [1, 1], uv[last])
    found = lsgp.measure_distortion(surface(strip), uv)
    assert (found.island == 0).all() and found.flipped.size == 0 and pairs(found.cut_edges) == {(0, 1)}


def test_cuts_are_where_the_two_sides_differ() -> None:
    for name in ("bumpy sphere", "two holes"):
        mesh = MAPPED[name]
        result = unwrap(mesh)
        found = lsgp.measure_distortion(surface(mesh), result.corner_uv)
        assert pairs(found.cut_edges) == oracle.open_edges(mesh.triangles, result.corner_uv) == pairs(result.cut_edges)
        assert found.seams.sister_ratio_max - 1 <= 1e-9
        assert found.seams.translation_residual <= 1e-9


def test_sisters_of_different_length_are_measured() -> None:
    """A strip cut across, one half a fifth larger and turned: ratio 1.2."""
    mesh = meshes.grid(4, 1)
    uv = flat_uv(mesh)
    right = mesh.positions[mesh.triangles].mean(axis=1)[:, 0] > 2
    uv[right] = oracle.as_uv(oracle.as_complex(uv[right]) * 1.2j + 9)
    found = lsgp.measure_distortion(surface(mesh), uv)
    assert pairs(found.cut_edges) == {(2, 7)}
    assert found.seams.sister_ratio_max == pytest.approx(1.2, rel=1e-12)
    assert sorted(set(found.island.tolist())) == [0, 1]
    assert (found.island == np.where(right, found.island[right][0], found.island[~right][0])).all()


def test_sisters_without_a_length_on_the_surface_are_not_compared() -> None:
    """Their length in the plane is no more than what the computation gives degenerate triangles."""
    mesh = meshes.grid(4, 2)
    right = mesh.positions[mesh.triangles].mean(axis=1)[:, 0] > 2
    uv = flat_uv(mesh) + np.where(right, 9, 0)[:, None, None]
    uv[(mesh.triangles == 12) & right[:, None]] += (0.0, 0.25)  # an end of the edge from 7 to 12
    ratios = []
    for at in (mesh.positions[12], mesh.positions[7] + (0, 1e-8, 0)):
        positions = mesh.positions.copy()
        positions[12] = at
        found = lsgp.measure_distortion(surface(mesh._replace(positions=positions)), uv)
        assert pairs(found.cut_edges) == {(2, 7), (7, 12)}
        ratios.append(found.seams.sister_ratio_max)
    assert ratios == [pytest.approx(1.25), 1]


def test_sister_ratio_of_lscm_is_the_oracles() -> None:
    mesh = MAPPED["bumpy sphere"]
    result = unwrap(mesh, method="lscm")
    seams = oracle.seam_quality(mesh.triangles, result.corner_uv, result.cut_edges, result.cones)
    assert result.seams.sister_ratio_max == pytest.approx(seams.ratio.max(), rel=1e-9)
    assert lsgp.measure_distortion(surface(mesh), result.corner_uv).seams.sister_ratio_max == pytest.approx(
        seams.ratio.max(), rel=1e-9
    )


def test_wrong_shape_is_refused() -> None:
    mesh = meshes.grid(2, 2)
    for shape in ((8, 3), (7, 3, 2), (24, 2)):
        with pytest.raises(lsgp.InputError) as caught:
            lsgp.measure_distortion(surface(mesh), np.zeros(shape))
        assert caught.value.code == "WRONG_SHAPE"


def test_sister_ratio_is_a_number_where_a_side_has_collapsed() -> None:
    mesh = meshes.grid(1, 1)
    uv = mesh.positions[mesh.triangles][..., :2] + np.array([0.0, 3.0])[:, None, None]
    shared = np.intersect1d(*mesh.triangles)
    a, b = (np.flatnonzero(mesh.triangles[0] == v)[0] for v in shared)
    uv[0, a] = uv[0, b]
    found = lsgp.measure_distortion(surface(mesh), uv).seams.sister_ratio_max
    assert np.isfinite(found) and found > 1e100
