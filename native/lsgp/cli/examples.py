# SPDX-License-Identifier: GPL-3.0-or-later
"""Examples at the end of each command's help."""

from __future__ import annotations

import argparse

EXAMPLES = {
    "unwrap": (
        "lsgp unwrap model.obj -o painted.obj --preset paint --picture layout.png",
        "lsgp unwrap model.obj -o tiled.obj --seamless --tiles 32",
        "lsgp unwrap model.glb -o even.glb --cones auto:12 --mode low-stretch",
    ),
    "cones": (
        "lsgp cones model.obj -o cones.json --target 1.03",
        "lsgp cones model.obj -o cones.json --count 12 --keep mine.json",
        "lsgp cones model.obj -o cones.json --symmetric",
    ),
    "quads": (
        "lsgp quads model.obj -o quads.obj --target 2000",
        "lsgp quads model.obj -o quads.obj --size 0.05 --cones auto:14",
        "lsgp quads model.obj -o even.obj --target 2000 --mode low-stretch",
    ),
    "batch": (
        "lsgp batch library --out unwrapped --preset paint",
        "lsgp batch library --out unwrapped --only-missing --jobs 8",
        "lsgp batch list.txt --out unwrapped --cones '{}.cones.json'",
    ),
    "measure": (
        "lsgp measure unwrapped.obj",
        "lsgp measure unwrapped.obj --report report.json",
        "lsgp measure unwrapped.glb --texture-size 2048",
    ),
    "pad": (
        "lsgp pad baked.png --uv unwrapped.obj --margin 16 -o padded.png",
        "lsgp pad normals.png --uv unwrapped.obj --margin 16 --normal-map -o out.png",
        "lsgp pad baked.png --uv unwrapped.obj --margin 8 --mips 5 -o padded.png",
    ),
}
"""By command."""

_TITLE = "examples:"


class Formatter(argparse.HelpFormatter):
    """Wraps paragraphs as usual, but keeps the lines of examples."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        paragraphs = (
            part if part.startswith(_TITLE) else super(Formatter, self)._fill_text(part, width, indent)
            for part in text.split("\n\n")
        )
        return "\n\n".join(paragraphs)


def with_examples(command: str, epilog: str | None) -> str:
    """The end of a command's help: examples before what it ends with otherwise."""
    lines = [_TITLE, *(f"  {example}" for example in EXAMPLES[command])]
    return "\n".join(lines) + ("" if epilog is None else f"\n\n{epilog}")
