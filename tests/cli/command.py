# SPDX-License-Identifier: GPL-3.0-or-later
"""Helpers of the tests of the command line: finished runs and the content of their files."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lsgp.io.mesh_files import read_mesh
from polygon_meshes import faces_of

REPORT_KEYS = [
    *["status", "code", "message", "elements", "warnings", "triangles", "cones", "cone_angles", "placement"],
    *[
        "distortion",
        "seams",
        "seamless",
        "features",
        "missing",
        "islands",
        "flipped",
        "wrong_angle_sums",
        "repair",
        "overlapping",
        "overlap_area",
        "direction_error",
        "texel_density",
        "packing",
        "quads",
        "stage_seconds",
    ],
]
DISTORTION_KEYS = [
    *["quasi_conformal", "quasi_conformal_area_weighted", "area", "area_p10", "area_p90", "l2_stretch"],
]
REPAIR_KEYS = ["flipped_before", "wrong_angle_sums_before", "iterations"]
SEAM_KEYS = ["sister_ratio_max", "rotation_residual", "translation_residual"]


@dataclass
class Ended:
    """A command line that has ended."""

    code: int
    out: str
    err: str
    folder: Path

    def report(self, name: str = "report.json") -> dict:
        return json.loads((self.folder / name).read_text(), parse_constant=_no_constant)


def _no_constant(text: str) -> None:
    raise AssertionError(f"{text} is no JSON")


def uv_of(path: Path) -> np.ndarray:
    return read_mesh(path, with_uv=True).corner_uv


def cut_edges(path: Path) -> set[tuple[int, int]]:
    """Edges whose two faces have different texture coordinates there."""
    sides: dict[tuple[int, int], list] = {}
    mesh = read_mesh(path, with_uv=True)
    for start, face in zip(mesh.starts.tolist(), faces_of(mesh), strict=True):
        for i, a in enumerate(face):
            j = (i + 1) % len(face)
            here = {a: tuple(mesh.corner_uv[start + i]), face[j]: tuple(mesh.corner_uv[start + j])}
            sides.setdefault((min(here), max(here)), []).append(here)
    return {edge for edge, both in sides.items() if len(both) == 2 and both[0] != both[1]}
