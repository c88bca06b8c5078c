# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays as callers have them: every layout of the same numbers gives the same bytes, anything else is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import _lsgp
from map_checks import surface

MESH = meshes.bumpy_sphere(1)
SEAMS = MESH.triangles[:3, :2]
EXPECTED = lsgp.parameterize(surface(MESH, seams=SEAMS), MESH.cones).corner_uv


def strided(array: np.ndarray) -> np.ndarray:
    """The same numbers with gaps between them in memory."""
    wide = np.zeros(tuple(3 * n for n in array.shape), array.dtype)
    wide[tuple(slice(1, None, 3) for _ in array.shape)] = array
    return wide[tuple(slice(1, None, 3) for _ in array.shape)]


def read_only(array: np.ndarray) -> np.ndarray:
    array = array.copy()
    array.flags.writeable = False
    return array


def unaligned(array: np.ndarray) -> np.ndarray:
    raw = np.empty(array.nbytes + 1, np.uint8)
    out = raw[1:].view(array.dtype).reshape(array.shape)
    out[...] = array
    return out


LAYOUTS: dict[str, Callable[[np.ndarray], object]] = {
    "column by column": np.asfortranarray,
    "strided": strided,
    "backwards": lambda a: a[::-1].copy()[::-1],
    "read-only": read_only,
    "unaligned": unaligned,
    "big endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "lists": lambda a: a.tolist(),
    "matrix of a subclass": lambda a: np.ma.masked_array(a),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_layout_in_memory_does_not_matter(layout: str) -> None:
    change = LAYOUTS[layout]
    given = lsgp.Surface(change(MESH.positions), change(MESH.triangles), None, change(SEAMS))
    result = lsgp.parameterize(given, change(MESH.cones))
    assert np.array_equal(result.corner_uv, EXPECTED)
    measured = lsgp.measure_distortion(given, change(EXPECTED), change(MESH.cones))
    assert measured.distortion == result.distortion


@pytest.mark.parametrize("dtype", ["i1", "i2", "i8", "u1", "u2", "u4", "u8"])
def test_integers_of_any_width_are_indices(dtype: str) -> None:
    given = lsgp.Surface(MESH.positions, MESH.triangles.astype(dtype), None, SEAMS.astype(dtype))
    assert np.array_equal(lsgp.parameterize(given, MESH.cones.astype(dtype)).corner_uv, EXPECTED)


@pytest.mark.parametrize("dtype", ["f2", "f4", "i4", "g"])
def test_coordinates_of_any_number_type_are_their_doubles(dtype: str) -> None:
    positions = (8 * MESH.positions).astype(dtype)
    result = lsgp.parameterize(lsgp.Surface(positions, MESH.triangles), MESH.cones)
    expected = lsgp.parameterize(lsgp.Surface(positions.astype(np.float64), MESH.triangles), MESH.cones)
    assert np.array_equal(result.corner_uv, expected.corner_uv)


TYPES = {
    "booleans": lambda a: a.astype(bool),
    "complex": lambda a: a.astype(complex),
    "objects": lambda a: a.astype(object),
    "text": lambda a: a.astype(str),
    "dates": lambda a: a.astype(np.int64).astype("M8[s]"),
    "records": lambda a: np.zeros(a.shape, [("x", "i4"), ("y", "f8")]),
}
SHAPES = {
    "one axis less": lambda a: a.ravel() if a.ndim > 1 else a[0],
    "one axis more": lambda a: a[None],
    "transposed": lambda a: a.T if a.ndim > 1 else a[:, None],
    "one column more": lambda a: np.concatenate([a, a[..., :1]], axis=-1) if a.ndim > 1 else np.stack([a, a]),
}
FIELDS = ("positions", "triangles", "edges", "seams")


@pytest.mark.parametrize("kind", [*TYPES, *SHAPES])
@pytest.mark.parametrize("field", FIELDS)
def test_a_surface_refuses_other_types_and_shapes(field: str, kind: str) -> None:
    arrays = {"positions": MESH.positions, "triangles": MESH.triangles, "edges": MESH.triangles[:, :2], "seams": SEAMS}
    with pytest.raises(lsgp.InputError, match=field) as caught:
        lsgp.Surface(**arrays | {field: (TYPES | SHAPES)[kind](arrays[field])})
    assert caught.value.code == ("WRONG_DTYPE" if kind in TYPES else "WRONG_SHAPE")


@pytest.mark.parametrize("kind", [*TYPES, *SHAPES])
def test_verbs_refuse_other_types_and_shapes_of_cones(kind: str) -> None:
    cones = (TYPES | SHAPES)[kind](MESH.cones)
    for verb in (lsgp.parameterize, lsgp.find_cuts, lsgp.prescribe_curvature):
        with pytest.raises(lsgp.InputError):
            verb(surface(MESH), cones)
    with pytest.raises(lsgp.InputError):
        lsgp.place_cones(surface(MESH), cones, count=4)
    with pytest.raises(lsgp.InputError):
        lsgp.measure_distortion(surface(MESH), EXPECTED, cones)


@pytest.mark.parametrize("kind", [*TYPES, *SHAPES])
def test_measuring_refuses_other_types_and_shapes(kind: str) -> None:
    with pytest.raises(lsgp.InputError, match="corner_uv"):
        lsgp.measure_distortion(surface(MESH), (TYPES | SHAPES)[kind](EXPECTED))
    with pytest.raises(lsgp.InputError, match="corner_uv"):
        lsgp.extract_quads(surface(MESH), (TYPES | SHAPES)[kind](EXPECTED))


@pytest.mark.parametrize("value", [2**31 - 1, 2**31, 2**32, 2**63 - 1, -1, -(2**31), -(2**31) - 1, -(2**63)])
@pytest.mark.parametrize("where", ["triangles", "edges", "seams", "cones", "pins"])
def test_huge_and_negative_indices_are_refused(where: str, value: int) -> None:
    given = {name: array.astype(np.int64) for name, array in (("triangles", MESH.triangles), ("seams", SEAMS))}
    given |= {"edges": meshes.edges_of(MESH.triangles).astype(np.int64), "cones": MESH.cones.astype(np.int64)}
    given["pins"] = np.array([0, 1])
    given[where].flat[1] = value
    with pytest.raises(lsgp.InputError) as caught:
        whole = lsgp.Surface(MESH.positions, given["triangles"], given["edges"], given["seams"])
        lsgp.parameterize(whole, given["cones"], pins=lsgp.Pins(given["pins"], np.zeros((2, 2))))
    assert caught.value.code in ("INDEX_OUT_OF_RANGE", "CONE_INDEX", "PIN_INDEX")
    assert "32 bits" in caught.value.message or str(value) in str(caught.value) or len(caught.value.elements.indices)


def test_unsigned_indices_beyond_all_integers_are_refused() -> None:
    triangles = MESH.triangles.astype(np.uint64)
    triangles[3, 1] = 2**64 - 1
    with pytest.raises(lsgp.InputError, match="32 bits"):
        lsgp.Surface(MESH.positions, triangles)


@pytest.mark.parametrize("angles", [[1.0], [], np.ones(40), [None] * 7])
def test_as_many_angles_as_cones(angles: list[float | None]) -> None:
    for verb in (lsgp.parameterize, lsgp.prescribe_curvature):
        with pytest.raises(lsgp.InputError) as caught:
            verb(surface(MESH), MESH.cones, angles)
        assert caught.value.code == "ANGLE_COUNT"


@pytest.mark.parametrize("angles", ["wide!", ["a"] * 6, [1j] * 6, [[1.0]] * 6, [{}] * 6, 3.0, np.float64(1)])
def test_angles_are_numbers(angles: object) -> None:
    for verb in (lsgp.parameterize, lsgp.prescribe_curvature):
        with pytest.raises((lsgp.InputError, TypeError, ValueError)):
            verb(surface(MESH), MESH.cones, angles)


@pytest.mark.parametrize("count", [2**31, 2**63, 10**30, -1, 1.5, "4", np.nan])
def test_counts_of_cones_are_small_whole_numbers(count: object) -> None:
    with pytest.raises((lsgp.InputError, TypeError)):
        lsgp.place_cones(surface(MESH), count=count)


def test_more_cones_than_vertices_end_with_those_there_are() -> None:
    assert len(lsgp.place_cones(surface(MESH), count=2**31 - 1).cones) <= len(MESH.positions)


def test_arguments_may_change_after_a_call_and_results_are_writable() -> None:
    given = [MESH.positions.copy(), MESH.triangles.copy(), MESH.cones.copy()]
    result = lsgp.parameterize(lsgp.Surface(given[0], given[1]), given[2])
    expected = result.corner_uv.copy()
    for array in given:
        array[...] = 0
    assert np.array_equal(result.corner_uv, expected)
    for name in ("corner_uv", "solved", "island", "cut_edges", "cones", "cone_angles", "flipped", "log_scale"):
        array = getattr(result, name)
        assert array.flags.writeable and array.flags.c_contiguous
        array[...] = 0
    assert np.array_equal(lsgp.parameterize(surface(MESH, seams=SEAMS), MESH.cones).corner_uv, EXPECTED)


NATIVE = {
    "positions": MESH.positions,
    "triangles": MESH.triangles,
    "edges": None,
    "seams": SEAMS,
    "importance": np.empty(0),
    "cut_costs": np.empty(0),
    "borders": np.empty((0, 2), np.int32),
    "directions": np.empty((0, 3)),
    "features": np.empty((0, 2), np.int32),
    "scale": np.empty(0),
    "cones": MESH.cones,
    "angles": np.zeros(6),
    "has_angle": np.zeros(6, bool),
    "options": {**vars(lsgp.Options()), "prescription": "least-distortion", "loop_turning": {}},
    "pinned_corners": np.empty(0, np.int32),
    "pinned_uv": np.empty((0, 2)),
}
ODD = {
    "nothing": None,
    "a word": "word",
    "a number": 7,
    "an empty list": [],
    "no axes": np.float64(3.0),
    "doubles": np.zeros((5, 3)),
    "single precision": np.zeros((5, 3), np.float32),
    "wide integers": np.zeros((5, 3), np.int64),
    "flags": np.zeros(5, bool),
    "four axes": np.zeros((2, 2, 2, 2), np.int32),
    "no rows": np.zeros((0, 3), np.int32),
    "no columns": np.zeros((4, 0), np.int32),
    "objects": np.array([None, "x"], object),
}


def _parameterize(arguments: dict[str, object]) -> dict[str, object]:
    """The native verb; it takes the arrays of the surface together, and those of the cones."""
    of_surface = ("positions", "triangles", "edges", "seams", "importance", "cut_costs", "borders")
    surface_arrays = (*(arguments[name] for name in (*of_surface, "directions", "features")), False, arguments["scale"])
    return _lsgp.parameterize(
        surface=surface_arrays,
        cones=tuple(arguments[name] for name in ("cones", "angles", "has_angle")),
        options=arguments["options"],
        pins=tuple(arguments[name] for name in ("pinned_corners", "pinned_uv")),
        progress=None,
    )


def test_the_native_layer_takes_what_the_python_layer_passes() -> None:
    assert _parameterize(NATIVE)["corner_uv"].shape == (len(MESH.triangles), 3, 2)


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("argument", NATIVE)
def test_the_native_layer_refuses_what_the_python_layer_would_not_pass(argument: str, odd: str) -> None:
    """Nothing but a Python exception or a result may come of it, whatever the caller gets wrong."""
    arguments = NATIVE | {argument: ODD[odd]}
    try:
        found = _parameterize(arguments)["corner_uv"]
    except (TypeError, ValueError, KeyError, RuntimeError, lsgp.LsgpError):
        return
    assert found.shape == (len(arguments["triangles"]), 3, 2) and np.isfinite(found).all()


@pytest.mark.parametrize("field", [name for name in vars(lsgp.Options())])
@pytest.mark.parametrize("value", [None, 3, "magic", b"follow", [], {}, {1: "x"}, {"x": 1.0}, {2**40: 1.0}, {-1: 1.0}])
def test_options_are_names_from_a_list(field: str, value: object) -> None:
    if (field in ("prescription", "seamless") and value is None) or (field == "loop_turning" and value in ([], {})):
        return
    if field in ("threads", "square_share") and value == 3:
        return
    with pytest.raises((lsgp.InputError, TypeError, ValueError)):
        lsgp.parameterize(surface(MESH), MESH.cones, None, replace(lsgp.Options(), **{field: value}))
