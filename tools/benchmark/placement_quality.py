# SPDX-License-Identifier: GPL-3.0-or-later
"""The predicted stretch of automatic cones and the stretch of their maps, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/placement_quality.py [--zoo N] [--limit SECONDS] [FOLDER ...]
    PYTHONPATH=tests python tools/benchmark/placement_quality.py --plates G [G ...]

FOLDER holds OBJ or OFF files (default: ../shared/meshes and its folder hard). N ordinary members of the zoo follow, one
of each family as far as there are so many. With --plates there are only bent plates with G tunnels each. Seconds are of
CPU time. Every mesh is unwrapped in a process of its own, which is ended after
SECONDS. Needs the lsgp wheel.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import lsgp
import zoo
from lsgp.io.mesh_files import parse_mesh
from lsgp.io.polygons import triangulate
from own_process import in_own_process
from zoo.tunnels import smooth_tunneled_plate

SHARED = Path(__file__).resolve().parents[3] / "shared" / "meshes"
COLUMNS = ("mesh", "triangles", "cones", "predicted L2", "map L2", "defects", "maps", "place s", "told")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", metavar="FOLDER", type=Path, default=[SHARED, SHARED / "hard"])
    parser.add_argument("--zoo", metavar="N", type=int, default=40, help="members of the zoo (default: 40)")
    parser.add_argument("--limit", metavar="SECONDS", type=float, default=120, help="for each mesh (default: 120)")
    parser.add_argument("--plates", metavar="G", type=int, nargs="+", help="only plates with so many tunnels")
    arguments = parser.parse_args()
    if arguments.plates:
        meshes = of_plates(arguments.plates)
    else:
        meshes = [*of_folders(arguments.folders), *of_zoo(arguments.zoo)]
    print(f"| {' | '.join(COLUMNS)} |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|---|")
    for name, read in meshes:
        print(f"| {name} | {' | '.join(within(arguments.limit, read))} |", flush=True)


def of_folders(folders: list[Path]) -> Iterator[tuple[str, Callable[[], lsgp.Surface]]]:
    for folder in folders:
        for path in sorted([*folder.glob("*.obj"), *folder.glob("*.off")]):
            yield path.stem, lambda path=path: read_surface(path)


def of_plates(tunnels: list[int]) -> Iterator[tuple[str, Callable[[], lsgp.Surface]]]:
    for count in tunnels:
        across = max(n for n in range(1, math.isqrt(count) + 1) if count % n == 0)
        plate = smooth_tunneled_plate(across, count // across)
        yield f"plate of genus {count}", lambda plate=plate: lsgp.Surface(plate.positions, plate.triangles)


def of_zoo(count: int) -> Iterator[tuple[str, Callable[[], lsgp.Surface]]]:
    """The last ordinary small member of each family, evenly over all families."""
    last = {one.family: one for one in zoo.members("small") if one.ordinary}
    chosen = list(last.values())
    for i in range(min(count, len(chosen))):
        member = chosen[i * len(chosen) // count] if count < len(chosen) else chosen[i]
        yield member.name, lambda member=member: of_member(member)


def read_surface(path: Path) -> lsgp.Surface:
    _, mesh = parse_mesh(path, path.read_bytes(), None, with_uv=False)
    split = triangulate(mesh)
    return lsgp.Surface(mesh.positions, split.triangles, split.edges)


def of_member(member: zoo.Member) -> lsgp.Surface:
    mesh = member.mesh()
    return lsgp.Surface(mesh.positions, mesh.triangles, member.edges())


def within(limit: float, read: Callable[[], lsgp.Surface]) -> list[str]:
    """The figures of a mesh, or that it took too long."""
    slow = ["", "", "", "", "", "", f"> {limit:g}", ""]
    return in_own_process(lambda: figures(read), limit, slow, ["", "", "", "", "", "", "", "crash"])


def figures(read: Callable[[], lsgp.Surface]) -> list[str]:
    surface = read()
    begin = time.process_time()
    try:
        placed = lsgp.place_cones(surface)
        seconds = time.process_time() - begin
        result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    except lsgp.LsgpError as error:
        return [str(len(surface.triangles)), "", "", "", "", "", f"{time.process_time() - begin:.2f}", error.code]
    defects = len(result.flipped) + len(result.wrong_angle_sums)
    return [
        str(len(surface.triangles)),
        str(len(placed.cones)),
        f"{placed.predicted_l2:.3f}",
        f"{result.distortion.l2_stretch:.3f}",
        str(defects),
        str(placed.maps),
        f"{seconds:.2f}",
        ", ".join(sorted({finding.code for finding in [*placed.warnings, *result.warnings]})),
    ]


if __name__ == "__main__":
    main()
