# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the islands of a file once, in a process of its own, for `packing_benchmark.py`.

    python tools/benchmark/packing_peers.py PACKER KIT.npz PACKED.npz

KIT.npz: corner_uv (m, 3, 2), island (m,), margin. PACKED.npz: corner_uv, and CPU seconds of all threads and child
processes. PACKER: of `PACKERS`; those of Blender take a Python with bpy, the others one with their package.
"""

from __future__ import annotations

import math
import resource
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

# Texels of the square's side, of packers that take margins as whole texels.
TEXTURE = 1024
CALIBRATIONS = 3
# Strips are packed one after the other, each as high as would make the last one a square.
STRIPS, SECONDS_EACH = 4, 3


def by_lsgp(uv: FloatArray, island: NDArray[np.int32], margin: float, **how: object) -> FloatArray:
    import lsgp

    return timed(lambda: lsgp.pack_islands(uv, island, margin, **how))


def by_xatlas(uv: FloatArray, island: NDArray[np.int32], margin: float, *, brute_force: bool) -> FloatArray:
    """Pads by whole texels. As it packs into more than the texels it is asked for, it is asked for fewer until these
    come out; what that takes does not count."""
    texture = round(max(1, math.ceil(margin * TEXTURE)) / margin)
    asked = float(texture)
    for _ in range(CALIBRATIONS):
        asked *= (
            texture / np.ptp(xatlas_layout(uv, island, margin, round(asked), False)[0].reshape(-1, 2), axis=0).max()
        )
    packed, seconds = xatlas_layout(uv, island, margin, round(asked), brute_force)
    global spent
    spent += seconds
    return packed


def xatlas_layout(
    uv: FloatArray, island: NDArray[np.int32], margin: float, resolution: int, brute_force: bool
) -> tuple[FloatArray, float]:
    """In texels, and the CPU seconds it took."""
    import xatlas

    triangles, first = joined(uv, island)
    options = xatlas.PackOptions()
    options.bruteForce = brute_force
    options.padding = max(1, math.ceil(margin * TEXTURE))
    options.resolution = resolution
    atlas = xatlas.Atlas()
    # As if each island had a material of its own, or those that touch would be one.
    materials = island[:, None].astype(np.uint32)
    atlas.add_uv_mesh(uv.reshape(-1, 2)[first].astype(np.float32), triangles.astype(np.uint32), materials)
    before = cpu_seconds()
    atlas.generate(pack_options=options)
    seconds = cpu_seconds() - before
    vertices, faces, placed = atlas[0]
    if atlas.atlas_count != 1 or not (vertices[faces] == triangles).all():
        raise SystemExit("xatlas lost islands")
    return (placed * [atlas.width, atlas.height])[faces], seconds


def by_spyrrow(uv: FloatArray, island: NDArray[np.int32], margin: float) -> FloatArray:
    """Outlines in strips; islands with holes are filled."""
    import spyrrow

    z = uv @ [1, 1j]
    start = np.unique(island, return_index=True)[1]
    origin = z[start, 0]
    shapes = [outline(z[island == i] - origin[i]) for i in range(len(start))]
    items = [spyrrow.Item(str(i), [(p.real, p.imag) for p in shape], 1, None) for i, shape in enumerate(shapes)]
    area = float(np.abs(np.linalg.det(uv[:, 1:] - uv[:, :1])).sum() / 2)
    threads = 1

    def strips() -> tuple[float, FloatArray]:
        height, best = math.sqrt(area / 0.6), (math.inf, uv)
        for _ in range(STRIPS):
            config = spyrrow.StripPackingConfig(
                min_items_separation=2 * margin * height,
                total_computation_time=SECONDS_EACH,
                num_workers=threads,
                seed=1,
            )
            found = spyrrow.StripPackingInstance("", height, items).solve(config)
            side = max(height, found.width)
            if side < best[0]:
                moved = np.empty_like(z)
                for item in found.placed_items:
                    of = island == int(item.id)
                    turn = np.exp(1j * math.radians(item.rotation))
                    moved[of] = (z[of] - origin[int(item.id)]) * turn + complex(*item.translation)
                best = side, np.stack([moved.real, moved.imag], axis=-1)
            height = math.sqrt(height * found.width)
        return best

    return timed(strips)[1]


def by_blender(uv: FloatArray, island: NDArray[np.int32], margin: float) -> FloatArray:
    import bpy

    triangles, first = joined(uv, island)
    mesh = bpy.data.meshes.new("islands")
    mesh.from_pydata(np.pad(uv.reshape(-1, 2)[first], ((0, 0), (0, 1))).tolist(), [], triangles.tolist())
    layer = mesh.uv_layers.new(name="uv")
    layer.uv.foreach_set("vector", uv.astype(np.float32).ravel())
    made = bpy.data.objects.new("islands", mesh)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    bpy.context.scene.tool_settings.use_uv_select_sync = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    exact = {"margin_method": "FRACTION", "margin": margin}
    timed(lambda: bpy.ops.uv.pack_islands(rotate=True, rotate_method="ANY", shape_method="CONCAVE", **exact))
    bpy.ops.object.mode_set(mode="OBJECT")
    packed = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["uv"].uv.foreach_get("vector", packed)
    return packed.reshape(-1, 3, 2).astype(float)


PACKERS: dict[str, Callable[..., FloatArray]] = {
    "lsgp, quick": lambda *kit: by_lsgp(*kit, effort="quick"),
    "lsgp, good": lambda *kit: by_lsgp(*kit, effort="good"),
    "lsgp, best": lambda *kit: by_lsgp(*kit, effort="best"),
    "xatlas": lambda *kit: by_xatlas(*kit, brute_force=False),
    "xatlas, brute force": lambda *kit: by_xatlas(*kit, brute_force=True),
    "Blender": by_blender,
    "spyrrow": by_spyrrow,
}

spent = 0.0


def timed(work: Callable[[], object]) -> object:
    """Its result; the CPU seconds it took are added to those spent."""
    global spent
    before = cpu_seconds()
    result = work()
    spent += cpu_seconds() - before
    return result


def cpu_seconds() -> float:
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def joined(uv: FloatArray, island: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Triangles (m, 3) of vertices that are shared within islands alone, and a corner of each vertex."""
    keys = np.column_stack([np.repeat(island, 3), uv.reshape(-1, 2)])
    _, first, vertex = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return vertex.reshape(-1, 3), first


def outline(z: NDArray[np.complex128]) -> list[complex]:
    """The longest of the loops around triangles (k, 3), without corners that are straight."""
    follows = defaultdict(list)
    edges = {(a, b) for corners in z.tolist() for a, b in zip(corners, corners[1:] + corners[:1], strict=True)}
    for a, b in edges:
        if (b, a) not in edges:
            follows[a].append(b)
    loops = []
    while follows:
        loop = [next(iter(follows))]
        while (following := follows.get(loop[-1])) is not None:
            loop.append(following.pop())
            if not following:
                del follows[loop[-2]]
        loops.append(loop[:-1])
    longest = np.array(max(loops, key=lambda loop: np.abs(np.diff([*loop, loop[0]])).sum()))
    along, back = np.roll(longest, -1) - longest, longest - np.roll(longest, 1)
    bends = np.abs((along * back.conj()).imag) > 1e-9 * np.abs(along * back)
    return longest[bends].tolist()


def main() -> None:
    packer, source, target = sys.argv[1:]
    kit = np.load(source)
    packed = PACKERS[packer](kit["corner_uv"], kit["island"], float(kit["margin"]))
    np.savez(Path(target), corner_uv=packed, seconds=spent)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from bpy_program import run_as_program

    run_as_program(main)
