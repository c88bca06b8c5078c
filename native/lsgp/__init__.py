# SPDX-License-Identifier: GPL-3.0-or-later
"""Cone parameterization with exact affine transitions across every cut.

Vintescu, Dupont, Lavoué, Memari, Tierny: Least Squares Affine Transitions for Global Parameterization, WSCG 2017.
"""

from importlib.metadata import version

from . import certificate, lattice
from .api import (
    ConeGains,
    CutPaths,
    Distortion,
    Measurement,
    Options,
    Pins,
    Placement,
    Prescription,
    RepairReport,
    Result,
    Seamless,
    SeamlessReport,
    SeamQuality,
    Solver,
    Surface,
    cone_gains,
    crease_borders,
    cut_costs,
    find_cuts,
    measure_distortion,
    parameterize,
    place_cones,
    prescribe_curvature,
)
from .auto_unwrap import auto_unwrap, preset_options
from .cut_paths import split_into_paths
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
from .gutters import pad_image
from .indexed_uv import index_uv
from .io.mesh_files import MeshFile, read_mesh_file, write_mesh_file
from .islands import correct_aspect, fit_placement
from .ledger import LedgerPart, build_ledger, hold_complete, part_surface
from .packing import pack_islands, packer_name
from .quads import QuadMesh, QuadQuality, QuadRemesh, extract_quads, quad_quality, remesh_to_quads
from .texels import TexelDensity, TexelLayout, at_texel_density, texel_density, triangle_texel_density
from .triangles import TriangleDistortion, singular_values, triangle_distortion

__version__ = version("lsgp")

__all__ = [
    "Cancelled",
    "ConeGains",
    "CurvatureError",
    "CutPaths",
    "Distortion",
    "Elements",
    "Finding",
    "InputError",
    "LedgerPart",
    "LsgpError",
    "Measurement",
    "MeshFile",
    "Options",
    "Pins",
    "Placement",
    "Prescription",
    "QuadMesh",
    "QuadQuality",
    "QuadRemesh",
    "RepairReport",
    "Result",
    "SeamQuality",
    "Seamless",
    "SeamlessReport",
    "Solver",
    "SolverError",
    "Surface",
    "TexelDensity",
    "TexelLayout",
    "TopologyError",
    "TriangleDistortion",
    "at_texel_density",
    "auto_unwrap",
    "build_ledger",
    "certificate",
    "cone_gains",
    "correct_aspect",
    "crease_borders",
    "cut_costs",
    "extract_quads",
    "find_cuts",
    "fit_placement",
    "hold_complete",
    "index_uv",
    "lattice",
    "measure_distortion",
    "pack_islands",
    "packer_name",
    "pad_image",
    "parameterize",
    "part_surface",
    "place_cones",
    "prescribe_curvature",
    "preset_options",
    "quad_quality",
    "read_mesh_file",
    "remesh_to_quads",
    "singular_values",
    "split_into_paths",
    "texel_density",
    "triangle_distortion",
    "triangle_texel_density",
    "write_mesh_file",
]
