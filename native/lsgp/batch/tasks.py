# SPDX-License-Identifier: GPL-3.0-or-later
"""The input of a worker: the settings of the run, then a task for each asset; plain values, which can be serialized."""

from __future__ import annotations

import argparse
import hashlib
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .. import InputError, __version__
from ..io.side_files import UsageError
from ..run.feature_options import FeatureKinds
from ..run.named_files import read_files
from ..run.unwrap_options import add_unwrap_options, library_options
from .assets import Asset, picture_name

# In the name of a file beside each mesh it stands for the mesh's own path without its suffix.
MESH = "{}"


def _unwrap_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(add_help=False)
    add_unwrap_options(parser)
    return parser


# The options that name a file beside each mesh.
_UNWRAP_FILES = read_files(_unwrap_parser())
SIDE_FILES = tuple(action.dest for action in _UNWRAP_FILES)


@dataclass(frozen=True, slots=True)
class Task:
    """An asset: where it is, the folder of all results, and in that the names of its result and its picture."""

    asset: str
    input: str
    out: str
    output: str
    picture: str

    @classmethod
    def of(cls, asset: Asset, out: Path, output: str) -> Task:
        return cls(asset.name, os.path.abspath(asset.path), os.path.abspath(out), output, picture_name(asset.name))


@dataclass(frozen=True, slots=True)
class Settings:
    """options: the values of the options of an unwrap, files by absolute paths. memory_limit: in MB, of what a worker
    allocates beyond its memory at start; None for no limit."""

    options: dict[str, Any]
    pictures: bool = True
    reports: bool = False
    memory_limit: int | None = None

    @classmethod
    def of(cls, args: argparse.Namespace) -> Settings:
        """Raises UsageError where options contradict each other, or a file or a package that they take is missing."""
        options = {name: getattr(args, name) for name in vars(_unwrap_parser().parse_args([]))}
        try:
            library_options(args)
        except InputError as error:
            raise UsageError(f"{error} ({error.code})") from error
        for action in _UNWRAP_FILES:
            if action.path_in(options[action.dest]) is not None:
                options[action.dest] = _whole_path(action.dest, options[action.dest])
        if isinstance(options["features"], FeatureKinds):
            options["features"] = asdict(options["features"])
        return cls(options, args.pictures, args.reports, args.memory_limit)

    def options_for(self, task: Task) -> dict[str, Any]:
        """The values of the options, as parsed, with the files of this asset."""
        mesh = os.path.splitext(task.input)[0]
        own = {name: text.replace(MESH, mesh) for name in SIDE_FILES if isinstance(text := self.options[name], str)}
        features = self.options["features"]
        if isinstance(features, dict):
            own["features"] = FeatureKinds(**features)
        return self.options | own

    def side_files(self, task: Task) -> list[Path]:
        """The files that the options name for this asset."""
        values = self.options_for(task)
        return [path for action in _UNWRAP_FILES if (path := action.path_in(values[action.dest])) is not None]

    def digest(self) -> str:
        """Identifies options and version, so that results made with others are recognized."""
        content = json.dumps([__version__, self.options], sort_keys=True)
        return hashlib.blake2b(content.encode(), digest_size=6).hexdigest()


def _whole_path(name: str, text: str) -> str:
    if text.startswith(MESH):
        return text
    path = os.path.abspath(text)
    if MESH not in path and not os.path.isfile(path):
        raise UsageError(f"there is no file '{text}' for --{name.replace('_', '-')}")
    return path
