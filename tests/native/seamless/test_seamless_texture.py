# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of seamless layouts: along every cut a texture has the same colors on both sides, as it is filtered.

Judged from the coordinates alone, in the single precision in which programs store them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from demo_texture import bilinear, pinwheels
from map_checks import surface
from meshes import Mesh
from numpy.typing import NDArray
from shared_meshes import shared_mesh

FloatArray = NDArray[np.float64]
Texture = Callable[[FloatArray], FloatArray]

SIZE = 256  # texels of a tile
OFFSET = 1 / 64  # texels from the cut
ROUNDING = 1e-12
SEEN = 0.1  # mean difference of colors from 0 to 1 across cuts that show
# Along an edge, exact in floating point.
PARTS = np.arange(1, 16)[:, None] / 16

GENERATED = {
    "cube": lambda: meshes.cube(6, (1.0, 1.3, 0.8)),
    "bumpy sphere": lambda: meshes.bumpy_sphere(3),
    "flower": meshes.flower,
    "forked": meshes.forked,
}
SHARED = {name: lambda name=name: shared_mesh(name) for name in ("fandisk", "igea-16k", "kitten-genus1")}


class Sides:
    """Points just left and just right of all cuts of a layout, and on them.

    on: two arrays (points, 2), the same place of the surface in the triangle left and in the one right of the cut.
    """

    def __init__(self, mesh: Mesh, corner_uv: FloatArray) -> None:
        uv = corner_uv.astype(np.float32).astype(np.float64).reshape(-1, 2)
        tail, head, apex = (
            np.arange(uv.shape[0]).reshape(-1, 3)[:, turn].ravel() for turn in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
        )
        vertex = mesh.triangles.ravel().astype(np.int64)
        count = len(mesh.positions)
        key, opposite = vertex[tail] * count + vertex[head], vertex[head] * count + vertex[tail]
        order = np.argsort(key)
        place = np.clip(np.searchsorted(key[order], opposite), 0, len(key) - 1)
        twin = np.where(key[order][place] == opposite, order[place], -1)
        h = np.flatnonzero(twin > np.arange(len(twin)))
        g = twin[h]
        left, right = uv[[tail[h], head[h]]], uv[[head[g], tail[g]]]
        cut = (left != right).any(axis=(0, 2))
        self.edges = int(cut.sum())
        self.on = [_along(side[:, cut]) for side in (left, right)]
        self._inward = [_inward(side[:, cut], uv[apex[halfedge[cut]]]) for side, halfedge in ((left, h), (right, g))]

    def beside(self, distance: float) -> list[FloatArray]:
        """Points at this distance from the cuts, less in thin triangles."""
        room = np.minimum(*(np.linalg.norm(inward, axis=1) for inward in self._inward))[:, None]
        step = np.minimum(distance, room / 32)
        return [
            place + step * inward / np.linalg.norm(inward, axis=1, keepdims=True)
            for place, inward in zip(self.on, self._inward, strict=True)
        ]


def _along(ends: FloatArray) -> FloatArray:
    """Points on edges, (2, edges, 2) to (edges * parts, 2)."""
    return (ends[0][:, None] * (1 - PARTS) + ends[1][:, None] * PARTS).reshape(-1, 2)


def _inward(ends: FloatArray, apex: FloatArray) -> FloatArray:
    """From each edge at right angles as far as the third corner of its triangle, for all points on it."""
    along = ends[1] - ends[0]
    to_apex = apex - ends[0]
    height = to_apex - along * ((to_apex * along).sum(axis=1) / (along * along).sum(axis=1))[:, None]
    return np.repeat(height, len(PARTS), axis=0)


def differences(texture: Texture, places: list[FloatArray]) -> FloatArray:
    """The largest difference of a channel at each pair of points."""
    left, right = (texture(side) for side in places)
    return np.abs(right - left).max(axis=1)


@cache
def tile() -> FloatArray:
    return pinwheels(SIZE)


@cache
def checker_tiles() -> FloatArray:
    """Two by two tiles, a black and a white one in each row."""
    black = np.kron(np.eye(2), np.ones((SIZE // 2, SIZE // 2)))
    return black[..., None]


def pinwheel_texture(uv: FloatArray) -> FloatArray:
    return bilinear(tile(), uv)


def checker_texture(uv: FloatArray) -> FloatArray:
    return bilinear(checker_tiles(), uv / 2)


def steepest(texels: FloatArray) -> float:
    """The largest slope of the filtered texture, in colors a texel: that of a plane through three texels."""
    across, up = (np.abs(np.roll(texels, 1, axis) - texels).max() for axis in (0, 1))
    return float(np.hypot(across, up))


def layout(mesh: Mesh, tiles: float = 64, **options: object) -> lsgp.Result:
    wanted = lsgp.Options(seamless=lsgp.Seamless(tiles=tiles, **options))
    result = lsgp.parameterize(surface(mesh), mesh.cones, options=wanted)
    assert len(result.flipped) == len(result.wrong_angle_sums) == len(result.seamless.relaxed_cones) == 0
    return result


def require_invisible(sides: Sides, texture: Texture, texels: FloatArray) -> None:
    """No difference at the cuts, and beside them no more than the texture's own over twice that distance."""
    assert sides.edges > 0
    assert differences(texture, sides.on).max() <= ROUNDING
    slope = steepest(texels)
    assert slope * 2 * OFFSET < SEEN / 2
    assert differences(texture, sides.beside(OFFSET / SIZE)).max() <= slope * 2 * OFFSET + ROUNDING


def require_seen(sides: Sides, texture: Texture) -> None:
    assert differences(texture, sides.beside(OFFSET / SIZE)).mean() > SEEN


# --- the texture ----------------------------------------------------------------------------------------------------


def test_texture_is_the_same_turned_by_quarters_but_not_mirrored():
    assert np.array_equal(tile(), np.rot90(tile()))
    small = pinwheels(32)
    shifts = np.stack(np.meshgrid(range(32), range(32)), axis=-1).reshape(-1, 2).tolist()
    assert min(np.abs(np.roll(small[::-1], shift, (0, 1)) - small).mean() for shift in shifts) > 0.1


# --- squares with quarter turns ---------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("tiles", [24, 64, 200])
@pytest.mark.parametrize("name", [*GENERATED, *SHARED])
def test_no_seam_is_seen(name: str, tiles: int) -> None:
    mesh = (GENERATED | SHARED)[name]()
    sides = Sides(mesh, layout(mesh, tiles).corner_uv)
    require_invisible(sides, pinwheel_texture, tile())


@pytest.mark.parametrize("name", [*GENERATED, *SHARED])
def test_seams_of_the_plain_map_are_seen(name: str) -> None:
    mesh = (GENERATED | SHARED)[name]()
    plain = lsgp.parameterize(surface(mesh), mesh.cones)
    require_seen(Sides(mesh, 64 * plain.corner_uv), pinwheel_texture)


def test_seams_are_seen_where_tiles_are_a_little_too_large() -> None:
    mesh = meshes.bumpy_sphere(3)
    require_seen(Sides(mesh, 1.01 * layout(mesh).corner_uv), pinwheel_texture)


# --- a checker ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [*GENERATED, *SHARED])
def test_checker_and_pinwheels_match_with_parity(name: str) -> None:
    mesh = (GENERATED | SHARED)[name]()
    sides = Sides(mesh, layout(mesh, parity=True).corner_uv)
    require_invisible(sides, checker_texture, checker_tiles())
    require_invisible(sides, pinwheel_texture, tile())


@pytest.mark.parametrize("name", [*GENERATED, *SHARED])
def test_checker_does_not_match_without_parity(name: str) -> None:
    mesh = (GENERATED | SHARED)[name]()
    sides = Sides(mesh, layout(mesh).corner_uv)
    assert differences(checker_texture, sides.beside(OFFSET / SIZE)).mean() > SEEN


# --- which texture for which lattice ----------------------------------------------------------------------------------

ROTATION_ORDER = {"translation": 1, "stripe": 2, "triangle": 3, "square": 4, "hexagon": 6}


class Waves:
    """A smooth texture that repeats on a lattice and is unchanged by rotations of 2 pi / `rotation_order`, no less."""

    def __init__(self, rotation_order: int, triangular: bool) -> None:
        rng = np.random.default_rng(rotation_order)
        second = np.exp(1j * np.pi / 3) if triangular else 1j
        # Waves that repeat along 1 and along the second vector.
        whole = rng.integers(-2, 3, (2, 4))
        along_second = (whole[1] - whole[0] * second.real) / second.imag
        waves = whole[0] + 1j * along_second
        self._waves = np.concatenate(
            [waves * np.exp(2j * np.pi * turn / rotation_order) for turn in range(rotation_order)]
        )
        self._heights = np.tile(rng.normal(size=4) + 1j * rng.normal(size=4), rotation_order)
        self._heights /= np.abs(self._heights).sum()
        self.slope = 2 * np.pi * float((np.abs(self._heights) * np.abs(self._waves)).sum())

    def __call__(self, uv: FloatArray) -> FloatArray:
        z = uv @ (1, 1j)
        phase = (self._waves.conj() * z[:, None]).real
        return (self._heights * np.exp(2j * np.pi * phase)).real.sum(axis=1, keepdims=True)


def lattice_mesh(lattice: str) -> Mesh:
    return meshes.torus(24, 14) if lattice == "translation" else meshes.bumpy_sphere(3)


@pytest.mark.parametrize("lattice", ROTATION_ORDER)
def test_textures_of_a_lattice_and_of_those_it_is_part_of_show_no_seam(lattice: str) -> None:
    mesh = lattice_mesh(lattice)
    result = layout(mesh, 24, lattice=lattice)
    sides = Sides(mesh, result.corner_uv)
    assert sides.edges > 0
    rotation_order, triangular = ROTATION_ORDER[lattice], lattice in ("triangle", "hexagon")
    # Textures of more turns are textures of fewer.
    for more in (1, 2, 3, 4, 6):
        if more % rotation_order or triangular != (more in (3, 6)):
            continue
        texture = Waves(more, triangular)
        off = differences(texture, sides.on).max()
        assert off <= texture.slope * result.seamless.error * result.seamless.cell + ROUNDING
        near = differences(texture, sides.beside(1e-4)).max()
        assert near <= texture.slope * (2e-4 + result.seamless.error * result.seamless.cell) + ROUNDING


@pytest.mark.parametrize(
    ("lattice", "rotation_order"), [("stripe", 1), ("square", 1), ("square", 2), ("hexagon", 3), ("hexagon", 2)]
)
def test_textures_of_too_few_turns_show_seams(lattice: str, rotation_order: int) -> None:
    mesh = lattice_mesh(lattice)
    texture = Waves(rotation_order, lattice == "hexagon")
    assert differences(texture, Sides(mesh, layout(mesh, 24, lattice=lattice).corner_uv).beside(1e-4)).mean() > SEEN
