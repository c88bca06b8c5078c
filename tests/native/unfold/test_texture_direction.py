# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions along which the texture is to run: exact where islands turn freely, as near as can be on a lattice."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes
from numpy.typing import NDArray
from result_check import undeclared_faults

UP = (0.0, 0.0, 1.0)
EXACT = 1e-9  # radians
ROTATION_ORDER = {"square": 4, "stripe": 2, "translation": 1, "triangle": 3, "hexagon": 6}
ONE_STROKE = 0.02  # radians: what an automatic grid may turn it by


def images(surface: lsgp.Surface, result: lsgp.Result) -> NDArray[np.complex128]:
    """(m,) what the map makes of each triangle's direction: the part in its plane by least squares along its edges."""
    place = surface.positions[surface.triangles]
    z = oracle.as_complex(result.corner_uv)
    out = np.zeros(len(place), complex)
    for f, (corners, direction) in enumerate(zip(place, surface.directions, strict=True)):
        edges = corners[1:] - corners[0]
        out[f] = np.linalg.lstsq(edges.T, direction, rcond=None)[0] @ (z[f, 1:] - z[f, 0])
    return out


def off_v(image: NDArray[np.complex128], rotation_order: int = 1) -> NDArray[np.float64]:
    """Angles between images and v, up to rotations by a full turn / rotation_order, radians."""
    period = 2 * np.pi / rotation_order
    angle = np.angle(image / 1j)
    return np.abs(angle - period * np.round(angle / period))


def with_stroke(mesh: meshes.Mesh, triangle: int) -> lsgp.Surface:
    """A direction at one triangle, along its second edge."""
    directions = np.zeros(mesh.triangles.shape)
    a, b = mesh.triangles[triangle, 1:]
    directions[triangle] = mesh.positions[b] - mesh.positions[a]
    return lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)


def closed_with_cones(levels: int = 2) -> meshes.Mesh:
    mesh = meshes.bumpy_sphere(levels)
    placed = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles))
    return mesh._replace(cones=placed.cones)


MODELS = {
    "ball": closed_with_cones,
    "hill": meshes.hill,
    "saddle": meshes.saddle,
    "tube": meshes.cylinder,
    "torus": meshes.torus,
    "plate": lambda: meshes.plate(3),
    "cube": lambda: meshes.cube(4),
    "flower": lambda: meshes.flower(3),
    "fork": lambda: meshes.forked(3),
    "two": lambda: meshes.merge([meshes.hill(6), meshes.cylinder(12, 4)]),
}


@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
@pytest.mark.parametrize("name", MODELS)
def test_one_stroke_on_an_island_runs_along_v(name: str, mode: str) -> None:
    mesh = MODELS[name]()
    options = lsgp.Options(mode=mode)
    plain = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), mesh.cones, options=options)
    for triangle in (0, len(mesh.triangles) // 3):
        surface = with_stroke(mesh, triangle)
        result = lsgp.parameterize(surface, mesh.cones, options=options)
        assert off_v(images(surface, result)[triangle]) <= EXACT
        assert result.direction_errors[triangle] <= EXACT and result.direction_error <= EXACT
        assert np.isnan(np.delete(result.direction_errors, triangle)).all()
        # Turned, and no more: the same triangles, and nothing outside the square.
        assert oracle.similarity_gap(result.corner_uv, plain.corner_uv) <= 1e-9 or name == "two"
        assert result.corner_uv.min() >= -1e-12 and result.corner_uv.max() <= 1 + 1e-12
        assert not undeclared_faults(surface, result, options)


@pytest.mark.parametrize("depth", [0.3, 0.8])
def test_walls_at_right_angles_are_not_turned_in_between(depth: float) -> None:
    # A floor with two walls that hang from neighboring sides, of depth 1 and less: v is up on the larger one.
    floor = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    walls = [(0, 0, -1), (1, 0, -1), (1, 0, -depth), (1, 1, -depth)]
    triangles = [(0, 1, 2), (0, 2, 3), (4, 5, 1), (4, 1, 0), (1, 6, 7), (1, 7, 2)]
    directions = np.tile(UP, (len(triangles), 1))
    surface = lsgp.Surface(np.array(floor + walls, float), np.array(triangles), directions=directions)
    result = lsgp.parameterize(surface, [])
    image = images(surface, result)
    assert off_v(image[2:4]).max() <= EXACT
    assert np.abs(off_v(image[4:]) - np.pi / 2).max() <= EXACT


def test_every_island_has_its_own_turn() -> None:
    mesh = meshes.merge([meshes.hill(6), meshes.saddle(6), meshes.hill(5)])
    component = oracle.face_components(mesh.triangles)
    directions = np.zeros(mesh.triangles.shape)
    first = [int(np.flatnonzero(component == part)[0]) for part in range(3)]
    for f in first:
        directions[f] = np.random.default_rng(f).normal(size=3)
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)
    result = lsgp.parameterize(surface, [])
    assert off_v(images(surface, result)[first]).max() <= EXACT


def test_several_strokes_on_an_island_are_met_in_the_sense_of_least_squares() -> None:
    mesh = meshes.hill(8)
    rng = np.random.default_rng(7)
    directions = np.array([0.0, 1.0, 0.3]) + 0.5 * rng.normal(size=(len(mesh.triangles), 3))
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)
    result = lsgp.parameterize(surface, [])
    area = oracle.triangle_areas(mesh.positions, mesh.triangles)
    normal = np.cross(*(mesh.positions[mesh.triangles[:, c]] - mesh.positions[mesh.triangles[:, 0]] for c in (1, 2)))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    inside = np.linalg.norm(directions - (directions * normal).sum(axis=1)[:, None] * normal, axis=1)
    image = images(surface, result)
    unit = image / np.abs(image) * area * inside
    # Any other turn is worse: the weighted mean of the unit images points along v.
    assert abs(np.angle(unit.sum() / 1j)) <= EXACT
    errors = off_v(image)
    assert result.direction_errors == pytest.approx(errors, abs=1e-9)
    assert result.direction_error == pytest.approx((errors * area * inside).sum() / (area * inside).sum(), abs=1e-9)


@pytest.mark.parametrize("lattice", ROTATION_ORDER)
@pytest.mark.parametrize("name", ["ball", "hill", "tube", "torus", "cube", "flower"])
def test_one_stroke_on_a_lattice(name: str, lattice: str) -> None:
    mesh = MODELS[name]()
    options = lsgp.Options(seamless=lsgp.Seamless(lattice=lattice))
    rotation_order = ROTATION_ORDER[lattice]
    surface = with_stroke(mesh, 5)
    cones = mesh.cones if lattice not in ("translation", "stripe") or name == "ball" else []
    try:
        result = lsgp.parameterize(surface, cones, options=options)
    except lsgp.LsgpError as error:
        assert lattice != "square", error  # curvature that these turns cannot take up
        return
    image = images(surface, result)[5]
    assert off_v(image, rotation_order) <= ONE_STROKE
    assert result.direction_errors[5] == pytest.approx(off_v(image, rotation_order), abs=1e-9)
    # No turn of the lattice brings it nearer to v itself.
    turned = image * np.exp(2j * np.pi * np.arange(rotation_order) / rotation_order)
    assert off_v(image) <= off_v(turned).min() + 1e-9
    assert not undeclared_faults(surface, result, options)


@pytest.mark.parametrize("name", ["tube", "torus", "cube"])
def test_level_courses_on_walls(name: str) -> None:
    """Where all that stands upright can be upright in the texture, it is."""
    mesh = meshes.torus(48, 32) if name == "torus" else MODELS[name]()
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=UP)
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=64))
    cones = mesh.cones if name == "cube" else []
    result = lsgp.parameterize(surface, cones, options=options)
    assert result.direction_error <= np.radians(2), np.degrees(result.direction_error)
    assert not undeclared_faults(surface, result, options)


def test_a_sleeve_becomes_a_straight_strip() -> None:
    mesh = meshes.cylinder(taper=0.6)
    options = lsgp.Options(seamless=lsgp.Seamless())
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    bent = lsgp.parameterize(surface, [], options=options)
    strip = lsgp.parameterize(replace(surface, directions=UP), [], options=options)
    sums = [oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions)) for result in (bent, strip)]
    turning = [[float((np.pi - s[loop]).sum()) for loop in oracle.boundary_loops(mesh.triangles)] for s in sums]
    assert np.abs(turning[1]).max() <= 1e-6
    assert np.abs(turning[0]).max() > 1
    # Turning that is given stays.
    rim = int(oracle.boundary_loops(mesh.triangles)[0][0])
    given = replace(options, loop_turning={rim: 2 * np.pi})
    kept = lsgp.parameterize(replace(surface, directions=UP), [], options=given)
    sums = oracle.uv_angle_sums(mesh.triangles, kept.corner_uv, len(mesh.positions))
    assert (np.pi - sums[oracle.boundary_loops(mesh.triangles)[0]]).sum() == pytest.approx(2 * np.pi, abs=1e-6)


def lathe(radius: NDArray[np.float64], height: NDArray[np.float64], around: int = 36) -> meshes.Mesh:
    """A profile turned about z, closed by a disk at its first ring."""
    turn = 2 * np.pi * np.arange(around) / around
    rings = [[r * np.cos(turn), r * np.sin(turn), np.full(around, h)] for r, h in zip(radius, height, strict=True)]
    index = np.arange(len(radius) * around).reshape(len(radius), around)
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    c, d = np.roll(index[1:], -1, axis=1), index[1:]
    bottom = np.stack([np.roll(index[0], -1), index[0], np.full(around, index.size)], axis=-1)
    sides = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    places = np.concatenate([np.concatenate([np.stack(ring, axis=-1) for ring in rings]), [[0, 0, height[0]]]])
    return meshes.make(places, np.concatenate([*sides, bottom]))


def test_a_vase_has_its_cones_around_the_bottom_and_level_courses() -> None:
    height = np.linspace(0, 2, 20)
    vase = lathe(0.5 + 0.25 * np.sin(2.2 * height), height)
    surface = lsgp.Surface(vase.positions, vase.triangles, directions=UP)
    placed = lsgp.place_cones(surface, lattice="square")
    assert placed.reached and placed.mapped_l2 <= 1.2
    assert (vase.positions[placed.cones, 2] == 0).all()
    assert (2 * np.pi - placed.cone_angles).sum() == pytest.approx(2 * np.pi, abs=1e-9)
    result = lsgp.auto_unwrap(surface, preset="tile")
    assert result.direction_error <= np.radians(7)
    assert not undeclared_faults(surface, result, lsgp.preset_options("tile"))
    # Without directions, or with a number of cones, they are where they lower the stretch most.
    for other in (replace(surface, directions=None), surface):
        count = None if other.directions is None else 6
        usual = lsgp.place_cones(other, lattice="square", count=count)
        assert (vase.positions[usual.cones, 2] > 0).any()
        assert usual.mapped_l2 < placed.mapped_l2


def open_lathe(radius: NDArray[np.float64], height: NDArray[np.float64], around: int = 36) -> meshes.Mesh:
    """The same without the disk."""
    closed = lathe(radius, height, around)
    middle = len(closed.positions) - 1
    return meshes.make(closed.positions[:-1], closed.triangles[(closed.triangles != middle).all(axis=1)])


def test_flat_rings_become_strips_only_where_that_stretches_little() -> None:
    """Directions around a ring; on a wide one, courses around the middle would be stretched to several times."""
    for inner, most_l2, most_error in ((0.5, 1.2, 2), (0.2, 1 + 1e-9, 45)):
        ring = open_lathe(np.linspace(1, inner, 8), np.zeros(8))
        x, y, _ = ring.positions[ring.triangles].mean(axis=1).T
        surface = lsgp.Surface(ring.positions, ring.triangles, directions=np.stack([-y, x, 0 * x], axis=1))
        result = lsgp.parameterize(surface, [], options=lsgp.Options(seamless=lsgp.Seamless()))
        assert result.distortion.l2_stretch <= most_l2
        assert result.direction_error <= np.radians(most_error)


def test_round_creases_do_not_turn_the_texture() -> None:
    """The rim of a hole in a square plate bends by 60 degrees, and has no direction of its own."""
    radius = np.array([3, 2, 1.3, 1, 0.97])
    plate = open_lathe(radius, np.array([0, 0, 0, 0, -0.05]), 32)
    turn = plate.positions[:32, :2]
    plate.positions[:32, :2] = 3 * turn / np.abs(turn).max(axis=1, keepdims=True)
    result = lsgp.auto_unwrap(lsgp.Surface(plate.positions, plate.triangles, directions=(0, 1, 0)), preset="tile")
    assert result.direction_error <= np.radians(5)


def test_a_sleeve_has_no_cones() -> None:
    mesh = meshes.cylinder(24, 12, taper=0.5)
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=UP)
    result = lsgp.auto_unwrap(surface, preset="tile")
    assert len(result.cones) == 0 and result.direction_error <= np.radians(3)


def test_a_bent_sleeve_has_no_cones_where_that_halves_the_error() -> None:
    """Its courses tilt as it bends, so that they miss the direction in any layout."""
    mesh = meshes.cylinder(24, 12, taper=0.25)
    along = np.linspace(-1, 1, 13).repeat(24)
    bent = mesh.positions + np.stack([0.6 * along**2, 0 * along, 0 * along], axis=-1)
    surface = lsgp.Surface(bent, mesh.triangles, directions=UP)
    usual = lsgp.place_cones(replace(surface, directions=None), lattice="square")
    assert len(usual.cones) > 0
    through_cones = lsgp.auto_unwrap(surface, usual.cones, usual.cone_angles, preset="tile")
    result = lsgp.auto_unwrap(surface, preset="tile")
    assert len(result.cones) == 0
    assert result.direction_error <= through_cones.direction_error / 2


def test_cones_are_not_moved_for_courses_that_bend_all_the_same() -> None:
    mesh = meshes.bumpy_sphere(3)
    plain = lsgp.Surface(mesh.positions, mesh.triangles)
    usual = lsgp.place_cones(plain, lattice="square")
    assert lsgp.place_cones(replace(plain, directions=UP), lattice="square").cones.tolist() == usual.cones.tolist()


def test_walls_are_upright_or_upside_down_rather_than_on_their_side() -> None:
    """The large faces of a wall may be half a turn apart in the layout: both count for more than its narrow sides."""
    mesh = meshes.cube(4, stretch=(2, 0.4, 1.2))
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=UP)
    result = lsgp.auto_unwrap(surface, mesh.cones, preset="tile")
    image = images(surface, result)
    large = np.ptp(mesh.positions[mesh.triangles][:, :, 1], axis=1) < 1e-9
    assert np.median(off_v(image[large], 2)) <= np.radians(2)


def test_directions_that_cancel_turn_nothing() -> None:
    mesh = meshes.icosphere(2)
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    placed = lsgp.place_cones(surface, count=6)
    plain = lsgp.parameterize(surface, placed.cones)
    rng = np.random.default_rng(0)
    noise = replace(surface, directions=rng.normal(size=mesh.triangles.shape))
    result = lsgp.parameterize(noise, placed.cones)
    assert np.array_equal(result.corner_uv, plain.corner_uv)
    assert result.direction_error > 1


@pytest.mark.parametrize("directions", [np.zeros(3), UP], ids=["none", "across"])
def test_directions_without_a_part_in_the_surface(directions: object) -> None:
    mesh = meshes.grid(4, 4)
    flat = mesh._replace(positions=mesh.positions * [1, 1, 0])
    surface = lsgp.Surface(flat.positions, flat.triangles)
    result = lsgp.parameterize(replace(surface, directions=directions), [])
    assert np.array_equal(result.corner_uv, lsgp.parameterize(surface, []).corner_uv)
    assert np.isnan(result.direction_errors).all() and result.direction_error is None


def test_neither_length_nor_unit_of_directions_matters() -> None:
    mesh = meshes.hill(6)
    of = {scale: np.array([0.3, 1.0, 0.2]) * scale for scale in (1.0, 2.0**-1000, 2.0**1000)}
    maps = [
        lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, directions=d), []).corner_uv for d in of.values()
    ]
    assert all(np.array_equal(maps[0], other) for other in maps[1:])


def test_a_direction_that_is_nothing_beside_others_still_has_an_error() -> None:
    mesh = meshes.hill(6)
    directions = np.ones(mesh.triangles.shape)
    directions[3] = -1.7e308, 1, 1
    surface = lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)
    result = lsgp.parameterize(surface, [])
    assert result.direction_error <= EXACT and result.direction_errors[3] <= EXACT
    others = replace(surface, directions=np.where(np.arange(len(directions))[:, None] == 3, 0.0, directions))
    errors = off_v(images(others, result))
    assert np.delete(result.direction_errors, 3) == pytest.approx(np.delete(errors, 3), abs=1e-9)


def test_faces_turned_the_other_way_and_doubled_ones() -> None:
    mesh = meshes.with_flipped(meshes.hill(6), [3, 4, 10])
    triangles = np.concatenate([mesh.triangles, mesh.triangles[:2]])
    surface = lsgp.Surface(mesh.positions, triangles, directions=(0.2, 1, 0.1))
    result = lsgp.parameterize(surface, [])
    assert "DUPLICATE_FACE" in codes(result.warnings)
    assert off_v(images(surface, result)) == pytest.approx(result.direction_errors, abs=1e-9)


def test_two_pins_say_how_an_island_is_turned() -> None:
    mesh = meshes.hill(6)
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    pins = lsgp.Pins([0, 100], [[0.1, 0.1], [0.8, 0.7]])
    plain = lsgp.parameterize(surface, [], pins=pins)
    turned = lsgp.parameterize(replace(surface, directions=(0, 1, 0)), [], pins=pins)
    assert np.array_equal(plain.corner_uv, turned.corner_uv)
    one = lsgp.Pins([0], [[0.1, 0.1]])
    up = replace(surface, directions=with_stroke(mesh, 7).directions)
    result = lsgp.parameterize(up, [], pins=one)
    assert off_v(images(up, result)[7]) <= EXACT
    assert result.corner_uv[0, 0] == pytest.approx([0.1, 0.1], abs=1e-12)


@pytest.mark.parametrize(
    ("directions", "code"),
    [
        ([0.0, 1.0], "WRONG_SHAPE"),
        (np.zeros((5, 3)), "WRONG_SHAPE"),
        (["x", "y", "z"], "WRONG_DTYPE"),
    ],
)
def test_directions_of_the_wrong_form_are_refused(directions: object, code: str) -> None:
    mesh = meshes.hill(4)
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)
    assert refused.value.code == code


def test_directions_that_are_not_finite_are_refused_by_triangle() -> None:
    mesh = meshes.hill(4)
    directions = np.zeros(mesh.triangles.shape)
    directions[[2, 5], 1] = np.nan, np.inf
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, directions=directions), [])
    assert refused.value.code == "WRONG_PARAMETER"
    assert refused.value.elements.kind == "triangles" and refused.value.elements.indices.tolist() == [2, 5]
