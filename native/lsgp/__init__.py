# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps whose textures continue across the seams: cone parameterization with exact affine transitions.

A map in one call, here of a tetrahedron:

>>> import lsgp
>>> surface = lsgp.Surface(
...     positions=[[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]],  # (n, 3), any unit
...     triangles=[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],  # (m, 3), counter-clockwise from outside
... )
>>> result = lsgp.auto_unwrap(surface, preset="paint")
>>> result.corner_uv.shape  # one (u, v) per triangle corner
(4, 3, 2)

The same step by step, with cones placed automatically and all options:

>>> placed = lsgp.place_cones(surface)
>>> options = lsgp.Options(mode="low-stretch")
>>> result = lsgp.parameterize(surface, placed.cones, placed.cone_angles, options)
>>> len(result.flipped), round(result.distortion.l2_stretch, 3)
(0, 1.0)

Further functions: `read_mesh_file` and `write_mesh_file` for meshes in files, `Solver` for repeated maps of one
surface, `measure_distortion` for existing coordinates, `draw_layout`, `pack_islands`, `pad_image` and `extract_quads`.
Every error is an `LsgpError` with a code, a message and the elements concerned. The command `lsgp` does the same for
files.

The method: Vintescu, Dupont, Lavoué, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG
2017.
"""

from importlib.metadata import version

from . import certificate, lattice
from .api import (
    Preview,
    Solver,
    cone_gains,
    crease_borders,
    cut_costs,
    find_cuts,
    find_tubes,
    measure_charts,
    measure_distortion,
    parameterize,
    place_cones,
    prescribe_curvature,
)
from .cut_moving import CutMover, GrabbedCut, MovedCut, Transition, overlapping_triangles
from .cut_paths import split_into_paths
from .edge_directions import edge_directions
from .errors import (
    Cancelled,
    CurvatureError,
    Elements,
    Finding,
    InputError,
    LsgpError,
    SolverError,
    TopologyError,
)
from .features import feature_edges
from .images.gutters import pad_image
from .images.layout_picture import draw_layout
from .images.mip_levels import pad_mip_levels
from .indexed_uv import index_uv
from .io.mesh_files import MeshFile, read_mesh_file, write_mesh_file
from .io.png_files import write_png
from .layouts.arranging import StitchedMap, align_islands, stitch_islands, turn_islands, upright_turns
from .layouts.islands import correct_aspect, fit_placement
from .layouts.packing import pack_islands
from .layouts.stacking import Stacks, find_stacks
from .layouts.texels import TexelDensity, TexelLayout, at_texel_density, texel_density, triangle_texel_density
from .layouts.upright import stand_upright
from .ledger import LedgerPart, build_ledger, hold_complete, part_surface
from .options import Options, Seamless
from .presets.auto_unwrap import Weights, auto_unwrap, preset_options, preset_weights
from .quads.quad_mesh import QuadMesh, QuadQuality, extract_quads, quad_quality
from .quads.remeshing import QuadRemesh, remesh_to_quads
from .results import (
    Chart,
    Choice,
    ConeGains,
    CutPaths,
    Distortion,
    FeatureReport,
    Measurement,
    Placement,
    Prescription,
    ReleasedFeature,
    RepairReport,
    Result,
    SeamlessReport,
    SeamQuality,
    Tubes,
)
from .shaping import ShapedMap, shape_patches
from .stitching import stitch_borders
from .surface import Pins, Surface
from .triangles import TriangleDistortion, singular_values, triangle_distortion

__version__ = version("lsgp")

__all__ = [
    "Cancelled",
    "Chart",
    "Choice",
    "ConeGains",
    "CurvatureError",
    "CutMover",
    "CutPaths",
    "Distortion",
    "Elements",
    "FeatureReport",
    "Finding",
    "GrabbedCut",
    "InputError",
    "LedgerPart",
    "LsgpError",
    "Measurement",
    "MeshFile",
    "MovedCut",
    "Options",
    "Pins",
    "Placement",
    "Prescription",
    "Preview",
    "QuadMesh",
    "QuadQuality",
    "QuadRemesh",
    "ReleasedFeature",
    "RepairReport",
    "Result",
    "SeamQuality",
    "Seamless",
    "SeamlessReport",
    "ShapedMap",
    "Solver",
    "SolverError",
    "Stacks",
    "StitchedMap",
    "Surface",
    "TexelDensity",
    "TexelLayout",
    "TopologyError",
    "Transition",
    "TriangleDistortion",
    "Tubes",
    "Weights",
    "align_islands",
    "at_texel_density",
    "auto_unwrap",
    "build_ledger",
    "certificate",
    "cone_gains",
    "correct_aspect",
    "crease_borders",
    "cut_costs",
    "draw_layout",
    "edge_directions",
    "extract_quads",
    "feature_edges",
    "find_cuts",
    "find_stacks",
    "find_tubes",
    "fit_placement",
    "hold_complete",
    "index_uv",
    "lattice",
    "measure_charts",
    "measure_distortion",
    "overlapping_triangles",
    "pack_islands",
    "pad_image",
    "pad_mip_levels",
    "parameterize",
    "part_surface",
    "place_cones",
    "prescribe_curvature",
    "preset_options",
    "preset_weights",
    "quad_quality",
    "read_mesh_file",
    "remesh_to_quads",
    "shape_patches",
    "singular_values",
    "split_into_paths",
    "stand_upright",
    "stitch_borders",
    "stitch_islands",
    "texel_density",
    "triangle_distortion",
    "triangle_texel_density",
    "turn_islands",
    "upright_turns",
    "write_mesh_file",
    "write_png",
]
