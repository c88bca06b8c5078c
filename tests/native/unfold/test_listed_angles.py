# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices at which angles are not those imposed: what a result lists is what its coordinates say.

`wrong_angle_sums` has those that are off by more than a degree, INEXACT_ANGLES those that are off by less, but by more
than a millionth of a radian.  Angles are counted with their signs, those of flipped triangles below 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface
from meshes import Mesh, make
from numpy.typing import NDArray
from opened_surface import edge_keys, named_by, next_corner, open_surface
from sanitized_run import many_solves
from shared_meshes import hard_mesh

TURN = 2 * np.pi
EXACT, WRONG = 1e-6, np.pi / 180  # radians
MARGIN = 1e-8  # radians that two ways to add angles up may differ by


@dataclass
class Angles:
    """By vertex: whether the angle there is imposed and can be told from the coordinates, and by how much it is off."""

    judged: NDArray[np.bool_]
    off: NDArray[np.float64]

    def beyond(self, bound: float) -> NDArray[np.bool_]:
        assert not (np.abs(self.off[self.judged] - bound) < MARGIN).any(), "a deviation on the bound itself"
        return self.judged & ~(self.off <= bound)


def angles_of(of: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> Angles:
    opened = open_surface(of, result, options)
    z = opened.z.reshape(-1, 3)
    fans = len(opened.closed)
    here = np.angle((z[:, [2, 0, 1]] - z) * (z[:, [1, 2, 0]] - z).conj())
    sums = np.bincount(opened.fan, here.ravel(), fans)
    vertex = np.zeros(fans, np.int64)
    vertex[opened.fan] = opened.vertex
    count = len(of.positions)
    wanted = np.full(count, TURN)
    wanted[result.cones] = result.cone_angles
    # The angles of a triangle without area may be 0 or half a turn; a vertex of several sheets has one entry for all.
    a, b = z[:, 1] - z[:, 0], z[:, 2] - z[:, 0]
    flat = ~(np.abs(np.imag(a.conj() * b)) > 1e-12 * np.abs(a) * np.abs(b))
    unclear = np.unique(opened.vertex.reshape(-1, 3)[flat])
    fans_of_vertex = np.bincount(vertex, minlength=count)
    judged, off = np.zeros(count, bool), np.zeros(count)
    judged[vertex] = (opened.closed | np.isin(vertex, result.cones)) & (fans_of_vertex[vertex] == 1)
    judged[unclear] = False
    off[vertex] = np.abs(sums - wanted[vertex])
    return Angles(judged, off)


def assert_listed_as_counted(of: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> tuple[int, int]:
    """Returns how many are wrong, and how many inexact."""
    angles = angles_of(of, result, options)
    wrong = np.flatnonzero(angles.beyond(WRONG))
    inexact = np.flatnonzero(angles.beyond(EXACT) & ~angles.beyond(WRONG))
    judged = np.flatnonzero(angles.judged)
    assert np.intersect1d(result.wrong_angle_sums, judged).tolist() == wrong.tolist()
    assert np.intersect1d(named_by(result, "INEXACT_ANGLES"), judged).tolist() == inexact.tolist()
    assert len(np.unique(result.wrong_angle_sums)) == len(result.wrong_angle_sums)
    assert named_by(result, "WRONG_ANGLE_SUMS").tolist() == result.wrong_angle_sums.tolist()
    curved = angles.judged[result.cones] & ~np.isclose(result.cone_angles % np.pi, 0)  # some are on borders
    largest = angles.off[result.cones][curved].max(initial=0)
    assert result.cone_angle_error >= largest - MARGIN
    return len(wrong), len(inexact)


# --- random meshes, cones, angles and options -------------------------------------------------------------------------

BASES = [
    meshes.icosphere(1),
    meshes.bumpy_sphere(2),
    meshes.flower(2),
    meshes.cube(3),
    meshes.torus(12, 6, 2, 1.5),
    meshes.double_torus(),
    meshes.hill(6),
    meshes.cylinder(8, 4),
    meshes.disk_with_holes(8, 2),
]
SEEDS = 160


def random_case(seed: int) -> tuple[lsgp.Surface, NDArray[np.int32], list[float | None] | None, lsgp.Options]:
    rng = np.random.default_rng(seed)
    mesh = BASES[seed % len(BASES)]
    parts = [meshes.transform(mesh, seed, 1.0)]
    if rng.random() < 0.3:
        parts.append(meshes.transform(BASES[rng.integers(len(BASES))], seed + 1, 10.0 ** rng.choice([0, -3, -7])))
    mesh = meshes.merge(parts)
    size = np.ptp(parts[0].positions, axis=0).max()
    positions = mesh.positions + rng.normal(size=mesh.positions.shape) * size * rng.choice([0, 0.01, 0.05, 0.2])
    if rng.random() < 0.2:
        positions = positions * [1, 1, rng.choice([1e-3, 1e3])]
    mesh = mesh._replace(positions=positions)
    cones = rng.choice(len(positions), min(len(positions), int(rng.integers(2, 12))), replace=False).astype(np.int32)
    angles = None
    if rng.random() < 0.5:
        curvature = rng.uniform(-1.5 * np.pi, 1.5 * np.pi, len(cones))
        defect = TURN * meshes.euler_characteristic(mesh.triangles)
        curvature += (defect - curvature.sum()) / len(cones)
        angles = (TURN - curvature).tolist()
    edges = meshes.edges_of(mesh.triangles)
    seams = edges[rng.random(len(edges)) < 0.1] if rng.random() < 0.3 else None
    options = lsgp.Options(
        repair=bool(rng.random() < 0.6),
        unfold=str(rng.choice(["poisson", "poisson", "spectral"])),
        mode=str(rng.choice(["conformal", "conformal", "low-stretch"])),
        overlaps=str(rng.choice(["keep", "keep", "split"])),
        seamless=lsgp.Seamless(tiles=64.0) if rng.random() < 0.2 else None,
    )
    return surface(mesh, seams=seams), cones, angles, options


def results() -> Iterator[tuple[lsgp.Surface, lsgp.Result, lsgp.Options]]:
    for seed in range(SEEDS):
        of, cones, angles, options = random_case(seed)
        try:
            yield of, lsgp.parameterize(of, cones, angles, options), options
        except lsgp.LsgpError:
            continue


def test_lists_are_what_is_counted_on_random_meshes() -> None:
    counted = [assert_listed_as_counted(*case) for case in results()]
    assert len(counted) >= SEEDS // 2, "most of these have a map"
    assert sum(wrong > 0 for wrong, _ in counted) >= 5 and sum(inexact > 0 for _, inexact in counted) >= 1


@pytest.mark.slow
@pytest.mark.parametrize("cones", [8, None])
@pytest.mark.parametrize("name", ["mpi", "pipe", *many_solves("femur", "joint")])
def test_lists_are_what_is_counted_on_hard_meshes(name: str, cones: int | None) -> None:
    mesh = hard_mesh(name)
    options = lsgp.Options()
    of = surface(mesh)
    placed = lsgp.place_cones(of, count=cones)
    result = lsgp.parameterize(of, placed.cones, placed.cone_angles, options)
    assert_listed_as_counted(of, result, options)
    assert result.seams.sister_ratio_max - 1 <= 1e-9, "whatever was repaired, the two sides of cuts stay alike"


# --- seams ------------------------------------------------------------------------------------------------------------


def sister_ratio(of: lsgp.Surface, result: lsgp.Result) -> float:
    """The largest of the longer to the shorter side of an edge at which the layout is open."""
    opened = open_surface(of, result, lsgp.Options())
    h = np.flatnonzero(opened.twin >= 0)
    h = h[np.isin(edge_keys(opened.vertex[h], opened.vertex[next_corner(h)]), edge_keys(*result.cut_edges.T))]
    ours, theirs = (np.abs(opened.z[next_corner(side)] - opened.z[side]) for side in (h, opened.twin[h]))
    return float((np.maximum(ours, theirs) / np.minimum(ours, theirs)).max(initial=1))


def strip_with_seam(scale: float) -> tuple[Mesh, NDArray[np.integer]]:
    """A small grid with a cone that a line of seams parts into two islands, beside a ball."""
    grid, ball = meshes.hill(6, 0.5), meshes.bumpy_sphere(2)
    middle = np.flatnonzero(np.abs(grid.positions[:, 0] - np.median(grid.positions[:, 0])) < 1e-9)
    edges = meshes.edges_of(grid.triangles)
    line = edges[np.isin(edges, middle).all(axis=1)]
    positions = np.concatenate([grid.positions * scale, ball.positions + np.array([5.0, 0, 0])])
    shift = len(grid.positions)
    return make(
        positions, np.concatenate([grid.triangles, ball.triangles + shift]), [*grid.cones, *ball.cones + shift]
    ), line


@pytest.mark.parametrize("scale", [1.0, 1e-4, 1e-8, 1e-10, 1e-12])
def test_seams_are_measured_where_islands_come_to_lie(scale: float) -> None:
    """Islands much smaller than the layout lose digits to their place in it, and the report says how many."""
    mesh, line = strip_with_seam(scale)
    of = surface(mesh, seams=line)
    result = lsgp.parameterize(of, mesh.cones)
    assert len(np.unique(result.island)) == 3
    found = sister_ratio(of, result)
    assert result.seams.sister_ratio_max - 1 == pytest.approx(found - 1, rel=1e-3, abs=1e-11)
    if scale <= 1e-10:
        assert found - 1 > 1e-8, "so small that it cannot be exact"
        assert len(named_by(result, "INEXACT_SEAMS"))
    if scale == 1:
        assert found - 1 < 1e-12 and not len(named_by(result, "INEXACT_SEAMS"))
