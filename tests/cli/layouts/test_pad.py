# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp pad`: it writes the result of the library, and leaves nothing behind when it refuses."""

from __future__ import annotations

from pathlib import Path

import lsgp as library
import numpy as np
import pytest
from lsgp.cli import main

cv2 = pytest.importorskip("cv2")
SIZE = 96


@pytest.fixture
def folder(lsgp, ball_files: Path) -> Path:
    """mapped.obj, and images of it full of noise."""
    assert lsgp("unwrap", "ball.obj", "-o", "mapped.obj", "--cones", "cones.json").code == 0
    noise = np.random.default_rng(4).random((SIZE, SIZE, 4))
    for name, kind, channels in [
        *[("gray8.png", "uint8", 1), ("rgb8.png", "uint8", 3), ("rgba16.png", "uint16", 4), ("rgb16.png", "uint16", 3)],
        *[("gray16.tif", "uint16", 1), ("rgb32.tif", "float32", 3), ("gray64.tiff", "float64", 1)],
    ]:
        scale = np.iinfo(kind).max if kind[0] == "u" else 1
        pixels = (noise[..., :channels] * scale).astype(kind)
        assert cv2.imwrite(str(ball_files / name), pixels[..., 0] if channels == 1 else pixels)
    return ball_files


def padded(folder: Path, name: str, margin: float, *, normal_map: bool = False) -> np.ndarray:
    """By the library, in OpenCV's order of channels."""
    file = library.read_mesh_file(folder / "mapped.obj", with_uv=True)
    pixels = cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED)
    swap = (lambda p: p[..., [2, 1, 0, 3][: p.shape[2]]]) if pixels.ndim == 3 else (lambda p: p)
    return swap(library.pad_image(swap(pixels), file.surface(), file.triangle_uv, margin, normal_map=normal_map))


@pytest.mark.parametrize(
    "name", ["gray8.png", "rgb8.png", "rgba16.png", "rgb16.png", "gray16.tif", "rgb32.tif", "gray64.tiff"]
)
def test_the_file_is_what_the_library_makes(lsgp, folder: Path, name: str) -> None:
    output = f"out{Path(name).suffix}"
    done = lsgp("pad", name, "--uv", "mapped.obj", "--margin", 4, "-o", output)
    assert (done.code, done.err) == (0, "")
    before = cv2.imread(str(folder / name), cv2.IMREAD_UNCHANGED)
    after = cv2.imread(str(folder / output), cv2.IMREAD_UNCHANGED)
    assert (after.dtype, after.shape) == (before.dtype, before.shape)
    assert (after == padded(folder, name, 4)).all()
    changed = int((after != before).reshape(SIZE * SIZE, -1).any(axis=1).sum())
    assert changed > 0 and f"{changed} of them changed" in done.out


def test_normals_are_turned_on_request(lsgp, folder: Path) -> None:
    call = ("pad", "rgb8.png", "--uv", "mapped.obj", "--margin", 4)
    assert lsgp(*call, "-o", "plain.png").code == lsgp(*call, "--normal-map", "-o", "turned.png").code == 0
    plain, turned = (cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_UNCHANGED) for name in ("plain", "turned"))
    assert (turned == padded(folder, "rgb8.png", 4, normal_map=True)).all()
    # Blue is the first channel here.
    assert (turned[..., 0] == plain[..., 0]).all() and (turned[..., 1] != plain[..., 1]).any()


def test_mip_levels_are_those_of_the_library_beside_the_output(lsgp, folder: Path) -> None:
    done = lsgp("pad", "rgba16.png", "--uv", "mapped.obj", "--margin", 6, "--mips", 3, "-o", "out.png")
    assert (done.code, done.err) == (0, "") and "mip levels 1 to 3" in done.out
    file = library.read_mesh_file(folder / "mapped.obj", with_uv=True)
    swap = [2, 1, 0, 3]
    pixels = cv2.imread(str(folder / "rgba16.png"), cv2.IMREAD_UNCHANGED)[..., swap]
    expected = library.pad_mip_levels(pixels, file.surface(), file.triangle_uv, [6, 3, 2, 2])
    for name, level in zip(["out", "out-mip1", "out-mip2", "out-mip3"], expected, strict=True):
        written = cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_UNCHANGED)
        assert written.dtype == np.uint16 and (written[..., swap] == level).all()
    assert not (folder / "out-mip4.png").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (("rgb8.png", "--uv", "ball.obj", "--margin", 4, "-o", "out.png"), 3, "NO_UV"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", -1, "-o", "out.png"), 2, "--margin -1 is no width"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", "nan", "-o", "out.png"), 2, "--margin nan is no width"),
        (("rgb32.tif", "--uv", "mapped.obj", "--margin", 4, "-o", "out.png"), 3, "PNG has no float32"),
        (("gray8.png", "--uv", "mapped.obj", "--margin", 4, "--normal-map", "-o", "out.png"), 3, "WRONG_SHAPE"),
        (("text.png", "--uv", "mapped.obj", "--margin", 4, "-o", "out.png"), 3, "MALFORMED_FILE: 'text.png'"),
        (("empty.png", "--uv", "mapped.obj", "--margin", 4, "-o", "out.png"), 3, "MALFORMED_FILE: 'empty.png'"),
        (("rgb8.png", "--uv", "tiled.obj", "--margin", 4, "-o", "out.png"), 3, "ISLANDS_OUTSIDE"),
        (("none.png", "--uv", "mapped.obj", "--margin", 4, "-o", "out.png"), 2, "'none.png'"),
        (("rgb8.png", "--uv", "none.obj", "--margin", 4, "-o", "out.png"), 2, "'none.obj'"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", 4, "-o", "out.jpg"), 2, ".png or .tif"),
        (("mapped.obj", "--uv", "mapped.obj", "--margin", 4, "-o", "out.png"), 2, ".png or .tif"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", 4, "-o", "rgb8.png"), 2, "same file"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", 4, "-o", "no/out.png"), 2, "there is no folder"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", 4, "--mips", 9, "-o", "out.png"), 2, "has 6; give no more"),
        (("rgb8.png", "--uv", "mapped.obj", "--margin", 4, "--mips", -1, "-o", "out.png"), 2, "below 0"),
        (("c-mip2.png", "--uv", "mapped.obj", "--margin", 4, "--mips", 2, "-o", "c.png"), 2, "same file"),
        (("rgb8.png", "--uv", "mapped.obj", "-o", "out.png"), 2, "--margin"),
        (("rgb8.png", "--margin", 4, "-o", "out.png"), 2, "--uv"),
    ],
)
def test_refusals_write_nothing(lsgp, folder: Path, arguments: tuple, code: int, told: str) -> None:
    (folder / "text.png").write_text("no image")
    (folder / "empty.png").touch()
    if "tiled.obj" in arguments:
        lsgp("unwrap", "ball.obj", "-o", "tiled.obj", "--cones", "cones.json", "--seamless", "--tiles", 4)
    (folder / "c-mip2.png").write_bytes((folder / "rgb8.png").read_bytes())
    before = {path: path.read_bytes() for path in folder.iterdir()}
    done = lsgp("pad", *arguments)
    assert done.code == code and told in done.err
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_without_opencv_the_refusal_says_how_to_install_it(folder: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setattr("lsgp.io.optional_packages.find_spec", lambda name: None)
    assert main(["pad", "rgb8.png", "--uv", "mapped.obj", "--margin", "4", "-o", "out.png"]) == 3
    assert "FORMAT_NOT_INSTALLED" in (said := capsys.readouterr().err) and "pip install 'lsgp[images]'" in said
    assert not (folder / "out.png").exists()
