# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of parameter values that cover all pairs: any value of one parameter with any value of any other."""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable, Mapping, Sequence
from typing import Any

Row = dict[str, Any]
Pair = tuple[tuple[str, int], tuple[str, int]]  # parameters and the places of their values


def all_pairs(values: Mapping[str, Sequence[Any]], allowed: Callable[[Row], bool] = lambda row: True) -> set[Pair]:
    """allowed: of a row that may have only some of the parameters."""
    found = set()
    for (a, of_a), (b, of_b) in itertools.combinations(sorted(values.items()), 2):
        for i, j in itertools.product(range(len(of_a)), range(len(of_b))):
            if allowed({a: of_a[i], b: of_b[j]}):
                found.add(((a, i), (b, j)))
    return found


def pairs_in(row: Mapping[str, int]) -> set[Pair]:
    """row: places of values."""
    return set(itertools.combinations(sorted(row.items()), 2))


def covering_rows(
    values: Mapping[str, Sequence[Any]], allowed: Callable[[Row], bool] = lambda row: True, tries: int = 8
) -> list[Row]:
    """Rows with a value of every parameter that together have every pair, not many more than needed.

    Greedy: of some rows that begin with the first pair not yet covered and are completed, in random order, parameter
    by parameter with the value that covers most, the one is taken that covers most; always the same.
    """
    rng, missing, rows = random.Random(0), all_pairs(values, allowed), []
    for begin in sorted(missing):
        if begin not in missing:
            continue
        drawn = [_completed(dict(begin), values, missing, allowed, rng) for _ in range(tries)]
        best = max(drawn, key=lambda row: len(pairs_in(row) & missing))
        missing -= pairs_in(best)
        rows.append({name: values[name][i] for name, i in best.items()})
    return rows


def _completed(
    row: dict[str, int],
    values: Mapping[str, Sequence[Any]],
    missing: set[Pair],
    allowed: Callable[[Row], bool],
    rng: random.Random,
) -> dict[str, int]:
    for name in rng.sample(sorted(set(values) - set(row)), len(values) - len(row)):
        chosen = {other: values[other][i] for other, i in row.items()}
        possible = [i for i in range(len(values[name])) if allowed({**chosen, name: values[name][i]})]
        rng.shuffle(possible)
        row[name] = max(possible, key=lambda i: sum(_pair(name, i, *one) in missing for one in row.items()))
    return row


def _pair(a: str, i: int, b: str, j: int) -> Pair:
    return ((a, i), (b, j)) if a < b else ((b, j), (a, i))
