# SPDX-License-Identifier: GPL-3.0-or-later
"""Any bytes as the files that a command line reads, led by coverage (Atheris).

The first byte chooses the command, the second its options and the suffix of the mesh; the files follow, with SEPARATOR
between them. Every command must end with an exit code of its own and without a traceback, what it wrote must be read
back as the same mesh, and the faces that it leaves without coordinates must be counted. Half of the inputs are made by
changing single fields of files (`file_mutations`).
tools/fuzz runs this, and replays what it found.
"""

from __future__ import annotations

import contextlib
import io
import random
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import atheris

with atheris.instrument_imports(include=["lsgp"]):
    from lsgp.batch import command
    from lsgp.batch.records import Record, ending
    from lsgp.cli import main
    from lsgp.errors import InputError
    from lsgp.io.mesh_files import read_mesh
    from lsgp.io.mesh_formats import OBJ, input_format
    from lsgp.io.polygons import PolygonMesh

import numpy as np
from file_mutations import mutated

SEPARATOR = b"\n%%\n"
SUFFIXES = [".obj", ".ply", ".off", "", ".gltf", ".glb", ".stl"]

# What beside the mesh is given to `unwrap`, and how.
OPTIONS = [
    ["--cones", "auto:4"],
    ["--cones", "auto", "--seams", "boundary", "--overlaps", "split"],
    ["--cones", "auto:2", "--mode", "low-stretch", "--importance", "importance"],
    ["--cones", "auto:4", "--seamless", "--tiles", "8"],
    ["--cones", "cones", "--seam-edges", "seams", "--directions", "directions"],
    ["--cones", "cones", "--prescription", "manual"],
    ["--cones", "cones", "--importance", "importance", "--report", "report"],
    ["--cones", "cones", "--seam-edges", "seams", "--border", "straight"],
]


class NoWorkers:
    """In place of the processes of a batch: every asset fails at once."""

    def __init__(self, *_: Any, **_named: Any) -> None:
        pass

    def run(self, assets: Iterable[Any]) -> Iterator[Record]:
        for asset in assets:
            yield ending("failed", "WORKER_DIED", "No asset is worked on here.", asset=asset.name, options="")


command.Pool = NoWorkers


MISSING = re.compile(rb"^(\d+) faces? without coordinates( and without triangles or area)?, ([\d.e+-]+) % of", re.M)


def run(argv: list[str], exit_codes: tuple[int, ...]) -> tuple[int, bytes]:
    """The exit code and all that was said."""
    said = io.TextIOWrapper(io.BytesIO())
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main(argv)
    said.flush()
    told = said.buffer.getvalue()
    assert code in exit_codes, f"{argv} ended with {code}: {told!r}"
    assert code == 0 or told.strip(), f"{argv} ended with {code} without a word"
    return code, told


def require_same(before: PolygonMesh, after: PolygonMesh) -> None:
    assert np.array_equal(before.positions, after.positions, equal_nan=True)
    assert np.array_equal(before.corners, after.corners) and np.array_equal(before.sizes, after.sizes)


def unwrap(folder: Path, how: int, mesh: Path) -> None:
    options = [str(folder / word) if (folder / word).is_file() else word for word in OPTIONS[how % len(OPTIONS)]]
    out = folder / "out.obj"
    code, told = run(["unwrap", str(mesh), "-o", str(out), *options], (0, 2, 3, 4))
    if code in (0, 4):
        require_same(read_mesh(mesh), read_mesh(out))
        try:
            before = read_mesh(mesh, with_uv=True)
        except InputError:  # old coordinates that are no numbers, which faces that are left out may keep
            return
        after = read_mesh(out, with_uv=True)
        require_same(before, after)
        assert np.isfinite(after.corner_uv).any()
        said = {bool(without_area): (int(count), float(part)) for count, without_area, part in MISSING.findall(told)}
        face = np.repeat(np.arange(len(after.sizes)), after.sizes)
        bare = np.unique(face[np.isnan(after.corner_uv).any(axis=1)])
        count = sum(count for count, _ in said.values())
        was_bare = np.arange(len(before.sizes))
        if before.corner_uv is not None and input_format(mesh, mesh.read_bytes()) == OBJ:  # is edited
            was_bare = np.unique(face[np.isnan(before.corner_uv).any(axis=1)])
        # Faces without new coordinates keep those that they had.
        assert np.isin(bare, was_bare).all(), told
        assert count == len(bare) if len(was_bare) == len(before.sizes) else count >= len(bare), told
        assert (code == 4) == (False in said) and all(0 <= part <= 100 for _, part in said.values())


def cones(folder: Path, how: int, mesh: Path) -> None:
    options = ["--count", "3"] if how % 2 else []
    options += ["--keep", str(folder / "cones")] if how & 2 else []
    options += ["--seam-edges", str(folder / "seams")] if how & 4 else []
    run(["cones", str(mesh), "-o", str(folder / "out.json"), *options], (0, 2, 3))


def measure(folder: Path, how: int, mesh: Path) -> None:
    run(["measure", str(mesh), *(["--report", str(folder / "report")] if how % 2 else [])], (0, 2, 3))


def batch(folder: Path, how: int, mesh: Path) -> None:
    """The first file is the list, the second a journal of before."""
    options = ["--only-missing"] if how % 2 else []
    options += ["--shard", "1/2"] if how & 2 else []
    journal = "journal-1-of-2.jsonl" if how & 2 else "journal.jsonl"
    (folder / "results").mkdir()
    (folder / "cones").rename(folder / "results" / journal)
    run(["batch", str(mesh), "--out", str(folder / "results"), *options], (0, 2, 3, 4))


COMMANDS = [unwrap, unwrap, measure, measure, cones, batch]


def one_input(raw: bytes) -> None:
    if len(raw) < 2:
        return
    files = raw[2:].split(SEPARATOR) + [b""] * 5
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        mesh = folder / f"mesh{SUFFIXES[raw[1] // 8 % len(SUFFIXES)]}"
        mesh.write_bytes(files[0])
        for side_file, data in zip(("cones", "seams", "importance", "directions"), files[1:], strict=False):
            (folder / side_file).write_bytes(data)
        COMMANDS[raw[0] % len(COMMANDS)](folder, raw[1], mesh)


def mutation(raw: bytes, most: int, seed: int) -> bytes:
    """Another input: by the fields of one of its files, or by Atheris."""
    rng = random.Random(seed)
    if len(raw) > 2 and rng.random() < 0.5:
        files = raw[2:].split(SEPARATOR)
        chosen = rng.choice([0, rng.randrange(len(files))])
        files[chosen] = mutated(files[chosen], rng)
        changed = raw[:2] + SEPARATOR.join(files)
        if len(changed) <= most:
            return changed
    return atheris.Mutate(raw, most)


if __name__ == "__main__":
    np.seterr(all="ignore")
    atheris.Setup(sys.argv, one_input, custom_mutator=mutation)
    atheris.Fuzz()
