# SPDX-License-Identifier: GPL-3.0-or-later
"""The report on the last unwrap of a mesh, stored with the mesh so that it can also be shown after loading a file.

A report is looked up by the digest of its UV map: it is not shown once the map has changed, and shown again when undo
or redo restore the map.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections import OrderedDict
from dataclasses import asdict, dataclass, field, replace
from itertools import pairwise
from typing import Any

import bpy
import numpy as np

from ..core.per_mesh import kept_by_mesh
from ..core.region import Region
from ..core.runs import as_runs, from_runs
from . import changes
from .uv_digest import uv_digest


@dataclass(frozen=True, slots=True)
class Report:
    """What is kept of a map, as lists and numbers that fit into JSON. Indices are those of the mesh.

    paths: the cuts and the borders inside, each as the vertices from node to node. kinds: of each path one of
    `cut_kinds`; empty in reports of earlier versions. cones, cone_angles: as imposed, in
    radians. flipped, overlapping: faces. faces: how many were unwrapped. islands, distortion, seams, overlap_area,
    certificate: as in the library's result of the last unwrap; certificate is None for layouts that are not seamless.
    texel_density: of the last unwrap in its final place the least, the median and the largest length in the map of a
    unit in the world; None before it has that place. square_used: the part of the UV square that is covered by all that
    was packed with it; None where it was not packed into that. overlaps_known: False once islands were scaled, which
    may have put them onto each other.
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
    texel_density: list[float] | None = None
    overlaps_known: bool = True
    kinds: list[str] = field(default_factory=list)
    drawn: list[int] = field(default_factory=list)
    drawn_errors: list[float] = field(default_factory=list)
    square_used: float | None = None

    def edges_of(self, kind: str) -> list[tuple[int, int]]:
        """The vertex pairs of the edges that were cut for this reason."""
        return [
            pair
            for path, of_path in zip(self.paths, self.kinds, strict=False)
            if of_path == kind
            for pair in pairwise(path)
        ]


ELEMENTS = ("cones", "flipped", "overlapping", "drawn")

# Reports since Blender was started, by digest; undo in edit mode restores UVs, but no properties of the mesh.
_known: OrderedDict[str, Report] = OrderedDict()
KNOWN = 64

# The version of each mesh and the report that was current then.
_current: dict[int, tuple[tuple[int, int], Report | None]] = kept_by_mesh()


def joined(earlier: Report | None, report: Report, region: Region) -> Report:
    """The report on a region, with what the earlier report says about all other faces."""
    if earlier is None:
        return report
    again, faces = region.vertex_used, np.zeros(len(region.face_loop_start), bool)
    faces[region.triangle_faces] = True
    kept = [i for i, cone in enumerate(earlier.cones) if not again[cone]]
    known = len(earlier.kinds) == len(earlier.paths)
    others = [i for i, path in enumerate(earlier.paths) if not again[path].all()]
    return replace(
        report,
        paths=[earlier.paths[i] for i in others] + report.paths,
        kinds=[earlier.kinds[i] for i in others] + report.kinds if known or not others else [],
        cones=[earlier.cones[i] for i in kept] + report.cones,
        cone_angles=[earlier.cone_angles[i] for i in kept] + report.cone_angles,
        flipped=[face for face in earlier.flipped if not faces[face]] + report.flipped,
        overlapping=[face for face in earlier.overlapping if not faces[face]] + report.overlapping,
        drawn=[face for face in earlier.drawn if not faces[face]] + report.drawn,
        drawn_errors=[error for face, error in zip(earlier.drawn, earlier.drawn_errors, strict=True) if not faces[face]]
        + report.drawn_errors,
    )


def store(mesh: bpy.types.Mesh, report: Report) -> None:
    """Keep the report with the mesh and its current UV map."""
    digest = uv_digest(mesh)
    _remember(digest, report)
    mesh.cone_unwrap_report = f"{digest}\n{_packed(report)}"
    changes.mark_changed(mesh)


def current(mesh: bpy.types.Mesh) -> Report | None:
    """The report on the active UV map; None where there is none or the map has changed since."""
    version = changes.version(mesh)
    kept = _current.get(mesh.session_uid)
    if kept is None or kept[0] != version:
        kept = _current[mesh.session_uid] = version, find(mesh)
    return kept[1]


def find(mesh: bpy.types.Mesh) -> Report | None:
    """As `current`, but without relying on Blender to have noticed all changes."""
    digest = uv_digest(mesh)
    stored, _, text = mesh.cone_unwrap_report.partition("\n")
    if stored == digest and digest not in _known:
        _remember(digest, _parsed(text))
    return _known.get(digest)


def forget(mesh: bpy.types.Mesh) -> bool:
    """Remove the report from the mesh.  Returns whether there was one."""
    present = bool(mesh.cone_unwrap_report)
    _known.pop(uv_digest(mesh), None)
    mesh.property_unset("cone_unwrap_report")
    changes.mark_changed(mesh)
    return present


def _remember(digest: str, report: Report | None) -> None:
    _known[digest] = report
    _known.move_to_end(digest)
    while len(_known) > KNOWN:
        _known.popitem(last=False)


def _packed(report: Report) -> str:
    """As text of few characters: elements as runs, compressed."""
    elements = {name: as_runs(getattr(report, name)) for name in ELEMENTS}
    kept = asdict(report) | elements | {"paths": [as_runs(path) for path in report.paths]}
    return base64.b85encode(zlib.compress(json.dumps(kept, separators=(",", ":")).encode())).decode()


def _parsed(text: str) -> Report | None:
    """None where another version of the add-on wrote it."""
    try:
        kept = json.loads(zlib.decompress(base64.b85decode(text)))
        elements = {name: from_runs(kept[name]) for name in ELEMENTS if name in kept}
        return Report(**kept | elements | {"paths": [from_runs(path) for path in kept["paths"]]})
    except (KeyError, TypeError, ValueError, zlib.error):
        return None


def register() -> None:
    bpy.types.Mesh.cone_unwrap_report = bpy.props.StringProperty(
        name="Cone Unwrap Report", description="The result of the last unwrap from cones", options={"HIDDEN"}
    )


def unregister() -> None:
    del bpy.types.Mesh.cone_unwrap_report
    _known.clear()
