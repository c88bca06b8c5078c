# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the outcome of a verb fulfills its contract, on any surface: a result, or an error of the library.

`result_check` judges a map by itself; added here are its place in the texture, what is left of it in single precision,
and what errors, placements, gains, cuts and measurements have to be.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

import lsgp
import numpy as np
from numpy.typing import NDArray
from opened_surface import edge_keys, named_by, open_surface
from overlap_check import overlaps
from result_check import OVERLAP, RESIDUAL, anisotropy, lost_by_pressing, undeclared_faults

AREA = 1e-6  # relative: islands have their area on the surface
SLIVERS = 0.11  # of the Dirichlet energy: parts sheared to less area keep their lengths instead
FIGURE = 1e-6  # relative: measures of distortion, and predictions
SLIVER = 1e-5  # height over length of a triangle below which measures lose too many digits

# Findings about the surface that change which triangles are measured, or which way round they are.
MENDED = {"REORIENTED", "DUPLICATE_FACE", "DEGENERATE_FACES", "COMPONENT_SKIPPED", "NON_MANIFOLD_EDGE", "SPLIT_VERTEX"}
# Elements of these are what is out of range, or rows of what was passed.
NAMES_WHAT_IS_NOT = {
    "INDEX_OUT_OF_RANGE",
    "CONE_INDEX",
    "PIN_INDEX",
    "SEAM_NOT_AN_EDGE",
    "EDGE_NOT_IN_MESH",
    "LOOP_TURNING",
}

Findings = Iterable[lsgp.Finding]


@cache
def documented_codes() -> frozenset[str]:
    """Of the guide's table of messages."""
    page = Path(__file__).resolve().parents[1] / "docs" / "how-to" / "troubleshooting.md"
    return frozenset(re.findall(r"`([A-Z][A-Z_]+)`", page.read_text()))


def error_faults(surface: lsgp.Surface | None, error: BaseException) -> list[str]:
    """What is wrong with an error: nothing else than an LsgpError may come, with a documented code and a sentence."""
    if not isinstance(error, lsgp.LsgpError):
        return [f"raised {type(error).__name__}: {error}"]
    faults = _finding_faults(surface, error.code, error.message, error.elements)
    return [f"error {error.code}: {fault}" for fault in faults]


def warning_faults(surface: lsgp.Surface, warnings: Findings) -> list[str]:
    return [
        f"warning {warning.code}: {fault}"
        for warning in warnings
        for fault in _finding_faults(surface, warning.code, warning.message, warning.elements)
    ]


def _finding_faults(surface: lsgp.Surface | None, code: str, message: str, elements: lsgp.Elements) -> list[str]:
    faults = []
    if code not in documented_codes():
        faults.append("the code is not documented")
    if not message.endswith((".", "!")):
        faults.append(f"no sentence: {message!r}")
    indices = np.asarray(elements.indices)
    if elements.kind not in ("vertices", "edges", "triangles"):
        faults.append(f"elements of kind {elements.kind!r}")
    elif indices.ndim != (2 if elements.kind == "edges" else 1):
        faults.append(f"{elements.kind} of shape {indices.shape}")
    elif surface is not None and indices.size and code not in NAMES_WHAT_IS_NOT:
        count = len(surface.triangles) if elements.kind == "triangles" else len(surface.positions)
        if indices.min() < 0 or indices.max() >= count:
            faults.append(f"{elements.kind} {indices.min()} to {indices.max()} of {count}")
    return faults


def result_faults(
    surface: lsgp.Surface,
    result: lsgp.Result,
    options: lsgp.Options,
    given: Mapping[int, float | None] | None = None,
    *,
    pinned: bool = False,
) -> list[str]:
    """Everything that is wrong with a result and that no warning of it names; empty for an honest one.

    Arguments as of `undeclared_faults`.  pinned: pins say where islands are and how large.
    """
    faults = undeclared_faults(surface, result, options, given) + warning_faults(surface, result.warnings)
    if not np.isfinite(result.corner_uv[result.solved]).all():
        return faults
    faults += _lost_in_single_precision(result)
    if not pinned:
        faults += _misplaced_islands(surface, result, options)
    return faults + _wrong_measures(surface, result, result.distortion, result.corner_uv)


def _areas(corner: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of triangles (m, 3, d), never negative."""
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    if corner.shape[2] == 2:
        return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    return np.linalg.norm(np.cross(a, b), axis=1) / 2


def _dirichlet(solid: NDArray[np.float64], z: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Of triangles, (m, 3, 3) to (m, 3): half the sum of squares of both singular values, times the area."""
    out = np.zeros(len(solid))
    for corner in range(3):
        a, b = (solid[:, (corner + k) % 3] - solid[:, corner] for k in (1, 2))
        with np.errstate(divide="ignore", invalid="ignore"):
            cotangent = (a * b).sum(axis=1) / np.linalg.norm(np.cross(a, b), axis=1)
        out += np.nan_to_num(cotangent * np.abs(z[:, (corner + 1) % 3] - z[:, (corner + 2) % 3]) ** 2) / 4
    return out


def _misplaced_islands(surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> list[str]:
    """Islands lie in the unit square, not on each other, and parts have their area up to one factor."""
    faults = []
    uv, island = result.corner_uv[result.solved], result.island[result.solved]
    if not len(uv):
        return faults
    between = _shared_by_islands(uv, island)
    if between > OVERLAP:
        faults.append(f"islands lie on each other, with {between:.1e} of the layout")
    if options.seamless is not None:
        return faults
    if uv.min() < -RESIDUAL or uv.max() > 1 + RESIDUAL:
        faults.append(f"coordinates from {uv.min():.17g} to {uv.max():.17g} are outside the unit square")
    return faults + _wrong_sizes(surface, result, options)


def _wrong_sizes(surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> list[str]:
    """Parts have their area on the surface; islands of one part have sides in common, which fit."""
    opened = open_surface(surface, result, options)
    solid = _areas(_unit_corners(surface)[opened.triangle])
    plane = _areas(result.corner_uv[opened.triangle])
    part, count = opened.component, int(opened.component.max()) + 1
    space, layout = (np.bincount(part, area, count) for area in (solid, plane))
    # Triangles without an area are given a little, and flipped ones count against the others.
    named = np.concatenate([result.flipped, named_by(result, "DEGENERATE_FACES")])
    honest = (space > 1e-12 * space.sum()) & (np.bincount(part, np.isin(opened.triangle, named), count) == 0)
    # What is sheared to slivers keeps its lengths rather than its area.
    energy = np.bincount(part, _dirichlet(_unit_corners(surface)[opened.triangle], opened.z.reshape(-1, 3)), count)
    honest &= layout > SLIVERS * energy
    scale = layout[honest] / space[honest]
    # Of slivers that lie in a large layout, rounding moves sides by a part of their height.
    sides = np.abs(opened.z - np.roll(opened.z.reshape(-1, 3), 1, axis=1).ravel())
    moved = 2 * np.finfo(float).eps * np.abs(opened.z).max(initial=0) * sides
    rounding = (np.bincount(np.repeat(part, 3), moved, count)[honest] / layout[honest]).max(initial=0)
    if len(scale) and not scale.max() <= (1 + AREA + rounding) * scale.min():
        return [f"scales of parts' areas differ by {scale.max() / scale.min():.9g}"]
    return []


def _unit_corners(surface: lsgp.Surface) -> NDArray[np.float64]:
    """(m, 3, 3) corners of triangles, each triangle's first in the origin, of about the size 1: areas of these neither
    overflow nor vanish, and lose no digits far from the origin."""
    with np.errstate(over="ignore", invalid="ignore"):
        corner = surface.positions[surface.triangles]
        corner = corner - corner[:, :1]
        return corner / (np.nanmax(np.abs(corner), initial=0) or 1.0)


def _shared_by_islands(uv: NDArray[np.float64], island: NDArray[np.int32]) -> float:
    """The area that triangles of different islands share, as a part of the layout's."""
    z = uv[..., 0] + 1j * uv[..., 1]
    pairs, shared = overlaps(z)
    apart = island[pairs[:, 0]] != island[pairs[:, 1]]
    sides = np.abs(z - np.roll(z, 1, axis=1)).sum(axis=1)
    sure = apart & (shared > RESIDUAL * np.abs(z).max() * sides[pairs].min(axis=1))
    return float(shared[sure].sum() / max(_areas(uv).sum(), 1e-300))


def _lost_in_single_precision(result: lsgp.Result) -> list[str]:
    """What is stored are 32-bit numbers, and those are finite; `seamless_check` looks at all else in them."""
    with np.errstate(over="ignore"):
        stored = result.corner_uv[result.solved].astype(np.float32)
    return [] if np.isfinite(stored).all() else ["coordinates that float32 does not hold"]


def _wrong_measures(
    surface: lsgp.Surface, result: lsgp.Result, told: lsgp.Distortion, corner_uv: NDArray[np.float64]
) -> list[str]:
    """Distortion against singular values computed here, where no triangle is too thin for that."""
    if len(result.flipped) or MENDED & {warning.code for warning in result.warnings}:
        return []
    corner = _unit_corners(surface)
    solid, plane = _areas(corner), _areas(corner_uv)
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
    if (solid < SLIVER * longest**2).any() or (plane < 1e-8 * plane.max()).any() or (solid < 1e-8 * solid.max()).any():
        return []
    sigma = np.sort(_singular_values(corner, corner_uv), axis=1)
    ratio = sigma[:, 1] / sigma[:, 0]
    share = solid / solid.sum()
    own = {
        "quasi_conformal": ratio.mean(),
        "quasi_conformal_area_weighted": share @ ratio,
        "area": (share / (plane / plane.sum())).mean(),
        "l2_stretch": np.sqrt(share @ ((sigma**-2.0).sum(axis=1) / 2) * (share @ sigma.prod(axis=1))),
    }
    return [
        f"{name} is {value:.9g} and not {getattr(told, name):.9g}"
        for name, value in own.items()
        if not abs(value / getattr(told, name) - 1) <= FIGURE
    ]


def _singular_values(corner: NDArray[np.float64], corner_uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, 2) stretches of the linear maps from triangles (m, 3, 3) to (m, 3, 2)."""
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    length = np.linalg.norm(a, axis=1)
    along = (a * b).sum(axis=1) / length
    across = np.linalg.norm(b - (along / length)[:, None] * a, axis=1)
    p, q = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    first = p / length[:, None]
    return np.linalg.svd(np.stack([first, (q - along[:, None] * first) / across[:, None]], axis=2), compute_uv=False)


def placement_faults(surface: lsgp.Surface, placed: lsgp.Placement, target: float | None) -> list[str]:
    """target: the stretch to reach where no number of cones was given."""
    faults = warning_faults(surface, placed.warnings)
    cones = placed.cones
    if len(np.unique(cones)) != len(cones) or not np.isin(cones, surface.triangles).all():
        faults.append("placed cones are not vertices of the surface, each once")
    if len(placed.cone_angles) != len(cones) or not (placed.cone_angles > 0).all():
        faults.append("a placed cone without an angle above 0")
    if placed.log_scale.shape != (len(surface.positions),) or not np.isfinite(placed.log_scale).all():
        faults.append("log_scale is not finite")
    faults += _wrong_prediction(placed.predicted_l2, placed.warnings)
    codes = {warning.code for warning in placed.warnings}
    if target is not None and not placed.reached and not codes & {"PLACEMENT_NOT_REACHED", "COMPONENT_SKIPPED"}:
        faults.append("the target was not reached, and no warning says so")
    return faults


def _wrong_prediction(predicted_l2: float, warnings: Findings) -> list[str]:
    """A stretch of 1 or more, beyond all numbers only where a warning says that it is high."""
    high = any(warning.code == "HIGH_DISTORTION" for warning in warnings)
    ok = predicted_l2 >= 1 - FIGURE and (high or np.isfinite(predicted_l2))
    return [] if ok else [f"predicted_l2 is {predicted_l2}"]


def gains_faults(surface: lsgp.Surface, gains: lsgp.ConeGains) -> list[str]:
    faults = warning_faults(surface, gains.warnings)
    if gains.predicted_l2.shape != (len(surface.positions),):
        faults.append("predicted_l2 is not one number for each vertex")
    if np.isnan(gains.present_l2):
        faults.append("present_l2 is not a number")
    if gains.best is not None and not np.isfinite(gains.predicted_l2[gains.best]):
        faults.append(f"the best place {gains.best} has no gain")
    return faults


def prescription_faults(surface: lsgp.Surface, prescription: lsgp.Prescription) -> list[str]:
    faults = warning_faults(surface, prescription.warnings)
    if not (prescription.cone_angles > 0).all() or not np.isfinite(prescription.cone_angles).all():
        faults.append("a cone without an angle above 0")
    if not np.isfinite(prescription.log_scale).all():
        faults.append("log_scale is not finite")
    faults += _wrong_prediction(prescription.predicted_l2, prescription.warnings)
    return faults


def cuts_faults(surface: lsgp.Surface, cuts: lsgp.CutPaths) -> list[str]:
    """Cuts are edges of the surface, each once, or once for each two triangles of several sheets; paths are made
    of just these."""
    faults = []
    keys = edge_keys(*cuts.edges.T)
    own, meeting = np.unique(
        edge_keys(surface.triangles.ravel(), surface.triangles[:, [1, 2, 0]].ravel()), return_counts=True
    )
    cut, times = np.unique(keys, return_counts=True)
    if not np.isin(cut, own).all() or (times > meeting[np.isin(own, cut)] // 2).any():
        faults.append("cuts are not edges of the surface, each once on a sheet")
    steps = [edge_keys(path[:-1], path[1:]) for path in cuts.paths]
    along = np.sort(np.concatenate(steps)) if steps else np.empty(0, np.int64)
    if not np.array_equal(along, np.sort(keys)):
        faults.append(f"paths walk {len(along)} edges of {len(keys)} cuts")
    return faults


def measurement_faults(surface: lsgp.Surface, measured: lsgp.Measurement, corner_uv: NDArray[np.float64]) -> list[str]:
    faults = []
    known = np.isfinite(corner_uv).all(axis=(1, 2))
    if not np.array_equal(measured.island >= 0, known):
        faults.append("islands are not those of the triangles with coordinates")
    if len(measured.flipped) and not np.isin(measured.flipped, np.flatnonzero(known)).all():
        faults.append("flipped triangles without coordinates")
    own = edge_keys(surface.triangles.ravel(), surface.triangles[:, [1, 2, 0]].ravel())
    if not np.isin(edge_keys(*measured.cut_edges.T), own).all():
        faults.append("cuts that are no edges of the surface")
    return faults


def same_measures(
    surface: lsgp.Surface, result: lsgp.Result, measured: lsgp.Measurement, *, pressed: bool = False
) -> list[str]:
    """Measuring the coordinates of a result gives the figures it was told with.

    pressed: as for `undeclared_faults`.
    """
    if len(result.flipped) or MENDED & {warning.code for warning in result.warnings}:
        return []
    corner = _unit_corners(surface)
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
    if (_areas(corner) < SLIVER * longest**2).any():
        return []
    lost = _lost_of_figures(surface, result) if pressed else {}
    return [
        f"{name} is {getattr(measured.distortion, name):.9g} measured and {getattr(result.distortion, name):.9g} told"
        for name in result.distortion.__slots__
        if not abs(getattr(measured.distortion, name) / getattr(result.distortion, name) - 1)
        <= FIGURE + lost.get(name, 0.0)
    ]


def _lost_of_figures(surface: lsgp.Surface, result: lsgp.Result) -> dict[str, float]:
    """What the rounding of positions by presets may change of each measure, relatively: of means as much as of what
    they are the means of. A strain changes lengths by itself, ratios of lengths and areas by twice that."""
    solved = result.solved
    lost, ratio = lost_by_pressing(surface)[solved], anisotropy(surface, result.corner_uv)[solved]
    area, uv_area = _areas(_unit_corners(surface))[solved], _areas(result.corner_uv[solved])

    def mean(weight: NDArray[np.float64]) -> float:
        return float((weight * lost).sum() / weight.sum())

    with np.errstate(all="ignore"):
        squares = area**2 / uv_area * (ratio + 1 / ratio)
        of_total = 2 * mean(area)
        return {
            "quasi_conformal": 2 * mean(ratio),
            "quasi_conformal_area_weighted": 4 * mean(ratio * area) + of_total,
            "area": 2 * mean(area / uv_area) + of_total,
            "area_p10": 2 * lost.max(initial=0) + of_total,
            "area_p90": 2 * lost.max(initial=0) + of_total,
            "l2_stretch": 2 * mean(squares) + of_total,
        }
