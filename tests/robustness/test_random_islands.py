# SPDX-License-Identifier: GPL-3.0-or-later
"""Random islands, most of which no mesh should have, are packed as promised or refused with what is wrong.

A sample runs at every change, 2,000 every night. As a script this module packs those from a seed on, and goes on after
faults:

    PYTHONPATH=tests python tests/robustness/test_random_islands.py [FIRST COUNT]
"""

from __future__ import annotations

import sys
from typing import Any

import lsgp
import numpy as np
import pytest
from nightly import nightly
from random_islands import Random, layout, layout_faults

SEEDS = [*range(40), *nightly(*range(40, 2000))]
MARGINS = (0.0, 1e-6, 1 / 1024, 4 / 1024, 0.03)


def how_to_pack(seed: int) -> dict[str, Any]:
    random = Random([seed, 1])
    return {
        "margin": MARGINS[random.randint(len(MARGINS))],
        "fill": bool(random.randint(4)),
        "turned": (True, True, False, "quarters")[random.randint(4)],
        "effort": ("quick", "good")[random.randint(4) == 0],
    }


def faults(seed: int) -> list[str]:
    """Of what a layout becomes; none where it is refused as it has to be."""
    given, how = layout(seed), how_to_pack(seed)
    if not how["fill"]:
        how["margin"] *= float(np.ptp(given.corner_uv.reshape(-1, 2), axis=0).max())
    uv, island = given.corner_uv.copy(), given.island.copy()
    try:
        packed = lsgp.pack_islands(uv, island, **how)
        again = lsgp.pack_islands(uv, island, **how)
    except lsgp.InputError as error:
        return [] if is_sound(error) else [f"refused: {error}"]
    found = layout_faults(given, packed, how["margin"], fill=how["fill"])
    if packed.tobytes() != again.tobytes():
        found.append("the second layout is another one")
    if not (np.array_equal(uv, given.corner_uv) and np.array_equal(island, given.island)):
        found.append("the arguments were changed")
    return found


def is_sound(error: lsgp.InputError) -> bool:
    """Whether it says what to do."""
    return error.code == "WRONG_PARAMETER" and any(word in error.message for word in ("margin", "leave out", "Scale"))


@pytest.mark.parametrize("seed", SEEDS)
def test_random_islands_are_packed_as_promised(seed: int) -> None:
    assert faults(seed) == []


@pytest.mark.parametrize("exponent", [-1000, 1000])
def test_islands_of_any_size_are_packed_alike(exponent: int) -> None:
    """To the last bit; and what is wrong with a layout is found at any size."""
    given, margin = layout(3, most=8), 0.01
    uv = np.ldexp(given.corner_uv, -int(np.frexp(np.abs(given.corner_uv).max())[1]))
    packed = lsgp.pack_islands(uv, given.island, margin, fill=False, effort="quick")
    large, wide = np.ldexp(uv, exponent), float(np.ldexp(margin, exponent))
    found = lsgp.pack_islands(large, given.island, wide, fill=False, effort="quick")
    assert np.array_equal(found, np.ldexp(packed, exponent))
    assert not layout_faults(given, found, wide, fill=False)
    assert layout_faults(given, found, 2 * wide, fill=False)


if __name__ == "__main__":
    begin, number = map(int, sys.argv[1:] or ("0", "2000"))
    bad = 0
    for one in range(begin, begin + number):
        if found := faults(one):
            bad += 1
            print(one, how_to_pack(one), *found, sep="; ", flush=True)
    print(f"{bad} of {number} layouts have faults")
    sys.exit(bool(bad))
