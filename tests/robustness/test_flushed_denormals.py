# SPDX-License-Identifier: GPL-3.0-or-later
"""Hosts may have told the processor to take numbers next to zero for zero: it must not change a map."""

from __future__ import annotations

import ctypes
import platform
from collections.abc import Iterator
from contextlib import contextmanager

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import SISTER_RATIO, digest, surface
from meshes import Mesh
from result_check import undeclared_faults

if platform.machine() != "x86_64" or platform.libc_ver()[0] != "glibc":
    pytest.skip("denormals are flushed through glibc's environment of an x86-64", allow_module_level=True)

MXCSR = 7  # 32-bit word of glibc's fenv_t
FLUSH = 1 << 15 | 1 << 6  # results to zero, and operands


@contextmanager
def denormals_flushed() -> Iterator[None]:
    """In this thread, as a library linked with -ffast-math does it."""
    libm = ctypes.CDLL("libm.so.6")
    before = (ctypes.c_uint32 * 8)()
    assert libm.fegetenv(before) == 0
    changed = (ctypes.c_uint32 * 8)(*before)
    changed[MXCSR] |= FLUSH
    assert libm.fesetenv(changed) == 0
    try:
        yield
    finally:
        libm.fesetenv(before)


def ended(mesh: Mesh, options: lsgp.Options) -> lsgp.Result | str:
    """The result, or the code of a refusal."""
    try:
        return lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    except lsgp.LsgpError as error:
        return error.code


def scaled(mesh: Mesh, scale: float) -> Mesh:
    return mesh._replace(positions=mesh.positions * scale)


MESHES = {
    "sphere": meshes.bumpy_sphere(2),
    "cube": meshes.cube(4),
    "torus": meshes.torus(14, 8),
    "holes": meshes.disk_with_holes(12, 2),
    "tube": meshes.cylinder(10, 4),
}
OPTIONS = {
    "default": lsgp.Options(),
    "spectral": lsgp.Options(unfold="spectral"),
    "straightness": lsgp.Options("straightness"),
}


def test_here_they_are_flushed() -> None:
    tiny = np.array([1e-310])
    with denormals_flushed():
        assert tiny * 1.5 == 0
    assert tiny * 1.5 > 0


@pytest.mark.parametrize("scale", [1, 1e-9, 1e-55])
@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("name", MESHES)
def test_maps_are_valid_and_the_same(name: str, options: str, scale: float) -> None:
    mesh = scaled(MESHES[name], scale)
    with denormals_flushed():
        flushed = ended(mesh, OPTIONS[options])
    plain = ended(mesh, OPTIONS[options])
    assert isinstance(plain, lsgp.Result) and isinstance(flushed, lsgp.Result)
    assert digest(flushed) == digest(plain)
    assert undeclared_faults(surface(mesh), flushed, OPTIONS[options]) == []
    assert flushed.flipped.size == 0 and flushed.seams.sister_ratio_max - 1 <= SISTER_RATIO


@pytest.mark.parametrize("seed", range(20))
def test_shapes_without_measure_end_in_an_honest_map_or_a_refusal(seed: int) -> None:
    """Sides that differ by up to 36 digits: there squares and their products do come close to zero."""
    random = np.random.default_rng(seed)
    mesh = meshes.cube(3)._replace(positions=meshes.cube(3).positions * 10.0 ** random.uniform(-18, 18, 3))
    options = OPTIONS[("default", "spectral")[seed % 2]]
    with denormals_flushed():
        found = ended(mesh, options)
    if isinstance(found, lsgp.Result):
        assert undeclared_faults(surface(mesh), found, options) == []
    else:
        assert found in ("SOLVER_FAILED", "DEGENERATE_MESH")


@pytest.mark.parametrize("size", [5e-324, 1e-310])
def test_a_surface_of_denormals_is_refused(size: float) -> None:
    """Its size is out of range; where that is taken for zero, it has none."""
    mesh = scaled(meshes.cube(2), size)
    assert ended(mesh, lsgp.Options()) == "SCALE_RANGE"
    with denormals_flushed():
        assert ended(mesh, lsgp.Options()) in ("SCALE_RANGE", "DEGENERATE_MESH")


@pytest.mark.exact_input  # how inputs are moved hangs on all bits, and would itself differ where denormals are flushed
@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-290])
def test_denormals_beside_ordinary_coordinates(size: float) -> None:
    mesh = meshes.grid(6, 5, lambda x, y: np.sin(x + y) * size)
    with denormals_flushed():
        flushed = ended(mesh, lsgp.Options())
    assert isinstance(flushed, lsgp.Result)
    assert flushed.flipped.size == 0 and undeclared_faults(surface(mesh), flushed) == []
    assert np.array_equal(flushed.corner_uv, lsgp.parameterize(surface(mesh), mesh.cones).corner_uv)
