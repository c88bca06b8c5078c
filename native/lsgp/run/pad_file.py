# SPDX-License-Identifier: GPL-3.0-or-later
"""A texture in, the same texture with gutters that hold what lies beyond the cuts out."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ..gutters import pad_image
from ..io.image_files import format_image, read_image
from ..io.whole_files import write_whole
from .unwrap_file import Run, read_file, uv_of


def add_pad_options(pad: argparse.ArgumentParser) -> None:
    """The arguments of padding, which args of `pad_file` have."""
    pad.add_argument("input", metavar="IMAGE", type=Path, help="PNG, 8 or 16 bits, or TIFF, these or floating point")
    pad.add_argument(
        "--uv",
        metavar="FILE",
        type=Path,
        required=True,
        help="the mesh with its texture coordinates: OBJ, glTF or GLB, or - for standard input",
    )
    pad.add_argument("--margin", metavar="N", type=float, required=True, help="width of the gutters, in pixels")
    pad.add_argument(
        "--normal-map",
        action="store_true",
        help="the image is a tangent-space normal map, green up: rotate its normals with the map",
    )
    pad.add_argument("-o", "--output", metavar="OUT", type=Path, required=True, help="PNG or TIFF, by its suffix")


def pad_file(args: argparse.Namespace, run: Run) -> str:
    """Pad args.input into args.output; returns the line for people.  Raises OSError, LsgpError."""
    image = read_image(args.input)
    file = read_file(args.uv, run, args.format, with_uv=True)
    corner_uv = uv_of(file, "use")
    with run.stage("pad_image"):
        padded = pad_image(image, file.surface(), corner_uv, args.margin, normal_map=args.normal_map)
    write_whole(args.output, format_image(padded, args.output))
    changed = padded != image
    texels = int(np.count_nonzero(changed.any(axis=2) if changed.ndim == 3 else changed))
    height, width = image.shape[:2]
    return f"{args.output}: {width} x {height} texels, {texels} of them changed"
