# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of *Bake* and *Paint* on some 30 meshes, made once and kept below build/ for `packing_benchmark.py`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import lsgp
import meshes
import numpy as np
import zoo
from island_kits import Kit
from meshes import Mesh
from own_process import in_own_process
from shared_meshes import shared_folder

KEPT = Path(__file__).resolve().parents[2] / "build" / "packing" / "layouts"
PRESETS = ("bake", "paint")
LIMIT = 300  # seconds

MADE: dict[str, Callable[[], Mesh]] = {
    "cube": lambda: meshes.cube(4),
    "bumpy sphere": lambda: meshes.bumpy_sphere(3),
    "flower": lambda: meshes.flower(3),
    "horned ball": lambda: meshes.two_horned(3),
    "double torus": meshes.double_torus,
    "perforated slab": lambda: meshes.perforated_slab(3),
    "parts": lambda: meshes.merge([*(meshes.bumpy_sphere(2) for _ in range(3)), *(meshes.cube(n) for n in (1, 2, 3))]),
}
MEMBERS = (
    *("beveled-box-cells=4-bevel=0.05-size=1x4x0.5", "gear-teeth=6-depth=0.15-layers=3"),
    *(
        "screw-turns=2-sides=12-ridge=0.1",
        "spring-turns=1-around=6-caps=True",
        "hollow-pipe-around=6-along=4-wall=0.05",
    ),
    *(
        "star-points=3-inner=0.3-height=2",
        "sponge-cells=2",
        "knot-p=2-q=3-around=4",
        "mixed-parts-count=2-spread=0-seed=0",
    ),
    *("ball-with-handles-levels=2-handles=3-seed=0", "box-with-handles-cells=5-handles=3-seed=0"),
    *("noise-ball-levels=1-amount=0.3-seed=0", "spiked-ball-levels=1-spikes=4-height=1"),
)
SHARED = (
    *("hand-5k.obj", "bird.obj", "fandisk.obj", "suzanne-messy.obj", "teapot-messy.obj", "eight-genus2.obj"),
    *("hard/cow.off", "hard/homer.off", "hard/triceratops.off", "hard/anchor.off", "hard/pinion.off"),
)


def layouts() -> Iterator[tuple[str, Callable[[], Kit | None]]]:
    """ "Bake, NAME" and its islands; None where the mesh has no map."""
    for preset in PRESETS:
        for name, read in surfaces():
            yield f"{preset.title()}, {name}", lambda preset=preset, name=name, read=read: kept(preset, name, read)


def surfaces() -> Iterator[tuple[str, Callable[[], lsgp.Surface]]]:
    for name, made in MADE.items():
        yield name, lambda made=made: surface(made())
    for name in MEMBERS:
        yield name, lambda name=name: surface(zoo.member(name).mesh())
    for name in SHARED:
        if (path := shared_folder() / "meshes" / name).is_file():
            yield path.stem, lambda path=path: lsgp.read_mesh_file(path).surface()


def surface(mesh: Mesh) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles)


@cache
def kept(preset: str, name: str, read: Callable[[], lsgp.Surface]) -> Kit | None:
    path = KEPT / f"{preset} {name}.npz"
    if not path.is_file():
        found = in_own_process(lambda: islands_of(read(), preset), LIMIT, None, None)
        if found is None:
            return None
        KEPT.mkdir(parents=True, exist_ok=True)
        np.savez(path, corner_uv=found.corner_uv, island=found.island)
    data = np.load(path)
    return Kit(data["corner_uv"], data["island"])


def islands_of(of: lsgp.Surface, preset: str) -> Kit | None:
    """On shelves, without the triangles that are in none."""
    try:
        result = lsgp.auto_unwrap(of, preset=preset, pack="shelves")
    except lsgp.LsgpError:
        return None
    inside = result.island >= 0
    return Kit(result.corner_uv[inside], result.island[inside].astype(np.int32))
