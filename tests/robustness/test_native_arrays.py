# SPDX-License-Identifier: GPL-3.0-or-later
"""Every function of the compiled module, every array it takes: what does not fit is refused before it is read.

The Python layer converts and refuses first. These calls go past it, as one of its defects would.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import asdict
from typing import Any

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import _lsgp, errors
from lsgp.api import cone_arrays, option_values
from lsgp.surface import surface_arrays
from map_checks import surface
from public_calls import EXTREMES, other_arrays

BALL = meshes.bumpy_sphere(1)
EDGES = meshes.edges_of(BALL.triangles)
WHOLE = surface(BALL, seams=BALL.triangles[:3, :2], edges=EDGES, cut_costs=np.ones(len(EDGES)))
RESULT = lsgp.parameterize(WHOLE, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless(tiles=16)))
ARRAYS = surface_arrays(WHOLE)
CONES, OPTIONS = cone_arrays(BALL.cones, None, lsgp.Options())
PLACEMENT = {
    **{"count": 4, "target": 1.05, "lattice": None, "prefer_sharp": False, "symmetric": False, "mirror": None},
    **{"follow_strokes": True, "seams": "follow", "border": "free", "threads": 1},
}
PACKING = {
    **{"margin": 0.01, "fill": True, "turns": "any", "effort": "quick", "seconds": None, "area": None, "tiles": 1},
    **{"snap": 0.0, "groups": np.zeros(0, np.int32), "locks": np.zeros((0, 3), bool)},
}
MAP = option_values(lsgp.Options())
CHOOSING = {
    **{"preset": "paint", "options": option_values(lsgp.preset_options("paint")), "count": 4, "target": 1.05},
    **{"weights": asdict(lsgp.Weights()), "symmetric": True, "charts": True, "creases": True},
    "seconds": None,
}
SOLVER = _lsgp.Solver(ARRAYS, None)
COMPLETED = SOLVER.complete_cones(CONES, None, 1.05, MAP, None)
PINS = (np.array([0, 5], np.int32), np.eye(2))
NONE = np.empty((0, 2), np.int32)
TEXT = b"f 1/2 3/4 5\n"
BEGINS, ENDS = np.array([0, 2, 6, 10]), np.array([1, 5, 9, 11])
NUMBERS = b"1 2.5 3"
NUMBER_PLACES = np.array([0, 2, 6]), np.array([1, 5, 7])
# Two quads and a triangle.
CORNERS, SIZES = np.array([0, 1, 2, 3, 3, 2, 5, 4, 4, 5, 6], np.int32), np.array([4, 4, 3])
POLYGON_EDGES = np.array([[0, 1], [1, 2], [2, 3], [0, 3], [2, 5], [4, 5], [3, 4], [5, 6], [4, 6]], np.int32)
POLYGON_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [8, 9, 10]])
ROUTER = _lsgp.CutRouter(ARRAYS)
PATH = max(RESULT.cut_paths, key=len)
SMALL_SURFACE = (ARRAYS, 100, None)

# By name the function and what it takes.
FUNCTIONS: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "split_rows": (_lsgp.split_rows, (TEXT, True, False)),
    "parse_floats": (_lsgp.parse_floats, (NUMBERS, *NUMBER_PLACES, np.arange(3))),
    "parse_integers": (_lsgp.parse_integers, (NUMBERS, *NUMBER_PLACES, np.arange(3))),
    "slash_parts": (_lsgp.slash_parts, (TEXT, BEGINS, ENDS, np.arange(4), 1)),
    "distinct_tokens": (_lsgp.distinct_tokens, (TEXT, BEGINS, ENDS, np.arange(4))),
    "format_rows": (_lsgp.format_rows, (b"v", BALL.positions, b"\n")),
    "format_table": (_lsgp.format_table, ([np.arange(3), np.ones(3), np.ones(3, np.float32)],)),
    "format_faces": (
        _lsgp.format_faces,
        (SIZES, np.array([True, False, True]), CORNERS.astype(np.int64), np.arange(len(CORNERS))),
    ),
    "plain_lines": (_lsgp.plain_lines, (TEXT, 0, 5)),
    "replace_references": (_lsgp.replace_references, (TEXT, np.arange(3))),
    "binary_rows": (_lsgp.binary_rows, (bytes(range(40)), 0, 3, [0, 1], [4, 1], [0, 1], True)),
    "clip_ears": (_lsgp.clip_ears, (np.array([[[0, 0], [1, 0], [1, 1], [0.5, 0.2], [0, 1.0]]]), None)),
    "polygon_edges": (_lsgp.polygon_edges, (CORNERS, SIZES, 7)),
    "quad_diagonals": (_lsgp.quad_diagonals, (BALL.positions, CORNERS[:8].reshape(2, 4))),
    "distinct_corners": (_lsgp.distinct_corners, (CORNERS.astype(np.int64), np.arange(22.0).reshape(11, 2))),
    "doubled_diagonals": (_lsgp.doubled_diagonals, (POLYGON_TRIANGLES, CORNERS, SIZES, POLYGON_EDGES, 7)),
    "pack_islands": (
        _lsgp.pack_islands,
        (
            BALL.positions[BALL.triangles[:4]][:, :, :2],
            np.array([0, 0, 1, 1], np.int32),
            PACKING,
            None,
            BALL.positions[BALL.triangles[:4]][:, :, 1:],
        ),
    ),
    "hidden_islands": (_lsgp.hidden_islands, (ARRAYS, np.zeros(len(BALL.triangles), np.int32), None)),
    "usual_margin": (
        _lsgp.usual_margin,
        (BALL.positions[BALL.triangles[:4]][:, :, :2], np.array([0, 0, 1, 1], np.int32), 1),
    ),
    "shape_patches": (
        _lsgp.shape_patches,
        (
            ARRAYS,
            RESULT.corner_uv,
            np.arange(4, dtype=np.int32),
            "rectangle",
            np.zeros(0, np.int32),
            np.zeros(0, np.int32),
            None,
        ),
    ),
    "parameterize": (_lsgp.parameterize, (ARRAYS, CONES, OPTIONS, PINS, None)),
    "preset": (_lsgp.preset, ("paint",)),
    "least_inside": (_lsgp.least_inside, ()),
    "auto_unwrap": (_lsgp.auto_unwrap, (ARRAYS, CONES, EDGES[:3], CHOOSING, PINS, None)),
    "Solver": (_lsgp.Solver, (ARRAYS, None)),
    "Solver.complete_cones": (SOLVER.complete_cones, (CONES, 4, 1.05, MAP, None)),
    "Solver.complete_feature_cones": (SOLVER.complete_feature_cones, (1.05, MAP, None)),
    "Solver.parameterize_through": (SOLVER.parameterize_through, (COMPLETED, MAP, None)),
    "Solver.parameterize": (_lsgp.Solver(ARRAYS, None).parameterize, (CONES, OPTIONS, PINS, None)),
    "Solver.place_cones": (_lsgp.Solver(ARRAYS, None).place_cones, (CONES, PLACEMENT, None)),
    "Preview": (_lsgp.Preview, SMALL_SURFACE),
    "Preview.parameterize": (_lsgp.Preview(*SMALL_SURFACE).parameterize, (CONES, OPTIONS, None)),
    "GrabbedCut.through": (ROUTER.grab(RESULT.cut_edges, PATH, BALL.cones).through, (int(PATH[1]),)),
    "CutRouter": (_lsgp.CutRouter, (ARRAYS,)),
    "CutRouter.grab": (ROUTER.grab, (RESULT.cut_edges, PATH, BALL.cones)),
    "overlapping_triangles": (_lsgp.overlapping_triangles, (RESULT.corner_uv,)),
    "find_cuts": (_lsgp.find_cuts, (ARRAYS, BALL.cones, OPTIONS, None)),
    "split_into_paths": (_lsgp.split_into_paths, (RESULT.cut_edges, BALL.cones)),
    "measure_charts": (_lsgp.measure_charts, (ARRAYS, OPTIONS, None)),
    "find_tubes": (_lsgp.find_tubes, (ARRAYS, BALL.cones, None)),
    "crease_borders": (_lsgp.crease_borders, (ARRAYS, BALL.cones, (0.3, EDGES[:3], 2, 0.5), None)),
    "feature_cones": (_lsgp.feature_cones, (ARRAYS, True, None)),
    "cut_costs": (_lsgp.cut_costs, (ARRAYS, ((0.0, 0.0, 1.0), True, EDGES[:3], np.ones(len(BALL.positions))), None)),
    "prescribe_curvature": (_lsgp.prescribe_curvature, (ARRAYS, CONES, OPTIONS, None)),
    "build_ledger": (_lsgp.build_ledger, (ARRAYS, CONES, OPTIONS, False)),
    "place_cones": (_lsgp.place_cones, (ARRAYS, CONES, PLACEMENT, None)),
    "cone_gains": (_lsgp.cone_gains, (ARRAYS, CONES, "follow", None)),
    "measure_distortion": (_lsgp.measure_distortion, (ARRAYS, RESULT.corner_uv, BALL.cones, None)),
    "require_closed": (_lsgp.require_closed, (ARRAYS,)),
    "extract_quads": (_lsgp.extract_quads, (ARRAYS, RESULT.corner_uv, 1.0, None)),
}


def changed(value: Any) -> Iterator[Any]:
    """The value with one array in it replaced, or one number."""
    if isinstance(value, np.ndarray):
        yield from other_arrays(value)
    elif isinstance(value, int) and not isinstance(value, bool):
        yield from (0, -1, 2**31 - 1, -(2**31), 2**31, 2**63, 10**30, 0.5)
    elif isinstance(value, float):
        yield from (0.0, -1.0, *EXTREMES["f"])
    elif isinstance(value, tuple | list):
        for i, part in enumerate(value):
            for other in changed(part):
                yield type(value)([*value[:i], other, *value[i + 1 :]])
    elif isinstance(value, dict):
        for name, part in value.items():
            for other in changed(part):
                yield {**value, name: other}


def test_all_functions_are_listed() -> None:
    found = set()
    for name, value in vars(_lsgp).items():
        if inspect.isclass(value):
            methods = [
                method for method in vars(value) if not method.startswith("_") and callable(getattr(value, method))
            ]
            constructor = [] if vars(value)["__init__"] is vars(object)["__init__"] else [name]
            found |= {*constructor, *(f"{name}.{method}" for method in methods)}
        elif callable(value):
            found.add(name)
    assert found - {"GrabbedCut", "CompletedCones"} == FUNCTIONS.keys()


@pytest.mark.slow
@pytest.mark.parametrize("name", FUNCTIONS)
def test_arrays_are_taken_or_refused(name: str) -> None:
    function, accepted = FUNCTIONS[name]
    function(*accepted)
    for i, value in enumerate(accepted):
        for other in changed(value):
            try:
                function(*accepted[:i], other, *accepted[i + 1 :])
            except (TypeError, lsgp.LsgpError):
                pass
            except ValueError as error:  # of pybind11, where a number or a name is none that it can convert
                assert not isinstance(other, np.ndarray), error


INDICES = {
    "parse_floats": [3],
    "slash_parts": [1, 2, 3],
    "distinct_tokens": [1, 2, 3],
    "polygon_edges": [0],
    "quad_diagonals": [1],
    "distinct_corners": [0],
    "doubled_diagonals": [0, 1, 3],
}


@pytest.mark.parametrize(("name", "place"), [(name, place) for name, places in INDICES.items() for place in places])
def test_an_index_that_is_none_is_refused_by_name(name: str, place: int) -> None:
    function, accepted = FUNCTIONS[name]
    wrong = accepted[place].copy()
    for value in [-1] if name == "distinct_corners" else [-1, 2**31 - 1]:
        wrong.flat[wrong.size // 2] = value
        with pytest.raises(lsgp.InputError) as caught:
            function(*accepted[:place], wrong, *accepted[place + 1 :])
        assert caught.value.code == "INDEX_OUT_OF_RANGE" and str(value) in caught.value.message


@pytest.mark.parametrize("sizes", [[4, 4, 4], [4, 4], [4, -1, 8], [2**62, 2**62, 3], [12, -1, 0]])
def test_sizes_of_polygons_add_up(sizes: list[int]) -> None:
    for name in ("polygon_edges", "format_faces", "doubled_diagonals"):
        function, accepted = FUNCTIONS[name]
        with pytest.raises(lsgp.InputError):
            function(*(np.array(sizes) if value is SIZES else value for value in accepted))


def test_vertices_far_beyond_the_corners_take_no_memory() -> None:
    """A table with an entry for each would have 2e18."""
    far = CORNERS.astype(np.int64) * 3 * 10**17
    for found, expected in zip(
        _lsgp.distinct_corners(far, np.zeros((11, 2))),
        _lsgp.distinct_corners(CORNERS.astype(np.int64), np.zeros((11, 2))),
        strict=True,
    ):
        assert np.array_equal(found, expected)


def test_an_interrupt_while_an_error_is_made_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """A signal is handled by whatever Python code runs next."""

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(errors.InputError, "__init__", interrupted)
    with pytest.raises(KeyboardInterrupt):
        _lsgp.distinct_corners(np.full(11, -1), np.zeros((11, 2)))
    with pytest.raises(KeyboardInterrupt):
        _lsgp.pack_islands(np.zeros((1, 3, 2)), np.array([7], np.int32), PACKING, None, None)


def test_objects_that_were_not_made_are_refused() -> None:
    """`__new__` gives one, where `__init__` was not called or there is none."""
    refused = 0
    for name, value in vars(_lsgp).items():
        for member in vars(value) if inspect.isclass(value) else ():
            if member.startswith("_"):
                continue
            with pytest.raises(TypeError, match="without __init__"):
                taken = getattr(value.__new__(value), member)
                taken(*FUNCTIONS[f"{name}.{member}"][1])
            refused += 1
    assert refused > 10
    with pytest.raises(TypeError, match="without __init__"):
        _lsgp.Solver(FUNCTIONS["Solver"][1][0], _lsgp.Solver.__new__(_lsgp.Solver))
