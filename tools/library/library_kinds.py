# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of meshes of a generated library: each a function of random numbers and the number of triangles wanted."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from library_shapes import (
    TAU,
    FloatArray,
    Polygons,
    Random,
    extruded,
    filled,
    joined,
    lathe,
    moved,
    net,
    pierced,
    polygons,
    random_turn,
    round_cube,
    shared_out,
    triangles_of,
    tube,
    waves,
    zero_set,
)
from numpy.typing import NDArray


def body(random: Random, count: int) -> Polygons:
    """A ball with waves or a body with limbs."""
    if count < 200 or random.randint(2):
        ball = round_cube(max(1, round(math.sqrt(count / 12))))
        radius = 1 + random.uniform(0.1, 0.5) * waves(ball.positions, random, 5, random.uniform(1, 3))
        return moved(ball._replace(positions=ball.positions * radius[:, None]), random.uniform(0.4, 1.5, 3))
    return zero_set(limbs(random, random.randint(3, 12)), count)


def limbs(random: Random, number: int) -> Callable[[FloatArray], FloatArray]:
    """A field around a trunk and tapering limbs."""
    ends = [(np.array([0, 0, -0.6]), np.array([0, 0, 0.5]), random.uniform(0.15, 0.35), random.uniform(0.15, 0.35))]
    for _ in range(number):
        start = ends[random.randint(len(ends))][1] * random.uniform(0.2, 1)
        reach = random.normal(size=3)
        ends.append(
            (start, np.clip(start + 0.5 * reach, -1.1, 1.1), random.uniform(0.06, 0.15), random.uniform(0.02, 0.1))
        )

    def field(points: FloatArray) -> FloatArray:
        least = np.full(len(points), np.inf)
        for a, b, first, last in ends:
            along = b - a
            t = np.clip((points - a) @ along / (along @ along), 0, 1)
            away = np.linalg.norm(points - a - t[:, None] * along, axis=1)
            least = np.minimum(least, away - first - t * (last - first))
        return least

    return field


def part(random: Random, count: int) -> Polygons:
    """A turned part, an extruded one, a pipe or a plate with holes."""
    return (turned_part, extruded_part, pipe, perforated_plate)[random.randint(4)](random, count)


def turned_part(random: Random, count: int) -> Polygons:
    steps = random.randint(2, 9)
    sides = max(3, round(math.sqrt(count / 2)))
    rows = max(steps, round(count / (2 * sides)))
    radius = np.repeat(random.uniform(0.2, 1, steps), 2)
    height = np.repeat(np.linspace(0, random.uniform(0.5, 4), steps + 1), 2)[1:-1]
    extra = max(0, rows - len(radius) + 1)
    at = np.concatenate([np.arange(len(radius)), random.uniform(0, len(radius) - 1, extra)])
    at.sort()
    return lathe(np.interp(at, range(len(radius)), radius), np.interp(at, range(len(radius)), height), sides)


def extruded_part(random: Random, count: int) -> Polygons:
    teeth = max(3, min(count // 16, random.randint(3, 200)))
    layers = max(1, round(count / (8 * teeth)) - 1)
    angle = TAU * np.arange(4 * teeth) / (4 * teeth)
    radius = np.where(np.arange(4 * teeth) % 4 < 2, 1.0, random.uniform(0.3, 1.0))
    outline = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return extruded(outline, random.uniform(0.1, 2), layers)


def pipe(random: Random, count: int) -> Polygons:
    sides = max(3, min(48, random.randint(5, 25), round(math.sqrt(count))))
    rings = max(3, round(count / (2 * sides)))
    t = np.linspace(0, 1, rings)
    bend, turns = random.uniform(0.2, 3), random.uniform(0, 4)
    path = np.stack([bend * np.cos(TAU * turns * t), bend * np.sin(TAU * turns * t), 4 * t], axis=1)
    radius = random.uniform(0.05, 0.15) * (1 + random.uniform(0, 0.5) * t)
    return tube(path, radius, sides, caps=bool(random.randint(2)))


def perforated_plate(random: Random, count: int) -> Polygons:
    """A solid plate of cells of which some are missing, bent or flat."""
    across = max(2, round(math.sqrt(count / 5)))
    cells = random.uniform(size=(across, max(2, across // 2), 1)) > random.uniform(0, 0.3)
    if not cells.any():
        cells[0, 0] = True
    plate = filled(cells)
    if random.randint(2):
        turn = plate.positions[:, 0] * (random.uniform(0.5, 5) / across)
        radius = across / 3 + plate.positions[:, 2]
        bent = np.stack([radius * np.cos(turn), plate.positions[:, 1], radius * np.sin(turn)], axis=1)
        return plate._replace(positions=bent)
    return plate


def scan(random: Random, count: int) -> Polygons:
    """Terrain, or a body, with noise at the scale of triangles, ragged borders, holes and pieces that float."""
    if random.randint(2):
        cells = max(2, round(math.sqrt(count / 2)))
        u, v = np.divmod(np.arange((cells + 1) ** 2), cells + 1)
        flat = np.stack([u / cells, v / cells, 0 * u], axis=1) * 4 - 2
        flat[:, 2] = random.uniform(0.1, 1) * waves(flat, random, 6, 1.5)
        mesh = polygons(flat, triangles_of(polygons(flat, net(cells + 1, cells + 1))))
    else:
        mesh = zero_set(limbs(random, random.randint(2, 6)), count)
        mesh = polygons(mesh.positions, triangles_of(mesh))
    edge = np.ptp(mesh.positions, axis=0).max() / math.sqrt(max(mesh.triangle_count(), 1))
    noise = random.uniform(0.02, 0.4) * edge * random.normal(size=mesh.positions.shape)
    mesh = mesh._replace(positions=mesh.positions + noise)
    (faces,) = mesh.faces
    at = mesh.positions[faces].mean(axis=1)
    missing = waves(at, random, 4, random.uniform(2, 8)) > random.uniform(0.3, 1.2)
    missing |= random.uniform(size=len(faces)) < random.uniform(0, 0.02)
    kept = faces[~missing] if not missing.all() else faces
    floating = [
        moved(round_cube(1), edge, random.permutation(mesh.positions)[0] + 3 * edge * random.normal(size=3))
        for _ in range(random.randint(0, 1 + min(20, count // 200)))
    ]
    return joined([polygons(mesh.positions, kept), *floating])


def foliage(random: Random, count: int) -> Polygons:
    """Branches with leaves: bent cards, or crossed ones, four faces to an edge."""
    per_leaf = random.choice([2, 4, 8, 16])
    leaves = max(1, round(0.8 * count / per_leaf))
    stems = max(1, leaves // random.randint(10, 80))
    made = []
    for of_stem, share in zip(shared_out(leaves, stems), shared_out(max(count // 5, 8), stems), strict=True):
        sides = 3 + random.randint(4)
        rings = max(2, share // (2 * sides))
        t = np.linspace(0, 1, rings)[:, None]
        reach = random.normal(size=3) + np.array([0, 0, 2])
        path = t * reach + 0.3 * np.sin(3 * t) * random.normal(size=3)
        if rings > 1:
            made.append(tube(path, np.linspace(0.05, 0.01, rings), sides, caps=bool(random.randint(2))))
        leaf = card(random, per_leaf // 2, 0.1) if per_leaf < 8 or random.randint(2) else crossed(random, per_leaf // 4)
        for at in random.uniform(0.2, 1, of_stem):
            made.append(moved(leaf, random.uniform(0.5, 1.2), path[int(at * (rings - 1))], random_turn(random)))
    return joined(made)


def card(random: Random, length: int, width: float) -> Polygons:
    """A bent strip of quads, pointed or not."""
    length = max(1, int(length))
    t = np.linspace(0, 1, length + 1)
    bend = random.uniform(-1, 1)
    half = width * (1 - random.uniform(0, 0.9) * t)
    middle = np.stack([np.zeros_like(t), t * np.cos(bend * t), t * np.sin(bend * t)], axis=1)
    positions = np.stack([middle - half[:, None] * [1, 0, 0], middle + half[:, None] * [1, 0, 0]], axis=1)
    return polygons(positions.reshape(-1, 3), net(length + 1, 2))


def crossed(random: Random, length: int) -> Polygons:
    """Two strips through each other, which share their middle line."""
    length = max(1, int(length))
    t = np.linspace(0, 1, length + 1)
    middle = np.stack([np.zeros_like(t), np.zeros_like(t), t], axis=1)
    arms = [middle + 0.2 * np.array([math.cos(a), math.sin(a), 0]) for a in TAU * np.arange(4) / 4]
    rows = np.arange(length + 1)
    quads = []
    for number in range(4):
        arm = (length + 1) * (number + 1) + rows
        quads.append(np.stack([rows[:-1], arm[:-1], arm[1:], rows[1:]], axis=1))
    return polygons(np.concatenate([middle, *arms]), *quads)


def hair(random: Random, count: int) -> Polygons:
    """Cards that hang from a ball."""
    length = random.randint(2, 20)
    cards = max(1, count // (2 * length))
    made = []
    for _ in range(cards):
        root = random.normal(size=3)
        root[2] = abs(root[2])
        root /= np.linalg.norm(root)
        strip = card(random, length, random.uniform(0.02, 0.08))
        made.append(moved(strip, random.uniform(0.5, 1.5), root, random_turn(random)))
    return joined(made)


def text(random: Random, count: int) -> Polygons:
    """Extruded letters: of strokes on a raster, and round ones with holes."""
    letters = max(1, min(count // 40, random.randint(1, 400)))
    each = max(12, count // letters)
    made = []
    for number in range(letters):
        place = [1.3 * (number % 40), -1.6 * (number // 40), 0]
        if number % 3 == 0:
            sides = max(4, each // 8)
            angle = TAU * np.arange(sides) / sides
            round_one = np.stack([0.5 * np.cos(angle), 0.7 * np.sin(angle)], axis=1)
            made.append(moved(pierced(round_one, random.uniform(0.4, 0.8) * round_one, 0.2), by=place))
        elif number % 3 == 1:
            sides = max(3, each // 8)
            angle = np.linspace(0.6, TAU - 0.6, sides)
            arc = np.stack([np.cos(angle), np.sin(angle)], axis=1) * [0.5, 0.7]
            made.append(moved(extruded(np.concatenate([arc, 0.7 * arc[::-1]]), 0.2), by=place))
        else:
            raster = np.zeros((3, 5, 1), bool)
            raster[random.randint(3)] = raster[:, random.randint(5)] = raster[:, random.randint(5)] = True
            fine = max(1, round(math.sqrt(each / 60)))
            raster = raster.repeat(fine, axis=0).repeat(fine, axis=1)
            made.append(moved(filled(raster, 0.3 / fine), by=place))
    return joined(made)


def cad(random: Random, count: int) -> Polygons:
    """Plates with bosses and round holes as tessellators leave them: needles, fans and slivers."""
    pieces = max(1, min(random.randint(1, 30), count // 100))
    made = []
    for number, triangles in enumerate(shared_out(count, pieces)):
        sides = max(3, triangles // 8)
        angle = TAU * (np.arange(sides) + random.uniform(0, 1e-3, sides)) / sides
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        wide, long = random.uniform(1, 3, 2)
        box = np.array([[-wide, -long], [wide, -long], [wide, long], [-wide, long]])
        place = 7.0 * np.array([number % 6, number // 6, 0])
        shape = random.randint(4)
        if shape == 0:
            made.append(moved(pierced(box, random.uniform(0.2, 0.9) * circle, random.uniform(0.05, 1)), by=place))
        elif shape == 1:
            made.append(moved(extruded(random.uniform(0.2, 1) * circle, random.uniform(1, 20)), by=place))
        elif shape == 2:
            made.append(moved(pierced(circle, random.uniform(0.9, 0.999) * circle, random.uniform(0.1, 3)), by=place))
        else:
            made.append(moved(slivers(random, max(2, triangles // 4)), by=place))
    return joined(made)


def slivers(random: Random, cells: int) -> Polygons:
    """A cylinder of rows of uneven heights, down to a millionth of their width."""
    sides = max(3, round(math.sqrt(cells)))
    rows = max(2, cells // sides)
    steps = 10.0 ** random.uniform(-6, 0, rows - 1)
    height = np.concatenate([[0], np.cumsum(steps)])
    return lathe(np.full(rows, 0.5), 2 * height / height[-1], sides)


def voxels(random: Random, count: int) -> Polygons:
    """Cells where noisy balls are: surfaces that touch in edges and corners."""
    balls = [(at, random.uniform(0.2, 0.5)) for at in random.uniform(-0.6, 0.6, (random.randint(1, 9), 3))]
    noise, seed = random.choice([0, 0.02, 0.1]), random.randint(2**31)
    side = max(3, round(math.sqrt(count / 6)))
    for _ in range(3):  # the share of cells at the surface depends on the noise
        mesh = filled(_near(balls, side, noise * Random(seed).normal(size=(side,) * 3)), 2 / side)
        side = max(3, round(side * math.sqrt(count / mesh.triangle_count())))
    return mesh


def _near(balls: list[tuple[FloatArray, float]], side: int, noise: FloatArray) -> NDArray[np.bool_]:
    line = np.linspace(-1, 1, side)
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1)
    solid = np.max([radius - np.linalg.norm(grid - at, axis=-1) for at, radius in balls], axis=0) + noise > 0
    if not solid.any():
        solid[side // 2, side // 2, side // 2] = True
    return solid


def soup(random: Random, count: int) -> Polygons:
    """Triangles without neighbors, random ones over few vertices, or a body taken apart."""
    kind = random.randint(3)
    if kind == 0:
        middle = random.normal(size=(count, 1, 3)) * random.uniform(1, 10)
        corners = middle + random.normal(size=(count, 3, 3)) * random.uniform(0.1, 2)
        return polygons(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    if kind == 1:
        vertices = max(4, int(count * random.uniform(0.4, 3)))
        corners = random.randint(vertices, size=(count, 3))
        corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
        if len(corners) == 0:
            corners = np.array([[0, 1, 2]])
        return polygons(random.normal(size=(vertices, 3)), corners)
    whole = body(random, count)
    corners = triangles_of(whole)
    return polygons(whole.positions[corners].reshape(-1, 3), np.arange(corners.size).reshape(-1, 3))


def kit(random: Random, count: int) -> Polygons:
    """Many parts beside each other, few large and most small, some of them copies."""
    number = max(1, min(count // 24, int(10 ** random.uniform(0.5, 3.3))))
    makers = (part, body, cad, foliage, voxels)
    made: list[Polygons] = []
    for place, triangles in enumerate(shared_out(count, number)):
        if made and random.uniform() < 0.4:
            one = made[random.randint(len(made))]
        else:
            one = makers[random.randint(len(makers))](random, max(12, triangles))
        one = one._replace(positions=one.positions - one.positions.mean(axis=0))
        size = min(1 / random.uniform(0.03, 1), 20) / max(np.ptp(one.positions, axis=0).max(), 1e-9)
        made.append(moved(one, size, 8.0 * np.array([place % 40, place // 40, 0])))
    return joined(made)


KINDS: dict[str, Callable[[Random, int], Polygons]] = {
    "bodies": body,
    "parts": part,
    "scans": scan,
    "foliage": foliage,
    "hair": hair,
    "text": text,
    "cad": cad,
    "voxels": voxels,
    "soups": soup,
    "kits": kit,
}
