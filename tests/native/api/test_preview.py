# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews: the map of a reduced surface, carried over to the whole one."""

from __future__ import annotations

import math

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.triangles import singular_values
from map_checks import codes, digest, pairs, wanted_angle_sums
from numpy.typing import NDArray

RAW = lsgp.Options(repair=False)
ORGANIC = {
    "bumps": lambda: meshes.bumpy_sphere(5),
    "petals": lambda: meshes.flower(5),
    "horns": lambda: meshes.two_horned(5)._replace(cones=np.array([12, 700, 3000, 5000, 7000, 9999], np.int32)),
    "ellipsoid": lambda: meshes.ellipsoid(5),
}
REDUCED = 3000


def surface_of(mesh: meshes.Mesh, **parts: object) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles, **parts)


def moved(mesh: meshes.Mesh) -> NDArray[np.int32]:
    """The cones, with one on a vertex that the reduced surface does not have by itself."""
    return np.r_[mesh.cones[:-1], len(mesh.positions) - 17].astype(np.int32)


def distances(exact: NDArray[np.float64], shown: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of corners after the similarity that brings most of them together, relative to the size of the layout."""
    to, of = (uv.reshape(-1, 2) @ [1, 1j] for uv in (exact, shown))
    weight = np.ones(len(to))
    for _ in range(30):
        middle_to, middle_of = np.average(to, weights=weight), np.average(of, weights=weight)
        scale = (weight * (to - middle_to) * (of - middle_of).conj()).sum() / (weight * abs(of - middle_of) ** 2).sum()
        apart = abs(to - middle_to - scale * (of - middle_of))
        weight = 1 / np.maximum(apart, 1e-3)
    return apart / np.ptp(exact.reshape(-1, 2), axis=0).max()


def angle_sums(mesh: meshes.Mesh, uv: NDArray[np.float64]) -> NDArray[np.float64]:
    z = uv @ [1, 1j]
    angle = np.angle((np.roll(z, 1, axis=1) - z) / (np.roll(z, -1, axis=1) - z))
    return np.bincount(mesh.triangles.ravel(), angle.ravel(), len(mesh.positions))


@pytest.mark.parametrize("make", [meshes.cube, meshes.bumpy_sphere, meshes.saddle, meshes.torus])
def test_a_surface_that_is_small_enough_has_its_exact_map(make: object) -> None:
    mesh = make()
    surface = surface_of(mesh)
    shown = lsgp.Preview(surface, triangles=len(mesh.triangles)).parameterize(mesh.cones, None, RAW)
    assert digest(shown) == digest(lsgp.parameterize(surface, mesh.cones, None, RAW))


def test_a_plane_is_shown_without_any_distortion() -> None:
    mesh = meshes.grid(60, 50)
    uv = lsgp.Preview(surface_of(mesh), triangles=1000).parameterize([], None, RAW).corner_uv
    largest, smallest = singular_values(surface_of(mesh), uv)
    assert largest.max() / smallest.min() - 1 < 1e-9


@pytest.mark.parametrize("make", ORGANIC.values(), ids=ORGANIC)
def test_a_preview_looks_like_the_map(make: object) -> None:
    mesh = make()
    surface, cones = surface_of(mesh), moved(mesh)
    exact = lsgp.parameterize(surface, cones, None, RAW)
    shown = lsgp.Preview(surface, triangles=REDUCED).parameterize(cones, None, RAW)
    assert np.array_equal(np.sort(shown.cones), np.sort(exact.cones))
    angle = dict(zip(shown.cones.tolist(), shown.cone_angles, strict=True))
    assert max(abs(angle[v] - a) for v, a in zip(exact.cones.tolist(), exact.cone_angles, strict=True)) < 0.15
    # Between the two routes of a cut the layout is on the other side of it; on a symmetric surface most may be.
    if make is not ORGANIC["ellipsoid"]:
        assert np.median(distances(exact.corner_uv, shown.corner_uv)) < 0.01
    assert abs(shown.distortion.l2_stretch - exact.distortion.l2_stretch) < 0.03 * exact.distortion.l2_stretch
    assert abs(shown.log_scale - exact.log_scale).mean() < 0.03
    assert shown.solved.all()
    # No triangle is torn from one side of a cut to the other.
    (largest, smallest), (most, _) = (singular_values(surface, each.corner_uv) for each in (shown, exact))
    assert largest.max() < 2.5 * most.max()
    assert np.quantile(largest / smallest, 0.9) < 1.25


@pytest.mark.parametrize("make", ORGANIC.values(), ids=ORGANIC)
def test_the_angles_around_cones_and_all_other_vertices_close(make: object) -> None:
    mesh = make()
    cones = moved(mesh)
    result = lsgp.Preview(surface_of(mesh), triangles=REDUCED).parameterize(cones, None, RAW)
    sums = angle_sums(mesh, result.corner_uv)
    wrong = np.flatnonzero(abs(sums - wanted_angle_sums(mesh, result.cones, result.cone_angles)) > 1e-6)
    # A triangle may fold where it is much larger than those of the reduced surface.
    assert not np.isin(wrong, cones).any()
    assert len(wrong) < 0.001 * len(sums)


def test_cuts_are_closed_paths_between_cones_along_edges_that_may_be_cut() -> None:
    mesh = meshes.bumpy_sphere(5)
    # Most triangles are halves of quads.
    sides: dict[tuple[int, int], list[int]] = {}
    for f, triangle in enumerate(np.sort(mesh.triangles, axis=1).tolist()):
        for edge in ((triangle[1], triangle[2]), (triangle[0], triangle[2]), (triangle[0], triangle[1])):
            sides.setdefault(edge, []).append(f)
    free, cuttable = np.ones(len(mesh.triangles), bool), []
    for edge, halves in sides.items():
        if free[halves].all():
            free[halves] = False
        else:
            cuttable.append(edge)
    surface = surface_of(mesh, edges=cuttable)
    cones = moved(mesh)
    result = lsgp.Preview(surface, triangles=REDUCED).parameterize(cones, None, RAW)
    assert pairs(result.cut_edges) <= pairs(cuttable)
    assert free.mean() < 0.2
    ends = np.bincount(np.ravel(result.cut_edges), minlength=len(mesh.positions))
    assert set(np.flatnonzero(ends == 1)) <= set(cones.tolist())
    assert pairs(np.concatenate([np.c_[path[:-1], path[1:]] for path in result.cut_paths])) == pairs(result.cut_edges)
    # It is continuous elsewhere.
    z, place = result.corner_uv @ [1, 1j], {}
    for f, triangle in enumerate(mesh.triangles.tolist()):
        for c in range(3):
            edge = tuple(sorted((triangle[c], triangle[(c + 1) % 3])))
            place.setdefault(edge, []).append({triangle[c]: z[f, c], triangle[(c + 1) % 3]: z[f, (c + 1) % 3]})
    cut = pairs(np.sort(result.cut_edges, axis=1))
    for edge, (one, other) in place.items():
        if edge not in cut:
            assert max(abs(one[v] - other[v]) for v in edge) < 1e-6


def test_seams_stay_where_they_are() -> None:
    mesh = meshes.bumpy_sphere(5)
    # The triangles on one side of a plane, and the edges around them.
    upper = mesh.positions[mesh.triangles].mean(axis=1)[:, 2] > 0.2
    around = pairs(np.sort(meshes.edges_of(mesh.triangles[upper]), axis=1))
    seams = np.array(sorted(around & pairs(np.sort(meshes.edges_of(mesh.triangles[~upper]), axis=1))), np.int32)
    options = lsgp.Options(repair=False, seams="boundary")
    surface = surface_of(mesh, seams=seams)
    shown = lsgp.Preview(surface, triangles=REDUCED).parameterize([], None, options)
    assert len(np.unique(shown.island[upper])) == len(np.unique(shown.island[~upper])) == 1
    assert shown.island[upper][0] != shown.island[~upper][0]
    exact = lsgp.parameterize(surface, [], None, options)
    for part in (upper, ~upper):
        assert distances(exact.corner_uv[part], shown.corner_uv[part]).max() < 0.02


def test_the_number_of_threads_does_not_matter() -> None:
    mesh = meshes.bumpy_sphere(6)
    preview = lsgp.Preview(surface_of(mesh), triangles=REDUCED)
    one, many = (
        preview.parameterize(moved(mesh), None, lsgp.Options(repair=False, threads=threads)) for threads in (1, 4)
    )
    assert digest(one) == digest(many)


@pytest.mark.parametrize(
    "make",
    [
        lambda: meshes.with_fin(meshes.bumpy_sphere(4))[0],
        lambda: meshes.with_flipped(meshes.bumpy_sphere(4), [0, 5, 900]),
        lambda: meshes.with_isolated_vertices(meshes.bumpy_sphere(4), 3),
        lambda: meshes.merge([meshes.bumpy_sphere(4), meshes.torus(60, 30), meshes.grid(30, 30)]),
    ],
    ids=["fin", "flipped", "isolated", "parts"],
)
def test_defects_of_a_mesh_are_told_as_of_its_map(make: object) -> None:
    mesh = make()
    surface = surface_of(mesh)
    exact = lsgp.parameterize(surface, mesh.cones, None, RAW)
    shown = lsgp.Preview(surface, triangles=800).parameterize(mesh.cones, None, RAW)
    assert np.array_equal(shown.solved, exact.solved)
    of_shape = {"ISOLATED_VERTICES", "NON_MANIFOLD_EDGE", "REORIENTED", "SPLIT_VERTEX", "COMPONENT_SKIPPED"}
    assert of_shape & set(codes(shown.warnings)) == of_shape & set(codes(exact.warnings)) - {"ISOLATED_VERTICES"}


def test_errors_name_the_vertices_of_the_whole_surface() -> None:
    mesh = meshes.bumpy_sphere(4)
    preview = lsgp.Preview(surface_of(mesh), triangles=800)
    cones = moved(mesh)
    with pytest.raises(lsgp.CurvatureError) as caught:
        preview.parameterize(cones, [None] * (len(cones) - 1) + [40 * math.pi], RAW)
    assert caught.value.elements.kind == "vertices" and cones[-1] in caught.value.elements.indices
    for wrong, code in (([-1], "CONE_INDEX"), ([5, 5], "CONE_DUPLICATE"), ([len(mesh.positions)], "CONE_INDEX")):
        with pytest.raises(lsgp.InputError) as refused:
            preview.parameterize(wrong, None, RAW)
        assert refused.value.code == code


def test_what_cannot_be_approximate_is_refused() -> None:
    mesh = meshes.cube()
    preview = lsgp.Preview(surface_of(mesh))
    with pytest.raises(lsgp.InputError, match="must be exact") as refused:
        preview.parameterize(mesh.cones, None, lsgp.Options(seamless=lsgp.Seamless()))
    assert refused.value.code == "WRONG_PARAMETER"
    with pytest.raises(lsgp.InputError, match="from 1"):
        lsgp.Preview(surface_of(mesh), triangles=0)


def test_making_one_can_be_stopped() -> None:
    mesh = meshes.icosphere(7)
    with pytest.raises(lsgp.Cancelled):
        lsgp.Preview(surface_of(mesh), triangles=1000, progress=lambda _: False)
