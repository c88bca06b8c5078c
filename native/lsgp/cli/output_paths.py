# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a command's paths before the work begins."""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path

from ..io.image_files import require_image_suffix
from ..io.mesh_formats import BY_KEY, output_format
from ..io.safe_files import is_same_file, is_standard_stream, require_separate, require_writable_kind
from ..io.side_files import UsageError
from ..run.named_files import named_files, require_separate_files
from ..run.pad_file import mip_files
from ..run.quads_file import require_quads_output


def require_usable_paths(args: argparse.Namespace) -> None:
    """Raise UsageError or OSError where what a command writes cannot be written, or would be written over a file that
    another argument names; with --in-place alone the output becomes the input.

    args: input, output and report, format, and whether the result may be written over the input.
    """
    files = named_files(args)
    if args.command == "unwrap":
        _choose_output(args)
        require_separate(args.input, args.output, in_place=args.in_place)
        if args.in_place:
            files.pop("output", None)  # which is the input
            files["input"] = replace(files["input"], is_written=True)
    every = [*files.values(), *(mip_files(args) if args.command == "pad" else ())]
    require_separate_files(every)
    if is_standard_stream(args.output) and is_standard_stream(args.report):
        raise UsageError("the output and --report are both -, standard output; name a file for one of them")
    if args.command == "unwrap":
        output_format(None if is_standard_stream(args.output) else args.output, args.format)
        if args.picture is not None and args.picture.suffix.lower() != ".png":
            raise UsageError(f"the picture is a PNG file; name it .png, not '{args.picture}'")
    elif args.command == "quads":
        require_quads_output(args)
    elif args.command == "pad":
        require_image_suffix(args.input, "the image")
        require_image_suffix(args.output, "the output")
    elif args.output is not None and args.output.suffix.lower()[1:] in BY_KEY:
        raise UsageError(f"the output is JSON; name it .json, not '{args.output}'")
    for file in every:
        if file.is_written and not is_standard_stream(file.path):
            _require_writable(file.path)


def _choose_output(args: argparse.Namespace) -> None:
    if args.in_place and is_standard_stream(args.input):
        raise UsageError("--in-place is for files; give the path of the input")
    if args.output is None and not args.in_place:
        raise UsageError("where to write to is missing: -o/--output, or --in-place")
    if args.output is None:
        args.output = args.input
    if args.in_place and not is_same_file(args.input, args.output):
        raise UsageError(f"--in-place writes over the input, not to '{args.output}'; leave out one of the two")


def _require_writable(path: Path) -> None:
    require_writable_kind(path)
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise UsageError(f"'{path}' is a folder")
    is_device = target.exists() and not target.is_file()
    if not is_device and not target.parent.is_dir():  # devices of Windows are in no folder
        raise UsageError(f"there is no folder '{target.parent}' to write '{path.name}' to; make it, or name another")
    if is_device and os.name == "nt":
        return  # Windows does not tell
    # A file is replaced through its folder; a device is written to.
    touched = [target] if target.exists() else []
    if not is_device:
        touched.append(target.parent)
    if not all(os.access(place, os.W_OK) for place in touched):
        raise UsageError(f"'{path}' cannot be written")
