# SPDX-License-Identifier: GPL-3.0-or-later
"""The bytes of layouts of all kinds of islands, for processes that do not have what tests need."""

from __future__ import annotations

import hashlib

import lsgp
from island_kits import KINDS, kit

WAYS = ({}, {"fill": False}, {"turned": "quarters"}, {"udim": 3}, {"snap": 1 / 256})


def digest() -> str:
    """Each way of packing, quickly, and islands of every size with some effort."""
    packed = [lsgp.pack_islands(*kit(kind, 9), 1 / 256, effort="quick", **how) for kind in KINDS for how in WAYS]
    packed.append(lsgp.pack_islands(*kit("mixed", 20), 1 / 256, effort="good"))
    return hashlib.sha256(b"".join(uv.tobytes() for uv in packed)).hexdigest()
