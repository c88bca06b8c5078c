# SPDX-License-Identifier: GPL-3.0-or-later
"""Where cuts have costs, cones are placed where cuts reach them cheaply, as far as the stretch permits."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface
from meshes import Mesh, edges_of
from numpy.typing import NDArray

TARGET = 1.05
CONE_AS_CUT = 1 / 3  # what a cone may save in cuts at least, in square roots of the area
BALL, EGG, RING = meshes.icosphere(3), meshes.ellipsoid(3), meshes.torus(24, 12)
MESHES = {"ball": BALL, "egg": EGG, "ring": RING, "bumpy": meshes.bumpy_sphere(3), "flower": meshes.flower(3)}
FRONTS = [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, 0.8, 0.0)]


def without_costs(mesh: Mesh) -> lsgp.Surface:
    return replace(surface(mesh), edges=edges_of(mesh.triangles))


def hidden(mesh: Mesh, front: tuple[float, float, float]) -> lsgp.Surface:
    plain = without_costs(mesh)
    return replace(plain, cut_costs=lsgp.cut_costs(plain, front, creases=False))


def toward(mesh: Mesh, front: tuple[float, float, float], vertices: NDArray[np.integer]) -> NDArray[np.float64]:
    """How far at the front some vertices are, 1 being the foremost vertex."""
    along = mesh.positions @ np.array(front)
    return along[vertices] / along.max()


def cost_of_cuts(costly: lsgp.Surface, placed: lsgp.Placement) -> float:
    """Of the cuts through these cones as the map is cut: edges whose sides are apart in the plane."""
    uv = lsgp.parameterize(costly, placed.cones, placed.cone_angles).corner_uv.reshape(-1, 3, 2)
    at: dict[tuple[int, int], list[NDArray[np.float64]]] = {}
    for corners, points in zip(costly.triangles.tolist(), uv, strict=True):
        for c in range(3):
            (a, p), (b, q) = sorted([(corners[c], c), (corners[c - 2], (c + 1) % 3)])
            at.setdefault((a, b), []).append(points[[p, q]])
    cost = 0.0
    for edge, factor in zip(costly.edges.tolist(), costly.cut_costs, strict=True):
        sides = at[tuple(sorted(edge))]
        if np.abs(sides[0] - sides[-1]).max() > 1e-9:
            cost += factor * float(np.linalg.norm(np.subtract(*costly.positions[edge])))
    return cost


@pytest.mark.parametrize("cost", [0.0, 1.0, 7.0])
@pytest.mark.parametrize("options", [{}, {"count": 70}, {"lattice": "square"}, {"symmetric": True}])
def test_costs_that_are_the_same_everywhere_are_none(cost: float, options: dict[str, object]) -> None:
    plain = without_costs(MESHES["flower"])
    same = lsgp.place_cones(replace(plain, cut_costs=np.full(len(plain.edges), cost)), **options)
    alone = lsgp.place_cones(plain, **options)
    for name in ("cones", "cone_angles", "log_scale"):
        assert getattr(same, name).tobytes() == getattr(alone, name).tobytes()


@pytest.mark.parametrize("front", FRONTS)
@pytest.mark.parametrize(("mesh", "target"), [(BALL, 1.1), (EGG, 1.06)])
def test_no_cone_is_in_the_middle_of_what_is_seen(mesh: Mesh, target: float, front: tuple[float, float, float]) -> None:
    placed = lsgp.place_cones(hidden(mesh, front), target=target)
    assert placed.reached and len(placed.cones) >= 4
    assert toward(mesh, front, placed.cones).max() < np.cos(np.pi / 4)


@pytest.mark.parametrize("front", FRONTS)
@pytest.mark.parametrize("name", MESHES)
def test_the_target_is_kept_and_cones_are_worth_what_their_cuts_save(
    name: str, front: tuple[float, float, float]
) -> None:
    costly = hidden(MESHES[name], front)
    alone, placed = lsgp.place_cones(without_costs(MESHES[name])), lsgp.place_cones(costly)
    assert placed.reached and placed.mapped_l2 <= TARGET
    a, b, c = (costly.positions[costly.triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    unit = np.sqrt(area) * max(1, np.quantile(costly.cut_costs, 0.25, method="lower"))
    saved = cost_of_cuts(costly, alone) - cost_of_cuts(costly, placed)
    assert CONE_AS_CUT * (len(placed.cones) - len(alone.cones)) <= saved / unit
    result = lsgp.parameterize(surface(MESHES[name]), placed.cones, placed.cone_angles)
    assert result.distortion.l2_stretch == pytest.approx(placed.mapped_l2, rel=1e-6)


@pytest.mark.parametrize(
    "name, count",
    [
        *((name, 8) for name in MESHES),
        ("ring", 70),
        *(pytest.param(name, 70, marks=pytest.mark.many_solves) for name in MESHES if name != "ring"),
    ],
)
def test_a_number_of_cones_stays_and_stretches_within_the_target(name: str, count: int) -> None:
    placed = lsgp.place_cones(hidden(MESHES[name], FRONTS[0]), count=count)
    assert len(placed.cones) == count and placed.mapped_l2 <= TARGET


@pytest.mark.parametrize(
    "options",
    [{}, pytest.param({"count": 70}, marks=pytest.mark.many_solves), {"lattice": "square"}, {"symmetric": True}],
)
@pytest.mark.parametrize("name", ["egg", "ring"])
def test_cuts_cost_less_than_those_of_cones_placed_without_regard(name: str, options: dict[str, object]) -> None:
    costly = hidden(MESHES[name], FRONTS[0])
    alone, placed = (lsgp.place_cones(on, **options) for on in (replace(costly, cut_costs=None), costly))
    assert cost_of_cuts(costly, placed) < 0.9 * cost_of_cuts(costly, alone)


def test_cones_leave_what_is_painted() -> None:
    alone = lsgp.place_cones(without_costs(EGG))
    near = np.linalg.norm(EGG.positions - EGG.positions[alone.cones[0]], axis=1) < 0.45
    plain = without_costs(EGG)
    paint = np.where(near, 1.0, 0.5)
    placed = lsgp.place_cones(replace(plain, cut_costs=lsgp.cut_costs(plain, None, creases=False, paint=paint)))
    assert placed.reached and near[alone.cones].any() and not near[placed.cones].any()


@pytest.mark.parametrize("name", ["egg", "bumpy"])
def test_one_more_cone_is_where_cuts_get_cheaply_and_it_gains_half_as_much_as_anywhere(name: str) -> None:
    costly = hidden(MESHES[name], FRONTS[0])
    cones = lsgp.place_cones(costly, count=6).cones
    alone, priced = (lsgp.cone_gains(on, cones) for on in (replace(costly, cut_costs=None), costly))
    assert priced.predicted_l2.tobytes() == alone.predicted_l2.tobytes()
    assert toward(MESHES[name], FRONTS[0], priced.best) < toward(MESHES[name], FRONTS[0], alone.best)
    # The L2 stretch is e^(2 variance) to leading order.
    gain, most = (np.log(alone.present_l2 / alone.predicted_l2[best]) for best in (priced.best, alone.best))
    assert 0.5 * most <= gain < most


def test_one_more_cone_is_where_it_gains_most_if_costs_are_the_same_everywhere() -> None:
    plain = without_costs(EGG)
    cones = lsgp.place_cones(plain, count=6).cones
    same = lsgp.cone_gains(replace(plain, cut_costs=np.full(len(plain.edges), 7.0)), cones)
    assert same.best == lsgp.cone_gains(plain, cones).best == np.nanargmin(same.predicted_l2)
