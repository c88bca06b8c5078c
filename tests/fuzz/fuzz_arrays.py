# SPDX-License-Identifier: GPL-3.0-or-later
"""Any bytes as arrays and options through every verb of the Python package, led by coverage (Atheris).

Every input must end with an answer that passes its own check, or with an LsgpError; anything else is a finding.
tools/fuzz runs this, and replays what it found.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import atheris

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

with atheris.instrument_imports(include=["lsgp"]):
    import lsgp

import numpy as np
from public_calls import FUNCTIONS
from random_islands import layout, layout_faults
from result_check import undeclared_faults

TYPES = ["f8", "f4", "i4", "i8", "u8", "u1", "?", "c16", "O", "S4"]
LATTICES = ["square", "stripe", "translation", "triangle", "hexagon"]
SEAM_MODES = ["follow", "exact", "boundary", "ignore"]

Data = atheris.FuzzedDataProvider


def pick(data: Data, choices: list) -> Any:
    return choices[data.ConsumeIntInRange(0, len(choices) - 1)]


def number(data: Data, *usual: object) -> Any:
    """One of the usual values, any float, or no number at all."""
    return pick(data, [*usual, *usual, data.ConsumeFloat(), pick(data, [10**400, "1", True, np.float32(2), None])])


def array(data: Data, width: int, regular: object) -> object:
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


def surface(data: Data) -> lsgp.Surface:
    """A wavy sheet, as a whole or changed."""
    columns, rows = data.ConsumeIntInRange(1, 4), data.ConsumeIntInRange(1, 4)
    x, y = (a.ravel().astype(float) for a in np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)))
    grid = np.arange(len(x)).reshape(rows + 1, columns + 1)
    a, b, c, d = grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, 1:].ravel(), grid[1:, :-1].ravel()
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    seams = triangles[: data.ConsumeIntInRange(0, 3), :2]
    return lsgp.Surface(
        array(data, 3, np.stack([x, y, np.sin(x + y)], 1)),
        array(data, 3, triangles),
        array(data, 2, triangles[:, :2]) if data.ConsumeBool() else None,
        array(data, 2, seams),
        array(data, 1, np.ones(len(x))) if data.ConsumeBool() else None,
        borders=array(data, 2, triangles[:2, 1:]) if data.ConsumeBool() else None,
        features=array(data, 2, triangles[:2, :2]) if data.ConsumeBool() else None,
        directions=array(data, 3, np.ones(triangles.shape)) if data.ConsumeBool() else None,
    )


def cones(data: Data, on: lsgp.Surface) -> tuple[object, list[Any] | None]:
    """Vertices, and angles of theirs."""
    vertices = array(data, 1, np.arange(min(data.ConsumeIntInRange(0, 5), len(on.positions)), dtype=np.int32))
    angles = [number(data, None, 1.5 * np.pi, 3.0) for _ in range(data.ConsumeIntInRange(0, 5))]
    return vertices, angles or None


def seamless(data: Data) -> lsgp.Seamless:
    return lsgp.Seamless(
        pick(data, LATTICES),
        number(data, None, 8),
        number(data, None, None, 0.5),
        data.ConsumeBool(),
        pick(data, ["refine", "merge", "relax"]),
        number(data, 1, 0.5),
    )


def options(data: Data) -> lsgp.Options:
    return lsgp.Options(
        pick(data, [None, "least-distortion", "harmonic", "straightness", "manual"]),
        pick(data, ["poisson", "spectral"]),
        pick(data, ["lsgp", "lsgp", "lsgp", "lscm"]),
        pick(data, SEAM_MODES),
        pick(data, ["free", "straight"]),
        {data.ConsumeIntInRange(-1, 9): number(data, 0.0, np.pi)} if data.ConsumeBool() else {},
        seamless(data) if data.ConsumeBool() else None,
        pick(data, ["conformal", "low-stretch"]),
        number(data, 0, 0.5, 1),
        data.ConsumeBool(),
        pick(data, ["keep", "split"]),
        pick(data, ["automatic", "cut", "sparse"]),
    )


def pins(data: Data) -> lsgp.Pins | None:
    if data.ConsumeBool():
        return None
    return lsgp.Pins(array(data, 1, np.array([0, 5], np.int32)), array(data, 2, np.eye(2)))


def progress(data: Data) -> Callable[[float], object] | None:
    """None, or a callback that may stop the work."""
    if data.ConsumeBool():
        return None
    left = data.ConsumeIntInRange(1, 100)

    def report(done: float) -> bool:
        nonlocal left
        assert 0 <= done <= 1
        left -= 1
        return left > 0

    return report


def parameterize(data: Data, on: lsgp.Surface) -> None:
    (vertices, angles), how, pinned = cones(data, on), options(data), pins(data)
    result = lsgp.parameterize(on, vertices, angles, how, pins=pinned, progress=progress(data))
    faults = undeclared_faults(on, result, how)
    assert not faults, f"{faults} of {on}, cones {vertices}, angles {angles}, {how}, pins {pinned}"
    lsgp.measure_distortion(on, result.corner_uv, vertices)


def solve(data: Data, on: lsgp.Surface) -> None:
    solver = lsgp.Solver(on)
    for _ in range(3):
        try:
            (vertices, angles), how, pinned = cones(data, on), options(data), pins(data)
            kept = solver.parameterize(vertices, angles, how, pins=pinned, progress=progress(data))
        except lsgp.LsgpError:
            continue
        fresh = lsgp.parameterize(on, vertices, angles, how, pins=pinned)
        assert np.array_equal(kept.corner_uv, fresh.corner_uv, equal_nan=True), f"{on}, {vertices}, {angles}, {how}"


def find_cuts(data: Data, on: lsgp.Surface) -> None:
    lsgp.find_cuts(on, cones(data, on)[0], options(data))


def creases(data: Data, on: lsgp.Surface) -> None:
    how = {"angle": number(data, 0.2), "most_corners": number(data, 0), "least_share": number(data, 0.5)}
    found = lsgp.crease_borders(on, cones(data, on)[0], sharp=on.seams, **how)
    assert len(np.unique(np.sort(found, axis=1), axis=0)) == len(found)


def prescribe(data: Data, on: lsgp.Surface) -> None:
    chosen = lsgp.prescribe_curvature(on, *cones(data, on), options(data))
    assert len(chosen.cones) == len(chosen.cone_angles) and (chosen.cone_angles > 0).all()
    assert np.isfinite(chosen.log_scale).all()


def place(data: Data, on: lsgp.Surface) -> None:
    placed = lsgp.place_cones(
        on,
        *(cones(data, on) if data.ConsumeBool() else ()),
        count=number(data, None, 3),
        target=number(data, 1.05),
        lattice=pick(data, [None, *LATTICES]),
        prefer_sharp=data.ConsumeBool(),
        symmetric=data.ConsumeBool(),
        mirror=(array(data, 1, np.zeros(3)), array(data, 1, np.ones(3))) if data.ConsumeBool() else None,
        seams=pick(data, SEAM_MODES),
        progress=progress(data),
    )
    assert np.isin(placed.cones, np.arange(len(on.positions))).all() and (placed.cone_angles > 0).all()


def gains(data: Data, on: lsgp.Surface) -> None:
    told = lsgp.cone_gains(on, *cones(data, on), seams=pick(data, SEAM_MODES), progress=progress(data))
    assert not (told.predicted_l2 < 1 - 1e-9).any()


def measure(data: Data, on: lsgp.Surface) -> None:
    flattened = np.zeros((len(on.triangles), 3, 2))
    if np.isin(on.triangles, np.arange(len(on.positions))).all():
        flattened += on.positions[on.triangles, :2]
    uv = array(data, 6, flattened)
    lsgp.measure_distortion(on, uv, cones(data, on)[0] if data.ConsumeBool() else None)


def quads(data: Data, on: lsgp.Surface) -> None:
    target, size = number(data, 100), number(data, 0.2)
    if data.ConsumeBool():
        target = None
    else:
        size = None
    vertices, angles = cones(data, on)
    found = lsgp.remesh_to_quads(on, vertices, angles, target=target, size=size, progress=progress(data)).mesh
    assert (np.bincount(found.quads.ravel(), minlength=len(found.positions)) == found.valences).all()
    assert np.isfinite(found.positions).all()


def pack(data: Data, _: lsgp.Surface) -> None:
    """Islands that no mesh should have, some corners of which are changed."""
    given = layout(data.ConsumeIntInRange(0, 2**31 - 1), most=12)
    uv = array(data, 6, given.corner_uv) if data.ConsumeBool() else given.corner_uv
    margin, fill = number(data, 0.0, 0.01), data.ConsumeBool()
    how = {"turned": pick(data, [True, False, "quarters"]), "progress": progress(data)}
    packed = lsgp.pack_islands(uv, given.island, margin, fill=fill, effort="quick", **how)
    faults = layout_faults(given._replace(corner_uv=np.asarray(uv)), packed, float(margin), fill=fill)
    assert not faults, f"{faults} of {uv}, {given.island}, {margin}, {fill}, {how}"


def any_function(data: Data, on: lsgp.Surface) -> None:
    """Any public function, with some of the arguments that it accepts replaced."""
    function, accepted = FUNCTIONS[pick(data, sorted(FUNCTIONS))]
    given = dict(accepted)
    for name in accepted:
        if data.ConsumeIntInRange(0, 2):
            continue
        value = accepted[name]
        if isinstance(value, np.ndarray) and value.dtype.kind in "fi":
            given[name] = array(data, max(value.ndim, 1), value)
        elif name == "surface":
            given[name] = on
        elif name not in SLOW:
            given[name] = number(data, value, 0, -1, 2**31 - 1)
    with contextlib.suppress(TypeError) if "progress" in given else contextlib.nullcontext():
        function(**given)


# With these, what is asked for may take any time.
SLOW = {"target", "size", "triangles", "count", "margin", "margins", "options", "preset"}
VERBS = [
    parameterize,
    parameterize,
    solve,
    find_cuts,
    creases,
    prescribe,
    place,
    gains,
    measure,
    quads,
    pack,
    any_function,
]


def one_input(raw: bytes) -> None:
    data = Data(raw)
    verb = pick(data, VERBS)
    with contextlib.suppress(lsgp.LsgpError):
        verb(data, surface(data))


if __name__ == "__main__":
    np.seterr(all="ignore")
    atheris.Setup(sys.argv, one_input)
    atheris.Fuzz()
