# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch overwrites its assets only if that was requested."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from lsgp.io.mesh_files import read_mesh
from meshes import grid
from systems import make_link

COMMENT = b"# by hand \xff\nusemtl stone\n"


@pytest.fixture
def assets(tmp_path: Path) -> Path:
    """A folder of two OBJ files, one of them in a folder of its own."""
    mesh = grid()
    lines = [f"v {x} {y} {z}" for x, y, z in mesh.positions.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (np.asarray(mesh.triangles) + 1).tolist()]
    folder = tmp_path / "assets"
    (folder / "deep").mkdir(parents=True)
    for name in ("a.obj", "deep/b.obj"):
        (folder / name).write_bytes(COMMENT + "\n".join([*lines, ""]).encode())
    return folder


def content(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*.obj*")}


@pytest.mark.slow
@pytest.mark.parametrize("out", ["assets", "link", "assets/../assets"])
def test_results_over_the_assets_take_an_option(batch, assets: Path, out: str) -> None:
    if out == "link":
        make_link(assets.parent / "link", assets)
    before = content(assets)
    done = batch("assets", "--out", out, "--no-pictures")
    assert done.returncode == 2
    assert "--in-place" in done.stderr and "a.obj" in done.stderr
    assert content(assets) == before and not list(assets.glob("journal*"))

    assert batch("assets", "--out", out, "--no-pictures", "--in-place").returncode == 0
    after = content(assets)
    assert after.keys() == before.keys()
    for name, data in after.items():
        assert data.startswith(COMMENT) and b"\nvt " in data
        assert before[name].removeprefix(COMMENT).splitlines()[0] in data
        assert not np.isnan(read_mesh(assets / name, with_uv=True).corner_uv).any()


def test_a_link_in_the_folder_of_the_results_is_not_followed_to_an_asset(batch, assets: Path) -> None:
    before = content(assets)
    (assets.parent / "out").mkdir()
    os.link(assets / "deep" / "b.obj", assets.parent / "out" / "a.obj")
    for options in ([], ["--in-place"]):
        done = batch("assets", "--out", "out", "--no-pictures", *options)
        assert done.returncode == 2
        assert "a.obj' would be written over" in done.stderr and "b.obj'" in done.stderr
    assert content(assets) == before
