# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of points on a model by where one sees them from its front."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

# Along z, y and x: the lower third of the model and the upper one. Seen from the front, -x is on the left.
ENDS = ((2, "Low", "Top"), (1, "Front", "Back"), (0, "Left", "Right"))
MIDDLE = "Middle"


def place_names(points: ArrayLike, box: ArrayLike) -> list[str]:
    """A name for each of (k, 3) points, as "Top Front Left"; those of one name are numbered.

    box: (b, 3), points that the model lies between.
    """
    points, box = np.asarray(points, float).reshape(-1, 3), np.asarray(box, float)
    low, size = box.min(axis=0), np.ptp(box, axis=0)
    share = np.divide(points - low, size, out=np.full(points.shape, 0.5), where=size > 0)
    return _numbered([_name(at) for at in np.clip(share, 0, 1).tolist()])


def _name(share: Sequence[float]) -> str:
    words = [(lower, "", upper)[min(int(3 * share[axis]), 2)] for axis, lower, upper in ENDS]
    return " ".join(filter(None, words)) or MIDDLE


def _numbered(names: Sequence[str]) -> list[str]:
    total, count, numbered = Counter(names), Counter(), []
    for name in names:
        count[name] += 1
        numbered.append(f"{name} {count[name]}" if total[name] > 1 else name)
    return numbered
