# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of results works: sound maps pass, and every kind of corruption is detected."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
import zoo
from map_checks import surface, unwrap
from result_check import undeclared_faults

MESH = meshes.bumpy_sphere(2)
SURFACE = surface(MESH)
SOUND = unwrap(MESH)

MIXED = meshes.merge([meshes.cube(2), meshes.moebius_strip(8, 1)])
SPLIT = meshes.with_flipped(meshes.hill(6), [7])
DOUBLED = SPLIT._replace(triangles=np.concatenate([SPLIT.triangles, SPLIT.triangles[3:4]]))


@pytest.mark.parametrize("mesh", [MESH, MIXED, SPLIT, DOUBLED, meshes.torus(14, 8), meshes.bow_tie(3)[0]])
@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
def test_sound_maps_pass(mesh: meshes.Mesh, unfold: str) -> None:
    options = lsgp.Options(unfold=unfold)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert undeclared_faults(surface(mesh), result, options) == []


def spoiled(change: Callable[[np.ndarray], object]) -> lsgp.Result:
    """The sound map with its coordinates changed in place."""
    uv = SOUND.corner_uv.copy()
    change(uv)
    return replace(SOUND, corner_uv=uv)


def moved_vertex(uv: np.ndarray, by: float) -> None:
    """A vertex away from cones and cuts."""
    vertex = np.setdiff1d(MESH.triangles, np.union1d(SOUND.cut_edges, SOUND.cones))[5]
    uv[MESH.triangles == vertex] += by


def corner_on_seam(uv: np.ndarray, by: float) -> None:
    """One side of an end of a cut edge."""
    a, b = SOUND.cut_edges[3]
    face = np.flatnonzero((MESH.triangles == a).any(axis=1) & (MESH.triangles == b).any(axis=1))[0]
    at = uv[face][MESH.triangles[face] == a]
    uv[(MESH.triangles == a) & (uv == at).all(axis=2)] += by


def named(code: str, kind: str, indices: list[int]) -> lsgp.Result:
    """The sound map with a warning."""
    finding = lsgp.Finding(code, "", lsgp.Elements(kind, np.array(indices, np.int32)))
    return replace(SOUND, warnings=[*SOUND.warnings, finding])


SPOILED = {
    "not finite": lambda: spoiled(lambda uv: uv[7, 1].fill(np.nan)),
    "flipped": lambda: spoiled(lambda uv: moved_vertex(uv, 0.5)),
    "mirrored": lambda: spoiled(lambda uv: np.negative(uv[..., 0], out=uv[..., 0])),
    "collapsed": lambda: spoiled(lambda uv: uv[7].fill(0.5)),
    "seam moved a little": lambda: spoiled(lambda uv: corner_on_seam(uv, 1e-9)),
    "seam moved far": lambda: spoiled(lambda uv: corner_on_seam(uv, 1e-3)),
    "triangle torn off": lambda: spoiled(lambda uv: uv[7].__iadd__([1e-3, 0])),
    "sheared": lambda: spoiled(lambda uv: uv[..., 0].__iadd__(0.01 * uv[..., 1])),
    "single precision": lambda: replace(SOUND, corner_uv=SOUND.corner_uv.astype(np.float32).astype(float)),
    "angles off": lambda: replace(SOUND, cone_angles=SOUND.cone_angles + np.array([1e-5, -1e-5, 0, 0, 0, 0])),
    "Gauss-Bonnet off": lambda: replace(SOUND, cone_angles=SOUND.cone_angles + 1e-8),
    "a cone withheld": lambda: replace(SOUND, cones=SOUND.cones[1:], cone_angles=SOUND.cone_angles[1:]),
    "unsolved triangles": lambda: replace(SOUND, solved=SOUND.solved & (np.arange(len(SOUND.solved)) > 3)),
    "stretch is no number": lambda: replace(SOUND, distortion=replace(SOUND.distortion, l2_stretch=np.nan)),
    "flips listed, not named": lambda: replace(SOUND, flipped=np.array([3], np.int32)),
    "overlaps listed, not named": lambda: replace(SOUND, overlapping=np.array([3, 4], np.int32), overlap_area=0.1),
    "overlaps named, not listed": lambda: named("OVERLAPPING_TRIANGLES", "triangles", [3, 4]),
    "overlaps without an area": lambda: replace(
        named("OVERLAPPING_TRIANGLES", "triangles", [3, 4]), overlapping=np.array([3, 4], np.int32)
    ),
    "an area of overlaps alone": lambda: replace(SOUND, overlap_area=1e-9),
}


@pytest.mark.parametrize("name", SPOILED)
def test_spoiled_maps_are_noticed(name: str) -> None:
    assert undeclared_faults(SURFACE, SPOILED[name]()) != []


def test_a_warning_withheld_is_noticed() -> None:
    hard = lsgp.parameterize(SURFACE, MESH.cones, [0.05 * np.pi] * 4 + [3.9 * np.pi] * 2, lsgp.Options(repair=False))
    assert undeclared_faults(SURFACE, hard) == [] and len(hard.flipped)
    silent = replace(hard, warnings=[], flipped=np.empty(0, np.int32), wrong_angle_sums=np.empty(0, np.int32))
    assert len(undeclared_faults(SURFACE, silent)) >= 1
    skipped = lsgp.parameterize(surface(MIXED), MIXED.cones)
    assert undeclared_faults(surface(MIXED), replace(skipped, warnings=[])) != []


def lopsided_cube() -> meshes.Mesh:
    """On a cube itself cuts run along any of several paths alike: between a third and hardly any of it overlaps."""
    mesh = meshes.cube(4)
    places = mesh.positions * [1, 1.3, 0.8]
    bent = 0.1 * np.sin(places @ np.array([[1, 2, 0.3], [0.7, 0.2, 1.9], [0.4, 1.1, 0.6]]))
    return mesh._replace(positions=places + bent)


HARD_CUBE = lopsided_cube()
LYING_ON_ITSELF = lsgp.parameterize(surface(HARD_CUBE), HARD_CUBE.cones, np.array([1, 4, 4, 6, 2, 2, 4, 1]) * np.pi / 2)


def test_overlaps_withheld_are_noticed() -> None:
    cube, whole = surface(HARD_CUBE), LYING_ON_ITSELF
    assert undeclared_faults(cube, whole) == [] and len(whole.overlapping) and 0 < whole.overlap_area < 1
    others = [finding for finding in whole.warnings if finding.code != "OVERLAPPING_TRIANGLES"]
    silent = replace(whole, warnings=others, overlapping=whole.overlapping[:0], overlap_area=0.0)
    assert undeclared_faults(cube, silent) != []
    assert undeclared_faults(cube, replace(whole, overlap_area=whole.overlap_area / 2)) != []
    beside = np.setdiff1d(np.arange(len(HARD_CUBE.triangles)), whole.overlapping)[0]
    for listed in (whole.overlapping[1:], np.append(whole.overlapping, beside)):
        finding = lsgp.Finding("OVERLAPPING_TRIANGLES", "", lsgp.Elements("triangles", listed))
        assert undeclared_faults(cube, replace(whole, overlapping=listed, warnings=[*others, finding])) != []


def test_overlaps_too_thin_to_be_sure_of_may_count() -> None:
    """Far from the origin rounding moves sides by a part of a triangle's width."""
    cube = surface(HARD_CUBE)
    far = lsgp.Pins(np.array([0], np.int32), np.array([[1e9, 0.0]]))
    result = lsgp.parameterize(cube, LYING_ON_ITSELF.cones, LYING_ON_ITSELF.cone_angles, pins=far)
    assert len(result.overlapping) and undeclared_faults(cube, result) == []
    for share in (0.9, 1.1):
        other = replace(result, overlap_area=share * result.overlap_area)
        assert any("area of overlaps" in fault for fault in undeclared_faults(cube, other))


def test_islands_on_each_other_are_noticed() -> None:
    both = meshes.merge([MESH, MESH])
    result = unwrap(both)
    assert undeclared_faults(surface(both), result) == []
    uv = result.corner_uv.copy()
    uv[result.island == 1] += uv[result.island == 0].mean(axis=(0, 1)) - uv[result.island == 1].mean(axis=(0, 1))
    faults = undeclared_faults(surface(both), replace(result, corner_uv=uv))
    assert any("overlap others" in fault for fault in faults)


def test_angles_other_than_those_asked_for_are_noticed() -> None:
    as_asked = dict(zip(SOUND.cones.tolist(), SOUND.cone_angles.tolist(), strict=True))
    first = int(SOUND.cones[0])
    other = as_asked | {first: as_asked[first] + 1e-3}
    automatic = as_asked | {first: None}
    adjusted = named("ANGLES_ADJUSTED", "vertices", [first])
    assert undeclared_faults(SURFACE, SOUND, given=as_asked) == undeclared_faults(SURFACE, SOUND, given=automatic) == []
    assert undeclared_faults(SURFACE, adjusted, given=other) == []
    assert undeclared_faults(SURFACE, SOUND, given=other) != []
    assert undeclared_faults(SURFACE, named("ANGLES_ADJUSTED", "vertices", [int(SOUND.cones[1])]), given=other) != []
    for given in (as_asked, automatic, {}):
        assert undeclared_faults(SURFACE, adjusted, given=given) != []
    assert undeclared_faults(SURFACE, adjusted) == []
    free = lsgp.Options("harmonic")  # a rule that keeps no angles
    assert undeclared_faults(SURFACE, SOUND, free, other) == []
    assert undeclared_faults(SURFACE, adjusted, free, other) != []


def test_seams_as_borders_need_no_transitions() -> None:
    seams = MESH.triangles[:60, :2]
    opened = lsgp.Surface(MESH.positions, MESH.triangles, None, seams)
    options = lsgp.Options(seams="boundary")
    result = lsgp.parameterize(opened, MESH.cones, None, options)
    assert undeclared_faults(opened, result, options) == []


TILED = {
    lattice: lsgp.Options(seamless=lsgp.Seamless(lattice, tiles=20, parity=lattice == "square"))
    for lattice in ("square", "stripe", "hexagon")
}
SEAMLESS = {lattice: unwrap(MESH, seamless=options.seamless) for lattice, options in TILED.items()}
TORUS = meshes.torus(14, 8)


# Of edges of three or more triangles: sheets that fold at a seam, and those of which some are opened along their seams.
@pytest.mark.parametrize("seams", ["follow", "exact"])
@pytest.mark.parametrize("seamless", [None, lsgp.Seamless()], ids=["", "seamless"])
@pytest.mark.parametrize("marked", ["all", "crowded"])
@pytest.mark.parametrize("seed", [7, 48, 60, 362])
def test_sound_maps_of_sheets_that_meet_at_seams_pass(
    seed: int, marked: str, seamless: lsgp.Seamless | None, seams: str
) -> None:
    mesh = zoo.member(f"mixture-seed={seed}").mesh()
    sides = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    given = lsgp.Surface(mesh.positions, mesh.triangles, seams=edges[count > (0 if marked == "all" else 2)])
    placed, options = lsgp.place_cones(given), lsgp.Options(seamless=seamless, seams=seams)
    try:
        result = lsgp.parameterize(given, placed.cones, None if seamless else placed.cone_angles, options)
    except lsgp.TopologyError as error:
        assert (seams, error.code) == ("exact", "SEAMS_INCOMPLETE")
        return
    assert undeclared_faults(given, result, options) == []


def test_sides_of_one_length_that_end_at_a_seam_are_no_sides_of_a_cut() -> None:
    """Three triangles end there, two of which are mirror images."""
    mesh = zoo.member("random-complex-vertices=9-triangles=12-seed=0").mesh()
    given = lsgp.Surface(mesh.positions, mesh.triangles, seams=np.array([[1, 5], [2, 5], [4, 5], [4, 6]], np.int32))
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=4, coarse_grid="merge"))
    assert undeclared_faults(given, lsgp.parameterize(given, [], None, options), options) == []


@pytest.mark.parametrize("lattice", TILED)
def test_sound_seamless_layouts_pass(lattice: str) -> None:
    assert undeclared_faults(SURFACE, SEAMLESS[lattice], TILED[lattice]) == []
    options = lsgp.Options(seamless=lsgp.Seamless(lattice, tiles=10))
    assert undeclared_faults(surface(TORUS), unwrap(TORUS, seamless=options.seamless), options) == []


def moved_seamless(lattice: str, change: Callable[[np.ndarray, lsgp.Result], object]) -> lsgp.Result:
    """The seamless layout with its coordinates changed in place, still numbers of float32."""
    uv = SEAMLESS[lattice].corner_uv.copy()
    change(uv, SEAMLESS[lattice])
    return replace(SEAMLESS[lattice], corner_uv=uv.astype(np.float32).astype(float))


def last_place(uv: np.ndarray) -> float:
    return float(np.spacing(np.float32(np.abs(uv).max())))


def one_side(uv: np.ndarray, result: lsgp.Result, by: float) -> None:
    """All corners that are at one place of a vertex inside a cut."""
    inside = np.setdiff1d(result.cut_edges, result.seamless.cut_nodes)[3]
    at = uv[MESH.triangles == inside][0]
    uv[(MESH.triangles == inside) & (uv == at).all(axis=2)] += by


def cone_with_its_sides(uv: np.ndarray, by: float) -> None:
    uv[MESH.triangles == MESH.cones[0]] += by


def certificate(lattice: str, **changes: Callable[[np.ndarray], object]) -> lsgp.Result:
    """The seamless layout with arrays of its certificate changed in place."""
    report = SEAMLESS[lattice].seamless
    for name, change in changes.items():
        array = getattr(report, name).copy()
        change(array)
        report = replace(report, **{name: array})
    return replace(SEAMLESS[lattice], seamless=report)


def stated(lattice: str, **changes: object) -> lsgp.Result:
    return replace(SEAMLESS[lattice], seamless=replace(SEAMLESS[lattice].seamless, **changes))


def without_a_cut(lattice: str) -> lsgp.Result:
    report = SEAMLESS[lattice].seamless
    names = ("cut_nodes", "cut_turns", "cut_translations", "cut_errors")
    return stated(lattice, **{name: getattr(report, name)[1:] for name in names})


UNSOUND = {
    "one side moved by a last place": lambda a: moved_seamless(a, lambda uv, r: one_side(uv, r, 2 * last_place(uv))),
    "one side moved by a cell": lambda a: moved_seamless(a, lambda uv, r: one_side(uv, r, 1.0)),
    "a cone off its place": lambda a: moved_seamless(a, lambda uv, r: cone_with_its_sides(uv, 2 * last_place(uv))),
    "everything off the lattice": lambda a: moved_seamless(a, lambda uv, r: uv.__iadd__(0.25)),
    "scaled": lambda a: moved_seamless(a, lambda uv, r: uv.__imul__(1.001)),
    "turned": lambda a: moved_seamless(a, lambda uv, r: uv.__imatmul__(np.array([[0.6, 0.8], [-0.8, 0.6]]))),
    "another turn stated": lambda a: certificate(a, cut_turns=lambda turns: turns[:1].__iadd__(1)),
    "another shift stated": lambda a: certificate(a, cut_translations=lambda shifts: shifts[2].__iadd__([0, 1])),
    "another end stated": lambda a: certificate(a, cut_nodes=lambda nodes: nodes[0].__iadd__([0, 1])),
    "ends exchanged": lambda a: certificate(
        a, cut_nodes=lambda nodes: nodes[0].__setitem__(slice(None), nodes[0, ::-1])
    ),
    "a cut left out": without_a_cut,
    "an error stated": lambda a: stated(a, error=1e-3),
    "an error of a cut stated": lambda a: certificate(a, cut_errors=lambda errors: errors[:1].__iadd__(1e-3)),
    "other cells stated": lambda a: stated(a, cell=0.5),
    "another rotation order stated": lambda a: stated(a, rotation_order=12),
    "a flat cone stated": lambda a: stated(a, flat_cones=MESH.cones[:1]),
    "a cone said to be off the lattice": lambda a: stated(a, relaxed_cones=MESH.cones[:1]),
    "no certificate": lambda a: replace(SEAMLESS[a], seamless=None),
}


@pytest.mark.parametrize("lattice", TILED)
@pytest.mark.parametrize("name", UNSOUND)
def test_unsound_seamless_layouts_are_noticed(name: str, lattice: str) -> None:
    assert undeclared_faults(SURFACE, UNSOUND[name](lattice), TILED[lattice]) != []


def test_a_layout_of_other_parity_is_noticed() -> None:
    """Cones on corners of cells instead of centers, and translations that lead from black to white."""
    plain = lsgp.Options(seamless=lsgp.Seamless(tiles=20))
    result = unwrap(MESH, seamless=plain.seamless)
    assert undeclared_faults(SURFACE, result, plain) == []
    assert undeclared_faults(SURFACE, result, TILED["square"]) != []
    shifted = replace(result, corner_uv=result.corner_uv + 0.5)
    assert not [fault for fault in undeclared_faults(SURFACE, shifted, TILED["square"]) if "off the lattice" in fault]
    black = 0  # some of the grids lead about a handle from black to white
    for tiles in range(17, 24):
        plain, even = (lsgp.Options(seamless=lsgp.Seamless(tiles=tiles, parity=parity)) for parity in (False, True))
        found = [undeclared_faults(surface(TORUS), unwrap(TORUS, seamless=plain.seamless), o) for o in (plain, even)]
        assert found[0] == []
        black += any("black" in fault for fault in found[1])
    assert black > 0


def test_a_layout_that_float32_does_not_hold_is_noticed() -> None:
    inside = np.setdiff1d(MESH.triangles, np.union1d(SOUND.cut_edges, SEAMLESS["square"].cut_edges))[0]
    uv = SEAMLESS["square"].corner_uv + np.where((MESH.triangles == inside)[..., None], 1e-12, 0)
    spoiled_result = replace(SEAMLESS["square"], corner_uv=uv)
    assert undeclared_faults(SURFACE, spoiled_result, TILED["square"]) == ["coordinates that float32 does not hold"]
