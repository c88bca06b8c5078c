# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the library: cause, place, amount and remedy.

Every error has a ``code`` with a permanent meaning, a ``message`` for artists that ends with a remedy, and the
``elements`` concerned in the caller's numbering, so that a user interface can select them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .base.equality import EqualByContent
from .base.short_repr import ShortRepr


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Elements(EqualByContent, ShortRepr):
    """The mesh elements that a finding concerns.

    kind: "vertices", "edges" or "triangles" ("faces" once mapped to the polygons of a file).
    indices: (k,) int32, or (k, 2) int32 vertex pairs for edges.
    """

    kind: str = "vertices"
    indices: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, np.int32))

    def __str__(self) -> str:
        """For a sentence: the kind and the first few elements; empty where there are none."""
        shown = 5
        if not len(self.indices):
            return ""
        first = ", ".join(
            "-".join(map(str, i)) if isinstance(i, list) else str(i) for i in self.indices[:shown].tolist()
        )
        rest = f" and {len(self.indices) - shown} more" if len(self.indices) > shown else ""
        return f"{self.kind} {first}{rest}"


@dataclass(frozen=True, slots=True)
class Finding:
    """A warning about a usable result: a code, a sentence and the elements concerned."""

    code: str
    message: str
    elements: Elements = field(default_factory=Elements)


class LsgpError(Exception):
    """Base of all errors raised by the library."""

    def __init__(self, code: str, message: str, elements: Elements | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.elements = elements if elements is not None else Elements()

    def __reduce__(self) -> tuple[Any, ...]:
        """Lets errors be copied and pickled: Python alone would keep the message and lose the other fields."""
        return type(self), (self.code, self.message, self.elements), self.__dict__

    def __str__(self) -> str:
        where = str(self.elements)
        return f"{self.message} ({where})" if where else self.message


class InputError(LsgpError, ValueError):
    """Arrays, indices, seams, options or coordinates that cannot be used as they are."""


class TopologyError(LsgpError):
    """A surface on which no map with these cones can exist."""


class CurvatureError(LsgpError):
    """Cone angles that no flat metric has; the message states their sum and the required sum."""


class SolverError(LsgpError):
    """A factorization or an iteration failed."""


class Cancelled(LsgpError):
    """The caller asked to stop."""
