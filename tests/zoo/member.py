# SPDX-License-Identifier: GPL-3.0-or-later
"""Members of the zoo, and how families of them are declared."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from meshes import IndexArray, Mesh

Size = Literal["small", "large"]
Parameters = dict[str, Any]
# A mesh and, where its polygons have diagonals, the edges that cuts may follow.
Made = Mesh | tuple[Mesh, IndexArray]


@dataclass(frozen=True)
class Member:
    """One mesh of the zoo.

    name: family and parameters.  ordinary: a well-formed model, of which a map has to come out with automatic cones.
    size: "small" ones are for every run of the tests.
    """

    name: str
    family: str
    parameters: Parameters
    ordinary: bool
    size: Size
    make: Callable[..., Made]

    def mesh(self) -> Mesh:
        made = self.make(**self.parameters)
        return made if isinstance(made, Mesh) else made[0]

    def edges(self) -> IndexArray | None:
        """Edges that cuts may follow; None for all."""
        made = self.make(**self.parameters)
        return None if isinstance(made, Mesh) else made[1]


def family(
    name: str,
    make: Callable[..., Made],
    small: Sequence[Parameters],
    large: Sequence[Parameters] = (),
    *,
    ordinary: bool = True,
) -> Iterator[Member]:
    sizes: list[tuple[Size, Sequence[Parameters]]] = [("small", small), ("large", large)]
    for size, sets in sizes:
        for parameters in sets:
            told = "-".join([name, *(f"{key}={_short(value)}" for key, value in parameters.items())])
            yield Member(told, name, parameters, ordinary, size, make)


def _short(value: object) -> str:
    return "x".join(map(_short, value)) if isinstance(value, tuple) else f"{value:g}" if _is_real(value) else str(value)


def _is_real(value: object) -> bool:
    return isinstance(value, float)


def each(**choices: Sequence[Any]) -> list[Parameters]:
    """All combinations of the values of each parameter."""
    sets: list[Parameters] = [{}]
    for key, values in choices.items():
        sets = [{**one, key: value} for one in sets for value in values]
    return sets
