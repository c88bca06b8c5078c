# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap as the first press of an artist: twelve models in Blender's window, beside Blender's own unwraps.

    export LIBGL_ALWAYS_SOFTWARE=1
    xvfb-run --auto-servernum "--server-args=-screen 0 1280x660x24" blender --factory-startup \
        --window-geometry 0 0 1280 660 --python tools/pictures/first_press.py -- --extension ZIP --out OUT [--only NAME]

Every model is made by Blender's generators, in the scene of the start, and unwrapped by a single press of *Auto Unwrap*
with each preset, by *Smart UV Project* and by *Unwrap* with the seams that it has, which are none. OUT/NAME.png shows
all five, each as the UV editor and the 3D view with a texture, above the number of its reports; OUT/table.md has the
figures and the texts of the reports. Fails where a map of *Auto Unwrap* has flipped faces, overlaps or leaves the
square, where tiles may do both of the latter, or where it reports more than one warning or error.

BLENDER_USER_RESOURCES must name a throw-away profile, and ImageMagick has to be installed.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Iterator
from dataclasses import astuple, dataclass
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "blender"))
import demo_scene
import first_press_models as models
from blender_window import WAIT, areas, arrange, inside, run
from scenes import coverage
from windows import PICTURES, running, take_picture

Objects = list[bpy.types.Object]

MODELS = (
    models.default_cube,
    models.suzanne,
    models.half_suzanne,
    models.text,
    models.screw,
    models.torus,
    models.beveled_block,
    models.kit,
    models.cylinder,
    models.cone,
    models.one_material,
    models.scan,
)
PRESETS = ("PAINT", "BAKE", "TILE")
METHODS = (*PRESETS, "SMART", "UNWRAP")
SIZE = 1024  # points across the raster that counts overlaps and what is covered
MOST_SECONDS = 120.0
MOST_WARNINGS = 1
TITLES = (
    *("model", "method", "seconds", "islands", "covered", "doubly", "smallest", "flipped", "outside"),
    *("warnings", "informed"),
)

Report = tuple[str, str]
"""Its type, such as "WARNING", and its text."""


@dataclass(frozen=True)
class Row:
    """The figures of one map, in the order of the titles.

    covered, doubly: shares of the square that one triangle or several cover. smallest: the area of the least island as
    a share of the mean's. outside: how far the map leaves the square. warnings, informed: how many reports of Auto
    Unwrap were warnings or worse, and how many others it made; Blender's operators make theirs out of a script's sight.
    """

    model: str
    method: str
    seconds: float
    islands: int
    covered: float
    doubly: float
    smallest: float
    flipped: int
    outside: float
    warnings: int
    informed: int

    def is_good(self) -> bool:
        """Whether it has no flips and hardly a warning and, unless tiled, no overlaps and fits in the square."""
        packed = self.method == "TILE" or (self.doubly == 0 and self.outside == 0)
        return packed and self.flipped == 0 and self.warnings <= MOST_WARNINGS


def press(method: str) -> None:
    """Press the button with the objects selected, as an artist would; the unwrap may continue in the background."""
    if method in PRESETS:
        bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True, preset=method)
        return
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project() if method == "SMART" else bpy.ops.uv.unwrap()
    bpy.ops.object.mode_set(mode="OBJECT")


def triangles_of(objects: Objects) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Of each mesh of the objects, the coordinates of its triangles, (m, 3, 2), and the island of each."""
    lsgp = sys.modules["lsgp"]
    for mesh in {obj.data: None for obj in objects}:
        mesh.calc_loop_triangles()
        loops, vertices = (np.empty(3 * len(mesh.loop_triangles), np.int32) for _ in range(2))
        mesh.loop_triangles.foreach_get("loops", loops)
        mesh.loop_triangles.foreach_get("vertices", vertices)
        uv, places = np.empty(2 * len(mesh.loops), np.float32), np.empty(3 * len(mesh.vertices), np.float32)
        mesh.uv_layers.active.uv.foreach_get("vector", uv)
        mesh.vertices.foreach_get("co", places)
        corner_uv = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2).astype(np.float64)
        surface = lsgp.Surface(places.reshape(-1, 3).astype(np.float64), vertices.reshape(-1, 3))
        yield corner_uv, lsgp.measure_distortion(surface, corner_uv).island


def figures(objects: Objects, name: tuple[str, str], seconds: float, reports: list[Report]) -> Row:
    """name: of the model and the method."""
    corner_uv, island = zip(*triangles_of(objects), strict=True)
    first = np.cumsum([0, *(part.max() + 1 for part in island)])
    island = np.concatenate([part + at for part, at in zip(island, first[:-1], strict=True)])
    uv = np.concatenate(corner_uv)
    z = uv @ (1, 1j)
    areas_of = ((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0])).imag / 2
    of_island = np.bincount(island, np.abs(areas_of))
    count = coverage(np.where(areas_of[:, None] < 0, z[:, ::-1], z), SIZE)
    return Row(
        *name,
        seconds,
        len(of_island),
        float((count > 0).mean()),
        float((count > 1).mean()),
        float(of_island.min() / of_island.mean()),
        int((areas_of <= 0).sum()),
        float(max(0.0, -uv.min(), uv.max() - 1)),
        sum(kind != "INFO" for kind, _ in reports),
        sum(kind == "INFO" for kind, _ in reports),
    )


def keep_reports() -> list[Report]:
    """What Auto Unwrap concludes from now on. Blender drops the reports of operators that scripts call."""
    background = sys.modules[f"{demo_scene.ADDON}.operators.shared.background"]
    conclude, kept = sys.modules[f"{demo_scene.ADDON}.operators.shared.conclusion"].conclude, []

    class Listener:
        """Stands for the operator: its own report is Blender's and cannot be replaced."""

        def __init__(self, operator: bpy.types.Operator) -> None:
            self.operator = operator

        def report(self, kinds: set[str], text: str) -> None:
            kept.extend((kind, text) for kind in kinds)
            self.operator.report(kinds, text)

    background.conclude = lambda operator, *rest: conclude(Listener(operator), *rest)
    return kept


def show(method: str) -> Iterator[float]:
    """The maps in the UV editor and the objects with a texture; yields seconds to wait."""
    view, editor = areas("VIEW_3D")[0], areas("IMAGE_EDITOR")[0]
    with inside(view):
        bpy.ops.uv.cone_texture(pattern="ASYMMETRIC", tiles=1 if method == "TILE" else 8)
        bpy.ops.view3d.view_selected()
        view.spaces.active.region_3d.view_distance *= 1.2
        view.spaces.active.overlay.show_overlays = False
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
    # The picture of the texture would hide the lines.
    editor.spaces.active.use_image_pin, editor.spaces.active.image = True, None
    yield WAIT
    with inside(editor):
        bpy.ops.uv.select_all(action="SELECT")
        bpy.ops.image.view_selected() if method == "TILE" else bpy.ops.image.view_all(fit_view=True)
    yield 2 * WAIT


def press_all(out: Path, only: str | None) -> Iterator[float]:
    """Press, measure and draw; yields seconds to wait."""
    os.environ[PICTURES] = str(out)
    rows: list[Row] = []
    said: list[str] = []
    for model in MODELS:
        if only is not None and only not in model.__name__:
            continue
        for method in METHODS:
            row, reports = yield from press_once(model, method)
            rows.append(row)
            said.extend(f"- {row.model}, {row.method}: {kind}: {text}" for kind, text in reports)
        pictures = [str(out / f"{model.__name__}-{method.lower()}.png") for method in METHODS]
        sheet = ["(", *pictures[:3], "+append", ")", "(", *pictures[3:], "+append", ")", "-append", "-resize", "50%"]
        subprocess.run(["convert", *sheet, str(out / f"{model.__name__}.png")], check=True)
    (out / "table.md").write_text("\n".join([table(rows), *said, ""]))
    bad = [row for row in rows if row.method in PRESETS and not row.is_good()]
    if bad:
        raise RuntimeError("first_press: not as promised:\n" + table(bad))


def press_once(model: Callable[[], Objects], method: str) -> Generator[float, None, tuple[Row, list[Report]]]:
    """Returns the row of the map, and what was reported."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield WAIT
    yield from prepare()
    with inside(areas("VIEW_3D")[0]):
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        objects = model()
        bpy.ops.object.select_all(action="DESELECT")
        for obj in objects:
            obj.select_set(True)
        bpy.context.view_layer.objects.active = objects[0]
    yield WAIT
    reports = keep_reports()
    begin = time.monotonic()
    with inside(areas("VIEW_3D")[0]):
        press(method)
    while running("UV_OT_cone_auto_unwrap"):
        if time.monotonic() - begin > MOST_SECONDS:
            raise TimeoutError(f"{model.__name__} takes longer with {method}")
        yield 0.05
    row = figures(objects, (model.__name__, method), time.monotonic() - begin, reports)
    print(line_of(row), flush=True)
    # The status bar is below the editors, and ImageMagick need not have a font.
    bpy.context.workspace.status_text_set(caption(row))
    yield from show(method)
    take_picture(f"{model.__name__}-{method.lower()}")
    return row, reports


def prepare() -> Iterator[float]:
    """A UV editor beside a 3D view, and nothing else."""
    for kind in ("PROPERTIES", "OUTLINER"):
        for area in areas(kind):
            with inside(area):
                bpy.ops.screen.area_close()
    yield WAIT
    yield from arrange(0.5)
    for space in areas("VIEW_3D")[0].spaces:
        space.show_region_toolbar = False
    for space in areas("IMAGE_EDITOR")[0].spaces:
        space.show_region_toolbar = False


def caption(row: Row) -> str:
    told = f", {row.warnings} warnings, {row.informed} for information" if row.method in PRESETS else ""
    return f"{row.model}, {row.method}: {row.islands} islands, {row.covered:.0%} covered{told}"


def line_of(row: Row) -> str:
    cells = (f"{cell:.3g}" if isinstance(cell, float) else str(cell) for cell in astuple(row))
    return f"| {' | '.join(cells)} |"


def table(rows: list[Row]) -> str:
    return "\n".join([f"| {' | '.join(TITLES)} |", "|" + "---|" * len(TITLES), *map(line_of, rows), ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--extension", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures and the table")
    parser.add_argument("--only", help="models with this in their name")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    arguments.out.mkdir(parents=True, exist_ok=True)
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.smooth_view = 0
    bpy.context.preferences.system.viewport_aa = "OFF"
    demo_scene.install_extension(arguments.extension)
    run(press_all(arguments.out.resolve(), arguments.only))


if __name__ == "__main__":
    main()
