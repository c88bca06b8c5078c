# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender executables the environment names: BLENDER and BLENDER_PYTHON, or BLENDER_CHROOTS."""

import os
import shutil
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class RealBlender:
    """A Blender executable: arguments of tools/test_in_blender.py that name it, and whether it can have a window."""

    name: str
    arguments: tuple[str, ...]
    has_screen: bool


def real_blenders() -> list[RealBlender]:
    """Those that the environment names."""
    found = []
    for folder in filter(None, os.environ.get("BLENDER_CHROOTS", "").split(os.pathsep)):
        name = Path(folder).name
        # The chroot sees the repository, but not every temporary folder.
        out = str(ROOT / "build" / f"in_{name}")
        has_screen = Path(folder, "usr", "bin", "xvfb-run").exists()
        found.append(RealBlender(name, ("--chroot", folder, "--out", out), has_screen))
    if "BLENDER" in os.environ and "BLENDER_PYTHON" in os.environ:
        arguments = ("--blender", os.environ["BLENDER"], "--python", os.environ["BLENDER_PYTHON"])
        found.append(RealBlender("blender", arguments, shutil.which("xvfb-run") is not None))
    return found
