# SPDX-License-Identifier: GPL-3.0-or-later
"""The option for edges that are to run straight along u or v."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..base.arguments import IndexArray
from ..base.unique_rows import unique_rows
from ..features import feature_edges
from ..io.side_files import UsageError, load_json, pairs_in
from ..stitching import at_stitched
from ..surface import Surface
from .named_files import Reads

_CREASE, _SHARP, _SEAMS, _BORDERS = "crease", "sharp", "seams", "borders"


@dataclass(frozen=True, slots=True)
class FeatureKinds:
    """Which edges are features. angle: least angle between the normals at a crease, radians; None for no creases."""

    angle: float | None = None
    sharp: bool = False
    seams: bool = False
    borders: bool = False

    def edges_of(self, surface: Surface, sharp: IndexArray) -> IndexArray:
        """For `Surface.features`.  sharp: (s, 2), the edges marked sharp.  Raises InputError."""
        found = feature_edges(surface, angle=self.angle, seams=self.seams, borders=self.borders)
        if not self.sharp:
            return found
        return unique_rows(np.concatenate([found, np.sort(sharp, axis=1)])).rows.astype(np.int32)


def add_features_option(command: argparse.ArgumentParser, which: str) -> None:
    """which: the edges that these are."""
    command.add_argument(
        "--features",
        metavar="FILE.json|KIND,...",
        action=Reads,
        type=_features_option,
        help=f"{which}: [[a, b], ...], or by kind: crease:ANGLE, edges with that angle between the normals, in "
        "degrees, or more; seams, those of --seam-edges; borders; and, in Blender's batches, sharp, those marked so "
        "(default: none)",
    )


def features_of(option: FeatureKinds | str | None, surface: Surface, stitched: IndexArray) -> IndexArray:
    """What the option says of a mesh file, for `Surface.features`.  Raises OSError, UsageError, InputError.

    stitched: as of the surface's `MeshFile`.
    """
    if option is None:
        return np.empty((0, 2), np.int32)
    if isinstance(option, str):
        path = Path(option)
        return at_stitched(stitched, pairs_in(load_json(path), path, "feature vertex"))
    if option.sharp:
        raise UsageError("--features sharp: files of this format mark no edges sharp; name the edges in a file")
    return option.edges_of(surface, np.empty((0, 2), np.int32))


def _features_option(text: str) -> FeatureKinds | str:
    """The kinds, or the name of the file as it stands."""
    names = [part.partition(":") for part in text.split(",")]
    if any(name not in {_CREASE, _SHARP, _SEAMS, _BORDERS} for name, _, _ in names):
        return text
    given = {name: value for name, _, value in names}
    for name, value in given.items():
        if value and name != _CREASE:
            raise argparse.ArgumentTypeError(f"'{name}:{value}': {name} has no value")
    angle = None
    if _CREASE in given:
        angle = _degrees(given[_CREASE])
    return FeatureKinds(angle, _SHARP in given, _SEAMS in given, _BORDERS in given)


def _degrees(text: str) -> float:
    """In radians."""
    try:
        angle = float(text)
    except ValueError:
        angle = math.nan
    if not 0 < angle <= 180:
        raise argparse.ArgumentTypeError(f"'crease:{text}': ANGLE is in degrees, above 0 and at most 180")
    return math.radians(angle)
