# SPDX-License-Identifier: GPL-3.0-or-later
"""Color scales of the distortion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Keeps shading and wires visible.
OPACITY = 0.75


@dataclass(frozen=True, slots=True)
class Scale:
    """Values from ``least`` to ``most`` with colors in between, on a logarithmic scale.

    label: what is shown. ends: texts for the least, the middle and the most.
    """

    label: str
    least: float
    most: float
    colors: tuple[tuple[float, float, float], ...]
    ends: tuple[str, str, str]

    def colors_of(self, values: ArrayLike) -> NDArray[np.float32]:
        """(n, 4) of (n,) values; values beyond the scale have the color of its end."""
        values = np.clip(np.asarray(values, np.float64), self.least, self.most)
        place = np.log(values / self.least) / np.log(self.most / self.least)
        stops = np.linspace(0.0, 1.0, len(self.colors))
        channels = [np.interp(place, stops, channel) for channel in zip(*self.colors, strict=True)]
        return np.stack([*channels, np.full(len(values), OPACITY)], axis=1).astype(np.float32)


# Both work for people who cannot tell red from green.
_GOOD_TO_BAD = ((0.93, 0.95, 0.97), (0.99, 0.80, 0.35), (0.88, 0.30, 0.12), (0.45, 0.02, 0.20))
_LOW_TO_HIGH = ((0.05, 0.20, 0.65), (0.40, 0.68, 0.90), (0.94, 0.94, 0.92), (0.98, 0.62, 0.30), (0.70, 0.10, 0.08))

SCALES = {
    "conformal": Scale("Angles, 1 is kept", 1.0, 2.0, _GOOD_TO_BAD, ("1", "1.4", "2")),
    "area": Scale("Texture area, 1 is even", 0.25, 4.0, _LOW_TO_HIGH, ("1/4", "1", "4")),
    "stretch": Scale("Stretch, 1 is none", 0.5, 2.0, _LOW_TO_HIGH, ("1/2", "1", "2")),
}
