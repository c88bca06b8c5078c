# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of an unwrap, declared once for all commands, and their conversion to the library's.

Their values are plain text, numbers and truth values, so that they can be handed to other processes and machines.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import fields, replace
from pathlib import Path
from typing import get_args

import numpy as np

from ..api import cut_costs
from ..base.arguments import FloatArray, IndexArray
from ..errors import InputError
from ..io.side_files import CutCostFile, UsageError, load_cut_costs
from ..layouts.inside import LEAST_SHARE
from ..layouts.packing import SHELVES, Effort, Pack, Packing, Stack
from ..layouts.texels import DEFAULT_MARGIN, MOST_TILES, TexelLayout
from ..options import (
    BorderMode,
    CoarseGrid,
    Compactness,
    FeaturePlaces,
    Lattice,
    Method,
    Mode,
    Options,
    Overlaps,
    PrescriptionRule,
    Seamless,
    SeamMode,
    UnfoldMethod,
)
from ..presets.auto_unwrap import Preset, Weights, preset_effort, preset_options, preset_weights
from ..stitching import at_stitched
from ..surface import Surface
from .direction_options import add_direction_options, require_finite_up
from .feature_options import add_features_option
from .named_files import Reads

DEFAULT_TEXTURE_SIZE = 1024
LARGEST_TEXTURE_SIZE = 65536

# Of most exporters of OBJ and of glTF.
DEFAULT_FRONT = (0.0, 0.0, 1.0)
DEFAULT_UP = (0.0, 1.0, 0.0)

# Of a cut per length.
MOST_COST = 1e6

AUTO, AUTO_COUNT = "auto", "auto:"

# Options that are fields of `Seamless` under the same names.
_OF_TILES = ("tiles", "tile_size", "lattice", "parity", "feature_places", "coarse_grid")


# What presets do unless --no-NAME is given: the presets that do it, and what the option changes.
_PRESET_SWITCHES = {
    "creases": (
        "paint, tile or bake",
        "do not cut hard surfaces at their creases, so that the texture continues across them; by default paint and "
        "bake cut there where hardly any stretch remains, and tile where creases cannot run along the tiles",
    ),
    "straighten": (
        "paint, tile or bake",
        "leave nearly straight boundaries and cuts of the layout as they are; by default paint and bake make them "
        "exactly straight and align them with u and v where that costs hardly any stretch, and with tile creases of "
        "hard surfaces run along the tiles where that costs at most a tenth of L2 stretch",
    ),
    "symmetric": (
        "paint, tile or bake",
        "place cones without regard to symmetry; by default they are alike on both sides of a mirror plane where that "
        "costs little",
    ),
}


def add_unwrap_options(unwrap: argparse.ArgumentParser) -> None:
    unwrap.add_argument(
        "--preset",
        choices=get_args(Preset),
        help="a map ready for use: cones from a file are kept, components with too few get more, no island overlaps "
        "itself, and lengths are preserved (paint, bake) or a tileable texture of squares shows no seam (tile); "
        "explicit options override those of the preset (default: none)",
    )
    add_cones_option(unwrap)
    unwrap.add_argument(
        "--weights",
        metavar="NAME=W,...",
        type=_weights,
        help="with --preset: what it chooses by, in hundredths of L2 stretch: islands and cones (each one), cuts and "
        "borders at creases (as long as the root of the area), square (as much of it left empty as is filled), "
        "symmetry; see --explain (default: those of the preset)",
    )
    unwrap.add_argument(
        "--prescription",
        choices=get_args(PrescriptionRule),
        help="how cone angles are chosen (default: the cone_angles of the cones file where it has them, otherwise "
        "least-distortion)",
    )
    unwrap.add_argument(
        "--unfold",
        choices=get_args(UnfoldMethod),
        default="poisson",
        help="integrate the prescribed metric by one linear solve, or compute the smallest conformal eigenvector as "
        "in the paper, on closed surfaces (default: poisson)",
    )
    unwrap.add_argument(
        "--method",
        choices=get_args(Method),
        default="lsgp",
        help="relate the sides of every cut by one rotation and translation, or, for comparison, unfold along the same "
        "cuts by least squares conformal maps without transitions (default: lsgp)",
    )
    unwrap.add_argument(
        "--seam-edges",
        metavar="FILE.json",
        action=Reads,
        help="[[a, b], ...]: marked edges, with the meaning given by --seams",
    )
    unwrap.add_argument(
        "--seams",
        choices=get_args(SeamMode),
        default="follow",
        help="meaning of marked edges: follow: cut, others only where parts that they bound, or cones, need it; exact: "
        "nothing else is cut; boundary: open, also on components with cones; or ignore (default: follow)",
    )
    add_cut_options(unwrap)
    add_features_option(
        unwrap,
        "edges that run straight along u or v, as far as they do not contradict each other and cost at most a tenth of "
        "L2 stretch",
    )
    add_direction_options(
        unwrap,
        "islands are rotated so that the texture's v follows it; 0 0 0: any rotation (default: with --preset tile "
        "0 1 0; otherwise packed islands have 0 1 0 pointing up as far as quarter turns take no room)",
        "v",
    )
    add_stitch_option(unwrap, default=None)
    _add_preset_switches(unwrap)
    unwrap.add_argument(
        "--border",
        choices=get_args(BorderMode),
        default="free",
        help="boundaries take the shape of least distortion, or are straight from cone to cone (default: free)",
    )
    add_mode_option(unwrap)
    unwrap.add_argument(
        "--no-repair",
        dest="repair",
        action="store_false",
        help="do not repair flipped triangles and angles that are off by a full turn",
    )
    unwrap.add_argument(
        "--no-follow-strokes",
        dest="follow_strokes",
        action="store_false",
        help="with --directions: only turn islands; by default automatic cone angles are chosen for several strokes as "
        "well, where that costs at most a tenth of L2 stretch",
    )
    unwrap.add_argument(
        "--overlaps",
        choices=get_args(Overlaps),
        help="keep islands that overlap themselves, or split them along further cuts (default: keep)",
    )
    unwrap.add_argument(
        "--compact",
        choices=get_args(Compactness),
        help="cut islands further that would leave much of the square empty: sparing, only where a short cut fills "
        "much of it, or full, wherever that is worth it (default: full with --preset bake, sparing with paint, else "
        "off)",
    )
    unwrap.add_argument(
        "--in-place",
        action="store_true",
        help="overwrite the input, which is kept as a backup until the result is complete",
    )
    unwrap.add_argument(
        "--time-limit",
        metavar="S",
        type=seconds_option,
        help="seconds after which the best map made until then is written, with the warning TIME_LIMIT; an error where "
        "there is none yet, as before the map of given cones without --preset (default: none)",
    )
    add_strict_option(unwrap, "layout", "tiny islands, ")
    _add_low_stretch_options(unwrap)
    _add_seamless_options(unwrap)
    _add_texel_options(unwrap)
    _add_pack_option(unwrap)


def _add_preset_switches(unwrap: argparse.ArgumentParser) -> None:
    for name, (_, text) in _PRESET_SWITCHES.items():
        unwrap.add_argument(f"--no-{name}", dest=name, action="store_false", help=f"with --preset: {text}")


def add_cones_option(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--cones",
        metavar="FILE.json|auto|auto:N",
        action=_ReadsCones,
        type=_cones_option,
        default=AUTO,
        help='{"cones": [vertices, from 0], "cone_angles": [radians or null], "angles_over_pi_2": [quarter turns]}, '
        "angles optional; or cones placed automatically, N on each component (default: auto)",
    )


def add_mode_option(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--mode",
        choices=get_args(Mode),
        help="preserve angles, or lengths as far as the cone angles permit (default: conformal)",
    )


def add_stretch_option(command: argparse._ActionsContainer) -> None:
    command.add_argument(
        "--stretch",
        metavar="S",
        type=float,
        help="from 0, the conformal map, to 1, the map of least stretch (default: 1)",
    )


def add_cut_options(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--cuts",
        choices=["hidden", "sharp", "shortest"],
        default="hidden",
        help="route of the cuts: hidden from the front and along creases, along creases only, or the shortest; "
        "automatic cones are placed accordingly, and the map of given cones is the same (default: hidden)",
    )
    command.add_argument(
        "--front",
        metavar=("X", "Y", "Z"),
        nargs=3,
        type=float,
        help="with --cuts hidden: the direction from the model to the viewer (default: 0 0 1)",
    )
    command.add_argument(
        "--cut-costs",
        metavar="FILE",
        action=Reads,
        help='lines "a b cost": cost per length, 0 to 1e6, of a cut along the edge between two vertices, counted from '
        "0, in place of that by --cuts, which is 0.01 to 30; or one number for each vertex, from 0, which attracts "
        "cuts, to 1, which repels them; or the same as [[a, b, cost], ...] or [number, ...]",
    )


def require_cut_options(args: argparse.Namespace) -> None:
    """Raises UsageError where they do not go together."""
    if args.front is not None and args.cuts != "hidden":
        raise UsageError("--front is for cuts that hide from it; add --cuts hidden")


def cut_costs_of(args: argparse.Namespace, surface: Surface, stitched: IndexArray) -> FloatArray | None:
    """What cuts along the surface's edges cost, for `Surface.cut_costs`.  Raises OSError, UsageError, LsgpError.

    stitched: as of the surface's `MeshFile`.
    """
    given = None if args.cut_costs is None else load_cut_costs(Path(args.cut_costs))
    if args.cuts == "shortest" and given is None:
        return None
    front = None if args.cuts in {"sharp", "shortest"} else args.front or DEFAULT_FRONT
    paint = None if given is None else given.paint
    if paint is not None and len(paint) != len(surface.positions):
        raise InputError(
            "WRONG_PARAMETER",
            f"'{args.cut_costs}' has {len(paint)} numbers for {len(surface.positions)} vertices. Give one for each, or "
            "lines of two vertices and a cost.",
        )
    costs = cut_costs(surface, front, creases=args.cuts != "shortest", paint=paint)
    return costs if given is None else _with_given_costs(surface, costs, given, args.cut_costs, stitched)


def _with_given_costs(
    surface: Surface, costs: FloatArray, given: CutCostFile, path: str, stitched: IndexArray
) -> FloatArray:
    """Costs with those of a file in their place.  Raises InputError."""
    edges = np.sort(surface.edges, axis=1).astype(np.int64)
    pairs = np.sort(at_stitched(stitched, given.pairs), axis=1)
    keys = edges[:, 0] << 32 | edges[:, 1]
    order = np.argsort(keys, kind="stable")
    outside = ((pairs < 0) | (pairs >= len(surface.positions))).any(axis=1)
    wanted = np.where(outside, -1, pairs[:, 0] << 32 | pairs[:, 1])
    place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    rows = order[place]
    for row in np.flatnonzero(keys[rows] != wanted)[:1].tolist():
        a, b = given.pairs[row].tolist()
        raise InputError(
            "EDGE_NOT_IN_MESH",
            f"'{path}' does not hold the costs of cuts. Line {given.lines[row]}: there is no edge from vertex {a} to "
            f"{b}. Name edges of the file's faces by vertices counted from 0.",
        )
    for row in np.flatnonzero(~((given.costs >= 0) & (given.costs <= MOST_COST)))[:1].tolist():
        raise InputError(
            "WRONG_PARAMETER",
            f"'{path}' does not hold the costs of cuts. Line {given.lines[row]}: {given.costs[row]:.6g} does not lie "
            "between 0 and 1e6. Correct the file.",
        )
    costs = costs.copy()
    costs[rows] = given.costs
    return costs


def add_stitch_option(command: argparse.ArgumentParser, *, default: bool | None) -> None:
    """default: whether boundaries are stitched without it; None: with a preset."""
    told = {True: "they are stitched", False: "they stay open", None: "with --preset they are stitched"}
    command.add_argument(
        "--stitch",
        action=argparse.BooleanOptionalAction,
        help="whether boundaries that lie exactly on each other are none, as in files that repeat vertices wherever "
        f"normals or texture coordinates differ (default: {told[default]})",
    )
    command.set_defaults(stitch=default)  # as an argument above, it would be in the help once more


def stitches(args: argparse.Namespace) -> bool:
    """Whether boundaries of the mesh are stitched."""
    return args.preset is not None if args.stitch is None else args.stitch


def add_threads_option(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--threads",
        metavar="N",
        type=int,
        default=0,
        help="number of threads for meshes of tens of thousands of triangles and more, up to 1024; the result is the "
        "same for any number (default: the environment variable LSGP_THREADS, or else the number of processors)",
    )


def up_of(args: argparse.Namespace) -> FloatArray | None:
    """The model's up, along which v is to run; None where it does not matter."""
    default = DEFAULT_UP if args.preset == "tile" and args.directions is None else (0.0, 0.0, 0.0)
    up = np.array(default if args.up is None else args.up)
    return up if up.any() else None


def add_strict_option(command: argparse.ArgumentParser, result: str, further_flaws: str = "") -> None:
    command.add_argument(
        "--strict",
        action="store_true",
        help=f"refuse a {result} with flipped triangles, wrong or inexact angles, inexact seams, "
        f"{further_flaws}components or faces left out, or cones that miss the target, instead of warning: exit code 3, "
        "and no file but the report",
    )


def _add_low_stretch_options(unwrap: argparse.ArgumentParser) -> None:
    low_stretch = unwrap.add_argument_group("with --mode low-stretch")
    add_stretch_option(low_stretch)
    low_stretch.add_argument(
        "--importance",
        metavar="FILE",
        action=Reads,
        help="weight of stretch at each vertex, numbers from 0 up, as text or [number, ...] (default: equal weights)",
    )


def _add_seamless_options(unwrap: argparse.ArgumentParser) -> None:
    unwrap.add_argument(
        "--seamless",
        action="store_true",
        default=None,
        help="round angles and translations so that a tileable texture shows no seam; coordinates are in tiles",
    )
    seamless = unwrap.add_argument_group("with --seamless")
    scale = seamless.add_mutually_exclusive_group()
    scale.add_argument(
        "--tiles",
        metavar="N",
        type=float,
        help="tiles along the layout's longer side (default: as few as cost at most a tenth in distortion)",
    )
    scale.add_argument("--tile-size", metavar="X", type=float, help="side of a tile on the surface, in its unit")
    seamless.add_argument(
        "--lattice",
        choices=get_args(Lattice),
        help="the texture's symmetry: rotations of squares by quarter turns (square), by half turns (stripe) or none "
        "(translation), of triangles by third turns (triangle) or sixth turns (hexagon) (default: square)",
    )
    seamless.add_argument(
        "--parity", action="store_true", default=None, help="the black and white squares of a checker match as well"
    )
    seamless.add_argument(
        "--feature-places",
        choices=get_args(FeaturePlaces),
        help="where features and creases along the tiles lie: anywhere, or between half or whole tiles, which may be "
        "smaller for it, at a cost of up to a fifth of L2 stretch instead of a tenth (default: anywhere)",
    )
    seamless.add_argument(
        "--coarse-grid",
        choices=get_args(CoarseGrid),
        help="if the tiles are too large for a valid layout: take smaller tiles, merge cones less than a tile apart, "
        "or leave cones off the grid (default: refine)",
    )
    seamless.add_argument(
        "--texture-size",
        metavar="T",
        type=texture_size_option,
        help=f"the texture's side in texels, a power of two, for errors given in texels "
        f"(default: {DEFAULT_TEXTURE_SIZE}); also for --texel-density, --udim and tight layouts",
    )
    seamless.add_argument(
        "--mip-levels",
        metavar="L",
        type=int,
        help="use cells of 2^L texels instead of whole tiles, for a texture that repeats in such cells; its first L "
        "mipmaps match as well",
    )


def _add_texel_options(unwrap: argparse.ArgumentParser) -> None:
    texels = unwrap.add_argument_group("texel density")
    texels.add_argument(
        "--texel-density",
        metavar="D",
        type=_density_option,
        help="texels per unit of length on the surface, with --texture-size: the layout has this scale instead of "
        "filling the unit square; each tile of a seamless layout is one texture, with this scale before rounding",
    )
    texels.add_argument(
        "--udim",
        metavar="N",
        type=_tiles_option,
        help="spread the islands over at most N UDIM tiles 1001, 1002, ..., each island inside one tile of the "
        "texture's size: in rows with --texel-density; without it as large as possible (default: one square)",
    )
    texels.add_argument(
        "--margin",
        metavar="M",
        type=_margin_option,
        help="with --udim and tight layouts: texels around each island "
        f"(default: {DEFAULT_MARGIN:.0f}, of {DEFAULT_TEXTURE_SIZE} without --texture-size)",
    )


def _add_pack_option(unwrap: argparse.ArgumentParser) -> None:
    unwrap.add_argument(
        "--pack",
        choices=get_args(Pack),
        help="pack islands tightly, or in rows (shelves) (default: tight with --preset paint and bake, otherwise "
        "shelves)",
    )
    unwrap.add_argument(
        "--stack",
        choices=get_args(Stack),
        help="in tight layouts, lay islands of one shape on each other, so that they share their texels: same ones, or "
        "mirrored ones as well (default: none)",
    )
    unwrap.add_argument(
        "--inside",
        metavar="F",
        type=_inside_option,
        help="in tight layouts, texel density of islands that nothing outside can see, relative to that of the others, "
        f"for instance 0.25; {LEAST_SHARE} to 1 (default: the same)",
    )
    unwrap.add_argument(
        "--effort",
        choices=get_args(Effort),
        help="of packing tight layouts: the first one that is found, the best of some hundreds, or of many more, for "
        "minutes (default: quick with paint, otherwise good)",
    )


def _inside_option(text: str) -> float:
    share = _number(text)
    if not LEAST_SHARE <= share <= 1:
        raise argparse.ArgumentTypeError(f"'{text}': F is a share of the texel density, {LEAST_SHARE} to 1")
    return share


def texture_size_option(text: str) -> int:
    size = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
    if not (1 <= size <= LARGEST_TEXTURE_SIZE and size.bit_count() == 1):
        raise argparse.ArgumentTypeError(f"'{text}': T is a power of two, at most {LARGEST_TEXTURE_SIZE}")
    return size


def _density_option(text: str) -> float:
    density = _number(text)
    if not 0 < density < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}': D is a number of texels above 0")
    return density


def _margin_option(text: str) -> float:
    margin = _number(text)
    if not 0 <= margin < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}': M is a number of texels, 0 or more")
    return margin


def _tiles_option(text: str) -> int:
    tiles = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
    if not 1 <= tiles <= MOST_TILES:
        raise argparse.ArgumentTypeError(f"'{text}': N is a number of tiles from 1 to {MOST_TILES}")
    return tiles


def _number(text: str) -> float:
    """NaN where the text is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _cones_option(text: str) -> str:
    if text.startswith(AUTO_COUNT):
        count = text.removeprefix(AUTO_COUNT)
        if not (count.isascii() and count.isdigit() and len(count) < 10):
            raise argparse.ArgumentTypeError(f"'{text}': N in auto:N is a number of cones, 0 or more")
    return text


class _ReadsCones(Reads):
    """Some values ask for automatic cones instead of naming a file."""

    @staticmethod
    def path_in(value: str) -> Path | None:
        return None if value == AUTO or value.startswith(AUTO_COUNT) else Path(value)


def cones_file(args: argparse.Namespace) -> Path | None:
    """The cones file; None where cones are placed automatically."""
    return _ReadsCones.path_in(args.cones)


def cone_count(args: argparse.Namespace) -> int | None:
    """How many cones are to be placed automatically on each component; None where that is left to the library."""
    return int(args.cones.removeprefix(AUTO_COUNT)) if args.cones.startswith(AUTO_COUNT) else None


def seconds_option(text: str, below: float = math.inf) -> float:
    seconds = _number(text)
    if not 0 < seconds < below:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds")
    return seconds


def _weights(text: str) -> dict[str, float]:
    """NAME=W,... as a dictionary.  Raises ArgumentTypeError."""
    out = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        try:
            out[name] = float(value)
            Weights(**{name: out[name]})
        except (ValueError, TypeError, InputError) as error:
            names = ", ".join(field.name for field in fields(Weights))
            raise argparse.ArgumentTypeError(
                f"'{part}' is no weight; give NAME=W with a number from 0 up, NAME one of {names}"
            ) from error
    return out


def weights_of(args: argparse.Namespace) -> Weights | None:
    """What the preset chooses by; None without one.  Raises UsageError where weights are given without a preset."""
    if args.preset is None:
        if args.weights is not None:
            raise UsageError("--weights are those of a preset; add --preset, or leave them out")
        return None
    return replace(preset_weights(args.preset), **(args.weights or {}))


def tries_symmetry(args: argparse.Namespace) -> bool:
    """Whether cones are placed symmetrically where that costs little."""
    return bool(args.symmetric) and args.preset is not None and cone_count(args) is None


def _is_seamless(args: argparse.Namespace) -> bool:
    return bool(args.seamless) or args.preset == "tile"


def texture_size(args: argparse.Namespace) -> int:
    """Side of the texture, in texels, that errors are given for."""
    return DEFAULT_TEXTURE_SIZE if args.texture_size is None else args.texture_size


def texel_layout(args: argparse.Namespace) -> TexelLayout | None:
    """The layout at a texel density; None where none is asked for, or by the size of tiles of a seamless layout.

    Raises UsageError where options do not fit.
    """
    if args.margin is not None and args.udim is None and _pack(args) != "tight":
        raise UsageError("--margin is for UDIM tiles or tight layouts; add --udim or --pack tight")
    if args.texel_density is None:
        return None
    if args.texture_size is None:
        raise UsageError("--texel-density needs the size of the texture; add --texture-size")
    if _is_seamless(args):
        return None
    margin = DEFAULT_MARGIN if args.margin is None else args.margin
    if args.udim is not None and 2 * margin >= args.texture_size:
        raise UsageError(f"--margin {margin:g}: a tile of {args.texture_size} texels has no room between its margins")
    return TexelLayout(args.texel_density, args.texture_size, args.udim, margin)


def _pack(args: argparse.Namespace) -> Pack | None:
    """As of `Packing`. Presets that pack tightly do so with the margin that is asked for, and never on shelves then."""
    by_preset = args.preset is not None and not _is_seamless(args) and args.udim is None
    has_margin = args.margin is not None or (args.texture_size is not None and args.texel_density is None)
    return "tight" if args.pack is None and by_preset and has_margin else args.pack


def packing_of(args: argparse.Namespace) -> Packing | None:
    """How islands are packed; None where they have to stay as they come.

    Raises UsageError where options do not fit.
    """
    if _is_seamless(args):
        for name in ("pack", "udim", "stack", "inside", "effort"):
            if getattr(args, name) is not None:
                raise UsageError(f"--{name} is for layouts that are not seamless; leave it out")
        return None
    pack = _pack(args)
    if args.inside is not None and args.texel_density is not None:
        raise UsageError("--inside and --texel-density both say how large islands are; leave one out")
    for name in ("stack", "inside", "effort"):
        is_given = getattr(args, name) is not None
        if is_given and pack != "tight" and (pack or not (args.preset or args.udim)):
            raise UsageError(f"--{name} is for tight layouts; add --pack tight")
        if is_given and args.udim is not None and args.texel_density is not None:
            raise UsageError(
                f"--{name} is for islands that are not in rows; leave it out, or --texel-density or --udim"
            )
    if args.udim is not None and args.texel_density is not None:
        if pack is not None:
            raise UsageError("--pack is for islands that are not in rows; leave it out, or --texel-density or --udim")
        return None
    if args.udim is not None and pack == SHELVES:
        raise UsageError("--udim makes a tight layout; leave --pack shelves out, or add --texel-density instead of it")
    if pack is None and args.preset is None and args.udim is None:
        return None
    margin = None if args.margin is None else args.margin / texture_size(args)
    if (pack == "tight" or args.udim is not None) and margin is None and args.texture_size is not None:
        margin = DEFAULT_MARGIN / args.texture_size
    if margin is not None and margin >= 0.5:
        raise UsageError(
            f"--margin {margin * texture_size(args):g}: a texture of {texture_size(args)} texels has no room"
        )
    effort = args.effort
    if effort is None and args.preset is not None and pack != SHELVES:
        effort = preset_effort(args.preset)
    up = DEFAULT_UP if args.up is None else tuple(args.up)
    return Packing(pack, margin, args.udim, args.stack, effort, up if any(up) else None, args.inside)


def library_options(args: argparse.Namespace) -> Options:
    """The options as the library takes them.  Raises UsageError where they do not go together; InputError."""
    if args.prescription == "manual" and cones_file(args) is None:
        raise UsageError("--prescription manual needs a cones file with angles; give one with --cones FILE.json")
    require_cut_options(args)
    require_finite_up(args)
    for name, (presets, _) in _PRESET_SWITCHES.items():
        if args.preset is None and not getattr(args, name):
            raise UsageError(f"--no-{name} is for presets; add --preset {presets}")
    texel_layout(args)
    packing_of(args)
    base = Options() if args.preset is None else preset_options(args.preset)
    mode = base.mode if args.mode is None else args.mode
    if mode != "low-stretch":
        for name in ("stretch", "importance"):
            if getattr(args, name) is not None:
                raise UsageError(f"--{name} is for maps of low stretch; add --mode low-stretch")
    seamless = _seamless(args, base.seamless)
    if args.features is not None and seamless is None and mode != "low-stretch":
        raise UsageError(
            "--features is for seamless layouts and maps of low stretch; add --seamless or --mode low-stretch"
        )
    return replace(
        base,
        prescription=args.prescription,
        unfold=args.unfold,
        method=args.method,
        seams=args.seams,
        border=args.border,
        seamless=seamless,
        mode=mode,
        stretch=base.stretch if args.stretch is None else args.stretch,
        straighten=base.straighten and args.straighten,
        repair=args.repair,
        follow_strokes=args.follow_strokes,
        overlaps=base.overlaps if args.overlaps is None else args.overlaps,
        compact=(base.compact if seamless is None else "off") if args.compact is None else args.compact,
        square_share=1.0 if args.udim is None else float(args.udim),
    )


def _seamless(args: argparse.Namespace, preset: Seamless | None) -> Seamless | None:
    """Raises UsageError where the options for seamless layouts do not fit.  preset: what it says of them."""
    base = Seamless() if args.seamless else preset
    if base is None:
        for name in (*_OF_TILES, "texture_size", "mip_levels"):
            if getattr(args, name) is None:
                continue
            if name != "texture_size":
                raise UsageError(f"--{name.replace('_', '-')} is for seamless layouts; add --seamless")
            if args.texel_density is None and args.udim is None and _pack(args) != "tight":
                raise UsageError(
                    "--texture-size is for margins, texel densities and seamless layouts; add --pack tight, --udim, "
                    "--texel-density or --seamless"
                )
        return None
    wanted = {name: getattr(args, name) for name in _OF_TILES}
    if args.texel_density is not None:
        if args.tiles is not None or args.tile_size is not None:
            raise UsageError("--texel-density says how large tiles are; leave --tiles and --tile-size out")
        wanted["tile_size"] = texture_size(args) / args.texel_density
    return replace(base, **{name: value for name, value in wanted.items() if value is not None}, cell=_cell(args))


def _cell(args: argparse.Namespace) -> float:
    """The side of a cell in texture coordinates.  Raises UsageError where the texture has no such level."""
    if args.mip_levels is None:
        return 1.0
    size = texture_size(args)
    most = size.bit_length() - 1
    if not 0 <= args.mip_levels <= most:
        raise UsageError(f"--mip-levels {args.mip_levels}: a texture of {size} texels a side has levels 0 to {most}")
    return 2.0**args.mip_levels / size
