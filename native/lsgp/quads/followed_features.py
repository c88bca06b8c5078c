# SPDX-License-Identifier: GPL-3.0-or-later
"""How far layouts follow the features of their surface."""

from __future__ import annotations

from ..results import Result

_MANY, _NEARLY_ALL = 0.25, 0.9


def feature_share(layout: Result) -> float:
    """Of the length of marked features, or of creases if none are marked: what runs along the lattice."""
    if layout.features is not None:
        return layout.features.share
    return layout.seamless.feature_share or 0.0


def runs_along_features(layout: Result) -> bool:
    """Whether a quarter of that length runs there."""
    return feature_share(layout) >= _MANY


def releases_many_features(layout: Result) -> bool:
    """Whether more than a tenth of it does not."""
    return feature_share(layout) < _NEARLY_ALL
