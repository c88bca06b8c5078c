# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments of public functions: converted to the library's types, or refused by name.

All raise InputError: WRONG_PARAMETER, WRONG_SHAPE, WRONG_DTYPE, INDEX_OUT_OF_RANGE; and SolverError (OUT_OF_MEMORY)
where a copy of an array does not fit into memory, as one whose elements are the same number in memory may be too large.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sized
from itertools import islice
from numbers import Integral, Real
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ..errors import Elements, InputError, SolverError

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

_INT32 = np.iinfo(np.int32)
_MOST_SHOWN = 60


def refuse(name: str, value: object, remedy: str) -> NoReturn:
    """remedy: what to pass instead."""
    raise InputError("WRONG_PARAMETER", f"{name} is {shown(value)}; {remedy}.")


def shown(value: object) -> str:
    """A value as text for a message: short, on one line."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # an integer of more digits than Python prints, or an object whose repr fails
        return f"a value of the type {type(value).__name__}"
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."


def require_type(name: str, value: Any, kind: type) -> None:
    if not isinstance(value, kind):
        refuse(name, value, f"pass a {kind.__name__}")


def require_choice(name: str, value: Any, choices: Iterable[Any]) -> None:
    # Compared one by one and by type: an array has no truth value, and True equals 1.
    if not any(type(value) is type(choice) and value == choice for choice in choices):
        refuse(name, value, f"choose one of {', '.join(map(str, choices))}")


def require_callable(progress: Callable | None) -> None:
    if not (progress is None or callable(progress)):
        raise TypeError(f"progress is {shown(progress)}; pass a function that takes what is done, or None.")


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, bool | np.bool_):
        refuse(name, value, "pass True or False")
    return bool(value)


def number(name: str, value: Any, remedy: str = "pass a number") -> float:
    """A real number, infinite or NaN ones included."""
    if is_number(value):
        try:
            return float(value)
        except OverflowError:  # an integer of more than 308 digits
            pass
    refuse(name, value, remedy)


def positive(name: str, value: Any, remedy: str = "pass a number above 0") -> float:
    found = number(name, value, remedy)
    if not (math.isfinite(found) and found > 0):
        refuse(name, value, remedy)
    return found


def whole_number(name: str, value: Any, least: int, remedy: str) -> int:
    """An integer of 32 bits that is no less than `least`."""
    if not isinstance(value, Integral) or isinstance(value, bool) or not least <= value <= _INT32.max:
        refuse(name, value, remedy)
    return int(value)


def is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def as_array(name: str, values: ArrayLike) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(
            "WRONG_SHAPE", f"{name} cannot be made an array: {shown(values)}. Pass rows of equally many numbers."
        ) from error


def floats(name: str, values: ArrayLike) -> FloatArray:
    """Numbers of any shape, contiguous."""
    array = as_array(name, values)
    if array.dtype.kind not in "fiu":
        raise InputError("WRONG_DTYPE", f"{name} holds {_held(array)}; pass numbers.")
    with np.errstate(over="ignore"):  # numbers too large for a double are infinite, which has an error of its own
        return contiguous(name, array, np.float64)


def float_rows(name: str, values: ArrayLike, width: int) -> FloatArray:
    array = as_array(name, values)
    if array.size == 0:
        return np.empty((0, width), np.float64)
    _require_shape(name, array, array.ndim == 2 and array.shape[1] == width, f"(n, {width})")
    return floats(name, array)


def floats_of_shape(name: str, values: ArrayLike, shape: tuple[int, ...], what: str = "") -> FloatArray:
    """what: follows the expected shape in the message."""
    array = as_array(name, values)
    _require_shape(name, array, array.shape == shape, f"{shape}{what}")
    return floats(name, array)


def corner_coordinates(name: str, values: ArrayLike, triangle_count: int) -> FloatArray:
    """(m, 3, 2)."""
    return floats_of_shape(name, values, (triangle_count, 3, 2), ", one (u, v) per corner")


def index_rows(name: str, values: ArrayLike, width: int) -> IndexArray:
    array = as_array(name, values)
    if array.size == 0:
        return np.empty((0, width), np.int32)
    _require_shape(name, array, array.ndim == 2 and array.shape[1] == width, f"(n, {width})")
    return _indices(name, array)


def index_vector(name: str, values: ArrayLike) -> IndexArray:
    array = as_array(name, values)
    if array.size == 0:
        return np.empty(0, np.int32)
    _require_shape(name, array, array.ndim == 1, "(n,)")
    return _indices(name, array)


def flags(name: str, values: ArrayLike, count: int) -> NDArray[np.bool_]:
    array = as_array(name, values)
    _require_shape(name, array, array.shape == (count,), f"({count},)")
    if array.size and array.dtype.kind != "b":
        raise InputError("WRONG_DTYPE", f"{name} holds {_held(array)}; pass True or False for each.")
    return array.astype(bool)


def islands(name: str, values: ArrayLike) -> IndexArray:
    """(m,), the island of each triangle, -1 for none; there are no more islands than triangles."""
    island = index_vector(name, values)
    wrong = np.flatnonzero((island < -1) | (island >= len(island)))
    if len(wrong):
        raise InputError(
            "INDEX_OUT_OF_RANGE",
            f"{name} holds {island[wrong[0]]}; pass islands counted from 0, fewer than triangles, or -1 for none.",
            Elements("triangles", wrong.astype(np.int32)),
        )
    return island


def require_indices(name: str, indices: IndexArray, count: int) -> None:
    """Refuse indices, (k,) or (k, d), that are not from 0 to count - 1."""
    outside = (indices < 0) | (indices >= count)
    if outside.any():
        raise InputError("INDEX_OUT_OF_RANGE", f"{name} holds {indices[outside][0]}; pass indices below {count}.")


def cone_angles(name: str, angles: Iterable[float | None] | None, count: int) -> list[float | None]:
    """One for each of `count` cones, None where they are automatic. Raises InputError: ANGLE_COUNT as well."""
    if angles is None:
        return [None] * count
    try:
        given = list(islice(angles, count + 1))  # there may be any number of them
    except TypeError:
        refuse(name, angles, "pass a number or None for each cone")
    if len(given) != count:
        found = len(angles) if isinstance(angles, Sized) else f"{len(given)} or more"
        raise InputError("ANGLE_COUNT", f"There are {count} cones but {found} {name}. Give one for each.")
    return [
        None if angle is None else number(f"{name}[{i}]", angle, "pass a number or None for each cone")
        for i, angle in enumerate(given)
    ]


def _indices(name: str, array: NDArray[Any]) -> IndexArray:
    if array.dtype.kind not in "iu":
        raise InputError("WRONG_DTYPE", f"{name} holds {_held(array)}; pass whole numbers.")
    converted = contiguous(name, array, np.int32)
    if converted is not array:
        for extreme in (array.max(), array.min()):
            if not _INT32.min <= extreme <= _INT32.max:
                raise InputError("INDEX_OUT_OF_RANGE", f"{name} holds {extreme}; indices must fit 32 bits.")
    return converted


def contiguous(name: str, array: NDArray[Any], dtype: DTypeLike) -> NDArray[Any]:
    """Row by row and aligned in memory, a copy where it is not.  Raises SolverError: OUT_OF_MEMORY."""
    try:
        return np.require(array, dtype, ["C", "A"])
    except MemoryError as error:
        megabytes = math.ceil(array.size * np.dtype(dtype).itemsize / 1e6)
        raise SolverError(
            "OUT_OF_MEMORY",
            f"{name} has shape {array.shape}, for which {megabytes} MB of memory are needed and not left. Pass fewer "
            "elements.",
        ) from error


def _require_shape(name: str, array: NDArray[Any], fits: bool, expected: str) -> None:
    if not fits:
        raise InputError("WRONG_SHAPE", f"{name} has shape {array.shape}; pass {expected}.")


def _held(array: NDArray[Any]) -> str:
    return str(array.dtype) if array.ndim else shown(array[()])
