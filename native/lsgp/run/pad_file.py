# SPDX-License-Identifier: GPL-3.0-or-later
"""A texture in, the same texture with gutters that hold what lies beyond the cuts out."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from ..base.progress import Progress
from ..images.mip_levels import pad_mip_levels
from ..io.image_files import format_image, read_image
from ..io.side_files import UsageError
from ..io.whole_files import write_all_whole
from .named_files import NamedFile, Reads, Writes
from .unwrap_file import Run, read_file, uv_of

# Bilinear lookups and the box of the next level read less than this beyond an island, in pixels.
LEAST_MIP_MARGIN = 2.0


def add_pad_options(pad: argparse.ArgumentParser) -> None:
    """The arguments of padding, which args of `pad_file` have."""
    pad.add_argument(
        "input",
        metavar="IMAGE",
        action=Reads,
        type=Path,
        help="PNG, 8 or 16 bits, or TIFF, these or floating point",
    )
    pad.add_argument(
        "--uv",
        metavar="FILE",
        action=Reads,
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
    pad.add_argument(
        "--mips",
        metavar="N",
        type=int,
        default=0,
        help="also write the mip levels 1 to N, their gutters filled as well: OUT-mip1.png, OUT-mip2.png, ...",
    )
    pad.add_argument(
        "-o", "--output", metavar="OUT", action=Writes, type=Path, required=True, help="PNG or TIFF, by its suffix"
    )


def pad_file(args: argparse.Namespace, run: Run, progress: Progress | None = None) -> str:
    """Pad args.input into args.output; returns the line for people.  Raises OSError, LsgpError."""
    if args.mips < 0:
        raise UsageError(f"--mips {args.mips} is below 0; give how many mip levels to write")
    if not 0 <= args.margin < math.inf:
        raise UsageError(f"--margin {args.margin:g} is no width; give pixels, 0 or more")
    image = read_image(args.input)
    height, width = image.shape[:2]
    most = max(height, width).bit_length() - 1
    if args.mips > most:
        raise UsageError(f"--mips {args.mips}: an image of {width} x {height} pixels has {most}; give no more")
    file = read_file(args.uv, run, args.format, with_uv=True)
    corner_uv = uv_of(file, "use")
    margins = _margins(args.margin, args.mips)
    with run.stage("pad_image"):
        levels = pad_mip_levels(
            image, file.surface(), corner_uv, margins, normal_map=args.normal_map, progress=progress
        )
    paths = [args.output, *mip_paths(args.output, args.mips)]
    contents = [format_image(level, path) for level, path in zip(levels, paths, strict=True)]
    write_all_whole(list(zip(paths, contents, strict=True)))
    changed = levels[0] != image
    texels = int(np.count_nonzero(changed.any(axis=2) if changed.ndim == 3 else changed))
    written = f", and mip levels 1 to {args.mips}" if args.mips else ""
    return f"{args.output}: {width} x {height} texels, {texels} of them changed{written}"


def mip_files(args: argparse.Namespace) -> list[NamedFile]:
    """The files that --mips names."""
    return [NamedFile("--mips", path, is_written=True) for path in mip_paths(args.output, args.mips)]


def mip_paths(output: Path, count: int) -> list[Path]:
    """Where the mip levels 1 to count go."""
    return [output.with_name(f"{output.stem}-mip{level}{output.suffix}") for level in range(1, count + 1)]


def _margins(margin: float, mips: int) -> list[float]:
    """Those of all levels: the same part of the texture, but no less than filters read."""
    return [margin, *(min(margin, max(margin / 2**level, LEAST_MIP_MARGIN)) for level in range(1, mips + 1))]
