# SPDX-License-Identifier: GPL-3.0-or-later
"""The interpreter is free while the library computes, and two threads may compute at once."""

from __future__ import annotations

import threading
import time

import meshes
import numpy as np
from map_checks import unwrap


def test_another_thread_runs_during_a_solve() -> None:
    """With the interpreter held, no tick could fall into the middle half of a call; one call of five is enough."""
    mesh = meshes.bumpy_sphere(5)
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    clock = threading.Thread(target=tick)
    clock.start()
    try:
        during = 0
        for _ in range(5):
            begin = time.perf_counter()
            unwrap(mesh)
            end = time.perf_counter()
            low, high = begin + (end - begin) / 4, end - (end - begin) / 4
            during = max(during, sum(low < t < high for t in list(ticks)))
            if during:
                break
    finally:
        done.set()
        clock.join()
    assert during > 0


def test_threads_do_not_disturb_each_other() -> None:
    parts = [meshes.bumpy_sphere(3), meshes.flower(4), meshes.disk_with_holes(18, 3)]
    expected = [unwrap(part).corner_uv for part in parts]
    found: list[np.ndarray | None] = [None] * len(parts)

    def work(i: int) -> None:
        found[i] = unwrap(parts[i]).corner_uv

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(parts))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(a, b) for a, b in zip(expected, found, strict=True))
