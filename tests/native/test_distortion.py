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
