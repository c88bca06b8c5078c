# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole map's time and memory on growing meshes, compared with other methods; a part of `benchmark.py`."""

from __future__ import annotations

import math
import statistics
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from benchmark_cases import Case, cut_open
from benchmark_workers import Worker, blender_worker, laplacian_worker, lsgp_worker, python_worker, read_cut

# Blender's methods, and the largest numbers of triangles for which they take acceptable time.
BLENDER = {"ANGLE_BASED": 60_000, "CONFORMAL": 250_000, "MINIMUM_STRETCH": 60_000}
NAMES = {
    "lsgp": "lsgp",
    "edit": "lsgp, angle edited",
    "move": "lsgp, cone moved",
    "eigen": "Laplacian, Eigen",
    "cholmod": "Laplacian, CHOLMOD",
    "lscm": "libigl LSCM",
    "CONFORMAL": "Blender Conformal",
    "ANGLE_BASED": "Blender Angle Based",
    "MINIMUM_STRETCH": "Blender Minimum Stretch",
}
OWN = ("lsgp", "edit", "move")
FLOORS = ("eigen", "cholmod")
FROM_TRIANGLES = 12_000  # the growth is measured from there on: below, constant costs dominate
UNWARMED_TRIANGLES = 500_000


@dataclass
class Measured:
    """seconds, peak_mb: by method, medians. stages: by own method, shares of its time. defects: of lsgp's map."""

    case: Case
    seconds: dict[str, float] = field(default_factory=dict)
    peak_mb: dict[str, float] = field(default_factory=dict)
    stages: dict[str, dict[str, float]] = field(default_factory=dict)
    defects: int = 0

    @property
    def triangles(self) -> int:
        return len(self.case.triangles)

    def ratio_to(self, methods: Iterable[str]) -> float | None:
        others = [self.seconds[method] for method in methods if method in self.seconds]
        return self.seconds["lsgp"] / min(others) if others and "lsgp" in self.seconds else None


def measure(case: Case, repetitions: int, laplacian: Path | None, blender: str | None) -> Measured:
    """All methods in turn, each in a process of its own, after one unmeasured run each."""
    triangles = len(case.triangles)
    is_warm = triangles <= UNWARMED_TRIANGLES
    repetitions = max(3 if is_warm else 1, min(4 * repetitions, repetitions * 60_000 // triangles))
    runs: dict[str, list[dict[str, object]]] = {}
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        workers = {"lsgp": lsgp_worker("lsgp", case, folder)}
        stack.callback(workers["lsgp"].close)
        first = workers["lsgp"].run()
        if first is None:
            return Measured(case)
        for method, worker in _other_workers(case, read_cut(folder), laplacian, blender, folder):
            workers[method] = worker
            stack.callback(worker.close)
        if not is_warm:
            runs["lsgp"] = [first]
        for repetition in range(repetitions + is_warm):
            for method, worker in list(workers.items()):
                if method == "lsgp" and repetition == 0:
                    continue  # done above
                found = worker.run()
                if found is None:
                    del workers[method]
                elif repetition >= is_warm:
                    runs.setdefault(method, []).append(found)
    return _medians(case, runs)


def _other_workers(
    case: Case, cut: np.ndarray, laplacian: Path | None, blender: str | None, folder: Path
) -> Iterator[tuple[str, Worker]]:
    if laplacian is not None:
        yield from ((library, laplacian_worker(laplacian, case, library, folder)) for library in FLOORS)
    if case.is_random:
        return
    yield from ((change, lsgp_worker(change, case, folder)) for change in ("edit", "move"))
    positions, triangles = cut_open(case, cut)
    yield "lscm", python_worker("lscm", folder, positions=positions, triangles=triangles)
    if blender is not None:
        for method, largest in BLENDER.items():
            if len(case.triangles) <= largest:
                yield method, blender_worker(blender, case, cut, method, folder)


def _medians(case: Case, runs: dict[str, list[dict[str, object]]]) -> Measured:
    out = Measured(case)
    for method, found in runs.items():
        out.seconds[method] = statistics.median(run["seconds"] for run in found)
        if found[-1].get("peak_mb") is not None:
            out.peak_mb[method] = found[-1]["peak_mb"]
    for method in OWN:
        if own := runs.get(method):
            out.stages[method] = {
                stage: statistics.median(run["stages"][stage] / sum(run["stages"].values()) for run in own)
                for stage in own[-1]["stages"]
            }
    own = runs.get("lsgp")
    out.defects = own[-1]["flips"] + own[-1]["turns"] if own else 0
    return out


def growth(rows: Iterable[Measured], method: str) -> float | None:
    """The exponent of the triangle count that the time grows with: the slope in a log-log plot."""
    points = [
        (row.triangles, row.seconds[method])
        for row in rows
        if not row.case.is_random and row.triangles >= FROM_TRIANGLES and method in row.seconds
    ]
    if len(points) < 2:
        return None
    return float(np.polyfit(*np.log(points).T, 1)[0])


def time_rows(rows: list[Measured]) -> list[dict[str, object]]:
    methods = [method for method in NAMES if any(method in row.seconds for row in rows)]
    table = [
        _heading(row) | {f"{NAMES[method]} s": _seconds(row.seconds.get(method)) for method in methods} for row in rows
    ]
    exponents = {f"{NAMES[method]} s": growth(rows, method) for method in methods}
    shown = {name: "" if exponent is None else f"{exponent:.2f}" for name, exponent in exponents.items()}
    return [*table, {"surface": "grows with the triangles to the power of"} | shown]


def ratio_rows(rows: list[Measured]) -> list[dict[str, object]]:
    return [
        _heading(row)
        | {
            "lsgp s": _seconds(row.seconds.get("lsgp")),
            "to the cheaper Laplacian": _ratio(row.ratio_to(FLOORS)),
            "to libigl LSCM": _ratio(row.ratio_to(("lscm",))),
            "Angle Based to lsgp": _ratio(_inverse(row.ratio_to(("ANGLE_BASED",)))),
            "lsgp MB": _megabytes(row.peak_mb.get("lsgp")),
            "LSCM MB": _megabytes(row.peak_mb.get("lscm")),
            "flips and turns": row.defects,
        }
        for row in rows
    ]


def stage_rows(rows: list[Measured]) -> list[dict[str, object]]:
    return [
        _heading(row)
        | {"": NAMES[method]}
        | {f"{stage} ms": f"{1e3 * share * row.seconds[method]:.1f}" for stage, share in stages.items()}
        for row in rows
        for method, stages in row.stages.items()
    ]


def _heading(row: Measured) -> dict[str, object]:
    cones = f"{len(row.case.cones)}{' random' if row.case.is_random else ''}"
    return {"surface": row.case.name, "triangles": f"{row.triangles:,}", "cones": cones}


def _inverse(ratio: float | None) -> float | None:
    return None if ratio is None else 1 / ratio


def _seconds(value: float | None) -> str:
    """Three digits."""
    return "" if value is None else f"{value:.{max(0, 2 - math.floor(math.log10(max(value, 1e-6))))}f}"


def _ratio(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"


def _megabytes(value: float | None) -> str:
    return "" if value is None else f"{value:.0f}"


def plot(rows: list[Measured], target: Path) -> None:
    """Seconds by triangles, both on logarithmic axes."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "benchmark"})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9, 5), layout="constrained")
    for method, name in NAMES.items():
        points = sorted(
            (row.triangles, row.seconds[method]) for row in rows if not row.case.is_random and method in row.seconds
        )
        if points:
            is_own = method == "lsgp"
            axes.loglog(*zip(*points, strict=True), "o-" if is_own else ".--", lw=2.5 if is_own else 1.2, label=name)
    for count in sorted({len(row.case.cones) for row in rows if row.case.is_random}):
        points = [
            (row.triangles, row.seconds["lsgp"])
            for row in rows
            if row.case.is_random and len(row.case.cones) == count and "lsgp" in row.seconds
        ]
        if points:
            axes.loglog(*zip(*points, strict=True), "s:", lw=1.2, label=f"lsgp, {count} random cones")
    axes.set(xlabel="triangles", ylabel="CPU seconds")
    axes.grid(True, which="both", alpha=0.25)
    figure.legend(loc="outside right center")
    figure.savefig(target, metadata={"Date": None})
    pyplot.close(figure)
