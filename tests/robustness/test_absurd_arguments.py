# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public function, every parameter, every absurd value: a result, or an error of the library that has a code."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import lsgp
import meshes
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lsgp import certificate, lattice
from map_checks import surface

BALL = meshes.bumpy_sphere(1)
EDGES = meshes.edges_of(BALL.triangles)
WHOLE = surface(BALL, seams=BALL.triangles[:3, :2], edges=EDGES, cut_costs=np.linspace(0.5, 2, len(EDGES)))
RESULT = lsgp.parameterize(WHOLE, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless()))
FINE_RESULT = lsgp.parameterize(WHOLE, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless(tiles=16)))
FREE_RESULT = lsgp.parameterize(WHOLE, BALL.cones)
ANGLES = list(RESULT.cone_angles)
PARTS = lsgp.build_ledger(WHOLE, BALL.cones)
MAP = {"corner_uv": RESULT.corner_uv, "old_uv": RESULT.corner_uv, "island": RESULT.island}
CALL = {"surface": WHOLE, "cones": BALL.cones, "angles": ANGLES, "options": lsgp.Options(), "progress": None}
TEXELS = {"surface": WHOLE, "corner_uv": RESULT.corner_uv, "texture_size": (1024, 512)}
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
    "Preview": (lsgp.Preview, {"surface": WHOLE, "triangles": 100, "progress": None}),
    "Preview.parameterize": (
        lsgp.Preview(WHOLE, triangles=100).parameterize,
        {name: CALL[name] for name in CALL if name != "surface"},
    ),
    "auto_unwrap": (
        lsgp.auto_unwrap,
        {
            **{"surface": WHOLE, "cones": BALL.cones, "angles": None, "preset": "paint", "options": None},
            **{"count": 4, "target": 1.05, "symmetric": True, "creases": True, "sharp": EDGES[:3], "pins": None},
            **{"pack": "shelves", "margin": None, "udim": None, "stack": None},
            **{"texels": lsgp.TexelLayout(100.0, 1024), "progress": None},
        },
    ),
    "preset_options": (lsgp.preset_options, {"preset": "bake"}),
    "find_cuts": (lsgp.find_cuts, {name: CALL[name] for name in CALL if name != "angles"}),
    "crease_borders": (
        lsgp.crease_borders,
        {
            **{"surface": WHOLE, "cones": BALL.cones, "angle": 0.3, "sharp": EDGES[:3], "most_corners": 2},
            **{"least_share": 0.5, "progress": None},
        },
    ),
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
            **{"follow_strokes": True, "seams": "follow"},
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
            **{"surface": WHOLE, "cones": BALL.cones, "angles": None, "target": 200, "size": None},
            **{"options": lsgp.Options(seamless=lsgp.Seamless()), "count": 4, "polish": True, "progress": None},
            "density": 2.0 ** BALL.positions[:, 0],
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
            **{"turned": True, "udim": 1, "progress": None},
        },
    ),
    "find_stacks": (
        lsgp.find_stacks,
        {"corner_uv": FREE_RESULT.corner_uv, "island": FREE_RESULT.island, "mirrored": True},
    ),
    "packer_name": (lsgp.packer_name, {}),
    "pad_image": (
        lsgp.pad_image,
        {
            **{"image": np.ones((8, 8, 3), np.uint8), "surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv},
            **{"margin": 2, "normal_map": True},
        },
    ),
    "pad_mip_levels": (
        lsgp.pad_mip_levels,
        {
            **{"image": np.ones((8, 8, 3), np.uint8), "surface": WHOLE, "corner_uv": FREE_RESULT.corner_uv},
            **{"margins": [2, 1], "normal_map": True},
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
if lsgp.packer_name() is None:
    del FUNCTIONS["pack_islands"]  # it is refused whatever is passed
FILES = {"read_mesh_file", "write_mesh_file"}  # what these refuse is in tests/cli
PARAMETERS = [(name, parameter) for name, (_, known) in FUNCTIONS.items() for parameter in known]

NUMBERS = [
    *(0, -1, 2**31 - 1, 2**31, -(2**31) - 1, 2**63, 10**30, 10**400, -(10**400), 10**5000, 1e300, -0.0, 1e400, -1e400),
    *(
        float("nan"),
        True,
        False,
        1j,
        "1",
        b"1",
        "",
        None,
        Fraction(1, 3),
        np.float32(0.5),
        np.int8(3),
        np.uint64(2**63),
    ),
    *(
        np.bool_(True),
        np.complex128(1j),
        np.float64("inf"),
        np.float16(2),
        np.longdouble("1e4000"),
        np.datetime64(0, "s"),
    ),
]
OBJECTS = [
    *([], {}, (), set(), object(), object, len, "follow", "x" * 10**4, [[]], [[1], [2, 3]], [None], ["a"], {0: None}),
    *(
        {None: 1.0},
        {0: 10**400},
        {10**400: 1},
        {True: 1.0},
        {0.5: 1.0},
        range(3),
        iter([]),
        np.array([]),
        np.array(1.0),
    ),
    *(np.zeros((3, 3, 3)), np.zeros((0, 7)), np.array([None, 1], object), np.array(["a"]), np.zeros(2, "M8[s]")),
    *(np.zeros(3, [("x", "f8")]), np.full((4, 3), np.nan), np.full((4, 3), 2**40), np.full(5, -7), np.ones(3, bool)),
]


# How the library calls what its parameters hold.
CALLED = {
    **{"target": ["L2 stretch", "cells"], "size": ["cells"], "mirror": ["mirror plane"], "shifts": ["shift"]},
    **{"cell": ["side of a cell", "cells", "texture coordinates"], "corner_uv": ["texture coordinates", "cells"]},
}


def places(value: Any) -> Iterator[Callable[[Any], Any]]:
    """Ways to put something absurd into an accepted value: in its place, or into an element of it."""
    yield lambda absurd: absurd
    if isinstance(value, list | tuple | np.ndarray) and len(value):
        yield lambda absurd: [absurd, *list(value)[1:]]
        yield lambda absurd: [*list(value), absurd]
        if np.ndim(value) > 1:
            yield lambda absurd: [[absurd, *list(value[0])[1:]], *list(value)[1:]]
    if isinstance(value, np.ndarray):
        yield lambda absurd: value.astype(object)
        yield lambda absurd: value[:-1]
        yield lambda absurd: value * np.nan
        yield lambda absurd: np.where(np.arange(value.size).reshape(value.shape) == 1, 2**31 - 1, value)
        yield lambda absurd: np.where(np.arange(value.size).reshape(value.shape) == 1, -5, value)


def require_a_result_or_a_refusal(name: str, parameter: str, value: Any) -> None:
    function, accepted = FUNCTIONS[name]
    try:
        with np.errstate(all="ignore"):
            function(**accepted | {parameter: value})
    except lsgp.InputError as error:
        assert error.code.isupper() and error.message
        assert len(error.message) < 1000 and error.message.isprintable()
        if error.code in ("WRONG_PARAMETER", "WRONG_SHAPE", "WRONG_DTYPE"):
            # Where shapes do not fit together, the other array may be the one that is named.
            assert any(called in error.message for called in (*accepted, *CALLED.get(parameter, ()))), error.message
    except (lsgp.TopologyError, lsgp.CurvatureError, lsgp.SolverError):
        pass
    except TypeError as error:
        assert parameter == "progress", error  # where a function is expected, as everywhere in Python


def test_all_public_functions_and_parameters_are_listed() -> None:
    public = {
        name
        for name in lsgp.__all__
        if callable(getattr(lsgp, name)) and (not inspect.isclass(getattr(lsgp, name)) or name in FUNCTIONS)
    } - FILES
    if lsgp.packer_name() is None:
        public.remove("pack_islands")
    for module in (lattice, certificate):
        own = vars(module).items()
        short = module.__name__.rpartition(".")[2]
        public |= {
            f"{short}.{name}"
            for name, value in own
            if inspect.isfunction(value) and value.__module__ == module.__name__ and not name.startswith("_")
        }
    assert public | {"Solver.parameterize", "Preview.parameterize"} == FUNCTIONS.keys()
    for function, accepted in FUNCTIONS.values():
        assert set(inspect.signature(function).parameters) == set(accepted)
        function(**accepted)


@pytest.mark.parametrize(("name", "parameter"), PARAMETERS)
def test_absurd_values_are_refused_by_name(name: str, parameter: str) -> None:
    for absurd in [*NUMBERS, *OBJECTS]:
        for put in list(places(FUNCTIONS[name][1][parameter]))[:1]:
            require_a_result_or_a_refusal(name, parameter, put(absurd))


@settings(max_examples=400, deadline=None)
@given(st.sampled_from(PARAMETERS), st.sampled_from([*NUMBERS, *OBJECTS]), st.integers(0, 8))
@example(("lattice.shift_islands", "triangles"), 0, 7)
@example(("lattice.shift_islands", "cut_edges"), 0, 7)
@example(("lattice.shift_islands", "corner_uv"), 0, 6)
@example(("lattice.shift_islands", "shifts"), 0, 6)
@example(("fit_placement", "island"), 0, 7)
@example(("singular_values", "surface"), 0, 0)
@example(("place_cones", "mirror"), 10**400, 2)
def test_absurd_elements_are_refused_by_name(where: tuple[str, str], absurd: Any, way: int) -> None:
    name, parameter = where
    ways = list(places(FUNCTIONS[name][1][parameter]))
    require_a_result_or_a_refusal(name, parameter, ways[way % len(ways)](absurd))


@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(PARAMETERS),
    st.one_of(st.integers(), st.floats(), st.text(max_size=5), st.complex_numbers(), st.lists(st.floats(), max_size=4)),
)
def test_any_value_is_refused_by_name(where: tuple[str, str], value: Any) -> None:
    require_a_result_or_a_refusal(*where, value)
