# SPDX-License-Identifier: GPL-3.0-or-later
"""The command of Blender's command line: `blender --background --command cone_unwrap LIST|FOLDER --out DIR`."""

from __future__ import annotations

import argparse
import sys

import bpy

from ...core import native
from ...core.identifiers import COMMAND, EXTENSION
from . import asset, files

WORKER = "--worker"

# Program of a worker in a Python with bpy; its arguments are the names of the add-on and of this module, and WORKER.
PYTHON_WORKER = """
import os, sys
from importlib import import_module
import bpy
bpy.ops.preferences.addon_enable(module=sys.argv[1])
os._exit(import_module(sys.argv[2]).run([sys.argv[3]]))
"""

_registered = []


def register() -> None:
    _registered.append(bpy.utils.register_cli_command(COMMAND, run))


def unregister() -> None:
    bpy.utils.unregister_cli_command(_registered.pop())


def run(arguments: list[str]) -> int:
    """Run the command with these arguments and return its exit code, one of those of `lsgp batch`."""
    if native.PROBLEM:
        print(f"{COMMAND}: error: {native.PROBLEM}", file=sys.stderr)
        return 2
    if arguments == [WORKER]:
        native.part("batch.worker").serve(asset.unwrap_asset)
    command = native.part("batch.command")
    kind = command.Kind(files.SUFFIXES, files.output_name, _worker())
    return command.main(arguments, kind, _parser())


def _parser() -> argparse.ArgumentParser:
    command, unwrap_options = native.part("batch.command"), native.part("run.unwrap_options")
    parser = argparse.ArgumentParser(
        prog=COMMAND,
        allow_abbrev=False,
        description="Unwrap the meshes of all .blend, .glb, .gltf and .fbx files of a folder or a list. Cones, their "
        "angles, seams and pins are those on the meshes; where a mesh has no cones, --cones auto says how many are "
        "placed. Every file gets a line in DIR/journal.jsonl when it has ended; DIR/summary.txt and "
        "DIR/contact-sheet.html are written at the end.",
        epilog=command.EXIT_CODES,
    )
    command.add_batch_options(parser)
    unwrap_options.add_unwrap_options(parser)
    parser.set_defaults(scheduler=None)
    return parser


def _worker() -> list[str]:
    """The command line that starts a worker: this Blender, or this Python where bpy is a module."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--command", COMMAND, WORKER]
    return [sys.executable, "-P", "-c", PYTHON_WORKER, EXTENSION, __name__, WORKER]
