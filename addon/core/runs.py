# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of whole numbers as runs of equal steps: a hundred thousand faces in a row are two runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def as_runs(numbers: Sequence[int]) -> list[int]:
    """A step and how often it is taken, in turn; the first one is from 0."""
    steps = np.diff(np.asarray(numbers, np.int64), prepend=0)
    if not len(steps):
        return []
    begins = np.concatenate([[0], np.flatnonzero(np.diff(steps)) + 1])
    times = np.diff(np.append(begins, len(steps)))
    return np.column_stack([steps[begins], times]).ravel().tolist()


def from_runs(runs: Sequence[int]) -> list[int]:
    """The numbers again."""
    return np.cumsum(np.repeat(np.asarray(runs[0::2], np.int64), runs[1::2])).tolist()
