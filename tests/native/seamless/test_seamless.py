# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless layouts: every cut is a lattice motion exactly, in float32, and the certificate says which.

`result_check.undeclared_faults` reads the transitions off the coordinates; the tests here say on which surfaces and
with which options, and what else a layout has to keep.
"""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from layout_check import coverage, overlapping_islands
from map_checks import codes, components, digest, only, surface, unwrap
from meshes import Mesh
from result_check import undeclared_faults

TURN = 2 * np.pi
LATTICES = ("square", "stripe", "translation", "triangle", "hexagon")
ROTATION_ORDER = {"square": 4, "stripe": 2, "translation": 1, "triangle": 3, "hexagon": 6}
TILES = 24


def punctured(mesh: Mesh, holes: int) -> Mesh:
    """A sphere without the triangles around some of its cones; the other cones stay."""
    gone = np.isin(mesh.triangles, mesh.cones[:holes]).any(axis=1)
    return meshes.compact(mesh._replace(triangles=mesh.triangles[~gone], cones=mesh.cones[holes:]))


def bent_corners(mesh: Mesh, step: int) -> Mesh:
    """Every so-many-th vertex at which a surface of voxels is bent as a cone."""
    bent = np.abs(oracle.angle_defects(mesh.positions, mesh.triangles)) > 0.1
    return mesh._replace(cones=np.flatnonzero(bent)[::step].astype(np.int32))


BALL = meshes.bumpy_sphere(3)
PUNCTURED = meshes.bumpy_sphere(3, 0.15)
SPHERES = {
    "cube": meshes.cube(4),
    "tetrahedron": meshes.subdivide(meshes.subdivide(meshes.tetrahedron())),
    "bumpy sphere": BALL,
    "flower": meshes.flower(3),
    "many cones": meshes.forked(),
}
HANDLES = {
    "torus": meshes.torus(),
    "torus with cones": meshes.torus()._replace(cones=np.array([0, 5, 90, 95, 140], np.int32)),
    "double torus": bent_corners(meshes.subdivide(meshes.double_torus()), 3),
}
OPEN = {
    "disk": meshes.saddle(),
    "disk with a cone": meshes.hill(),
    "disk with cones": punctured(PUNCTURED, 1),
    "cylinder": meshes.cylinder(),
    "annulus": punctured(PUNCTURED._replace(cones=PUNCTURED.cones[:2]), 2),
    "annulus with cones": punctured(PUNCTURED, 2),
    "closed holes": meshes.disk_with_holes(12, 2),
    "three holes": punctured(PUNCTURED._replace(cones=PUNCTURED.cones[:3]), 3),
    "three holes and cones": punctured(PUNCTURED, 3),
}
EVERYTHING = SPHERES | HANDLES | OPEN


def seamless(mesh: Mesh, angles: list[float | None] | None = None, **wanted: object) -> lsgp.Result:
    return unwrap(mesh, angles, seamless=lsgp.Seamless(**({"tiles": TILES} | wanted)))


def checked(mesh: Mesh, angles: list[float | None] | None = None, **wanted: object) -> lsgp.Result:
    """A seamless layout without any fault."""
    options = lsgp.Options(seamless=lsgp.Seamless(**({"tiles": TILES} | wanted)))
    result = lsgp.parameterize(surface(mesh), mesh.cones, angles, options)
    assert undeclared_faults(surface(mesh), result, options) == []
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    return result


@cache
def ball(**wanted: object) -> lsgp.Result:
    return seamless(BALL, **wanted)


def energy(mesh: Mesh, corner_uv: np.ndarray) -> float:
    """Symmetric Dirichlet energy, each component at its best scale, the mean by area."""
    total = 0.0
    for part, faces in components(mesh):
        share = oracle.triangle_areas(part.positions, part.triangles)
        sigma = oracle.stretches(part.positions, part.triangles, corner_uv[faces])
        grown, shrunk = (share @ (sigma**power).sum(axis=1) / 2 for power in (2.0, -2.0))
        total += np.sqrt(grown * shrunk)
    return total / oracle.triangle_areas(mesh.positions, mesh.triangles).sum()


def longer_side(corner_uv: np.ndarray) -> float:
    """Of the smallest rectangle about a layout."""
    points = corner_uv.reshape(-1, 2) @ (1, 1j)
    sides = []
    for direction in np.exp(1j * np.linspace(0, np.pi / 2, 4000, endpoint=False)):
        turned = points * direction
        sides.append((np.ptp(turned.real), np.ptp(turned.imag)))
    return max(min(sides, key=lambda box: box[0] * box[1]))


# --- exact on every kind of surface -----------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("lattice", LATTICES)
@pytest.mark.parametrize("name", EVERYTHING)
def test_every_cut_is_a_lattice_motion(name: str, lattice: str) -> None:
    if lattice == "translation" and name in SPHERES:
        with pytest.raises(lsgp.CurvatureError) as caught:
            seamless(EVERYTHING[name], lattice=lattice)
        assert caught.value.code == "SEAMLESS_IMPOSSIBLE"
        return
    result = checked(EVERYTHING[name], lattice=lattice)
    assert "GRID_REFINED" not in codes(result.warnings)
    report = result.seamless
    assert (report.rotation_order, report.tiles, report.cell) == (ROTATION_ORDER[lattice], TILES, 1)
    if lattice in ("square", "stripe", "translation"):
        assert report.error == 0 and (report.cut_errors == 0).all()


@pytest.mark.parametrize("tiles", [8, 64, 512])
@pytest.mark.parametrize("name", ["bumpy sphere", "torus with cones", "annulus with cones"])
def test_coarse_and_fine_grids(name: str, tiles: int) -> None:
    result = checked(EVERYTHING[name], tiles=tiles)
    assert ("GRID_REFINED" in codes(result.warnings)) == (result.seamless.tiles != tiles)


@pytest.mark.parametrize("lattice", ["triangle", "hexagon"])
def test_triangular_lattices_match_to_the_last_place(lattice: str) -> None:
    """Were both sides of a cut rounded for themselves, some of these would miss each other by more."""
    for tiles in range(16, 56):
        checked(HANDLES["torus with cones"], lattice=lattice, tiles=tiles)


@pytest.mark.parametrize("lattice", ["square", "triangle", "hexagon"])
def test_the_finest_grid_is_exact_too(lattice: str) -> None:
    checked(BALL, lattice=lattice, tiles=16384)


def test_a_surface_without_cuts_needs_no_certificate() -> None:
    report = checked(OPEN["disk"]).seamless
    assert len(report.cut_nodes) == len(report.cut_turns) == len(report.cut_translations) == report.error == 0


def test_cuts_are_those_of_the_certificate() -> None:
    """The certificate's nodes are the cones and junctions of a cut whose cones are leaves of a tree."""
    report = ball().seamless
    assert np.isin(BALL.cones, report.cut_nodes).all()
    nodes = len(np.unique(report.cut_nodes))
    assert len(report.cut_nodes) == nodes - 1
    assert ((report.cut_turns >= 0) & (report.cut_turns < 4)).all()


def test_handles_add_two_cuts_each() -> None:
    for name, genus in (("torus", 1), ("double torus", 2)):
        nodes = checked(HANDLES[name]).seamless.cut_nodes
        assert len(nodes) == len(np.unique(nodes)) - 1 + 2 * genus


def test_a_torus_without_cones_only_shifts() -> None:
    for lattice in LATTICES:
        report = checked(HANDLES["torus"], lattice=lattice).seamless
        assert (report.cut_turns == 0).all() and report.cut_translations.any(axis=1).all()


@pytest.mark.parametrize("seed", range(4))
def test_numbering_keeps_layouts_valid(seed: int) -> None:
    for name in ("bumpy sphere", "torus with cones", "annulus with cones"):
        checked(meshes.renumber(EVERYTHING[name], seed)[0])


@pytest.mark.parametrize("exponent", [-6, 0, 5])
def test_size_and_place_of_the_surface(exponent: int) -> None:
    moved = meshes.transform(BALL, 3, 10.0**exponent)
    report, plain = checked(moved).seamless, ball().seamless
    assert report.tile_size == pytest.approx(10.0**exponent * plain.tile_size, rel=1e-6)
    assert report.energy_before == pytest.approx(plain.energy_before, rel=1e-6)


# --- what the certificate says besides --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["cube", "bumpy sphere", "flower", "torus with cones", "annulus with cones"])
def test_energies_are_those_of_the_layouts(name: str) -> None:
    mesh = EVERYTHING[name]
    for tiles in (TILES, 256):
        result = checked(mesh, tiles=tiles)
        assert result.seamless.energy_after == pytest.approx(energy(mesh, result.corner_uv), rel=1e-4)
    # Fine grids leave the layout as it was.
    assert result.seamless.energy_after == pytest.approx(result.seamless.energy_before, rel=0.01)


@pytest.mark.parametrize("name", ["cube", "bumpy sphere", "flower"])
def test_rounding_starts_from_the_map_with_the_rounded_angles(name: str) -> None:
    mesh = SPHERES[name]
    result = checked(mesh)
    plain = lsgp.parameterize(surface(mesh), result.cones, result.cone_angles)
    assert result.seamless.energy_before == pytest.approx(energy(mesh, plain.corner_uv), rel=1e-6)
    # Tiles are counted along it where it has the surface's size.
    area = oracle.triangle_areas(mesh.positions, mesh.triangles).sum()
    scale = np.sqrt(area / oracle.signed_areas(plain.corner_uv).sum())
    extent = scale * longer_side(plain.corner_uv)
    assert result.seamless.tiles * result.seamless.tile_size == pytest.approx(extent, rel=1e-5)


@pytest.mark.parametrize("lattice", ["square", "hexagon"])
def test_tile_size_is_that_of_a_cell_on_the_surface(lattice: str) -> None:
    for tiles in (64, 256):
        result = checked(BALL, lattice=lattice, tiles=tiles)
        in_space = oracle.triangle_areas(BALL.positions, BALL.triangles).sum()
        in_cells = oracle.signed_areas(result.corner_uv).sum()
        assert np.sqrt(in_space / in_cells) == pytest.approx(result.seamless.tile_size, rel=1 / tiles)


def test_number_and_size_of_tiles_are_one_choice() -> None:
    first = ball().seamless
    again = checked(BALL, tiles=None, tile_size=first.tile_size).seamless
    assert (again.tiles, again.tile_size) == pytest.approx((TILES, first.tile_size), rel=1e-12)
    assert again.energy_after == pytest.approx(first.energy_after, rel=1e-9)


@pytest.mark.parametrize("cell", [1.0, 2.0**-4, 2.0**-14])
def test_cells_of_any_side_are_the_same_layout(cell: float) -> None:
    result = checked(BALL, cell=cell)
    assert np.array_equal(result.corner_uv, cell * ball().corner_uv)
    assert np.array_equal(result.seamless.cut_translations, ball().seamless.cut_translations)


def test_flat_cones_are_cones_no_more() -> None:
    mesh = meshes.grid(8, 8)._replace(cones=np.array([20, 40], np.int32))
    result = checked(mesh)
    assert (
        result.seamless.flat_cones.tolist() == [20, 40] == only(result.warnings, "FLAT_CONES").elements.indices.tolist()
    )
    assert result.cones.size == 0 and result.cut_edges.size == 0
    assert "FLAT_CONES" not in codes(ball().warnings)


# --- which grid -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["cube", "bumpy sphere", "many cones", "torus with cones", "annulus with cones"])
def test_automatic_grids_are_the_coarsest_that_cost_at_most_a_tenth(name: str) -> None:
    mesh = EVERYTHING[name]
    report = checked(mesh, tiles=None).seamless
    assert report.energy_after <= 1.1 * report.energy_before
    if report.tiles > 4:
        size = 2 ** np.floor(np.log2(report.tiles))
        coarser = size if report.tiles > size else 0.75 * size
        other = checked(mesh, tiles=coarser)
        refined = "GRID_REFINED" in codes(other.warnings)
        assert refined or other.seamless.energy_after > 1.1 * other.seamless.energy_before


def test_a_grid_too_coarse_is_refined_and_says_so() -> None:
    result = checked(SPHERES["many cones"], tiles=1)
    assert result.seamless.tiles > 1
    assert f"{result.seamless.tiles:g}" in only(result.warnings, "GRID_REFINED").message


def test_parts_share_one_grid() -> None:
    mesh = meshes.merge([BALL, meshes.cube(4), meshes.hill(), meshes.torus(), meshes.cylinder()])
    result = checked(mesh, tiles=128)
    assert result.seamless.tiles == 128
    size, boxes = [], []
    for part, faces in components(mesh):
        in_space = oracle.triangle_areas(part.positions, part.triangles).sum()
        size.append(np.sqrt(in_space / oracle.signed_areas(result.corner_uv[faces]).sum()))
        boxes.append((result.corner_uv[faces].min(axis=(0, 1)), result.corner_uv[faces].max(axis=(0, 1))))
        assert len(np.unique(result.island[faces])) == 1
    assert size == pytest.approx([result.seamless.tile_size] * 5, rel=0.05)
    for i in range(5):
        for j in range(i):
            assert (np.maximum(boxes[i][0] - boxes[j][1], boxes[j][0] - boxes[i][1]) >= 0).any()
    assert result.seamless.energy_after == pytest.approx(energy(mesh, result.corner_uv), rel=1e-4)


def test_a_part_without_a_layout_is_left_out_and_named() -> None:
    """Two cones are too few for a sphere; the other one is seamless all the same."""
    small = meshes.cube(2)
    mesh = meshes.merge([BALL, small._replace(cones=small.cones[:2])])
    result = checked(mesh)
    skipped = only(result.warnings, "COMPONENT_SKIPPED").elements.indices
    assert skipped.tolist() == list(range(len(BALL.triangles), len(mesh.triangles)))
    assert np.isin(result.cones, BALL.cones).all()


# --- parity -----------------------------------------------------------------------------------------------------------


def color_changes(mesh: Mesh, result: lsgp.Result) -> tuple[int, int]:
    """At how many points on cuts black is beside white, and the number of points looked at, all well inside cells."""
    opened = oracle.cut_open(mesh.triangles, result.cut_edges)
    z = np.empty(opened.count, complex)
    z[opened.corner.ravel()] = oracle.as_complex(result.corner_uv.astype(np.float32).astype(float)).ravel()
    along = np.linspace(0, 1, 41)
    sides = [(1 - along) * z[ends[:, :1]] + along * z[ends[:, 1:]] for ends in (opened.left, opened.right)]
    off = np.stack([np.abs(part - np.round(part)) for side in sides for part in (side.real, side.imag)])
    inside = (off > 1e-3).all(axis=0)
    colors = [(np.floor(side.real) + np.floor(side.imag)) % 2 for side in sides]
    return int((colors[0] != colors[1])[inside].sum()), int(inside.sum())


@pytest.mark.parametrize("name", ["cube", "bumpy sphere", "many cones", *HANDLES, "annulus with cones", "three holes"])
def test_checkers_match_with_parity(name: str) -> None:
    mesh = EVERYTHING[name]
    changes, points = color_changes(mesh, checked(mesh, parity=True))
    assert changes == 0 and points > 200


@pytest.mark.parametrize("name", ["bumpy sphere", "double torus"])
def test_checkers_do_not_match_without(name: str) -> None:
    mesh = EVERYTHING[name]
    changes, points = color_changes(mesh, checked(mesh))
    assert changes > points / 10


@pytest.mark.parametrize("tiles", [8, 64, 200])
def test_parity_on_other_grids(tiles: int) -> None:
    assert color_changes(BALL, checked(BALL, parity=True, tiles=tiles))[0] == 0


# --- options and refusals ---------------------------------------------------------------------------------------------

WRONG = {
    **{f"tiles {value}": {"tiles": value} for value in (0, -1, -0.0, np.nan, np.inf, -np.inf, 16385, 2e9)},
    **{f"size {value}": {"tiles": None, "tile_size": value} for value in (0, -1, np.nan, np.inf, 1e-9)},
    **{f"cell {value}": {"cell": value} for value in (0, -1, 3, 0.3, 2, np.nan, np.inf, 2.0**-15)},
    "both": {"tiles": 8, "tile_size": 0.1},
    "text": {"tiles": "8"},
    "truth": {"tiles": True},
    "lattice": {"lattice": "octagon"},
    "coarse grid": {"coarse_grid": "guess"},
    **{f"parity of {lattice}": {"lattice": lattice, "parity": True} for lattice in LATTICES[1:]},
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_parameters_are_refused(name: str) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        seamless(BALL, **WRONG[name])
    assert caught.value.code == "WRONG_PARAMETER"


@pytest.mark.parametrize("options", [{"method": "lscm"}, {"border": "straight"}], ids=str)
def test_options_without_transitions_are_refused(options: dict[str, str]) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        unwrap(OPEN["disk"], seamless=lsgp.Seamless(), **options)
    assert caught.value.code == "WRONG_PARAMETER"


@pytest.mark.parametrize("count", [1, 2])
def test_pins_are_refused(count: int) -> None:
    pins = lsgp.Pins(np.arange(count), np.arange(2.0 * count).reshape(-1, 2))
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.parameterize(surface(BALL), BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless()), pins)
    assert caught.value.code == "PINS_CONFLICT"


def test_something_else_than_options_is_refused() -> None:
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.Options(seamless=True)
    assert caught.value.code == "WRONG_PARAMETER"


@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
@pytest.mark.parametrize("rule", ["least-distortion", "harmonic", "straightness"])
def test_every_way_to_angles_and_maps_leads_to_a_layout(rule: str, unfold: str) -> None:
    options = lsgp.Options(prescription=rule, unfold=unfold, seamless=lsgp.Seamless(tiles=TILES))
    result = lsgp.parameterize(surface(BALL), BALL.cones, None, options)
    assert undeclared_faults(surface(BALL), result, options) == []
    assert result.flipped.size == 0


def test_given_angles_are_kept_or_rounded() -> None:
    given = [1.5 * np.pi, 1.5 * np.pi, None, None, 1.4 * np.pi, None]
    result = checked(BALL, given)
    angle = dict(zip(result.cones.tolist(), result.cone_angles.tolist(), strict=True))
    assert [angle[v] for v in BALL.cones[:2].tolist()] == pytest.approx([1.5 * np.pi] * 2, abs=1e-12)


def test_seams_as_borders_make_islands_with_their_own_motions() -> None:
    seams = BALL.triangles[:200, :2]
    cut = lsgp.Surface(BALL.positions, BALL.triangles, None, seams)
    options = lsgp.Options(seams="boundary", seamless=lsgp.Seamless(tiles=TILES))
    result = lsgp.parameterize(cut, BALL.cones, None, options)
    assert undeclared_faults(cut, result, options) == []


def test_corners_of_a_border_with_given_angles() -> None:
    """A quarter turn at each corner of a square patch."""
    mesh = meshes.saddle(8)._replace(cones=np.array([0, 8, 72, 80], np.int32))
    checked(mesh, [np.pi / 2] * 4)


def test_prescribed_turning_of_borders() -> None:
    mesh = OPEN["annulus with cones"]
    loop = oracle.boundary_loops(mesh.triangles)[0]
    options = lsgp.Options(loop_turning={int(loop[0]): -TURN}, seamless=lsgp.Seamless(tiles=TILES))
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert undeclared_faults(surface(mesh), result, options) == []
    # Closed about that border: no cut leads there.
    assert not np.isin(result.cut_edges, loop).any()


def test_digests_tell_layouts_apart() -> None:
    assert digest(ball()) == digest(seamless(BALL)) != digest(ball(tiles=25))


def test_scraps_without_cuts_share_cells():
    """Beside a ball with cones, whose parts lie on whole tiles, 200 triangles take less room than a cell each."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0]])
    places = np.stack(np.divmod(np.arange(200), 20), axis=1) @ np.array([[1, 0, 0], [0, 1, 0]])
    scraps = [meshes.make(0.02 * (corners + 2 * place), [[0, 1, 2]]) for place in places]
    mesh = meshes.merge([BALL, *scraps])
    result = lsgp.auto_unwrap(surface(mesh), preset="tile")
    assert result.solved.all()
    assert undeclared_faults(surface(mesh), result, lsgp.preset_options("tile")) == []
    assert overlapping_islands(result.corner_uv, result.island) == 0
    is_scrap = np.arange(len(mesh.triangles)) >= len(BALL.triangles)
    of_scraps = result.corner_uv[is_scrap].reshape(-1, 2)
    assert np.ptp(of_scraps, axis=0).prod() < len(scraps) / 2
    box = np.concatenate([of_scraps.min(axis=0), of_scraps.max(axis=0)])
    assert coverage((result.corner_uv[is_scrap] - box[:2]) / (box[2:] - box[:2]), np.arange(200)) > 0.3
