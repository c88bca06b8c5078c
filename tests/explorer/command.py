# SPDX-License-Identifier: GPL-3.0-or-later
"""A command line with the files of a session's choices, judged by its output, files and exit code."""

from __future__ import annotations

import contextlib
import io
import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import lsgp
import numpy as np
from lsgp.cli import main
from lsgp.layouts.texels import tiny_findings
from lsgp.presets.auto_unwrap import choose_map
from numpy.typing import NDArray

from .steps import Step

SECONDS = 60
RESULT, USAGE, REFUSED, INCOMPLETE = 0, 2, 3, 4


def command_faults(
    surface: lsgp.Surface,
    cones: list[int],
    angles: list[float | None] | None,
    options: lsgp.Options,
    step: Step,
) -> tuple[str, list[str]]:
    """What the command has no option for is left at its default, in the call it is compared with as well."""
    options = replace(
        options,
        loop_turning={},
        factorization="automatic",
        square_share=1.0,
        straighten=False,
        mirrored_cuts=False,
        follow_strokes=True,
        threads=0,
    )
    surface = replace(surface, edges=None, cut_costs=None, borders=None)
    if options.mode != "low-stretch":
        options = replace(options, stretch=1.0)
    if step["command"] == "cones":
        surface = replace(surface, directions=None)
    if options.mode != "low-stretch" or step["command"] == "cones":
        surface = replace(surface, importance=None)
    takes_features = options.seamless is not None or options.mode == "low-stretch"
    if not takes_features or step["command"] == "cones":
        surface = replace(surface, features=None)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        arguments = _files_and_arguments(folder, surface, cones, angles, options, step)
        code, told = _run(folder, arguments, separate=step["process"])
        faults = [f"a traceback: {told[-300:]}"] if "Traceback" in told else []
        if code not in (RESULT, USAGE, REFUSED, INCOMPLETE):
            return f"exit {code}", [*faults, f"exit code {code}: {told[-300:]}"]
        # The command wants angles where they are to be chosen by hand; from Python those that lack are automatic.
        wants_angles = options.prescription == "manual" and not (step["cones"] == "given" and angles)
        if code == USAGE and not wants_angles:
            faults.append(f"wrong usage: {told[-300:]}")
        if code != USAGE and not (code == REFUSED and wants_angles):
            faults += _compared(folder, surface, cones, angles, options, step, code)
        if code in (RESULT, INCOMPLETE) and step["command"] == "unwrap":
            measured, told = _run(folder, ["measure", "out.obj", "--report", "measured.json"], separate=False)
            if measured != RESULT:
                faults.append(f"what was written cannot be measured: {told[-300:]}")
    return f"exit {code}", faults


def _files_and_arguments(
    folder: Path,
    surface: lsgp.Surface,
    cones: list[int],
    angles: list[float | None] | None,
    options: lsgp.Options,
    step: Step,
) -> list[str]:
    lines = ["v {!r} {!r} {!r}".format(*point) for point in surface.positions.tolist()]
    lines += ["f {} {} {}".format(*face) for face in (surface.triangles + 1).tolist()]
    (folder / "in.obj").write_text("\n".join(lines) + "\n")
    (folder / "cones.json").write_text(
        json.dumps({"cones": cones} | ({} if angles is None else {"cone_angles": angles}))
    )
    (folder / "seams.json").write_text(json.dumps(surface.seams.tolist()))
    shared = ["--seam-edges", "seams.json", "--seams", options.seams, "--cuts", "shortest", "--report", "report.json"]
    if step["command"] == "cones":
        keep = ["--keep", "cones.json"] if step["cones"] == "given" else []
        return ["cones", "in.obj", "-o", "out.json", *keep, *shared]
    given = "cones.json" if step["cones"] == "given" else step["cones"]
    arguments = ["unwrap", "in.obj", "-o", "out.obj", "--cones", given, *shared]
    for name in ("prescription", "unfold", "method", "border", "mode", "overlaps", "compact"):
        value = getattr(options, name)
        arguments += [] if value is None else [f"--{name}", value]
    arguments += [] if options.repair else ["--no-repair"]
    if surface.directions is not None:
        strokes = [[f, *direction] for f, direction in enumerate(surface.directions.tolist())]
        (folder / "directions.json").write_text(json.dumps(strokes))
        arguments += ["--directions", "directions.json"]
    if len(surface.features):
        (folder / "features.json").write_text(json.dumps(surface.features.tolist()))
        arguments += ["--features", "features.json"]
    if options.mode == "low-stretch":
        arguments += ["--stretch", repr(options.stretch)]
        if surface.importance is not None:
            (folder / "importance.txt").write_text("\n".join(map(repr, surface.importance.tolist())))
            arguments += ["--importance", "importance.txt"]
    return arguments + ([] if options.seamless is None else _seamless_arguments(options.seamless))


def _seamless_arguments(seamless: lsgp.Seamless) -> list[str]:
    arguments = ["--seamless", "--lattice", seamless.lattice, "--coarse-grid", seamless.coarse_grid]
    arguments += ["--feature-places", seamless.feature_places]
    if seamless.tiles is not None:
        arguments += ["--tiles", repr(seamless.tiles)]
    elif seamless.tile_size is not None:
        arguments += ["--tile-size", repr(seamless.tile_size)]
    return arguments + (["--parity"] if seamless.parity else [])


def _run(folder: Path, arguments: list[str], *, separate: bool) -> tuple[int, str]:
    """Exit code and what was printed."""
    if separate:
        command = [sys.executable, "-m", "lsgp", *arguments]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=SECONDS)
        return done.returncode, done.stdout + done.stderr
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        code = main(arguments)
    return code, printed.getvalue()


def _compared(
    folder: Path,
    surface: lsgp.Surface,
    cones: list[int],
    angles: list[float | None] | None,
    options: lsgp.Options,
    step: Step,
    code: int,
) -> list[str]:
    """With the same call from Python: refused as well, or the same coordinates in the file."""
    report = json.loads((folder / "report.json").read_text(), parse_constant=_no_constant)
    is_chosen = step["command"] == "unwrap" and step["cones"] != "given"
    if is_chosen and (len(surface.features) or surface.directions is not None or options.compact == "sparing"):
        return []  # which the command compares several maps by
    try:
        expected = _call(surface, cones, angles, options, step)
    except lsgp.LsgpError as error:
        # Of several reasons the command may meet another one first.
        return [] if code == REFUSED else [f"the command ends with {code}, the call with {error.code}"]
    if code == REFUSED:
        # A file is refused as a whole, also where its angles would not be used.
        lacks_angles = step["cones"] == "given" and angles is not None and len(angles) != len(cones)
        if lacks_angles and report["code"] == "ANGLE_COUNT":
            return []
        return [f"the command is refused with {report['code']}, the call is not"]
    if isinstance(expected, lsgp.Placement):
        written = json.loads((folder / "out.json").read_text())
        same = written["cones"] == expected.cones.tolist() and written["cone_angles"] == expected.cone_angles.tolist()
        return [] if same else ["the cones that were written are not those of the call"]
    written = corner_uv_of(folder / "out.obj")
    if written.shape != expected.corner_uv.shape or not np.array_equal(written, expected.corner_uv, equal_nan=True):
        return ["the coordinates that were written are not those of the call"]
    # Before these it has those of placing the cones, after them that of tiny islands.
    findings = [*expected.warnings, *tiny_findings(expected.corner_uv, expected.island)]
    told, codes = [warning["code"] for warning in report["warnings"]], [finding.code for finding in findings]
    if told[len(told) - len(codes) :] != codes or (step["cones"] == "given" and told != codes):
        return [f"the report warns of {told}, the call of {codes}"]
    return []


def _call(
    surface: lsgp.Surface,
    cones: list[int],
    angles: list[float | None] | None,
    options: lsgp.Options,
    step: Step,
) -> Any:
    if step["command"] == "cones":
        kept = (cones, angles) if step["cones"] == "given" else ((), None)
        return lsgp.place_cones(surface, *kept, seams=options.seams)
    if options.seamless is not None:
        tile_size = options.seamless.tile_size if options.seamless.tiles is None else None
        options = replace(options, seamless=replace(options.seamless, cell=1.0, tile_size=tile_size))
    if step["cones"] == "given":
        manual = options.prescription in (None, "manual")
        return lsgp.parameterize(surface, cones, angles if manual else None, options)
    count = int(step["cones"].removeprefix("auto:")) if ":" in step["cones"] else None
    how = {"options": options, "count": count, "symmetric": False, "charts": False, "creases": False}
    return choose_map(surface, **how).result


def corner_uv_of(path: Path) -> NDArray[np.float64]:
    """(m, 3, 2) texture coordinates of the triangles of an OBJ, read without the library; NaN where there are none."""
    points, corners = [[np.nan, np.nan]], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["vt"]:
            points.append([float(word) for word in words[1:3]])
        elif words[:1] == ["f"]:
            corners.append([int([*word.split("/"), "0"][1] or 0) for word in words[1:]])
    return np.array(points)[np.array(corners, int).reshape(-1, 3)]


def _no_constant(text: str) -> None:
    raise AssertionError(f"{text} is no JSON")
