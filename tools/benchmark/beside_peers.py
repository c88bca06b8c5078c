# SPDX-License-Identifier: GPL-3.0-or-later
"""A press beside uvunwrap, xatlas and Blender's Smart UV Project on generated models, as a Markdown table of medians.

    PYTHONPATH=tests python tools/benchmark/beside_peers.py [--each] [NAME ...]

The models are all large members of the zoo that are closed, swept or have tunnels, up to 30,000 triangles, and the duck
of the examples; NAME chooses some. Every program unwraps arrays in memory with its defaults, the presets too, in one
process. Time is that of the processor, of all threads, the lesser one of two runs; the rest is measured as in
`presets.py`. Smart UV Project needs a Python with bpy, in BPY_PYTHON. Needs the lsgp wheel, scipy, uvunwrap and xatlas.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import lsgp
import numpy as np
import uvunwrap
from numpy.typing import NDArray
from presets import Row, by_xatlas, measure
from zoo import closed, swept, tunnels

FloatArray = NDArray[np.float64]

MOST = 30_000  # triangles
DUCK = Path(__file__).parents[2] / "examples" / "model.obj"
METHODS = ("Paint", "Bake", "uvunwrap", "xatlas", "Smart UV Project")
TITLES = ("CPU seconds", "islands", "cuts", "covered", "L2 stretch", "overlap, %")
FORMATS = (".2f", ".4g", ".1f", ".2f", ".3f", ".2f")


class Timed(NamedTuple):
    """What a program took for a model, and what came of it."""

    seconds: float
    layout: Row

    def figures(self) -> tuple[float, ...]:
        """In the order of the titles."""
        layout = self.layout
        return self.seconds, layout.islands, layout.cut_length, layout.covered, layout.l2_stretch, layout.overlap


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", metavar="NAME", nargs="*", help="of models")
    parser.add_argument("--each", action="store_true", help="print the figures of each model as well")
    arguments = parser.parse_args()
    rows: dict[str, dict[str, Timed]] = {}
    for name, surface in models():
        if not arguments.names or name in arguments.names:
            rows[name] = dict(unwraps(surface))
            if arguments.each:
                print(f"{name}, {len(surface.triangles)} triangles")
                print_table(name, {method: timed.figures() for method, timed in rows[name].items()})
    print_table(f"medians of {len(rows)} models", dict(medians(rows)))


def models() -> Iterator[tuple[str, lsgp.Surface]]:
    yield "duck", lsgp.read_mesh_file(DUCK).surface()
    for room in (closed, swept, tunnels):
        for member in room.members():
            mesh = member.mesh()
            if member.size == "large" and len(mesh.triangles) <= MOST:
                yield member.name, lsgp.Surface(mesh.positions, mesh.triangles)


def unwraps(surface: lsgp.Surface) -> Iterator[tuple[str, Timed]]:
    """By every program that is there."""
    programs: dict[str, Callable[[lsgp.Surface], FloatArray]] = {
        "Paint": lambda surface: lsgp.auto_unwrap(surface, preset="paint").corner_uv,
        "Bake": lambda surface: lsgp.auto_unwrap(surface, preset="bake").corner_uv,
        "uvunwrap": by_uvunwrap,
        "xatlas": by_xatlas,
    }
    for method in METHODS:
        if method in programs:
            seconds, uv = faster_of_two(lambda make=programs[method]: make(surface))
        elif "BPY_PYTHON" in os.environ:
            seconds, uv = by_blender(os.environ["BPY_PYTHON"], surface)
        else:
            continue
        yield method, Timed(seconds, measure(surface, uv))


def faster_of_two(make: Callable[[], FloatArray]) -> tuple[float, FloatArray]:
    found = []
    for _ in range(2):
        begin = time.process_time()
        uv = make()
        found.append((time.process_time() - begin, uv))
    return min(found, key=lambda of_run: of_run[0])


def by_uvunwrap(surface: lsgp.Surface) -> FloatArray:
    mesh = uvunwrap.Mesh(surface.positions.astype(np.float32), surface.triangles)
    return np.array(uvunwrap.generate([mesh]).meshes[0].corner_uvs, np.float64).reshape(-1, 3, 2)


def by_blender(python: str, surface: lsgp.Surface) -> tuple[float, FloatArray]:
    """By Smart UV Project, which is timed inside."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "surface.npz"), Path(folder, "map.npz")
        np.savez(source, positions=surface.positions, triangles=surface.triangles, seams=np.empty((0, 2), np.int32))
        command = [python, str(Path(__file__).with_name("benchmark_in_blender.py"))]
        command += [str(source), "SMART_PROJECT", str(target)]
        done = subprocess.run(command, input="run\nrun\n", text=True, stdout=subprocess.PIPE, check=True)
        times = [json.loads(line.split(" ", 1)[1]) for line in done.stdout.splitlines() if line.startswith("RESULT ")]
        return min(run["seconds"] for run in times), np.load(target)["corner_uv"]


def medians(rows: dict[str, dict[str, Timed]]) -> Iterator[tuple[str, tuple[float, ...]]]:
    for method in METHODS:
        figures = [of[method].figures() for of in rows.values() if method in of]
        if figures:
            yield method, tuple(map(statistics.median, zip(*figures, strict=True)))


def print_table(first: str, rows: dict[str, tuple[float, ...]]) -> None:
    print(f"| {first} | {' | '.join(TITLES)} |\n|---|{'--:|' * len(TITLES)}")
    for name, figures in rows.items():
        cells = [format(value, form) for value, form in zip(figures, FORMATS, strict=True)]
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
