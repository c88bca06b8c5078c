# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric cones on surfaces that are their own mirror image."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import lsgp
import meshes
import numpy as np
import pytest
import zoo
from lsgp.presets import map_comparison
from lsgp.presets.map_comparison import may_replace_map
from lsgp.triangles import uv_area
from map_checks import assert_curvature_adds_up, codes, only, surface
from meshes import Mesh, make
from placement_checks import place


def images_in_x(mesh: Mesh) -> np.ndarray:
    """The vertex at each vertex's mirror image in x = 0."""
    keys = {tuple(row): v for v, row in enumerate(np.round(mesh.positions, 9) + 0.0)}
    return np.array([keys[tuple(row)] for row in np.round(mesh.positions * [-1, 1, 1], 9) + 0.0])


MESH = meshes.two_horned()
IMAGE = images_in_x(MESH)


def assert_symmetric(placed: lsgp.Placement) -> None:
    angle = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True))
    assert {int(IMAGE[v]) for v in angle} == set(angle)
    assert all(angle[int(IMAGE[v])] == pytest.approx(a, abs=1e-12) for v, a in angle.items())
    assert placed.log_scale == pytest.approx(placed.log_scale[IMAGE], abs=1e-9)
    assert_curvature_adds_up(MESH, placed.cones, placed.cone_angles)


@pytest.mark.parametrize("options", [{}, {"count": 8}, {"count": 11}, {"prefer_sharp": True}])
@pytest.mark.parametrize("mirror", [None, ([0, 3, 1], [-2, 0, 0])])
def test_cones_and_angles_mirror_each_other(options: dict[str, object], mirror: object) -> None:
    placed = place(MESH, symmetric=True, mirror=mirror, **options)
    assert_symmetric(placed)
    assert "NOT_SYMMETRIC" not in codes(placed.warnings)
    assert len(placed.cones) in (options.get("count", len(placed.cones)), options.get("count", 0) - 1)


def test_the_map_is_symmetric() -> None:
    placed = place(MESH, symmetric=True)
    uv = lsgp.parameterize(surface(MESH), placed.cones, placed.cone_angles).corner_uv
    lengths = np.linalg.norm(uv - uv[:, [1, 2, 0]], axis=2) / np.sqrt(np.ptp(uv.reshape(-1, 2), axis=0).prod())
    edges = {frozenset(e): length for e, length in zip(
        np.stack([MESH.triangles, MESH.triangles[:, [1, 2, 0]]], axis=2).reshape(-1, 2).tolist(),
        lengths.ravel(), strict=True)}  # fmt: skip
    gap = max(abs(edges[frozenset((int(IMAGE[a]), int(IMAGE[b])))] - length) for (a, b), length in edges.items())
    assert gap <= 1e-6


def test_little_is_lost() -> None:
    free, symmetric = place(MESH, count=10), place(MESH, count=10, symmetric=True)
    assert symmetric.predicted_l2 - 1 <= 2 * (free.predicted_l2 - 1)


def test_existing_cones_get_their_image() -> None:
    v = int(np.argmax(MESH.positions[:, 0]))
    placed = place(MESH, [v], [5.0], count=9, symmetric=True)
    assert placed.cones[0] == v and IMAGE[v] in placed.cones
    assert_symmetric(placed)
    assert placed.cone_angles[placed.cones.tolist().index(int(IMAGE[v]))] == 5.0


def assert_nearly_symmetric(positions: np.ndarray, placed: lsgp.Placement, within: float) -> None:
    """Each cone has one of the same angle near its image in x = 0."""
    assert "NOT_SYMMETRIC" not in codes(placed.warnings)
    cones = positions[placed.cones]
    apart = np.linalg.norm(cones[:, None] * [-1, 1, 1] - cones[None], axis=2)
    image = apart.argmin(axis=1)
    assert apart.min(axis=1).max() <= within
    assert image[image].tolist() == list(range(len(cones)))
    assert placed.cone_angles[image] == pytest.approx(placed.cone_angles, abs=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_noise_and_other_triangles_on_either_side_leave_it_symmetric(tilt: float) -> None:
    mesh = meshes.two_horned(turn=0.7)
    extent = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    noise = np.random.default_rng(3).uniform(-0.005, 0.005, mesh.positions.shape) * extent
    tilted = meshes.rotation([3, 1, -2], tilt)
    placed = place(make((mesh.positions + noise) @ tilted.T, mesh.triangles), count=12, symmetric=True)
    edge = np.linalg.norm(mesh.positions[mesh.triangles] - mesh.positions[mesh.triangles[:, [1, 2, 0]]], axis=2).mean()
    assert len(placed.cones) >= 11
    assert_nearly_symmetric(mesh.positions, placed, 0.75 * edge)


def mirrored(mesh: Mesh) -> Mesh:
    return make(mesh.positions * [-1, 1, 1], mesh.triangles[:, ::-1])


@pytest.mark.parametrize("count", [None, 7])
def test_parts_that_mirror_each_other_get_mirrored_cones(count: int | None) -> None:
    odd = meshes.bumpy_sphere(2)
    both = meshes.merge([odd, meshes.renumber(mirrored(odd), 5)[0]])
    placed = place(both, count=count, symmetric=True)
    assert len(placed.cones) == 2 * np.sum(placed.cones < len(odd.positions)) > 0
    middle = (both.positions.min(axis=0) + both.positions.max(axis=0)) / 2
    assert_nearly_symmetric(both.positions - middle * [1, 0, 0], placed, 1e-9)


def test_without_symmetry_it_says_so_and_places_as_usual() -> None:
    mesh = meshes.bumpy_sphere(3)
    placed = place(mesh, count=9, symmetric=True)
    assert codes(placed.warnings) == ["NOT_SYMMETRIC"]
    assert placed.cones.tolist() == place(mesh, count=9).cones.tolist()
    wrong = place(MESH, count=9, symmetric=True, mirror=([0, 0, 0], [0, 1, 0]))
    assert codes(wrong.warnings) == ["NOT_SYMMETRIC"]


def test_one_finding_names_all_components_without_symmetry() -> None:
    odd, even = meshes.bumpy_sphere(2), meshes.icosphere(2)
    placed = place(meshes.merge([odd, even, odd]), count=4, symmetric=True)
    finding = only(placed.warnings, "NOT_SYMMETRIC")
    assert finding.message.startswith("2 components are not their own mirror images in any plane that was tried; their")
    count = len(odd.triangles)
    triangles = np.arange(3 * count)
    assert finding.elements.indices.tolist() == triangles[triangles // count != 1].tolist()


def test_the_first_press_is_symmetric_unless_that_is_turned_off_or_cones_are_given() -> None:
    given = surface(MESH)
    placed = {symmetric: place(MESH, symmetric=symmetric).cones.tolist() for symmetric in (True, False)}
    assert set(placed[True]) != set(placed[False])
    assert lsgp.auto_unwrap(given).cones.tolist() == placed[True]
    assert lsgp.auto_unwrap(given, symmetric=False).cones.tolist() == placed[False]
    count = len(placed[False])
    counted = lsgp.auto_unwrap(given, count=count)
    assert counted.cones.tolist() == place(MESH, count=count).cones.tolist()
    v = placed[False][0]
    assert lsgp.auto_unwrap(given, [v]) == lsgp.auto_unwrap(given, [v], symmetric=False)


@pytest.mark.slow
def test_each_component_is_symmetric_where_that_costs_little() -> None:
    """Alone the box with a handle gets usual cones, since symmetric ones are many, and MESH gets symmetric ones."""
    box, horned = zoo.member("box-with-handles-cells=5-handles=1-seed=0").mesh(), meshes.two_horned(3)
    first = len(box.positions)
    alone = [lsgp.auto_unwrap(surface(mesh)) for mesh in (box, horned)]
    assert alone[0].cones.tolist() == lsgp.auto_unwrap(surface(box), symmetric=False).cones.tolist()
    assert alone[1].cones.tolist() != lsgp.auto_unwrap(surface(horned), symmetric=False).cones.tolist()
    joint = lsgp.auto_unwrap(surface(meshes.merge([box, horned])))
    assert sorted(joint.cones[joint.cones < first].tolist()) == sorted(alone[0].cones.tolist())
    assert sorted((joint.cones[joint.cones >= first] - first).tolist()) == sorted(alone[1].cones.tolist())


def test_where_nothing_is_symmetric_the_first_press_says_nothing_of_it() -> None:
    given = surface(meshes.bumpy_sphere(2))
    assert lsgp.auto_unwrap(given) == lsgp.auto_unwrap(given, symmetric=False)


def filled_boxes(result: lsgp.Result, *_: object, **__: object) -> float:
    """The part that islands fill of all their boxes, or of the square around the longest one, if that is less."""
    boxes = lsgp.lattice.island_boxes(result.corner_uv, result.island)
    size = boxes[:, 2:] - boxes[:, :2]
    return uv_area(result.corner_uv[result.solved]) / max(size.prod(axis=1).sum(), size.max() ** 2)


def test_a_symmetric_map_replaces_another_only_at_a_small_cost(monkeypatch: pytest.MonkeyPatch) -> None:
    # How far a packer fills a square with a triangle cut off has no part in it.
    monkeypatch.setattr(map_comparison, "_filled_when_packed", filled_boxes)
    usual = lsgp.auto_unwrap(surface(meshes.merge([meshes.two_horned(1)] * 10)), count=4, preset="bake", pack="shelves")
    islands = int(usual.island.max()) + 1
    assert islands >= 10

    def with_islands(more: int) -> lsgp.Result:
        island = usual.island.copy()
        island[:more] = islands + np.arange(more)
        return replace(usual, island=island)

    def with_l2(factor: float) -> lsgp.Result:
        l2 = factor * usual.distortion.l2_stretch
        return replace(usual, distortion=replace(usual.distortion, l2_stretch=l2))

    assert may_replace_map(usual, usual)
    assert may_replace_map(with_islands(islands // 10), usual)
    assert not may_replace_map(with_islands(islands // 10 + 1), usual)
    assert may_replace_map(with_l2(1.009), usual) and not may_replace_map(with_l2(1.011), usual)
    assert not may_replace_map(replace(usual, flipped=np.array([3], np.int32)), usual)
    # Half the cuts are worth a stretch up to the target, but not an isometric map.
    l2 = usual.distortion.l2_stretch
    for stretch, before, may in ((1.049, 1.02, True), (1.051, 1.02, False), (1.049, 1.0005, False)):
        with_few_cuts = replace(with_l2(stretch / l2), cut_edges=usual.cut_edges[: len(usual.cut_edges) // 2])
        assert may_replace_map(with_few_cuts, with_l2(before / l2)) == may
    # Islands fill their boxes as before, but one square around the longest is larger than all boxes.
    longer = replace(usual, corner_uv=usual.corner_uv * [8, 1 / 8])
    assert not may_replace_map(longer, usual) and may_replace_map(longer, usual, square_share=2.0)


def test_a_symmetric_map_may_fill_a_tenth_less_of_the_square() -> None:
    whole = replace(lsgp.preset_options("paint"), compact="off")
    usual = lsgp.auto_unwrap(surface(MESH), symmetric=False, options=whole, pack="shelves")
    assert usual.island.max() == 0
    size = np.ptp(usual.corner_uv, axis=(0, 1))
    # The longer side stays as it is, and with it the square.
    for height, may in ((0.91, True), (0.89, False)):
        narrower = usual.corner_uv * np.where(size == size.max(), 1, height)
        assert may_replace_map(replace(usual, corner_uv=narrower), usual) == may


def with_rectangles(usual: lsgp.Result, count: int, height: float = 1.0) -> lsgp.Result:
    """So many islands of two triangles, each as high as this relative to its width; other triangles are points."""
    solved = np.arange(len(usual.island)) < 24
    rectangle = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]]) * [1, height]
    corner_uv = np.zeros_like(usual.corner_uv)
    island = np.where(solved, 0, -1).astype(np.int32)
    for i in range(count):
        corner_uv[2 * i : 2 * i + 2] = rectangle + np.array([1.1 * i, 0])
        island[2 * i : 2 * i + 2] = i
    return replace(usual, corner_uv=corner_uv, island=island, solved=solved)


def test_a_pair_of_islands_more_has_to_fill_the_square_as_well() -> None:
    usual = lsgp.auto_unwrap(surface(MESH), symmetric=False, pack="shelves")
    # One square fills a square, two do half of it, three three quarters, four all of it, and five five ninths.
    replaced = {
        (1, 1): True,
        (1, 2): False,
        (1, 3): False,
        (2, 3): True,
        (2, 4): True,
        (2, 5): False,
        (3, 5): False,
    }
    for (before, after), may in replaced.items():
        assert may_replace_map(with_rectangles(usual, after), with_rectangles(usual, before)) == may


@pytest.mark.parametrize(("before", "filled", "least"), [(2, 1 / 2, 0.8), (3, 3 / 4, 0.7)])
def test_fewer_islands_may_fill_the_square_less(before: int, filled: float, least: float) -> None:
    usual = lsgp.auto_unwrap(surface(MESH), symmetric=False, pack="shelves")
    squares = with_rectangles(usual, before)
    # A single rectangle fills as much of the square as its height, but for margins.
    for more, may in ((0.05, True), (-0.05, False)):
        assert may_replace_map(with_rectangles(usual, 1, filled * (least + more)), squares) == may


def test_one_island_fewer_of_many_may_not_fill_the_square_less(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(map_comparison, "_filled_when_packed", filled_boxes)
    usual = lsgp.auto_unwrap(surface(MESH), symmetric=False, pack="shelves")
    squares = with_rectangles(usual, 12)
    # Strips fill as much of a square that is as wide as they are as their heights add up to.
    for count, filled, may in ((11, 0.85, False), (11, 0.95, True), (10, 0.75, True), (10, 0.65, False)):
        assert may_replace_map(with_rectangles(usual, count, filled / count), squares) == may


@dataclass
class MapsByCuts:
    """Stands in for a solver: a map for the usual cones, and two for the symmetric ones, of which it counts islands."""

    usual: lsgp.Result
    mirrored: lsgp.Result
    free: lsgp.Result
    surface: lsgp.Surface
    made: list[str] = field(default_factory=list)

    def parameterize(self, cones: np.ndarray, angles: object, options: lsgp.Options, *_: object) -> lsgp.Result:
        self.made.append("usual" if not len(cones) else "mirrored" if options.mirrored_cuts else "free")
        return getattr(self, self.made[-1])


# Islands of the maps, and which of them are made and chosen.
@pytest.mark.parametrize(
    ("usual", "mirrored", "free", "tried", "chosen"),
    [
        (3, 5, 3, True, "free"),
        (3, 6, 4, True, "free"),
        (3, 5, 4, True, "usual"),
        (2, 4, 3, True, "mirrored"),
        (3, 4, 2, False, "mirrored"),
        (4, 4, 2, False, "mirrored"),
    ],
)
def test_symmetric_cones_get_other_cuts_where_that_saves_two_islands(
    usual: int, mirrored: int, free: int, tried: bool, chosen: str
) -> None:
    unwrapping = lsgp.presets.cone_choices
    result = lsgp.auto_unwrap(surface(MESH), symmetric=False, pack="shelves")
    maps = MapsByCuts(*(with_rectangles(result, count) for count in (usual, mirrored, free)), surface(MESH))
    choices = unwrapping.ConeChoices(
        unwrapping.CompletedCones(np.array([], np.int32), [], None),
        unwrapping.CompletedCones(np.array([3, 5], np.int32), [None, None], None, is_symmetric=True),
    )
    whole = replace(lsgp.preset_options("paint"), compact="off")
    _, best = unwrapping.best_map(maps, choices, whole)
    assert maps.made == ["usual", "mirrored", "free"][: 2 + tried]
    assert best == getattr(maps, chosen)
