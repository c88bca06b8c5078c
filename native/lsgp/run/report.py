# SPDX-License-Identifier: GPL-3.0-or-later
"""The output of a run: the JSON report for programs and the table for people."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.counted import counted
from ..certificate import certificate
from ..errors import Elements, Finding, LsgpError
from ..io.polygons import Triangulation
from ..layouts.texels import TexelDensity
from ..quads.quad_mesh import QuadQuality
from ..quads.remeshing import QuadRemesh
from ..results import Choice, FeatureReport, Measurement, Placement, Result
from .missing_faces import MissingFaces
from .unwrap_file import Packed, Run

Report = dict[str, Any]

# The least error of a stroke that people are told of, in degrees, and how many strokes at most.
_NOTICEABLE, _MOST_STROKES = 0.05, 10

# Every report has all of these keys, in this order; what does not apply is null or empty.
EMPTY: Report = {
    "status": "ok",
    "code": None,
    "message": None,
    "elements": None,
    "warnings": [],
    "triangles": None,
    "cones": [],
    "cone_angles": [],
    "placement": None,
    "distortion": None,
    "seams": None,
    "seamless": None,
    "features": None,
    "missing": None,
    "islands": None,
    "flipped": None,
    "wrong_angle_sums": None,
    "repair": None,
    "overlapping": None,
    "overlap_area": None,
    "direction_error": None,
    "texel_density": None,
    "packing": None,
    "quads": None,
    "stage_seconds": {},
}


def on_faces(elements: Elements, triangulation: Triangulation | None) -> Elements:
    """Triangles become the faces of the file they were cut from; other elements stay."""
    if elements.kind != "triangles" or triangulation is None:
        return elements
    return Elements("faces", triangulation.polygons_of(elements.indices))


def where(elements: Elements, triangulation: Triangulation | None) -> str:
    """The elements that a message concerns, to be appended to it: in brackets and in the file's numbering."""
    named = str(on_faces(elements, triangulation))
    return f" ({named})" if named else ""


def refusal_report(error: LsgpError, triangulation: Triangulation | None) -> Report:
    """The report of an input that was refused.  triangulation: None where the file was refused before it had one."""
    return EMPTY | {
        "status": "refused",
        "code": error.code,
        "message": error.message,
        "elements": _elements(on_faces(error.elements, triangulation)),
        "triangles": None if triangulation is None else len(triangulation.triangles),
    }


def placed_figures(placement: Placement) -> Report:
    """The expected quality with placed cones, over all components: the L2 stretch predicted and that of the map, null
    where it was not made or is not valid, and whether the target was reached."""
    return {
        "predicted_l2": placement.predicted_l2,
        "mapped_l2": placement.mapped_l2,
        "reached": placement.reached,
    }


def unwrap_report(result: Result, run: Run, texture_size: int) -> Report:
    """The report of a map. "flipped", "wrong_angle_sums" and "overlapping" are counts; the warnings name the faces and
    vertices. "cones" and "cone_angles" are those that were imposed, so that a report serves as a cones file too.

    texture_size: side of the texture in whose texels the errors of a seamless layout are given, and the texel density.
    """
    return EMPTY | {
        "warnings": _warnings(result.warnings, run.triangulation),
        "triangles": len(run.triangulation.triangles),
        "cones": result.cones.tolist(),
        "cone_angles": result.cone_angles.tolist(),
        "placement": None if run.placement is None else placed_figures(run.placement),
        "distortion": asdict(result.distortion),
        "seams": asdict(result.seams),
        "seamless": None if result.seamless is None else certificate(result.seamless, texture_size),
        "features": None if result.features is None else _feature_figures(result.features),
        "missing": None if run.missing is None else _missing_figures(run.missing),
        "islands": island_count(result.island),
        "flipped": len(result.flipped),
        "wrong_angle_sums": len(result.wrong_angle_sums),
        "repair": asdict(result.repair),
        "overlapping": len(result.overlapping),
        "overlap_area": result.overlap_area,
        "direction_error": _direction_figures(result, run),
        "texel_density": _texel_figures(run.texels, texture_size),
        "packing": None if run.packed is None else asdict(run.packed),
        "stage_seconds": dict(run.stage_seconds),
    }


def _missing_figures(missing: MissingFaces) -> Report:
    return {
        "faces": missing.faces.tolist(),
        "area_percent": missing.area_percent,
        "impossible": missing.impossible.tolist(),
        "impossible_area_percent": missing.impossible_area_percent,
    }


def missing_lines(missing: MissingFaces | None) -> list[str]:
    """Lines on faces without coordinates: which ones, and how much of the area they are."""
    if missing is None:
        return []
    kinds = (
        ("", missing.faces, missing.area_percent),
        (" and without triangles or area", missing.impossible, missing.impossible_area_percent),
    )
    return [
        f"{counted(len(faces), 'face')} without coordinates{what}, {percent:.3g} % of the area{where(named, None)}"
        for what, faces, percent in kinds
        if (named := Elements("faces", faces)) and len(faces)
    ]


def _feature_figures(features: FeatureReport) -> Report:
    """What became of marked features; paths of vertices."""
    released = [
        {"path": feature.path.tolist(), "reason": feature.reason, "share": feature.share}
        for feature in features.released
    ]
    return {"share": features.share, "released": released}


def placement_report(placement: Placement, triangulation: Triangulation, stage_seconds: Mapping[str, float]) -> Report:
    """The report of cones that were placed; the map that was made for that is not kept."""
    return EMPTY | {
        "warnings": _warnings(placement.warnings, triangulation),
        "triangles": len(triangulation.triangles),
        "cones": placement.cones.tolist(),
        "cone_angles": placement.cone_angles.tolist(),
        "placement": placed_figures(placement),
        "stage_seconds": dict(stage_seconds),
    }


def quads_report(remesh: QuadRemesh, quality: QuadQuality, run: Run) -> Report:
    """The report of a mesh of quads. "distortion" is that of the layout whose grid they are; "irregular" of "quads"
    counts its vertices by how many quads meet there, "feature_distance" is their mean distance from features, in sides
    of a quad, or null without."""
    mesh, layout = remesh.mesh, remesh.layout
    distances = remesh.feature_distances()
    valences, counts = np.unique(mesh.valences[mesh.irregular], return_counts=True)
    return EMPTY | {
        "warnings": _warnings(remesh.warnings, run.triangulation),
        "triangles": len(run.triangulation.triangles),
        "cones": layout.cones.tolist(),
        "cone_angles": layout.cone_angles.tolist(),
        "distortion": asdict(layout.distortion),
        "quads": {
            "count": len(mesh.quads),
            "vertices": len(mesh.positions),
            "irregular": {str(valence): count for valence, count in zip(valences, counts.tolist(), strict=True)},
            "feature_distance": float(distances.mean()) if len(distances) else None,
            "size": layout.seamless.tile_size,
            **asdict(quality),
        },
        "stage_seconds": dict(run.stage_seconds),
    }


def measure_report(
    measurement: Measurement,
    warnings: Iterable[Finding],
    run: Run,
    texture_size: int | None = None,
    texels: TexelDensity | None = None,
) -> Report:
    """The report on given texture coordinates, which tell nothing of cones or the angles they should have."""
    return EMPTY | {
        "warnings": _warnings(warnings, run.triangulation),
        "triangles": len(run.triangulation.triangles),
        "distortion": asdict(measurement.distortion),
        "seams": asdict(measurement.seams),
        "islands": island_count(measurement.island),
        "flipped": len(measurement.flipped),
        "texel_density": _texel_figures(texels, texture_size),
        "stage_seconds": dict(run.stage_seconds),
    }


def to_json(report: Report) -> bytes:
    """The report as JSON text; NaN and infinity become null."""
    return (json.dumps(finite(report), indent=1, allow_nan=False) + "\n").encode("ascii")


def finite(value: Any) -> Any:
    """The value with null in the place of NaN and infinity, which JSON has not."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def island_count(island: NDArray[np.int32]) -> int:
    """island: the island of each triangle, negative where it has none."""
    return len(np.unique(island[island >= 0]))


def quality_table(
    measured: Result | Measurement, texels: TexelDensity | None = None, packed: Packed | None = None
) -> str:
    """The quality of a map as lines of text, the ideal value beside each figure that has one.

    texels: its texel density, packed: how its islands were, None where that is not known."""
    d, s = measured.distortion, measured.seams
    rows = [
        ("quasi-conformal", f"{d.quasi_conformal:.4f}", "1", f"area-weighted {d.quasi_conformal_area_weighted:.4f}"),
        ("area", f"{d.area:.4f}", "1", f"10 % {d.area_p10:.4f}, 90 % {d.area_p90:.4f}"),
        ("L2 stretch", f"{d.l2_stretch:.4f}", "1", ""),
        ("seam length mismatch", f"{s.sister_ratio_max - 1:.1e}", "0", ""),
        ("rotation residual", f"{math.degrees(s.rotation_residual):.1e}", "0", "degrees"),
        ("translation residual", f"{s.translation_residual:.1e}", "0", "of the layout"),
    ]
    flips = ""
    further = []
    if isinstance(measured, Result):
        repair, overlap = measured.repair, 100 * measured.overlap_area
        wrong, before = len(measured.wrong_angle_sums), repair.wrong_angle_sums_before
        flips = f"{repair.flipped_before} as first unfolded"
        further = [
            ("wrong angle sums", f"{wrong}", "0", f"vertices, {before} as first unfolded"),
            ("Newton iterations", f"{repair.iterations}", "", ""),
            ("overlapping triangles", f"{len(measured.overlapping)}", "0", f"{overlap:.3g} % of the layout"),
        ]
        if measured.direction_error is not None:
            largest = math.degrees(float(np.nanmax(measured.direction_errors)))
            mean = math.degrees(measured.direction_error)
            further.append(("direction error", f"{mean:.2f}", "0", f"degrees, the mean; at most {largest:.2f}"))
    rows += [("flipped triangles", f"{len(measured.flipped)}", "0", flips), *further]
    if texels is not None:
        spread = f"texels per unit, from {texels.minimum:.4g} to {texels.maximum:.4g}"
        rows.append(("texel density", f"{texels.median:.4g}", "", spread))
    if packed is not None:
        how = "in rows" if packed.pack == "shelves" else "tightly"
        tiles = f" in {packed.tiles} UDIM tiles" if packed.tiles > 1 else ""
        rows.append(("part of the square", f"{packed.coverage:.4f}", "1", f"packed {how}{tiles}"))
    lines = [f"{'':<22}{'value':>10}{'ideal':>7}"]
    lines += [f"{label:<22}{value:>10}{ideal:>7}  {note}".rstrip() for label, value, ideal, note in rows]
    return "\n".join(lines)


def _texel_figures(texels: TexelDensity | None, texture_size: int | None) -> Report | None:
    return None if texels is None else {"texture_size": texture_size} | asdict(texels)


def _direction_figures(result: Result, run: Run) -> Report | None:
    """Radians; the mean as of `Result.direction_error`. faces, errors: of the faces of a directions file, the largest
    of their triangles; edges, edge_errors: of its edges likewise. NaN where there is no map, and at edges between faces
    that have directions of their own."""
    if result.direction_error is None:
        return None
    figures = {"mean": result.direction_error, "largest": float(np.nanmax(result.direction_errors))}
    if run.strokes is None:
        return figures
    of_faces, of_edges = np.split(run.strokes.largest(result.direction_errors), [len(run.strokes.faces)])
    figures |= {"faces": run.strokes.faces.tolist(), "errors": of_faces.tolist()}
    return figures | {"edges": run.strokes.edges.tolist(), "edge_errors": of_edges.tolist()}


def missed_strokes(result: Result, run: Run) -> list[str]:
    """A line for each of the strokes of a directions file that the map misses noticeably, the worst first; those that
    are hardly better are only counted."""
    if run.strokes is None or result.direction_errors is None:
        return []
    names, errors = run.strokes.names, np.degrees(run.strokes.largest(result.direction_errors))
    missed = np.flatnonzero(errors > _NOTICEABLE)
    if not len(missed):
        return []
    worst = missed[np.argsort(-errors[missed], kind="stable")]
    lines = [f"strokes that the texture misses by more than {_NOTICEABLE} degrees: {len(missed)} of {len(errors)}"]
    lines += [f"  {names[k]}: {errors[k]:.2f}" for k in worst[:_MOST_STROKES]]
    if len(worst) > _MOST_STROKES:
        lines.append(f"  and {len(worst) - _MOST_STROKES} more, in the report (--report)")
    return lines


def choice_lines(choices: Sequence[Choice]) -> list[str]:
    """A line for each map that a preset made or considered, in that order; none without."""
    if not choices:
        return []
    width = max(len(choice.name) for choice in choices)
    lines = ["choices, with what they cost or were expected to, in hundredths of L2 stretch:"]
    for choice in choices:
        if choice.cost is not None:
            cost = f"{choice.cost:11.2f}"
        else:
            cost = f"about {choice.estimate:5.2f}" if math.isfinite(choice.estimate) else ""
        lines.append(f"  {'*' if choice.is_best else ' '} {choice.name:{width}}  {cost:11}  {choice.reason}")
    return lines


def _warnings(findings: Iterable[Finding], triangulation: Triangulation) -> list[Report]:
    return [
        {"code": f.code, "message": f.message, "elements": _elements(on_faces(f.elements, triangulation))}
        for f in findings
    ]


def _elements(elements: Elements) -> Report:
    return {"kind": elements.kind, "indices": np.asarray(elements.indices).tolist()}
