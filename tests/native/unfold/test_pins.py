# SPDX-License-Identifier: GPL-3.0-or-later
"""Pinned texture coordinates: met exactly where the transitions leave room, refused by name where not."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_exact_transitions, surface, unwrap

BUMPY = meshes.bumpy_sphere(2)
HILL = meshes.hill(10)


def pinned(mesh: meshes.Mesh, corners: object, uv: object, **options: str) -> lsgp.Result:
    return lsgp.parameterize(
        surface(mesh), mesh.cones, options=lsgp.Options(**options), pins=lsgp.Pins(np.asarray(corners), np.asarray(uv))
    )


def spread_corners(mesh: meshes.Mesh, count: int) -> np.ndarray:
    """Corners of triangles all over the mesh, each of another vertex."""
    _, first = np.unique(mesh.triangles, return_index=True)
    return first[np.linspace(0, len(first) - 1, count).astype(int)]


@pytest.mark.parametrize("mesh", [BUMPY, HILL], ids=["closed", "open"])
def test_two_pins_give_place_size_and_turn_and_change_nothing_else(mesh: meshes.Mesh) -> None:
    plain = unwrap(mesh)
    corners, uv = spread_corners(mesh, 2), np.array([[3.0, -1.0], [2.5, 0.25]])
    result = pinned(mesh, corners, uv)
    assert result.corner_uv.reshape(-1, 2)[corners] == pytest.approx(uv, abs=1e-12)
    assert oracle.similarity_gap(plain.corner_uv, result.corner_uv) <= 1e-9


def test_one_pin_gives_the_place_alone() -> None:
    plain = unwrap(BUMPY)
    result = pinned(BUMPY, [7], [[0.25, 4.0]])
    assert result.corner_uv.reshape(-1, 2)[7] == pytest.approx([0.25, 4.0], abs=1e-12)
    shift = result.corner_uv - plain.corner_uv
    assert np.ptp(shift.reshape(-1, 2), axis=0) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("mesh", [BUMPY, HILL], ids=["closed", "open"])
def test_more_pins_are_all_met_and_seams_stay_exact(mesh: meshes.Mesh) -> None:
    plain = unwrap(mesh).corner_uv.reshape(-1, 2)
    corners = spread_corners(mesh, 7)
    rng = np.random.default_rng(1)
    uv = plain[corners] * 2 + 0.02 * rng.standard_normal((7, 2))
    result = pinned(mesh, corners, uv)
    assert result.corner_uv.reshape(-1, 2)[corners] == pytest.approx(uv, abs=1e-9)
    assert_exact_transitions(mesh, result)


def test_pins_everywhere_give_back_what_was_pinned() -> None:
    uncut = HILL._replace(cones=np.empty(0, np.int32))
    plain = unwrap(uncut).corner_uv.reshape(-1, 2)
    bent = plain + 0.03 * np.sin(7 * plain[:, ::-1])
    result = pinned(uncut, np.arange(len(bent)), bent)
    assert result.corner_uv.reshape(-1, 2) == pytest.approx(bent, abs=1e-9)


def test_one_vertex_in_two_places_is_refused_by_name() -> None:
    vertex = int(HILL.triangles[40, 0])
    corners = np.flatnonzero(HILL.triangles.ravel() == vertex)[:2]
    with pytest.raises(lsgp.InputError) as caught:
        pinned(HILL, corners, [[0, 0], [1, 1]])
    assert caught.value.code == "PINS_CONFLICT"
    assert caught.value.elements.kind == "vertices" and caught.value.elements.indices.tolist() == [vertex]


def test_pins_against_a_transition_are_refused_by_name() -> None:
    """Both sides of one cut edge pinned to different lengths."""
    plain = unwrap(BUMPY)
    a, b = (int(v) for v in plain.cut_edges[len(plain.cut_edges) // 2])
    faces = np.flatnonzero((BUMPY.triangles == a).any(axis=1) & (BUMPY.triangles == b).any(axis=1))
    corners = [3 * f + int(np.flatnonzero(BUMPY.triangles[f] == v)[0]) for f in faces for v in (a, b)]
    uv = plain.corner_uv.reshape(-1, 2)[corners]
    uv[1] = uv[0] + 3 * (uv[1] - uv[0])
    with pytest.raises(lsgp.InputError) as caught:
        pinned(BUMPY, corners, uv)
    assert caught.value.code == "PINS_CONFLICT"
    assert set(caught.value.elements.indices.tolist()) == {a, b}


@pytest.mark.parametrize(
    ("corners", "uv", "code"),
    [
        ([10**6], [[0.0, 0.0]], "PIN_INDEX"),
        ([-1], [[0.0, 0.0]], "PIN_INDEX"),
        ([3], [[np.nan, 0.0]], "PIN_NON_FINITE"),
        ([3, 4], [[1.0, 0.0], [0.0, -1e300]], "PIN_NON_FINITE"),
        ([3, 4], [[1e-300, 0.0], [0.0, 0.0]], "PINS_CONFLICT"),
        ([3, 9], [[0.0, 0.0]], "PIN_INDEX"),
    ],
)
def test_pins_that_cannot_be(corners: list[int], uv: list[list[float]], code: str) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        pinned(HILL, corners, uv)
    assert caught.value.code == code


def test_all_pins_on_one_point_are_refused() -> None:
    with pytest.raises(lsgp.InputError) as caught:
        pinned(HILL, spread_corners(HILL, 3), np.zeros((3, 2)))
    assert caught.value.code == "PINS_CONFLICT"
