# SPDX-License-Identifier: GPL-3.0-or-later
"""Any bytes as a mesh file through the readers, and as arrays through the Python API, led by coverage (Atheris).

Every input must end with a mesh or a map that passes its own check, or with an LsgpError; anything else is a finding.

    pip install atheris numpy scipy
    mkdir -p build/corpus && python tests/fuzz/fuzz_python.py -max_len=400 -timeout=10 build/corpus
    python tests/fuzz/fuzz_python.py crash-...      replays a finding
"""

from __future__ import annotations

import sys
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

with atheris.instrument_imports(include=["lsgp"]):
    import lsgp
    from lsgp import polygons
    from lsgp.mesh_obj import format_obj, read_obj
    from lsgp.mesh_off import read_off
    from lsgp.mesh_ply import read_ply

import numpy as np
from result_check import undeclared_faults

# What a file of each kind begins with, so that not every input has to find it again.
STARTS = [
    (lambda data: read_obj(data, True), b""),
    (lambda data: read_obj(data, False), b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"),
    (read_off, b"OFF\n4 2 0\n"),
    (read_off, b""),
    (read_ply, b"ply\nformat ascii 1.0\n"),
    (
        read_ply,
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        b"property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n",
    ),
    (read_ply, b""),
]
TYPES = ["f8", "f4", "i4", "i8", "u8", "u1", "?", "c16", "O", "S4"]


def pick(data: atheris.FuzzedDataProvider, choices: list) -> object:
    return choices[data.ConsumeIntInRange(0, len(choices) - 1)]


def read_a_file(data: atheris.FuzzedDataProvider) -> None:
    read, start = pick(data, STARTS)
    mesh = read(start + data.ConsumeBytes(1 << 20))
    cut = polygons.triangulate(mesh)
    assert int((mesh.sizes - 2).sum()) == len(cut.triangles)
    again = read_obj(format_obj(mesh, np.zeros((len(mesh.corners), 2))), True)
    assert np.array_equal(again.corners, mesh.corners) and np.array_equal(again.sizes, mesh.sizes)
    assert np.array_equal(again.positions, mesh.positions, equal_nan=True)
    if len(cut.triangles) <= 64:
        unwrap(data, lsgp.Surface(mesh.positions, cut.triangles, cut.edges), None, lsgp.Options())


def an_array(data: atheris.FuzzedDataProvider, width: int, regular: object) -> object:
    """Mostly what belongs there, changed in places; at times an array of any type and shape, or no array."""
    kind = data.ConsumeIntInRange(0, 9)
    if kind < 7:
        out = np.array(regular)
        for _ in range(data.ConsumeIntInRange(0, 6)):
            if out.size:
                at = data.ConsumeIntInRange(0, out.size - 1)
                if out.dtype.kind == "f":
                    out.flat[at] = data.ConsumeFloat()
                else:
                    out.flat[at] = data.ConsumeIntInRange(-1, max(int(out.max()) + 1, 0))
        return out
    if kind == 7:
        return data.ConsumeIntListInRange(width * data.ConsumeIntInRange(0, 8), -2, 9)
    shape = [data.ConsumeIntInRange(0, 5) for _ in range(data.ConsumeIntInRange(0, 3))]
    return np.zeros(shape, str(pick(data, TYPES)))


def call_the_api(data: atheris.FuzzedDataProvider) -> None:
    columns, rows = data.ConsumeIntInRange(1, 4), data.ConsumeIntInRange(1, 4)
    x, y = (a.ravel().astype(float) for a in np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)))
    grid = np.arange(len(x)).reshape(rows + 1, columns + 1)
    a, b, c, d = grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, 1:].ravel(), grid[1:, :-1].ravel()
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    seams = triangles[: data.ConsumeIntInRange(0, 3), :2]
    surface = lsgp.Surface(
        an_array(data, 3, np.stack([x, y, np.sin(x + y)], 1)),
        an_array(data, 3, triangles),
        None if data.ConsumeBool() else an_array(data, 2, triangles[:, :2]),
        an_array(data, 2, seams),
    )
    cones = an_array(data, 1, grid.ravel()[: data.ConsumeIntInRange(0, 5)].astype(np.int32))
    options = lsgp.Options(
        pick(data, [None, "least-distortion", "harmonic", "straightness", "manual"]),
        pick(data, ["poisson", "spectral"]),
        pick(data, ["lsgp", "lsgp", "lsgp", "lscm"]),
        pick(data, ["follow", "boundary", "ignore"]),
        pick(data, ["free", "straight"]),
        mode=pick(data, ["conformal", "low-stretch"]),
        stretch=pick(data, [0, 0.5, 1, data.ConsumeFloat()]),
        repair=data.ConsumeBool(),
        overlaps=pick(data, ["keep", "split"]),
    )
    pins = None
    if data.ConsumeBool():
        pins = lsgp.Pins(an_array(data, 1, np.array([0, 5], np.int32)), an_array(data, 2, np.eye(2)))
    unwrap(data, surface, cones, options, pins)


def unwrap(
    data: atheris.FuzzedDataProvider,
    surface: lsgp.Surface,
    cones: object,
    options: lsgp.Options,
    pins: lsgp.Pins | None = None,
) -> None:
    if cones is None:
        cones = lsgp.place_cones(surface, count=data.ConsumeIntInRange(0, 8), seams=options.seams).cones
    angles = [pick(data, [None, data.ConsumeFloat(), 1.5 * np.pi, 3.0]) for _ in range(data.ConsumeIntInRange(0, 5))]
    result = lsgp.parameterize(surface, cones, angles or None, options, pins=pins)
    faults = undeclared_faults(surface, result, options)
    assert not faults, f"{faults} of {surface}, cones {cones}, angles {angles}, {options}, pins {pins}"
    lsgp.measure_distortion(surface, result.corner_uv, cones)


def one_input(raw: bytes) -> None:
    data = atheris.FuzzedDataProvider(raw)
    try:
        if data.ConsumeBool():
            read_a_file(data)
        else:
            call_the_api(data)
    except lsgp.LsgpError:
        pass


if __name__ == "__main__":
    np.seterr(all="ignore")
    atheris.Setup(sys.argv, one_input)
    atheris.Fuzz()
