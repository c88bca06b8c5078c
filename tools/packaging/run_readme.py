# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the README's lines with an installed wheel alone: python tools/packaging/run_readme.py PYTHON

PYTHON is that of a virtual environment with lsgp in it. The blocks run in a new folder, which has the model of the
examples and nothing else of the repository, and find no other programs than those of the environment, hence no
compiler. What the README shows has to be printed. Blocks for Blender are left out.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))
from code_blocks import ROOT, blocks_of, require_shown

README = ROOT / "README.md"
SECONDS = 300


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("python", metavar="PYTHON", type=Path)
    python = Path(os.path.abspath(parser.parse_args().python))
    blocks = [block for block in blocks_of(README) if block.runs and not block.in_blender]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "examples").mkdir()
        shutil.copy(ROOT / "examples" / "model.obj", Path(folder) / "examples")
        printed = ""
        for block in blocks:
            if block.language == "text":
                require_shown(block, printed, README)
            elif block.language == "sh":
                printed = run([shutil.which("bash"), "-eu", "-c", block.text], python, folder)
        program = "\n".join(block.text for block in blocks if block.language == "python")
        run([python, "-I", "-c", program], python, folder)
    print(f"run_readme: {len(blocks)} blocks of the README passed with {python}")


def run(command: list[str | Path | None], python: Path, folder: str) -> str:
    """What it prints to either stream.  Raises CalledProcessError."""
    environment = {"PATH": str(python.parent), "HOME": folder, "LC_ALL": "C.UTF-8"}
    done = subprocess.run(
        list(map(str, command)),
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
        check=False,
    )
    if done.returncode != 0:
        raise SystemExit(f"run_readme: {command[-1]}\nends with {done.returncode}:\n{done.stdout}")
    return done.stdout


if __name__ == "__main__":
    main()
