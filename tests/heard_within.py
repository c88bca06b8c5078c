# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures for how long a call tells nothing, and how soon it ends after it was asked to, in a process of its own:

    python -m heard_within FAMILY TRIANGLES JOB SEED

prints a line of JSON. Times are processor seconds of the process, or those of the clock if they are fewer, as where
several threads work: what else a machine does must not count.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import lsgp
import numpy as np
from large_meshes import FAMILIES
from meshes import edges_of

Progress = Callable[[float], bool | None]
Call = Callable[[Progress | None], object]

# Requests to stop by each way in a cell.
_MOMENTS = 2


@dataclass
class Measured:
    """silence: the longest time between two calls of progress, begin and end of the call included, and between which
    fractions that was. stopped, interrupted: the longest time from a request to the end. faults: what must not be.
    ended: "", or the code of the refusal."""

    seconds: float = 0.0
    calls: int = 0
    silence: float = 0.0
    silent: tuple[float, float] = (0.0, 0.0)
    stopped: float = 0.0
    interrupted: float = 0.0
    ended: str = ""
    faults: list[str] = field(default_factory=list)


class Watch:
    def __init__(self) -> None:
        self._begin = self._now()

    @staticmethod
    def _now() -> tuple[float, float]:
        return time.process_time(), time.monotonic()

    def seconds(self) -> float:
        return min(now - begin for now, begin in zip(self._now(), self._begin, strict=True))


def _map_of(surface: lsgp.Surface) -> lsgp.Result:
    return lsgp.auto_unwrap(surface, pack="shelves")


def _placed(surface: lsgp.Surface, **how: Any) -> tuple[Any, Any]:
    placed = lsgp.place_cones(surface, **how)
    return placed.cones, placed.cone_angles


def _scattered(surface: lsgp.Surface) -> np.ndarray:
    vertices = np.unique(surface.triangles)
    return vertices[:: max(1, len(vertices) // 60)].astype(np.int32)


def _parameterize(options: lsgp.Options, **how: Any) -> Callable[[lsgp.Surface], Call]:
    def job(surface: lsgp.Surface) -> Call:
        cones = _placed(surface, **how)
        return lambda tell: lsgp.parameterize(surface, *cones, options, progress=tell)

    return job


def _auto(**how: Any) -> Callable[[lsgp.Surface], Call]:
    return lambda surface: lambda tell: lsgp.auto_unwrap(surface, **how, progress=tell)


def _split(surface: lsgp.Surface) -> Call:
    cones, options = _scattered(surface), lsgp.Options(overlaps="split")
    return lambda tell: lsgp.parameterize(surface, cones, None, options, progress=tell)


def _pack(**how: Any) -> Callable[[lsgp.Surface], Call]:
    def job(surface: lsgp.Surface) -> Call:
        of = _map_of(surface)
        return lambda tell: lsgp.pack_islands(of.corner_uv, of.island, **how, progress=tell)

    return job


def _gutters(surface: lsgp.Surface) -> Call:
    image = np.random.RandomState(0).randint(0, 255, (2048, 2048, 3)).astype(np.uint8)
    uv = _map_of(surface).corner_uv
    return lambda tell: lsgp.pad_mip_levels(image, surface, uv, [16, 8], progress=tell)


def _measure(surface: lsgp.Surface) -> Call:
    uv = _map_of(surface).corner_uv
    return lambda tell: lsgp.measure_distortion(surface, uv, progress=tell)


def _stacks(surface: lsgp.Surface) -> Call:
    of = _map_of(surface)
    return lambda tell: lsgp.find_stacks(of.corner_uv, of.island, mirrored=True, progress=tell)


def _shape(shape: Any, share: float = 1.0) -> Callable[[lsgp.Surface], Call]:
    """Of the first triangles of the largest island."""

    def job(surface: lsgp.Surface) -> Call:
        of = _map_of(surface)
        largest = np.flatnonzero(of.island == np.bincount(of.island[of.solved]).argmax())
        some = largest[: math.ceil(share * len(largest))]
        return lambda tell: lsgp.shape_patches(surface, of.corner_uv, some, shape, progress=tell)

    return job


def _costs(surface: lsgp.Surface) -> Call:
    with_edges = dataclasses.replace(surface, edges=edges_of(surface.triangles))
    return lambda tell: lsgp.cut_costs(with_edges, [0.0, -1.0, 0.2], progress=tell)


JOBS: dict[str, Callable[[lsgp.Surface], Call]] = {
    "paint": _auto(),
    "bake": _auto(preset="bake"),
    "tile": _auto(preset="tile"),
    "stack": _auto(stack="mirrored"),
    "udim": _auto(udim=10),
    "low stretch": _auto(options=lsgp.Options(mode="low-stretch", overlaps="split")),
    "quads": lambda surface: lambda tell: lsgp.remesh_to_quads(surface, target=1000, progress=tell),
    "place": lambda surface: lambda tell: lsgp.place_cones(surface, progress=tell),
    "many cones": lambda surface: lambda tell: lsgp.place_cones(surface, count=100, progress=tell),
    "cones": _parameterize(lsgp.Options(), count=40),
    "seamless": _parameterize(lsgp.Options(seamless=lsgp.Seamless()), lattice="square"),
    "spectral": _parameterize(lsgp.Options(unfold="spectral"), count=12),
    "split": _split,
    "pack": _pack(),
    "tiles": _pack(udim=10),
    "find stacks": _stacks,
    "gutters": _gutters,
    "measure": _measure,
    "gains": lambda surface: lambda tell: lsgp.cone_gains(surface, progress=tell),
    "costs": _costs,
    "borders": lambda surface: lambda tell: lsgp.crease_borders(surface, progress=tell),
    "cuts": lambda surface: lambda tell: lsgp.find_cuts(surface, _scattered(surface), progress=tell),
    "angles": lambda surface: lambda tell: lsgp.prescribe_curvature(surface, _scattered(surface), progress=tell),
    "charts": lambda surface: lambda tell: lsgp.measure_charts(surface, lsgp.Options(), progress=tell),
    "tubes": lambda surface: lambda tell: lsgp.find_tubes(surface, progress=tell),
    "rectangle": _shape("rectangle"),
    "part of rectangle": _shape("rectangle", 0.3),
    "grid": _shape("grid"),
    "strips": _auto(options=lsgp.Options(border="strips", overlaps="split")),
    "upright": _auto(up=[0.0, 1.0, 0.0]),
    "limited": _auto(seconds=1e9),
    "preview": lambda surface: lambda tell: lsgp.Preview(surface, progress=tell) and None,
}


def digest(value: object) -> str:
    """Of all that a value holds but the time it took."""
    found = hashlib.sha256()

    def add(of: object) -> None:
        if isinstance(of, np.ndarray):
            found.update(repr((of.shape, of.dtype)).encode())
            found.update(np.ascontiguousarray(of).tobytes())
        elif dataclasses.is_dataclass(of):
            for one in dataclasses.fields(of):
                if one.name != "stage_seconds":
                    add(getattr(of, one.name))
        elif isinstance(of, list | tuple):
            for one in of:
                add(one)
        else:
            found.update(repr(of).encode())

    add(value)
    return found.hexdigest()


def _outcome(call: Call, tell: Progress | None) -> tuple[str, str]:
    """The digest of the result and "", or of the refusal and its code."""
    try:
        return digest(call(tell)), ""
    except lsgp.Cancelled:
        raise
    except lsgp.LsgpError as error:
        return digest([error.code, error.message, error.elements.indices]), error.code


def measure(family: str, count: int, job: str, seed: int) -> Measured:
    surface = FAMILIES[family](count)
    found = Measured()
    try:
        call = JOBS[job](surface)
    except lsgp.LsgpError as error:  # there is nothing to begin with
        found.ended = error.code
        return found
    given = digest(surface)
    random = np.random.RandomState(seed)

    watch, last = Watch(), 0.0
    whole = Watch()

    def tell(done: float) -> None:
        nonlocal watch, last
        silence = watch.seconds()
        if silence > found.silence:
            found.silence, found.silent = silence, (last, done)
        found.calls += 1
        watch, last = Watch(), done

    first, found.ended = _outcome(call, tell)
    found.seconds = whole.seconds()
    tell(1.0)
    calls = found.calls - 1

    for _ in range(_MOMENTS if calls else 0):
        _stop(found, call, random.randint(calls))
    for _ in range(_MOMENTS):
        _interrupt(found, call, found.seconds * random.random_sample())
    if digest(surface) != given:
        found.faults.append("the surface has changed")
    if _outcome(call, None)[0] != first:
        found.faults.append("another result after it was stopped")
    return found


def _stop(found: Measured, call: Call, at: int) -> None:
    """Answer False when progress is told for that time."""
    heard = 0
    watch = Watch()

    def tell(_done: float) -> bool:
        nonlocal heard, watch
        heard += 1
        watch = Watch()
        return heard <= at

    try:
        call(tell)
    except lsgp.Cancelled:
        found.stopped = max(found.stopped, watch.seconds())
        if heard != at + 1:
            found.faults.append(f"told {heard - at - 1} times after it was stopped")
    except lsgp.LsgpError as error:
        found.faults.append(f"{error.code} when it was stopped")
    else:
        found.faults.append(f"not stopped the time {at} of {found.calls}")


def _interrupt(found: Measured, call: Call, after: float) -> None:
    """Have the system send a signal after so many processor seconds, which Python handles as it does Ctrl-C: no thread
    that sends it need be awake then."""
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    begin = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, max(after, 1e-3))
    try:
        try:
            _outcome(call, None)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
    except KeyboardInterrupt:
        found.interrupted = max(found.interrupted, time.process_time() - begin - after)
    finally:
        signal.signal(signal.SIGPROF, before)


if __name__ == "__main__":
    print(json.dumps(dataclasses.asdict(measure(sys.argv[1], int(sys.argv[2]), sys.argv[3], int(sys.argv[4])))))
