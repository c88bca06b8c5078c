# SPDX-License-Identifier: GPL-3.0-or-later
"""The packer is asked only for layouts that are there, and waits for threads before it frees what they belong to."""

from __future__ import annotations

import hashlib
import math
import sys
import threading

import numpy as np
import pytest
from lsgp.layouts import chart_packer
from lsgp.layouts.chart_packer import Islands
from lsgp.layouts.layout_search import islands_of


def stars(count: int, seed: int) -> Islands:
    """Star-shaped islands of random sizes, 10 to 100 texels wide; the last one is a copy of the first."""
    random = np.random.default_rng(seed)
    corners = np.exp(2j * np.pi * np.arange(12) / 12) * random.uniform(5, 50, (count, 1)) * random.uniform(0.3, 1, 12)
    corners[-1] = corners[0]
    triangles = np.stack([np.zeros_like(corners), corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 3)
    return islands_of(np.stack([triangles.real, triangles.imag], axis=2), np.repeat(np.arange(count), 12))


@pytest.mark.parametrize("padding", [0, 1, 7])
@pytest.mark.parametrize("count", [1, 2, 3, 6, 40])
def test_the_packer_finds_no_layout_where_a_quick_look_finds_none(
    monkeypatch: pytest.MonkeyPatch, padding: int, count: int
) -> None:
    pytest.importorskip("xatlas", reason="tight layouts take pip install 'lsgp[pack]'")
    looked = []

    def look(*given: object) -> bool:
        looked.append(islands_fit(*given))
        return True

    islands_fit = chart_packer._lsgp.islands_fit
    monkeypatch.setattr(chart_packer._lsgp, "islands_fit", look)
    for seed in range(6):
        islands = stars(count, seed)
        size = islands.boxes(islands.place)[1]
        least = int(max(size.real.max(), size.imag.max())) + 3
        most = math.ceil(math.sqrt((size.real + 2 * padding + 2) @ (size.imag + 2 * padding + 2))) + least
        looked.clear()
        found = [
            chart_packer._run(islands, inside, padding) is not None
            for inside in range(least, most, 1 + (most - least) // 20)
        ]
        assert looked == found
        assert found[-1]
        assert count == 1 or not found[0]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells what threads do")
def test_threads_that_run_are_waited_for_and_those_that_sleep_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chart_packer, "_MOST_SETTLING", 60.0)
    others = chart_packer._threads()
    is_running, is_done, may_end = threading.Event(), threading.Event(), threading.Event()

    def work() -> None:
        is_running.set()
        hashlib.pbkdf2_hmac("sha256", b"", b"", 100_000)  # without the interpreter's lock
        is_done.set()
        may_end.wait()

    thread = threading.Thread(target=work)
    thread.start()
    is_running.wait()
    chart_packer._settle(others)
    assert is_done.is_set()
    assert thread.is_alive()
    may_end.set()
    thread.join()
