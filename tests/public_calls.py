# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public function with arguments that it accepts, and arrays to put in the place of those."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import lsgp
import meshes
import numpy as np
from lsgp import certificate, lattice
from map_checks import surface

BALL = meshes.bumpy_sphere(1)
EDGES = meshes.edges_of(BALL.triangles)
BOX = meshes.cube(1)  # for what takes many maps
WHOLE = surface(BALL, seams=BALL.triangles[:3, :2], edges=EDGES, cut_costs=np.linspace(0.5, 2, len(EDGES)))
RESULT = lsgp.parameterize(WHOLE, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless()))
FINE_RESULT = lsgp.parameterize(WHOLE, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless(tiles=16)))
FREE_RESULT = lsgp.parameterize(WHOLE, BALL.cones)
ANGLES = list(RESULT.cone_angles)
MOVER, PATH = lsgp.CutMover(WHOLE), max(FREE_RESULT.cut_paths, key=len)
GRABBED = MOVER.grab(FREE_RESULT.corner_uv, FREE_RESULT.cut_edges, PATH, BALL.cones)
PARTS = lsgp.build_ledger(WHOLE, BALL.cones)
MAP = {"corner_uv": RESULT.corner_uv, "old_uv": RESULT.corner_uv, "island": RESULT.island}
CALL = {"surface": WHOLE, "cones": BALL.cones, "angles": ANGLES, "options": lsgp.Options(), "progress": None}
TEXELS = {"surface": WHOLE, "corner_uv": RESULT.corner_uv, "texture_size": (1024, 512)}
ISLANDS = {"surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv, "island": FREE_RESULT.island}
CELLS = {"rotation_order": 4, "cell": 1.0}

# By name the function and arguments it accepts; all parameters are among them.
FUNCTIONS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "Surface": (
        lsgp.Surface,
        {
            "positions": BALL.positions,
            "triangles": BALL.triangles,
            "edges": EDGES,
            "seams": WHOLE.seams,
            "importance": np.ones(len(BALL.positions)),
            "cut_costs": WHOLE.cut_costs,
            "borders": EDGES[:3],
            "features": EDGES[:3],
            "may_collapse": False,
            "directions": np.ones(BALL.triangles.shape),
            "scale": np.ones(len(BALL.positions)),
        },
    ),
    "Pins": (lsgp.Pins, {"corners": [0, 5], "uv": [[0, 0], [1, 0]]}),
    "Options": (lsgp.Options, vars(lsgp.Options()) | {"loop_turning": {0: 1.0}}),
    "Seamless": (lsgp.Seamless, vars(lsgp.Seamless(tiles=12))),
    "parameterize": (lsgp.parameterize, CALL | {"pins": lsgp.Pins([0, 5], [[0, 0], [1, 0]])}),
    "Solver": (lsgp.Solver, {"surface": WHOLE, "earlier": lsgp.Solver(WHOLE)}),
    "Solver.parameterize": (
        lsgp.Solver(WHOLE).parameterize,
        {name: CALL[name] for name in CALL if name != "surface"} | {"pins": None},
    ),
    "Solver.place_cones": (
        # Its options are those of `place_cones`.
        lambda cones, angles, progress: lsgp.Solver(WHOLE).place_cones(cones, angles, progress=progress, count=4),
        {"cones": (), "angles": None, "progress": None},
    ),
    "Weights": (
        lsgp.Weights,
        {"islands": 0.4, "cuts": 0.3, "borders": 0.3, "cones": 0.1, "square": 1.2, "strips": 5.0, "symmetry": 1.0},
    ),
    "TexelLayout": (lsgp.TexelLayout, {"density": 100.0, "texture_size": 1024, "udim": 4, "margin": 4.0}),
    "CutMover": (lsgp.CutMover, {"surface": WHOLE}),
    "CutMover.grab": (
        MOVER.grab,
        {"corner_uv": FREE_RESULT.corner_uv, "cuts": FREE_RESULT.cut_edges, "path": PATH, "nodes": BALL.cones},
    ),
    "GrabbedCut.through": (GRABBED.through, {"vertex": int(PATH[1]), "single": False}),
    "Transition.power": (GRABBED.transition.power, {"exponent": 2}),
    "Preview": (lsgp.Preview, {"surface": WHOLE, "triangles": 100, "progress": None}),
    "Preview.parameterize": (
        lsgp.Preview(WHOLE, triangles=100).parameterize,
        {name: CALL[name] for name in CALL if name != "surface"},
    ),
    "auto_unwrap": (
        lsgp.auto_unwrap,
        {
            **{"surface": surface(BOX), "cones": BOX.cones[:2], "angles": None, "preset": "paint", "options": None},
            **{"count": 4, "target": 1.05, "symmetric": True, "creases": True, "sharp": BOX.triangles[:3, :2]},
            **{"pins": None, "seconds": None, "up": np.array([0.0, 1.0, 0.0])},
            **{"pack": "shelves", "margin": None, "udim": None, "stack": None, "effort": None, "inside": None},
            **{"texels": lsgp.TexelLayout(100.0, 1024), "weights": lsgp.Weights(islands=0.1), "progress": None},
        },
    ),
    "preset_options": (lsgp.preset_options, {"preset": "bake"}),
    "preset_weights": (lsgp.preset_weights, {"preset": "bake"}),
    "find_cuts": (lsgp.find_cuts, {name: CALL[name] for name in CALL if name != "angles"}),
    "crease_borders": (
        lsgp.crease_borders,
        {
            **{"surface": WHOLE, "cones": BALL.cones, "angle": 0.3, "sharp": EDGES[:3], "most_corners": 2},
            **{"least_share": 0.5, "progress": None},
        },
    ),
    "measure_charts": (lsgp.measure_charts, {"surface": WHOLE, "options": CALL["options"], "progress": None}),
    "find_tubes": (lsgp.find_tubes, {"surface": WHOLE, "cones": BALL.cones, "progress": None}),
    "edge_directions": (lsgp.edge_directions, {"surface": WHOLE, "edges": EDGES[:3], "up": np.array([0.0, 1.0, 0.0])}),
    "feature_edges": (lsgp.feature_edges, {"surface": WHOLE, "angle": 0.3, "seams": True, "borders": True}),
    "cut_costs": (
        lsgp.cut_costs,
        {
            **{"surface": WHOLE, "front": np.array([0.0, -1.0, 0.5]), "creases": True, "sharp": EDGES[:3]},
            **{"paint": np.linspace(0, 1, len(BALL.positions)), "progress": None},
        },
    ),
    "prescribe_curvature": (lsgp.prescribe_curvature, CALL),
    "place_cones": (
        lsgp.place_cones,
        {
            **{"surface": WHOLE, "cones": (), "angles": None, "count": 4, "target": 1.05, "lattice": None},
            **{"prefer_sharp": False, "symmetric": True, "mirror": ([0, 0, 0], [1, 0, 0])},
            **{"follow_strokes": True, "seams": "follow", "border": "strips"},
            "threads": 2,
            "progress": None,
        },
    ),
    "cone_gains": (
        lsgp.cone_gains,
        {"surface": WHOLE, "cones": BALL.cones, "angles": ANGLES, "seams": "follow", "progress": None},
    ),
    "measure_distortion": (
        lsgp.measure_distortion,
        {"surface": WHOLE, "corner_uv": RESULT.corner_uv, "cones": BALL.cones, "progress": None},
    ),
    "overlapping_triangles": (lsgp.overlapping_triangles, {"corner_uv": RESULT.corner_uv}),
    "extract_quads": (
        lsgp.extract_quads,
        {"surface": WHOLE, "corner_uv": FINE_RESULT.corner_uv, "cell": 1.0, "progress": None},
    ),
    "quad_quality": (
        lsgp.quad_quality,
        {"positions": BALL.positions, "quads": [[0, 1, 2, 3], [3, 2, 1, 0]], "density": np.ones(len(BALL.positions))},
    ),
    "remesh_to_quads": (
        lsgp.remesh_to_quads,
        {
            **{"surface": surface(BOX), "cones": BOX.cones[:2], "angles": None, "target": 200, "size": None},
            **{"options": lsgp.Options(seamless=lsgp.Seamless()), "count": 4, "polish": True, "progress": None},
            "density": 2.0 ** BOX.positions[:, 0],
        },
    ),
    "singular_values": (lsgp.singular_values, {"surface": WHOLE, "corner_uv": RESULT.corner_uv}),
    "triangle_distortion": (lsgp.triangle_distortion, {"surface": WHOLE, "corner_uv": RESULT.corner_uv}),
    "texel_density": (lsgp.texel_density, TEXELS),
    "triangle_texel_density": (lsgp.triangle_texel_density, TEXELS),
    "at_texel_density": (
        lsgp.at_texel_density,
        {"surface": WHOLE, "result": FREE_RESULT, "layout": lsgp.TexelLayout(100.0, 1024, 4)},
    ),
    "pack_islands": (
        lsgp.pack_islands,
        {
            **{"corner_uv": FREE_RESULT.corner_uv, "island": FREE_RESULT.island, "margin": 0.01, "fill": True},
            **{"turned": True, "udim": 1, "effort": "quick", "seconds": None, "area": None, "groups": None},
            **{"locks": {"rotation": [0]}, "snap": None, "progress": None},
        },
    ),
    "shape_patches": (
        lsgp.shape_patches,
        {
            **{"surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv, "triangles": np.arange(len(BALL.triangles))},
            **{"shape": "rectangle", "corners": (), "pinned": (), "progress": None},
        },
    ),
    "upright_turns": (lsgp.upright_turns, ISLANDS | {"up": np.array([0.0, 0.0, 1.0])}),
    "turn_islands": (
        lsgp.turn_islands,
        {name: ISLANDS[name] for name in ("corner_uv", "island")}
        | {"turns": np.full(int(FREE_RESULT.island.max()) + 1, 0.5)},
    ),
    "stand_upright": (
        lsgp.stand_upright,
        {
            **{"corner_uv": FREE_RESULT.corner_uv, "island": FREE_RESULT.island, "margin": 0.01, "whole": True},
            "turns": np.full(int(FREE_RESULT.island.max()) + 1, 2.0),
        },
    ),
    "align_islands": (
        lsgp.align_islands,
        {"boxes": np.array([[0.0, 0.0, 1.0, 1.0]]), "side": "left", "fixed": np.array([False])},
    ),
    "stitch_islands": (lsgp.stitch_islands, ISLANDS | {"edges": FREE_RESULT.cut_edges, "fixed": np.array([0])}),
    "find_stacks": (
        lsgp.find_stacks,
        {"corner_uv": FREE_RESULT.corner_uv, "island": FREE_RESULT.island, "mirrored": True, "progress": None},
    ),
    "Stacks.stacked": (
        lsgp.find_stacks(FREE_RESULT.corner_uv, FREE_RESULT.island).stacked,
        {"corner_uv": FREE_RESULT.corner_uv},
    ),
    "draw_layout": (lsgp.draw_layout, {"surface": WHOLE, "result": FREE_RESULT, "size": 64}),
    "pad_image": (
        lsgp.pad_image,
        {
            **{"image": np.ones((8, 8, 3), np.uint8), "surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv},
            **{"margin": 2, "normal_map": True, "progress": None},
        },
    ),
    "pad_mip_levels": (
        lsgp.pad_mip_levels,
        {
            **{"image": np.ones((8, 8, 3), np.uint8), "surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv},
            **{"margins": [2, 1], "normal_map": True, "progress": None},
        },
    ),
    "build_ledger": (
        lsgp.build_ledger,
        {name: CALL[name] for name in CALL if name != "progress"} | {"gets_cones": False},
    ),
    "hold_complete": (
        lsgp.hold_complete,
        {name: CALL[name] for name in CALL if name != "progress"} | {"tentative": [True] * len(ANGLES)},
    ),
    "part_surface": (lsgp.part_surface, {"surface": WHOLE, "part": PARTS[0]}),
    "fit_placement": (lsgp.fit_placement, MAP),
    "correct_aspect": (lsgp.correct_aspect, {"corner_uv": RESULT.corner_uv, "aspect": 2.0}),
    "index_uv": (lsgp.index_uv, {"triangles": BALL.triangles, "corner_uv": RESULT.corner_uv}),
    "stitch_borders": (lsgp.stitch_borders, {"positions": BALL.positions, "triangles": BALL.triangles}),
    "split_into_paths": (lsgp.split_into_paths, {"edges": RESULT.cut_edges, "nodes": RESULT.cones}),
    "lattice.whole_cells": (lattice.whole_cells, {"shift": [[1.2, 3.4]], **CELLS}),
    "lattice.nearest_places": (lattice.nearest_places, MAP | CELLS),
    "lattice.shelf_places": (lattice.shelf_places, {"boxes": [[0, 0, 1, 2]], **CELLS}),
    "lattice.island_boxes": (lattice.island_boxes, {"corner_uv": RESULT.corner_uv, "island": RESULT.island}),
    "lattice.shift_islands": (
        lattice.shift_islands,
        {
            **{"triangles": BALL.triangles, "corner_uv": RESULT.corner_uv, "island": RESULT.island},
            **{"cut_edges": RESULT.cut_edges, "shifts": np.zeros((1, 2))},
        },
    ),
    "certificate.certificate": (certificate.certificate, {"report": RESULT.seamless, "texture_size": 1024}),
    "certificate.certificate_table": (certificate.certificate_table, {"report": RESULT.seamless, "texture_size": 1024}),
}
# What these refuse is in tests/cli and tests/native/io.
FILES = {"read_mesh_file", "write_mesh_file", "write_png", "MeshFile.surface", "MeshFile.cones", "MeshFile.told"}
# Errors, and what the library makes for callers to read.
NOT_CALLED = {
    *("Cancelled", "CurvatureError", "Elements", "Finding", "InputError", "LsgpError", "SolverError", "TopologyError"),
    *(
        "Chart",
        "Choice",
        "ConeGains",
        "CutPaths",
        "Distortion",
        "FeatureReport",
        "GrabbedCut",
        "LedgerPart",
        "Measurement",
        "MeshFile",
    ),
    *("MovedCut", "Placement", "Prescription", "QuadMesh", "QuadQuality", "QuadRemesh", "ReleasedFeature", "Result"),
    *("RepairReport", "SeamQuality", "SeamlessReport", "Stacks", "TexelDensity", "Transition", "TriangleDistortion"),
    *("ShapedMap", "StitchedMap", "Tubes"),
}


def public_names() -> Iterator[str]:
    """Of functions, of classes that callers make, and of the methods of all classes."""
    for name in lsgp.__all__:
        value = getattr(lsgp, name)
        if inspect.ismodule(value):
            own = vars(value).items()
            yield from (
                f"{name}.{of}"
                for of, function in own
                if inspect.isfunction(function) and function.__module__ == value.__name__ and not of.startswith("_")
            )
        elif inspect.isclass(value):
            if name not in NOT_CALLED:
                yield name
            methods = (of for of, method in vars(value).items() if inspect.isfunction(method) and of[0] != "_")
            yield from (
                f"{name}.{of}" for of in methods if inspect.signature(getattr(value, of)).parameters.keys() != {"self"}
            )
        else:
            yield name


EXTREMES = {
    "i": [-1, -(2**31), 2**31 - 1, 2**40, -(2**63), 2**63 - 1],
    "f": [np.nan, np.inf, -np.inf, 1e160, -1e308, 1e-320],
    "b": [True],
    "u": [0, 255],
}


def other_arrays(value: Any) -> Iterator[Any]:
    """Other arrays in the place of one: of other types, shapes and lengths, and with extremes in some places."""
    yield from (None, 7, "word", np.zeros(3, [("x", "f8")]), np.array([None]), np.zeros((2, 2, 2, 2), value.dtype))
    yield from (value[:-1], value[:0], np.concatenate([value, value]), value[None], value.ravel()[:1], value.T)
    yield from (value.astype("f4"), value.astype("i2"), value[..., :1], value.reshape(-1))
    wide = np.zeros((*value.shape, 2), value.dtype)
    wide[..., 0] = value
    yield wide[..., 0]
    raw = np.empty(value.nbytes + 1, np.uint8)
    unaligned = raw[1:].view(value.dtype).reshape(value.shape)
    unaligned[...] = value
    yield unaligned
    if not value.size:
        return
    yield np.broadcast_to(value.ravel()[0], value.shape)
    yield np.broadcast_to(value.ravel()[0], (2**50, *value.shape[1:]))
    for extreme in EXTREMES[value.dtype.kind]:
        fits = value.dtype.kind not in "iu" or np.iinfo(value.dtype).min <= extreme <= np.iinfo(value.dtype).max
        for place in (value.size - 1, value.size // 2, 0) if fits else ():
            changed = value.copy()
            with np.errstate(over="ignore"):  # in single precision
                changed.flat[place] = extreme
            yield changed
        if fits:
            yield np.full_like(changed, changed.flat[0])
