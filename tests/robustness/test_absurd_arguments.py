# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public function, every parameter, every absurd value: a result, or an error of the library that has a code."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import lsgp
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from public_calls import FILES, FUNCTIONS, NOT_CALLED, other_arrays, public_names

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
    "path": ["A cut"],
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
    public = set(public_names())
    assert public >= FILES and set(lsgp.__all__) >= NOT_CALLED
    assert public - FILES == FUNCTIONS.keys()
    for function, accepted in FUNCTIONS.values():
        assert set(inspect.signature(function).parameters) == set(accepted)
        function(**accepted)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "parameter"), PARAMETERS)
def test_absurd_values_are_refused_by_name(name: str, parameter: str) -> None:
    for absurd in [*NUMBERS, *OBJECTS]:
        for put in list(places(FUNCTIONS[name][1][parameter]))[:1]:
            require_a_result_or_a_refusal(name, parameter, put(absurd))


ARRAYS = [
    (name, parameter)
    for name, (_, known) in FUNCTIONS.items()
    for parameter, value in known.items()
    if isinstance(value, np.ndarray) and value.dtype != object
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "parameter"), ARRAYS)
def test_other_arrays_are_refused_by_name(name: str, parameter: str) -> None:
    """Of all types, shapes, lengths and layouts in memory, with the extremes of their type in places."""
    for other in other_arrays(FUNCTIONS[name][1][parameter]):
        require_a_result_or_a_refusal(name, parameter, other)


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


@pytest.mark.slow
@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(PARAMETERS),
    st.one_of(st.integers(), st.floats(), st.text(max_size=5), st.complex_numbers(), st.lists(st.floats(), max_size=4)),
)
def test_any_value_is_refused_by_name(where: tuple[str, str], value: Any) -> None:
    require_a_result_or_a_refusal(*where, value)
