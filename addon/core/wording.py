# SPDX-License-Identifier: GPL-3.0-or-later
"""The library's sentences as an artist reads them: one stretch, controls by their names, no codes."""

from __future__ import annotations

import re

_NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_DEGREES = re.compile(rf"({_NUMBER}) degrees\b")
_CODE = re.compile(r" \([A-Z]+(?:_[A-Z]+)+\)")
_DECIMALS = re.compile(r"\b\d+\.\d{4,}\b(?!°)")
# The library has one word for what it can do in several ways; here it is a control.
_PHRASES = (
    ("an L2 stretch", "a stretch"),
    ("L2 stretch", "stretch"),
    ("place them automatically", "use Auto Unwrap"),
    ("choose to split overlaps", "set Overlaps to Split"),
)


def for_artists(message: str) -> str:
    """The sentence of an error or warning as it is shown in Blender."""
    message = _DEGREES.sub(r"\1°", _CODE.sub("", message))
    for phrase, shown in _PHRASES:
        message = message.replace(phrase, shown)
    return _DECIMALS.sub(lambda found: f"{float(found[0]):.4g}", message)
