# SPDX-License-Identifier: GPL-3.0-or-later
"""How automatic cones and presets end on meshes of every kind, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/placement_sweep.py [--runs NAME ...] [--each N] [--only WORD]
                                                               [--limit SECONDS] [--jobs N] [--log FILE]

The meshes are N small ordinary members of each family of the zoo, the large ones of up to LARGEST triangles, and the
shared meshes of up to LARGEST_SHARED where they are there. Runs are `auto` (cones to the target 1.05), `auto:8` (eight
on each component) and the presets. Every run has a process of its own, which is ended after SECONDS, and ends in one of

- valid: no flipped triangle, wrong angle sum or inexact seam, and the checks of the tests confirm all that is told;
- named: a map with such defects, all of which warnings name;
- refused: an error of the library, by its code;
- silent: a fault that nothing names, a target missed without a word, or another stretch than placement has told;
- crash, or slow: the process died, or took too long.

Of the valid maps the table has those whose L2 stretch is within 3 % of the one predicted before any map is made, those
that are no worse than that, those that have the stretch that placement has measured and told, and those within the
target. The exit code is 1 with
silent, crash or slow. Needs scipy and the lsgp wheel.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import lsgp
import numpy as np
import zoo
from outcome_check import error_faults, placement_faults, result_faults
from own_process import in_own_process
from placement_quality import SHARED, of_member, read_surface

TARGET = 1.05
LARGEST, LARGEST_SHARED = 8000, 20000  # triangles
AS_PREDICTED, SAME = 0.03, 1e-3
BAD_ENDS = ("silent", "crash", "slow")
# What a map with a stretch above the target has to report.
MISSED = {"PLACEMENT_NOT_REACHED", "COMPONENT_SKIPPED"}

Read = Callable[[], lsgp.Surface]


@dataclass(frozen=True)
class Ending:
    """How a run ended.  told: codes, or what is wrong.  predicted, measured, l2: the stretch that was predicted, that
    which placement has told, and that of a valid map; NaN otherwise or unknown."""

    end: str
    told: tuple[str, ...] = ()
    predicted: float = np.nan
    measured: float = np.nan
    l2: float = np.nan


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", nargs="+", choices=list(RUNS), default=list(RUNS), help="default: all")
    parser.add_argument("--each", metavar="N", type=int, default=2, help="members of each family (default: 2)")
    parser.add_argument("--only", metavar="WORD", default="", help="meshes whose names have this")
    parser.add_argument("--limit", metavar="SECONDS", type=float, default=60, help="of a run (default: 60)")
    parser.add_argument("--jobs", metavar="N", type=int, default=2, help="processes at once (default: 2)")
    parser.add_argument("--log", metavar="FILE", type=Path, help="a line for every run that is not valid")
    arguments = parser.parse_args()
    meshes = [(name, read) for name, read in all_meshes(arguments.each) if arguments.only in name]
    found = sweep(arguments.runs, meshes, arguments.limit, arguments.jobs)
    print(f"{len(meshes)} meshes:\n\n{table(found)}")
    lines = [line_of(*one) for one in found if one[2].end != "valid" or is_off(one[2])]
    print("\n".join(lines) if arguments.log is None else f"{len(lines)} lines in {arguments.log}")
    if arguments.log is not None:
        arguments.log.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return int(any(ending.end in BAD_ENDS for _, _, ending in found))


def sweep(
    runs: Iterable[str], meshes: Iterable[tuple[str, Read]], limit: float, jobs: int
) -> list[tuple[str, str, Ending]]:
    """Run, mesh and ending of all of them."""
    meshes = list(meshes)
    tasks = [(run, name, read) for run in runs for name, read in meshes]
    with ThreadPoolExecutor(jobs) as pool:
        endings = list(pool.map(lambda task: within(limit, task[0], task[2]), tasks))
    return [(run, name, ending) for (run, name, _), ending in zip(tasks, endings, strict=True)]


def all_meshes(each: int) -> Iterator[tuple[str, Read]]:
    for family in zoo.families():
        small = [one for one in zoo.members("small", family) if one.ordinary]
        count = min(each, len(small))
        chosen = [small[(2 * i + 1) * len(small) // (2 * count)] for i in range(count)]
        large = [one for one in zoo.members("large", family) if one.ordinary and triangles_of(one) <= LARGEST]
        for member in [*chosen, *large]:
            yield member.name, lambda member=member: of_member(member)
    for path in sorted([*SHARED.glob("*.obj"), *SHARED.glob("hard/*.off")]):
        if len(read_surface(path).triangles) <= LARGEST_SHARED:
            yield path.stem, lambda path=path: read_surface(path)


def triangles_of(member: zoo.Member) -> int:
    return len(member.mesh().triangles)


def within(limit: float, run: str, read: Read) -> Ending:
    return in_own_process(lambda: ending_of(run, read), limit, Ending("slow"), Ending("crash"))


def ending_of(run: str, read: Read) -> Ending:
    surface = read()
    try:
        return RUNS[run](surface)
    except lsgp.LsgpError as error:
        faults = error_faults(surface, error)
        return Ending("silent", tuple(faults)) if faults else Ending("refused", (error.code,))


def with_cones(surface: lsgp.Surface, count: int | None) -> Ending:
    placed = lsgp.place_cones(surface, count=count, target=TARGET)
    given = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True))
    result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    faults = placement_faults(surface, placed, None if count is not None else TARGET)
    faults += result_faults(surface, result, lsgp.Options(), given)
    codes = {finding.code for finding in [*placed.warnings, *result.warnings]}
    if np.isfinite(placed.mapped_l2) and not is_same(result.distortion.l2_stretch, placed.mapped_l2):
        faults.append(f"the map has an L2 stretch of {result.distortion.l2_stretch:.4f}, not {placed.mapped_l2:.4f}")
    if count is None and result.distortion.l2_stretch > TARGET * (1 + 1e-6) and not codes & MISSED:
        faults.append(f"the map has an L2 stretch of {result.distortion.l2_stretch:.3f}, and no warning says so")
    return ending(result, codes, faults, placed)


def with_preset(surface: lsgp.Surface, preset: lsgp.Preset) -> Ending:
    result = lsgp.auto_unwrap(surface, preset=preset, pack="shelves" if preset != "tile" else None)
    options = lsgp.preset_options(preset)
    opened = replace(surface, borders=result.borders)
    return ending(result, {one.code for one in result.warnings}, result_faults(opened, result, options))


def ending(result: lsgp.Result, codes: set[str], faults: list[str], placed: lsgp.Placement | None = None) -> Ending:
    if faults:
        return Ending("silent", tuple(faults))
    defects = len(result.flipped) + len(result.wrong_angle_sums) + ("INEXACT_SEAMS" in codes)
    l2 = result.distortion.l2_stretch
    told = (placed.predicted_l2, placed.mapped_l2) if placed is not None else (np.nan, np.nan)
    return Ending("named" if defects else "valid", tuple(sorted(codes)), *told, l2)


RUNS: dict[str, Callable[[lsgp.Surface], Ending]] = {
    "auto": lambda surface: with_cones(surface, None),
    "auto:8": lambda surface: with_cones(surface, 8),
    "paint": lambda surface: with_preset(surface, "paint"),
    "tile": lambda surface: with_preset(surface, "tile"),
    "bake": lambda surface: with_preset(surface, "bake"),
}


def is_same(l2: float, told: float) -> bool:
    return abs(l2 / told - 1) <= SAME


def is_off(one: Ending) -> bool:
    """Whether the map of a run differs from its prediction; not where none is made."""
    return one.end == "valid" and abs(one.l2 / one.predicted - 1) > AS_PREDICTED


def table(found: list[tuple[str, str, Ending]]) -> str:
    columns = [
        "valid",
        "named",
        "refused",
        "silent",
        "crash",
        "slow",
        "as predicted",
        "no worse",
        "as reported",
        "at most 1.05",
    ]
    lines = [f"| run | {' | '.join(columns)} | codes |", f"|---|{'--:|' * len(columns)}---|"]
    for run in dict.fromkeys(one[0] for one in found):
        endings = [ending for of_run, _, ending in found if of_run == run]
        ends = Counter(ending.end for ending in endings)
        valid = [ending for ending in endings if ending.end == "valid"]
        predicted = [one for one in valid if np.isfinite(one.predicted)]
        refusals = Counter(code for one in endings if one.end == "refused" for code in one.told)
        cells = [
            run,
            *(str(ends[end]) for end in ("valid", "named", "refused", *BAD_ENDS)),
            percent(sum(not is_off(one) for one in predicted), len(predicted)),
            percent(sum(one.l2 <= (1 + AS_PREDICTED) * one.predicted for one in predicted), len(predicted)),
            percent(sum(is_same(one.l2, one.measured) for one in predicted), len(predicted)),
            percent(sum(one.l2 <= TARGET for one in valid), len(valid)),
            ", ".join(f"{code} {count}" for code, count in sorted(refusals.items())),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else ""


def line_of(run: str, name: str, one: Ending) -> str:
    figures = f" predicted {one.predicted:.3f}, map {one.l2:.3f}" if np.isfinite(one.l2) else ""
    return f"{run} {name}: {one.end}{figures} {'; '.join(one.told)}".rstrip()


if __name__ == "__main__":
    sys.exit(main())
