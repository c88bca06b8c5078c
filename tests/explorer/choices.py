# SPDX-License-Identifier: GPL-3.0-or-later
"""The source of the choices of random steps: a seed, or Hypothesis, which can shrink them."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any, Protocol, TypeVar

from hypothesis import strategies as st

T = TypeVar("T")


class Choices(Protocol):
    def whole(self, low: int, high: int) -> int: ...

    def pick(self, values: Sequence[T]) -> T: ...


class SeededChoices:
    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def whole(self, low: int, high: int) -> int:
        return self._random.randint(low, high)

    def pick(self, values: Sequence[T]) -> T:
        return self._random.choice(values)


class HypothesisChoices:
    """data: of the strategy st.data()."""

    def __init__(self, data: Any) -> None:
        self._data = data

    def whole(self, low: int, high: int) -> int:
        return self._data.draw(st.integers(low, high))

    def pick(self, values: Sequence[T]) -> T:
        return self._data.draw(st.sampled_from(values))
