# SPDX-License-Identifier: GPL-3.0-or-later
"""Previews of moved cones beside the exact maps: time and difference, for `benchmark.py`."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator
from typing import TypeVar

import igl
import lsgp
import numpy as np
from benchmark_cases import SHARED, Case, bumpy_sphere, growing_cases, read_case

T = TypeVar("T")
MODELS = ("hand-5k", "kitten-genus1", "fandisk", "bird", "igea-16k", "julius", "octa-flower")
DENSE, MANY = 50_000, 100
NEAR = 0.02
OPTIONS = lsgp.Options(repair=False)

PREVIEWS = """\
## Previews of dragged cones

`lsgp.Preview` beside `lsgp.Solver`, CPU milliseconds; one of the cones is moved to random vertices. *Making it* is done
once for a surface. The difference is that of texture coordinates after the similarity that fits most of them, as a
share of the layout's longer side. Where a cut takes another way, the piece between both ways is on its other side:
*near* is the share of corners less than 2 % apart.
"""


def preview_cases(largest: int) -> Iterator[Case]:
    """Models, subdivided (Loop) to 50,000 triangles or more, and a head of growing size."""
    if not SHARED.is_dir():
        yield from (bumpy_sphere(level) for level in range(6, 9) if 8 * 4**level <= largest)
        return
    for case in map(read_case, MODELS):
        positions, triangles = case.positions, case.triangles
        while len(triangles) < DENSE:
            positions, triangles = igl.loop(positions, triangles)
        yield Case(case.name, positions, triangles.astype(np.int32), case.cones)
    yield from (case for case in growing_cases(largest) if len(case.triangles) >= 20_000 and len(case.cones) < MANY)


def measure_preview(case: Case, repetitions: int) -> dict[str, object]:
    surface = lsgp.Surface(case.positions, case.triangles)
    solver = lsgp.Solver(surface)
    solver.parameterize(case.cones, None, OPTIONS)
    making, preview = timed(lambda: lsgp.Preview(surface))
    exact_times, preview_times, apart = [], [], []
    for vertex in np.random.default_rng(0).choice(len(case.positions), repetitions, replace=False):
        cones = np.r_[vertex, case.cones[1:]]
        seconds, exact = timed(lambda cones=cones: solver.parameterize(cones, None, OPTIONS))
        exact_times.append(seconds)
        seconds, shown = timed(lambda cones=cones: preview.parameterize(cones, None, OPTIONS))
        preview_times.append(seconds)
        apart.append(distances(exact.corner_uv, shown.corner_uv))
    return {
        "surface": case.name,
        "triangles": f"{len(case.triangles):,}",
        "exact": f"{1e3 * statistics.median(exact_times):.0f}",
        "preview": f"{1e3 * statistics.median(preview_times):.0f}",
        "making it": f"{1e3 * making:.0f}",
        "median difference": f"{statistics.median(float(np.median(each)) for each in apart):.4f}",
        "mean difference": f"{statistics.median(float(each.mean()) for each in apart):.3f}",
        "near": f"{100 * statistics.median(float((each < NEAR).mean()) for each in apart):.0f} %",
    }


def timed(call: Callable[[], T]) -> tuple[float, T]:
    begin = time.process_time()
    result = call()
    return time.process_time() - begin, result


def distances(exact: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """Of corners, after the similarity that brings most of them together, by weights of inverse distances."""
    to, of = (uv.reshape(-1, 2) @ [1, 1j] for uv in (exact, shown))
    weight = np.ones(len(to))
    for _ in range(30):
        middle_to, middle_of = np.average(to, weights=weight), np.average(of, weights=weight)
        factor = (weight * (to - middle_to) * (of - middle_of).conj()).sum()
        apart = abs(to - middle_to - factor / (weight * abs(of - middle_of) ** 2).sum() * (of - middle_of))
        weight = 1 / np.maximum(apart, 1e-3)
    return apart / np.ptp(exact.reshape(-1, 2), axis=0).max()
