# SPDX-License-Identifier: GPL-3.0-or-later
"""A drawing of a layout, which takes no renderer: its faces, and every cut in one color on both its sides.

Cuts and cones have the colors of `demo_picture`. Runs inside Blender.
"""

from __future__ import annotations

from pathlib import Path

import bpy
import demo_picture
import numpy as np

SIZE, MARGIN = 1000, 20  # units of the drawing; of its longer side without margins
CUT, CONE = 4, 7  # width of a line and radius of a disk
PAPER, FACE, EDGE, BORDER = "#f6f4ee", "#dfe5ea", "#a9b6c0", "#28303c"


def write_layout(model: bpy.types.Object, cut_edges: np.ndarray, cones: np.ndarray, path: Path) -> None:
    """Write the active layer of `model` as an SVG.  cut_edges: (c, 2) vertex pairs. cones: (k,) vertices."""
    import lsgp  # comes with the extension

    mesh = model.data
    uv = demo_picture.read_uv(mesh)
    low, high = uv.min(axis=0), uv.max(axis=0)
    scale = SIZE / (high - low).max()
    place = np.column_stack([uv[:, 0] - low[0], high[1] - uv[:, 1]]) * scale + MARGIN
    width, height = (high - low) * scale + 2 * MARGIN

    def line(loops: list[int]) -> str:
        return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in place[loops])

    sides = demo_picture.Sides(mesh)
    faces = "".join(f"{line(list(polygon.loop_indices))}Z" for polygon in mesh.polygons)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" stroke-linejoin="round">',
        f'<rect width="100%" height="100%" fill="{PAPER}"/>',
        f'<path d="{faces}" fill="{FACE}" stroke="{EDGE}" stroke-width="0.4"/>',
    ]
    paths = [(BORDER, border) for border in lsgp.split_into_paths(sides.border_edges(), cut_edges.ravel())]
    cuts = lsgp.split_into_paths(cut_edges, cones)
    paths += [(_hexadecimal(demo_picture.cut_color(number)), cut) for number, cut in enumerate(cuts)]
    for color, vertices in paths:
        drawn = "".join(line(loops) for loops in sides.of_path(vertices))
        parts.append(f'<path d="{drawn}" fill="none" stroke="{color}" stroke-width="{CUT}"/>')
    for cone in cones.tolist():
        color = _hexadecimal(demo_picture.cone_color(sides.curvature(cone, uv)))
        for x, y in place[sides.places(cone, uv)]:
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{CONE}" fill="{color}"/>')
    path.write_text("\n".join([*parts, "</svg>", ""]), encoding="utf-8")


def _hexadecimal(color: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * share):02x}" for share in color)
