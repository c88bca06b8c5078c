# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender executables the environment names: BLENDER and BLENDER_PYTHON, or BLENDER_CHROOTS."""

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import pytest

ROOT = Path(__file__).resolve().parents[2]


def leave_out(reason: str) -> NoReturn:
    """Skip what needs a Blender that is not there; an error where CONE_UNWRAP_REQUIRE_BLENDER says it has to be."""
    if os.environ.get("CONE_UNWRAP_REQUIRE_BLENDER") == "1":
        pytest.fail(reason)
    pytest.skip(reason)


@dataclass(frozen=True)
class RealBlender:
    """A Blender executable: arguments of `test_in_blender.py` that name it, and what is tried beside its tests."""

    name: str
    arguments: tuple[str, ...]
    has_screen: bool


def chroots() -> list[str]:
    """The folders of BLENDER_CHROOTS, the newest system last."""
    return [folder for folder in os.environ.get("BLENDER_CHROOTS", "").split(os.pathsep) if folder]


def real_blenders() -> list[RealBlender]:
    """Those that the environment names."""
    found = []
    folders = chroots()
    for folder in folders:
        name = Path(folder).name
        # The chroot sees the repository, but not every temporary folder.
        out = str(ROOT / "build" / f"in_{name}")
        # Windows take minutes: those of the last one, the newest, are enough.
        has_screen = folder == folders[-1] and Path(folder, "usr", "bin", "xvfb-run").exists()
        found.append(RealBlender(name, ("--chroot", folder, "--out", out), has_screen))
    if "BLENDER" in os.environ and "BLENDER_PYTHON" in os.environ:
        arguments = ("--blender", os.environ["BLENDER"], "--python", os.environ["BLENDER_PYTHON"])
        has_screen = shutil.which("xvfb-run") is not None
        found.append(RealBlender("blender", arguments, has_screen))
    return found
