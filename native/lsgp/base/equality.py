# SPDX-License-Identifier: GPL-3.0-or-later
"""Equality of dataclasses that hold arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


class EqualByContent:
    """Equal where all compared fields are, arrays element by element; NaN equals NaN.

    For dataclasses made with eq=False, whose own comparison asks arrays for one truth value. Not hashable, because
    arrays can be written to.
    """

    __slots__ = ()
    __hash__ = None

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        compared = (field.name for field in fields(self) if field.compare)
        return all(_equal(getattr(self, name), getattr(other, name)) for name in compared)


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return np.array_equal(a, b, equal_nan=True)
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return False
    if isinstance(a, list | tuple):
        return type(a) is type(b) and len(a) == len(b) and all(map(_equal, a, b))
    return bool(a == b or (a != a and b != b))
