# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last unwrap of a mesh ended with, stored with the mesh so that it can be shown, also after the file is read.

A report is found again by the digest of the UV map it tells of: it is no longer shown where the map was changed, and
shown again where undo or redo bring the map back.
"""

from __future__ import annotations

import json
from collections import OrderedDict
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import changes, native
from .probe import probe

if TYPE_CHECKING:
    from .unwrapping import Unwrapped

TEXTURE_SIZE = 1024
"""Texels a side of the texture that errors of seams are told in."""


@dataclass(frozen=True, slots=True)
class Report:
    """Indices are the mesh's; all are plain lists and numbers, as JSON has them.

    paths: the cuts, each the vertices from node to node. cones, cone_angles: as imposed, radians. flipped, overlapping:
    faces. faces: how many were unwrapped. islands, distortion, seams, overlap_area, certificate: as in the library's
    result, of the last unwrap; certificate is None for layouts that are not seamless.
    """

    paths: list[list[int]]
    cones: list[int]
    cone_angles: list[float]
    flipped: list[int]
    overlapping: list[int]
    faces: int
    islands: int
    distortion: dict[str, float]
    seams: dict[str, float]
    overlap_area: float
    certificate: dict[str, Any] | None


# Those made since Blender started, by digest; undo in edit mode brings back UVs, but no properties of the mesh.
_known: OrderedDict[str, Report] = OrderedDict()
KNOWN = 64

# By the mesh's session_uid: its version and the report current then.
_current: dict[int, tuple[tuple[int, int], Report | None]] = {}


def report_on(unwrapped: Unwrapped) -> Report:
    """What is to be kept of a finished map."""
    result, region = unwrapped.result, unwrapped.region
    certificate = None
    if result.seamless is not None:
        certificate = native.lsgp.certificate.certificate(result.seamless, TEXTURE_SIZE)
    return Report(
        paths=[path.tolist() for path in native.lsgp.split_into_paths(result.cut_edges, result.cones)],
        cones=result.cones.tolist(),
        cone_angles=result.cone_angles.tolist(),
        flipped=_faces(region.triangle_faces[result.flipped]),
        overlapping=_faces(region.triangle_faces[result.overlapping]),
        faces=len(np.unique(region.triangle_faces[result.solved])),
        islands=int(result.island.max()) + 1,
        distortion=asdict(result.distortion),
        seams=asdict(result.seams),
        overlap_area=result.overlap_area,
        certificate=certificate,
    )


def joined(earlier: Report | None, report: Report, unwrapped: Unwrapped) -> Report:
    """The report with what the earlier one says of the faces that were not unwrapped this time."""
    if earlier is None:
        return report
    region = unwrapped.region
    again, faces = region.vertex_used, np.zeros(len(region.face_loop_start), bool)
    faces[region.triangle_faces] = True
    kept = [i for i, cone in enumerate(earlier.cones) if not again[cone]]
    return replace(
        report,
        paths=[path for path in earlier.paths if not again[path].all()] + report.paths,
        cones=[earlier.cones[i] for i in kept] + report.cones,
        cone_angles=[earlier.cone_angles[i] for i in kept] + report.cone_angles,
        flipped=[face for face in earlier.flipped if not faces[face]] + report.flipped,
        overlapping=[face for face in earlier.overlapping if not faces[face]] + report.overlapping,
    )


def store(mesh: bpy.types.Mesh, report: Report) -> None:
    """Keep the report with the mesh as it is now."""
    digest = probe(mesh)
    _remember(digest, report)
    mesh.cone_unwrap_report = f"{digest}\n{json.dumps(asdict(report))}"
    changes.mark_changed(mesh)


def current(mesh: bpy.types.Mesh) -> Report | None:
    """The report on the mesh's active UV map; None where there is none or the map has changed since."""
    version = changes.version(mesh)
    kept = _current.get(mesh.session_uid)
    if kept is None or kept[0] != version:
        kept = _current[mesh.session_uid] = version, find(mesh)
    return kept[1]


def find(mesh: bpy.types.Mesh) -> Report | None:
    """As `current`, whether or not Blender has noticed all changes."""
    digest = probe(mesh)
    stored, _, text = mesh.cone_unwrap_report.partition("\n")
    if stored == digest and digest not in _known:
        _remember(digest, _parsed(text))
    return _known.get(digest)


def is_stale(mesh: bpy.types.Mesh) -> bool:
    """Whether there was a report, but not on the mesh and its UV map as they are."""
    return bool(mesh.cone_unwrap_report) and current(mesh) is None


def _remember(digest: str, report: Report | None) -> None:
    _known[digest] = report
    _known.move_to_end(digest)
    while len(_known) > KNOWN:
        _known.popitem(last=False)


def _parsed(text: str) -> Report | None:
    """None where another version of the add-on has written it."""
    try:
        return Report(**json.loads(text))
    except (TypeError, ValueError):
        return None


def _faces(faces: NDArray[np.int32]) -> list[int]:
    return np.unique(faces).tolist()


def register() -> None:
    bpy.types.Mesh.cone_unwrap_report = bpy.props.StringProperty(
        name="Cone Unwrap Report", description="What the last unwrap from cones ended with", options={"HIDDEN"}
    )


def unregister() -> None:
    del bpy.types.Mesh.cone_unwrap_report
    _known.clear()
    _current.clear()
