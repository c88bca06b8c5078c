# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a result fulfills its guarantees, judged from its coordinates alone, on any surface however messy.

`map_checks` states what a map of a clean surface has to be; this module asks less and of more: whatever is wrong with
a map must be said by a warning that names the elements.  Nothing here is shared with the library or the oracle.
"""

from __future__ import annotations

from collections.abc import Mapping

import lsgp
import numpy as np
from numpy.typing import NDArray
from opened_surface import Opened, edge_keys, labels, named_by, next_corner, open_surface
from overlap_check import overlaps
from seamless_check import seamless_faults

TURN = 2 * np.pi
ANGLE = 1e-6  # radians
SISTER_RATIO = 1e-9
RESIDUAL = 1e-12  # relative to the layout
GAUSS_BONNET = 1e-9  # radians
OVERLAP = 1e-6  # of the smaller triangle, beside what rounding of the layout's digits makes of it
DEFAULTS = lsgp.Options()


def undeclared_faults(
    surface: lsgp.Surface,
    result: lsgp.Result,
    options: lsgp.Options = DEFAULTS,
    given: Mapping[int, float | None] | None = None,
    *,
    pressed: bool = False,
) -> list[str]:
    """Everything that is wrong with a result and that no warning of it names; empty for an honest one.

    options: what the map was made with: seams may be open borders, and the method "lscm" knows no transitions.
    given: the angles that were asked for, by cone, None for automatic ones; not judged where they are not told.
    pressed: a preset chose the map, of positions that it rounds first.
    """
    faults = _wrong_figures(result) + ([] if given is None else _changed_angles(result, options, given))
    skipped = np.flatnonzero(~result.solved)
    if not np.array_equal(np.unique(named_by(result, "COMPONENT_SKIPPED")), skipped):
        faults.append(f"{len(skipped)} triangles without a map are not those of COMPONENT_SKIPPED")
    if not np.isnan(result.corner_uv[skipped]).all():
        faults.append("coordinates of a triangle without a map")
    bad = int((~np.isfinite(result.corner_uv[result.solved])).any(axis=(1, 2)).sum())
    if bad:
        return [*faults, f"{bad} triangles of a map have coordinates that are not finite"]

    opened = open_surface(surface, result, options)
    z = opened.z.reshape(-1, 3)
    area = np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0]))
    flipped = opened.triangle[~(area > 0)]
    # Moved into a square, what is named as too small for its shape may collapse to a point, with what digits are left.
    collapsed = opened.triangle[np.abs(area) <= (1e-15 * np.abs(z).max(axis=1)) * np.abs(z - z[:, :1]).max(axis=1) * 8]
    kept = flipped[~(np.isin(flipped, named_by(result, "ISLANDS_TINY")) & np.isin(flipped, collapsed))]
    if not np.isin(kept, named_by(result, "FLIPPED_TRIANGLES")).all() or not np.isin(kept, result.flipped).all():
        faults.append(f"{len(kept)} flipped triangles {kept[:5].tolist()}, {len(result.flipped)} listed")
    faults += _hidden_overlaps(result, opened)
    unlisted = ~np.isin(edge_keys(*_open_edges(opened)), edge_keys(*result.cut_edges.T))
    if unlisted.any():
        faults.append(f"{int(unlisted.sum())} sides of edges are apart that cut_edges does not list")
    if options.seams == "follow":
        inner = np.flatnonzero(opened.twin >= 0)
        seams = np.intersect1d(
            edge_keys(*surface.seams.T), edge_keys(opened.vertex[inner], opened.vertex[next_corner(inner)])
        )
        uncut = int((~np.isin(seams, edge_keys(*result.cut_edges.T))).sum())
        if uncut:
            faults.append(f"{uncut} of {len(seams)} marked seams are not cut")
    if options.method == "lsgp":
        faults += _wrong_angles(result, opened, flipped) + _open_seams(surface, result, opened)
    if surface.directions is not None:
        slack = np.zeros(len(surface.triangles))
        if pressed:  # where a map is stretched along one direction, others turn toward it
            slack = lost_by_pressing(surface) * anisotropy(surface, result.corner_uv)
        faults += _wrong_directions(surface, result, slack)
    if options.seamless is not None:
        faults += seamless_faults(opened, result, options.seamless)
    return faults


def lost_by_pressing(surface: lsgp.Surface) -> NDArray[np.float64]:
    """(m,) what each triangle may be turned or stretched by, relatively, as presets round positions to 2^-32 of the
    farthest corner's distance from the middle: a corner moves by half of that along each axis, and that divided by
    its height is what the triangle is strained by."""
    place = surface.positions[surface.triangles]
    with np.errstate(all="ignore"):
        sides = np.linalg.norm(place - np.roll(place, 1, axis=1), axis=2)
        doubled = np.linalg.norm(np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]), axis=1)
        corner = place.reshape(-1, 3)
        radius = np.linalg.norm(corner - corner.mean(axis=0), axis=1).max(initial=0)
        # Of lines and points that are left out of the middle: it is then elsewhere.
        radius = 2 * radius if (surface.triangles == np.roll(surface.triangles, 1, axis=1)).any() else radius
        moved = np.sqrt(3) / 2 * 2.0**-32 * radius
        return np.nan_to_num(moved * (sides / doubled[:, None]).sum(axis=1), nan=np.inf)


def anisotropy(surface: lsgp.Surface, corner_uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) by how much more each triangle is stretched along one direction than across it."""
    place, z = surface.positions[surface.triangles], corner_uv @ [1, 1j]
    first, last = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
    with np.errstate(all="ignore"):
        length = np.linalg.norm(first, axis=1)
        along = (first * last).sum(axis=1) / length
        height = np.linalg.norm(np.cross(first, last), axis=1) / length
        right = (z[:, 1] - z[:, 0]) / length
        up = (z[:, 2] - z[:, 0] - along * right) / height
        turned, mirrored = np.abs(right - 1j * up), np.abs(right + 1j * up)
        return np.nan_to_num((turned + mirrored) / np.abs(turned - mirrored), nan=np.inf)


def _wrong_figures(result: lsgp.Result) -> list[str]:
    faults = []
    if not np.array_equal(result.solved, result.island >= 0):
        faults.append("`solved` and `island` disagree")
    for listed, code in (
        (result.flipped, "FLIPPED_TRIANGLES"),
        (result.wrong_angle_sums, "WRONG_ANGLE_SUMS"),
        (result.overlapping, "OVERLAPPING_TRIANGLES"),
    ):
        if not np.array_equal(np.sort(listed), np.sort(named_by(result, code))):
            faults.append(f"{code} does not name what the result lists")
    if (result.overlap_area > 0) != (len(result.overlapping) > 0):
        faults.append(f"{len(result.overlapping)} triangles overlap by an area of {result.overlap_area}")
    if len(result.cones) != len(result.cone_angles) or not (result.cone_angles > 0).all():
        faults.append("a cone without an angle above 0")
    figures = {name: getattr(result.seams, name) for name in ("sister_ratio_max", "rotation_residual")}
    figures |= {"translation_residual": result.seams.translation_residual, "cone_angle_error": result.cone_angle_error}
    if not len(result.flipped):  # a flipped triangle may have no area, and then no finite distortion either
        figures |= {name: getattr(result.distortion, name) for name in result.distortion.__slots__}
    faults += [f"{name} is {value}" for name, value in figures.items() if not np.isfinite(value)]
    if not np.isfinite(result.log_scale).all():
        faults.append("log_scale is not finite")
    return faults


def _changed_angles(result: lsgp.Result, options: lsgp.Options, given: Mapping[int, float | None]) -> list[str]:
    """Angles that were asked for are imposed, but on a lattice, or ANGLES_ADJUSTED names their cones."""
    adjusted = named_by(result, "ANGLES_ADJUSTED")
    if options.seamless is not None or options.prescription not in (None, "manual"):
        return ["ANGLES_ADJUSTED where no angles were to be kept"] if len(adjusted) else []
    asked = np.array([np.nan if given.get(cone) is None else given[cone] for cone in result.cones.tolist()])
    other = result.cones[np.abs(result.cone_angles - asked) > ANGLE]
    faults = []
    if not np.isin(other, adjusted).all():
        faults.append(f"the angles of {other[:5].tolist()} are not those asked for")
    if len(adjusted) and not len(other):
        faults.append("ANGLES_ADJUSTED where all angles are those asked for")
    return faults


def _wrong_directions(surface: lsgp.Surface, result: lsgp.Result, slack: NDArray[np.float64]) -> list[str]:
    """The errors of directions are those of their images, which are combinations of the images of two edges.
    slack: (m,) radians."""
    place, z = surface.positions[surface.triangles], result.corner_uv @ [1, 1j]
    first, last = place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]
    normal = np.cross(first, last)
    with np.errstate(all="ignore"):
        area = np.linalg.norm(normal, axis=1)
        unit = normal / area[:, None]
        length = np.abs(surface.directions).max(axis=1)
        inside = surface.directions / length[:, None]
        out = (inside * unit).sum(axis=1)
        inside -= out[:, None] * unit
        # Where a direction leaves the surface, what is left of it turns with the triangle by as much more.
        slack = slack * (1 + np.abs(out) / np.linalg.norm(inside, axis=1))
        along = [(np.cross(inside, last) * unit).sum(axis=1), (np.cross(first, inside) * unit).sum(axis=1)]
        image = along[0] * (z[:, 1] - z[:, 0]) + along[1] * (z[:, 2] - z[:, 0])
        # Needles and directions across the surface leave few digits.
        sides = (first**2).sum(axis=1) + (last**2).sum(axis=1)
        sure = (area > 1e-4 * sides) & (np.linalg.norm(inside, axis=1) > 1e-4) & (np.abs(image) > 0)
        # So do images that are tiny beside where they lie.
        shortest = np.minimum(np.abs(z[:, 1] - z[:, 0]), np.abs(z[:, 2] - z[:, 0]))
        sure &= shortest > 1e-8 * np.abs(z).max(axis=1)
    wrong = sure & ~np.isin(np.arange(len(z)), named_by(result, "DUPLICATE_FACE"))
    turn = TURN / (1 if result.seamless is None else result.seamless.rotation_order)
    angle = np.angle(image[wrong] / 1j)
    off = np.abs(np.abs(angle - turn * np.round(angle / turn)) - result.direction_errors[wrong])
    wrong[wrong] = ~(off <= ANGLE + slack[wrong])
    return [f"the directions of {np.flatnonzero(wrong)[:5].tolist()} are off by other angles"] if wrong.any() else []


def _hidden_overlaps(result: lsgp.Result, opened: Opened) -> list[str]:
    z = opened.z.reshape(-1, 3)
    pairs, shared = overlaps(z)
    sides = np.abs(z - np.roll(z, 1, axis=1))
    area = np.abs(np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0]))) / 2
    smaller = np.take_along_axis(pairs, area[pairs].argmin(axis=1)[:, None], axis=1).ravel()
    sure = shared > OVERLAP * area[smaller] + RESIDUAL * np.abs(z).max(initial=0) * sides.sum(axis=1)[smaller]
    faults = []
    on_others = np.unique(opened.triangle[pairs[sure]])
    unlisted = on_others[~np.isin(on_others, result.overlapping)]
    if len(unlisted):
        faults.append(f"{len(unlisted)} triangles {unlisted[:5].tolist()} overlap others that the result does not list")
    if not np.isin(result.overlapping, opened.triangle[pairs]).all():
        faults.append("triangles listed as overlapping that lie on no other")
    # What rounding may have made of nothing counts or does not.
    least, most = (shared[sure].sum() / area.sum(), shared.sum() / area.sum()) if len(area) else (0, 0)
    gap = max(least - result.overlap_area, result.overlap_area - most)
    if gap > OVERLAP:
        faults.append(f"the area of overlaps is off by {gap:.1e} of the layout")
    return faults


def _open_edges(opened: Opened) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Both vertices of all halfedges at which the two sides have different coordinates."""
    h = np.flatnonzero(opened.twin >= 0)
    other = opened.twin[h]
    apart = (opened.z[h] != opened.z[next_corner(other)]) | (opened.z[next_corner(h)] != opened.z[other])
    return opened.vertex[h[apart]], opened.vertex[next_corner(h[apart])]


def _wrong_angles(result: lsgp.Result, opened: Opened, flipped: NDArray[np.int64]) -> list[str]:
    faults = []
    z, fan_count = opened.z.reshape(-1, 3), len(opened.closed)
    here = np.angle((z[:, [2, 0, 1]] - z) * (z[:, [1, 2, 0]] - z).conj())
    sums = np.bincount(opened.fan, here.ravel(), fan_count)
    vertex = np.zeros(fan_count, np.int64)
    vertex[opened.fan] = opened.vertex
    wanted = np.full(int(opened.vertex.max()) + 1, TURN)
    on_surface = result.cones < len(wanted)
    wanted[result.cones[on_surface]] = result.cone_angles[on_surface]
    # A vertex at which several sheets meet has one entry in the result and an angle on each sheet.
    fans_of_vertex = np.bincount(vertex, minlength=len(wanted))
    # Borders are free but at cones.
    judged = (opened.closed | np.isin(vertex, result.cones)) & (fans_of_vertex[vertex] == 1)
    beside_flips = opened.vertex.reshape(-1, 3)[np.isin(opened.triangle, flipped)].ravel()
    excused = np.concatenate([result.wrong_angle_sums, named_by(result, "INEXACT_ANGLES"), beside_flips])
    off = np.abs(sums - wanted[vertex])
    wrong = judged & ~(off <= ANGLE) & ~np.isin(vertex, excused)
    if wrong.any():
        faults.append(f"angles at {vertex[wrong][:5].tolist()} off by {off[wrong].max():.1e} rad")

    # Gauss-Bonnet of what was imposed, on every closed component.
    part_of_fan = np.zeros(fan_count, np.int64)
    part_of_fan[opened.fan] = np.repeat(opened.component, 3)
    parts = int(opened.component.max()) + 1
    is_closed = np.bincount(part_of_fan, ~opened.closed, parts) == 0
    edges = np.bincount(opened.component[np.flatnonzero(opened.twin >= 0) // 3], minlength=parts) / 2
    euler = np.bincount(part_of_fan, minlength=parts) - edges + np.bincount(opened.component, minlength=parts)
    total = np.bincount(part_of_fan, TURN - wanted[vertex], parts)
    single = np.bincount(part_of_fan, fans_of_vertex[vertex] > 1, parts) == 0
    gap = np.abs(total - TURN * euler)[is_closed & single]
    if gap.max(initial=0) > GAUSS_BONNET:
        faults.append(f"the imposed angles miss Gauss-Bonnet by {gap.max():.1e} rad")
    return faults


def _open_seams(surface: lsgp.Surface, result: lsgp.Result, opened: Opened) -> list[str]:
    """Each path of the cut between nodes (cones, branchings, the border) is one rotation and one translation."""
    z, twin = opened.z, opened.twin
    h = np.flatnonzero(twin >= 0)
    left = np.stack([z[h], z[next_corner(h)]], axis=1)
    right = np.stack([z[next_corner(twin[h])], z[twin[h]]], axis=1)
    cut = (left != right).any(axis=1)
    h, left, right = h[cut], left[cut], right[cut]
    if not len(h):
        return []
    faults = []
    lengths = np.abs(left[:, 1] - left[:, 0]), np.abs(right[:, 1] - right[:, 0])
    named = named_by(result, "INEXACT_SEAMS").reshape(-1, 2)
    excused = np.isin(edge_keys(opened.vertex[h], opened.vertex[next_corner(h)]), edge_keys(*named.T))
    positions = surface.positions
    on_surface = np.linalg.norm(positions[opened.vertex[h]] - positions[opened.vertex[next_corner(h)]], axis=1)
    is_point = on_surface <= np.finfo(np.float32).eps * np.linalg.norm(np.ptp(positions, axis=0))
    ratio = np.divide(*lengths, where=lengths[1] > 0, out=np.ones(len(h)))[~(excused | is_point)].max(initial=1)
    if ratio - 1 > SISTER_RATIO:
        faults.append(f"sister edges differ in length by {ratio - 1:.1e}")

    path = labels(*opened.straight_on(h, result.cones), len(h))

    def mean(values: NDArray[np.complex128], weights: NDArray[np.float64] | None = None) -> NDArray[np.complex128]:
        total = np.bincount(path, values.real) + 1j * np.bincount(path, values.imag)
        return total / (np.bincount(path) if weights is None else weights)

    turn = mean((left[:, 1] - left[:, 0]).conj() * (right[:, 1] - right[:, 0]), np.ones(1))
    turn = (turn / np.where(turn == 0, 1, np.abs(turn)))[path]
    shift = (right - turn[:, None] * left).mean(axis=1)
    residual = np.abs(right - turn[:, None] * left - mean(shift)[path][:, None]).max(axis=1)
    residual = residual[np.bincount(path, excused)[path] == 0].max(initial=0)
    size = max(float(np.ptp(z.real)), float(np.ptp(z.imag)))
    # Far from the origin coordinates have no more digits.
    digits = 4 * np.finfo(float).eps * float(np.abs(z).max())
    if not residual <= RESIDUAL * size + digits:
        faults.append(f"seam residual {residual / size:.1e} of the layout")
    return faults
