# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress rises from 0 to 1, and a run can be stopped at each time it is told, with no trace left behind."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import digest, surface
from meshes import Mesh
from nightly import some_nightly
from zoo import closed

PI = np.pi


@dataclass(frozen=True)
class Run:
    mesh: Mesh
    angles: list[float] | None = None
    options: lsgp.Options = field(default_factory=lsgp.Options)

    def __call__(self, progress: Callable[[float], object] | None = None) -> lsgp.Result:
        return lsgp.parameterize(surface(self.mesh), self.mesh.cones, self.angles, self.options, progress=progress)


TORUS = meshes.torus(10, 6)
CUBE = meshes.cube(4)
BALL = meshes.bumpy_sphere(1)
# Quarter turns at the cube's corners: maps with flips that Newton's method turns over, at once or on the way from
# easier angles.
HARD, HARDER = [2, 1, 5, 6, 1, 5, 1, 3], [3, 6, 2, 2, 7, 2, 1, 1]
RUNS = {
    "repair": Run(CUBE, [n * PI / 2 for n in HARD]),
    "angles followed": Run(CUBE, [n * PI / 2 for n in HARDER]),
    "torus": Run(TORUS),
    "spectral": Run(BALL, None, lsgp.Options(unfold="spectral")),
    "seamless ball": Run(BALL, None, lsgp.Options(seamless=lsgp.Seamless())),
    "seamless torus": Run(TORUS, None, lsgp.Options(seamless=lsgp.Seamless(tiles=10))),
    "coarse": Run(BALL, None, lsgp.Options(seamless=lsgp.Seamless(tiles=2, coarse_grid="merge"))),
    "left off": Run(BALL, None, lsgp.Options(seamless=lsgp.Seamless(tiles=2, coarse_grid="relax"))),
    "two parts": Run(meshes.merge([BALL, CUBE])),
    "low stretch": Run(BALL, None, lsgp.Options(mode="low-stretch")),
    "seamless low stretch": Run(BALL, None, lsgp.Options(seamless=lsgp.Seamless(tiles=12), mode="low-stretch")),
    "seamless split": Run(CUBE, None, lsgp.Options(seamless=lsgp.Seamless(tiles=12), overlaps="split")),
    "split": Run(CUBE, [n * PI / 2 for n in HARD], lsgp.Options(overlaps="split")),
}


@pytest.fixture(params=RUNS)
def run(request: pytest.FixtureRequest) -> Run:
    return RUNS[request.param]


def told_by(run: Run) -> list[float]:
    told: list[float] = []
    run(told.append)
    return told


def test_newtons_method_is_among_them() -> None:
    for name in ("repair", "angles followed", "low stretch", "seamless low stretch"):
        result = RUNS[name]()
        assert 0 < result.repair.iterations <= len(told_by(RUNS[name])) - 2
        assert not len(result.flipped)
    assert all(RUNS[name]().repair.flipped_before > 0 for name in ("repair", "angles followed"))


def test_progress_rises_to_1(run: Run) -> None:
    told = told_by(run)
    assert len(told) >= 2
    assert all(type(done) is float for done in told)
    assert told[0] >= 0 and told[-1] == 1
    assert (np.diff(told) >= 0).all()


def test_the_same_is_told_every_time(run: Run) -> None:
    assert told_by(run) == told_by(run)


def test_a_run_that_is_watched_gives_the_same_bytes(run: Run) -> None:
    assert digest(run(lambda done: None)) == digest(run())


@pytest.mark.slow
def test_a_run_stopped_at_any_time_leaves_no_trace(run: Run) -> None:
    plain, told = digest(run()), told_by(run)
    for call in range(len(told)):
        heard: list[float] = []
        with pytest.raises(lsgp.Cancelled) as caught:
            run(lambda done, heard=heard, call=call: heard.append(done) or len(heard) <= call)
        assert heard == told[: call + 1], "told again after it was stopped"
        assert caught.value.code == "CANCELLED"
        assert not len(caught.value.elements.indices)
    assert digest(run()) == plain


class Pressed(BaseException):
    """Not an Exception, as KeyboardInterrupt is none."""


@pytest.mark.slow
def test_what_progress_raises_comes_through_as_it_is(run: Run) -> None:
    require_passed_through(run, ValueError)


@pytest.mark.parametrize("kind", [Pressed, KeyboardInterrupt, lsgp.Cancelled, lsgp.SolverError, MemoryError])
def test_whatever_it_is(kind: type[BaseException]) -> None:
    for name in ("repair", "two parts", "coarse"):
        require_passed_through(RUNS[name], kind)


def require_passed_through(run: Run, kind: type[BaseException]) -> None:
    plain, told = digest(run()), told_by(run)
    for call in range(len(told)):
        raised = kind("code", "message")
        heard: list[float] = []

        def tell(done: float, raised: BaseException = raised, heard: list[float] = heard, call: int = call) -> None:
            heard.append(done)
            if len(heard) > call:
                raise raised

        with pytest.raises(kind) as caught:
            run(tell)
        assert caught.value is raised
        assert len(heard) == call + 1
    assert digest(run()) == plain


@pytest.mark.parametrize("answer", [None, True, 1, 0, "", []])
def test_only_false_stops(answer: object) -> None:
    assert digest(RUNS["torus"](lambda done: answer)) == digest(RUNS["torus"]())


def test_a_false_of_numpy_stops_as_well() -> None:
    """Callers compare: `done < limit` is one of its bools where either is a number of numpy."""
    result = RUNS["torus"]()
    calls: dict[str, Callable[..., object]] = {
        "native": RUNS["torus"],
        "polish": lambda progress: lsgp.remesh_to_quads(surface(CUBE), target=50, polish=True, progress=progress),
    }
    calls["pack"] = lambda progress: lsgp.pack_islands(result.corner_uv, result.island, progress=progress)
    for call in calls.values():
        heard: list[float] = []
        call(heard.append)
        for limit in np.array([heard[0], heard[-2]]):
            with pytest.raises(lsgp.Cancelled):
                call(lambda done, limit=limit: done < limit)


def test_progress_is_told_on_the_thread_that_called() -> None:
    heard: dict[str, set[int]] = {}

    def work(name: str) -> None:
        heard[name] = set()
        RUNS[name](lambda done: heard[name].add(threading.get_ident()))
        assert heard[name] == {threading.get_ident()}

    threads = [threading.Thread(target=work, args=(name,)) for name in ("repair", "torus", "seamless ball")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(map(len, heard.values())) == [1, 1, 1]


def test_a_run_may_be_started_from_progress() -> None:
    outer, inner = RUNS["torus"], RUNS["two parts"]
    found: list[str] = []
    watched = outer(lambda done: found.append(digest(inner())))
    assert set(found) == {digest(inner())} and digest(watched) == digest(outer())


@pytest.mark.parametrize("progress", [1, "done", [], np.zeros(2)])
def test_progress_that_cannot_be_called_is_a_type_error(progress: object) -> None:
    with pytest.raises(TypeError):
        RUNS["torus"](progress)


# Work of about a second each, and how often its caller is to be let in at least.
FINE = meshes.bumpy_sphere(5)
CUBE_OF_MANY = meshes.subdivide(meshes.subdivide(CUBE))
GEAR = closed.gear(5, 0.3, 2)
OVERLAPPING = [n * PI / 2 for n in HARD]
LONG = {
    "place": (10, lambda told: lsgp.place_cones(surface(FINE), count=30, progress=told)),
    "place many": (20, lambda told: lsgp.place_cones(surface(FINE), count=800, progress=told)),
    "gains": (3, lambda told: lsgp.cone_gains(surface(FINE), np.arange(0, 10000, 25), progress=told)),
    "many cones": (20, lambda told: Run(FINE._replace(cones=np.arange(0, 10000, 12)))(told)),
    "many seamless cones": (
        40,
        lambda told: Run(FINE._replace(cones=np.arange(0, 10000, 30)), None, lsgp.Options(seamless=lsgp.Seamless()))(
            told
        ),
    ),
    "many holes": (8, lambda told: Run(meshes.plate(40)._replace(cones=[]))(told)),
    "low stretch": (20, lambda told: Run(FINE, None, lsgp.Options(mode="low-stretch"))(told)),
    "spectral": (5, lambda told: Run(FINE, None, lsgp.Options(unfold="spectral"))(told)),
    "split": (10, lambda told: Run(CUBE_OF_MANY, OVERLAPPING, lsgp.Options(overlaps="split"))(told)),
    "quads along creases": (200, lambda told: lsgp.remesh_to_quads(surface(GEAR), target=500, progress=told)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", some_nightly(LONG, "place many"))
def test_long_work_is_told_of_often_and_stops_at_once(name: str) -> None:
    least, run = LONG[name]
    told: list[float] = []
    run(lambda done: told.append(done) or True)
    assert len(told) >= least
    for stop in (len(told) // 3, 2 * len(told) // 3):
        begin: list[float] = []

        def progress(_done: float, stop: int = stop, begin: list[float] = begin) -> bool:
            begin.append(time.monotonic())
            return len(begin) <= stop

        with pytest.raises(lsgp.Cancelled):
            run(progress)
        assert len(begin) == stop + 1, "asked again after the answer"
        assert time.monotonic() - begin[-1] < 2  # a watchdog: it is to be over at once
