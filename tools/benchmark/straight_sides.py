# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the outlines of islands is straight and axis-aligned, with and without straight sides: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/straight_sides.py [--preset bake] [--picture FOLDER] [FOLDER]

Sides are the parts of an outline between corners of 20 degrees or more whose edges are all within 10 degrees of
the chord, measured by their length on the surface. FOLDER holds OBJ or OFF files of machine parts (default:
../shared/meshes and its folder hard); those that are missing are left out. With --picture, that folder gets
MODEL-without.png and MODEL-with.png. Needs the lsgp wheel and the tests' scipy.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import lsgp
import numpy as np
import oracle
from meshes import Mesh
from numpy.typing import NDArray
from zoo import closed, swept

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes"
PARTS = ("fandisk", "couplingdown", "joint", "spool", "pinion", "anchor")
FORMATS = (".2f", ".2f", ".1e", "d", ".2f")
JOINS = (" | ", " | ", " | ", " → ", " → ")  # between the values without and with
CORNER, MOST_TURNED, EXACT = np.radians(20), np.radians(10), 1e-9


def barrel(around: int, along: int) -> Mesh:
    """A barrel with flat ends."""
    height = np.linspace(0, 2, along + 1)
    return closed.lathe(0.9 + 0.1 * np.sin(np.pi * height / 2), height, around, caps=(True, True))


GENERATED = {
    "beveled block": closed.beveled_box(8, 0.1, (1, 1.5, 2)),
    "barrel": barrel(48, 8),
    "hollow pipe": swept.pipe(24, 8, 0.0, True),
    "gear": closed.gear(12, 0.3, 2),
}


def models(folder: Path, generated: Mapping[str, Mesh] = GENERATED) -> Iterator[tuple[str, lsgp.Surface]]:
    for name in PARTS:
        for file in (folder / f"{name}.obj", folder / f"{name}.off", folder / "hard" / f"{name}.off"):
            if file.is_file():
                yield name, lsgp.read_mesh_file(str(file)).surface()
    for name, mesh in generated.items():
        yield name, lsgp.Surface(mesh.positions, mesh.triangles)


def outlines(surface: lsgp.Surface, result: lsgp.Result) -> list[NDArray[np.int64]]:
    """The halfedges around the islands, each closed outline in order."""
    z = (result.corner_uv @ [1, 1j]).ravel()
    twin = oracle.halfedges(surface.triangles)[2]
    h = np.arange(len(twin))
    following = h // 3 * 3 + (h + 1) % 3
    is_joined = (twin >= 0) & (z == z[following[twin]]) & (z[following] == z[twin])
    is_joined &= result.island[h // 3] == result.island[twin // 3]
    out, is_listed = [], np.zeros(len(h), bool)
    for first in h[~is_joined & result.solved[h // 3]]:
        outline, at = [], int(first)
        while not is_listed[at]:
            is_listed[at] = True
            outline.append(at)
            at = following[at]
            while is_joined[at]:
                at = following[twin[at]]
        if outline:
            out.append(np.array(outline))
    return out


def sides_of(edges: NDArray[np.complex128]) -> Iterator[NDArray[np.int64]]:
    """The edges of every nearly straight side of a closed outline."""
    corners = np.flatnonzero(np.abs(np.angle(edges * np.conj(np.roll(edges, 1)))) >= CORNER)
    for begin, end in zip(corners, [*corners[1:], *(corners[:1] + len(edges))], strict=True):
        side = np.arange(begin, end) % len(edges)
        if np.abs(np.angle(edges[side] * np.conj(edges[side].sum()))).max() <= MOST_TURNED:
            yield side


def measure(surface: lsgp.Surface, result: lsgp.Result) -> tuple[float, float]:
    """Shares of the length of nearly straight sides: exactly straight, and moreover axis-aligned."""
    z = (result.corner_uv @ [1, 1j]).ravel()
    points = surface.positions[surface.triangles].reshape(-1, 3)
    total = straight = aligned = 0.0
    for outline in outlines(surface, result):
        ends = outline // 3 * 3 + (outline + 1) % 3
        edges, lengths = z[ends] - z[outline], np.linalg.norm(points[ends] - points[outline], axis=1)
        for side in sides_of(edges):
            chord, length = edges[side].sum(), lengths[side].sum()
            total += length
            if np.abs((np.cumsum(edges[side]) / chord).imag).max() < EXACT:
                straight += length
                aligned += length * (min(abs(chord.real), abs(chord.imag)) < EXACT * abs(chord))
    return straight / total, aligned / total


def covered_share(result: lsgp.Result) -> float:
    """Of the unit square."""
    a, b, c = (result.corner_uv[result.solved][:, k] @ [1, 1j] for k in range(3))
    return float(np.abs(np.imag(np.conj(b - a) * (c - a))).sum() / 2)


def rows(name: str, surface: lsgp.Surface, arguments: argparse.Namespace) -> Iterator[tuple[float, ...]]:
    """The measures of both layouts: the two shares, L2 stretch above 1, the number of islands, and coverage."""
    for kind in ("without", "with"):
        options = replace(lsgp.preset_options(arguments.preset), straighten=kind == "with")
        result = lsgp.auto_unwrap(surface, preset=arguments.preset, options=options)
        if len(result.flipped) or len(result.overlapping):
            raise SystemExit(f"{name}: flipped or overlapping triangles {kind} straight sides")
        if arguments.picture:
            draw(arguments.picture / f"{name}-{kind}.png".replace(" ", "-"), result, surface)
        islands = len(np.unique(result.island[result.solved]))
        yield *measure(surface, result), result.distortion.l2_stretch - 1, islands, covered_share(result)


def draw(file: Path, result: lsgp.Result, surface: lsgp.Surface) -> None:
    from matplotlib import pyplot as plt

    uv = result.corner_uv[result.solved]
    figure, axes = plt.subplots(figsize=(8, 8))
    axes.triplot(*uv.reshape(-1, 2).T, np.arange(3 * len(uv)).reshape(-1, 3), linewidth=0.3, color="silver")
    z = (result.corner_uv @ [1, 1j]).ravel()
    for outline in outlines(surface, result):
        closed_outline = z[[*outline, outline[0]]]
        axes.plot(closed_outline.real, closed_outline.imag, linewidth=1, color="black")
    axes.set_aspect("equal")
    figure.savefig(file, dpi=100)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    parser.add_argument("--preset", choices=["paint", "bake"], default="bake")
    parser.add_argument("--picture", metavar="FOLDER", type=Path, help="write the layouts into this folder")
    arguments = parser.parse_args()
    print("| | straight, without | with | along u or v, without | with | L2 - 1, without | with | islands | covered |")
    print("|---|" + "--:|" * 8)
    for name, surface in models(arguments.folder):
        cells = [name]
        for format_one, join, before, after in zip(FORMATS, JOINS, *rows(name, surface, arguments), strict=True):
            cells.append(join.join(format(value, format_one) for value in (before, after)))
        print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
