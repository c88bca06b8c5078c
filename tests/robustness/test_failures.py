# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults injected: too little memory at any point, systems that cannot be solved.  Each ends in an error of its own."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import only, surface
from meshes import Mesh
from nightly import nightly
from result_check import undeclared_faults

if sys.platform != "linux":
    pytest.skip("the address space is limited and measured the way Linux does it", allow_module_level=True)

# A child process: the bytes of memory it had at its peak more than before the call, and how the call ended.
CHILD = """
import json, resource, sys, threading
import lsgp, meshes, numpy as np
from lsgp.cli import main

def size(key):
    return next(1024 * int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(key))

mesh = meshes.bumpy_sphere(7 if sys.argv[1] == "fine" else 5)
surface = lsgp.Surface(mesh.positions, mesh.triangles)
many = np.arange(0, len(mesh.positions), 20)
plate, box = meshes.plate(25), meshes.cube(2)
overlapping, flipped = np.array([[1, 1, 1, 5, 4, 4], [3, 4, 1, 2, 1, 5]]) * np.pi / 2
calls = {
    "poisson": lambda: lsgp.parameterize(surface, mesh.cones),
    "fine": lambda: lsgp.parameterize(surface, mesh.cones),
    "spectral": lambda: lsgp.parameterize(surface, mesh.cones, None, lsgp.Options(unfold="spectral")),
    "straightness": lambda: lsgp.parameterize(surface, mesh.cones, None, lsgp.Options("straightness")),
    "low stretch": lambda: lsgp.parameterize(surface, mesh.cones, None, lsgp.Options(mode="low-stretch")),
    "repair": lambda: lsgp.parameterize(surface, mesh.cones, flipped),
    "split": lambda: lsgp.parameterize(surface, mesh.cones, overlapping, lsgp.Options(overlaps="split")),
    "seamless": lambda: lsgp.parameterize(surface, mesh.cones, None, lsgp.Options(seamless=lsgp.Seamless())),
    "many cones": lambda: lsgp.parameterize(surface, many),
    "place": lambda: lsgp.place_cones(surface),
    "place many": lambda: lsgp.place_cones(surface, count=1500),
    "gains": lambda: lsgp.cone_gains(surface, many),
    "holes": lambda: lsgp.parameterize(lsgp.Surface(plate.positions, plate.triangles), []),
    "measure": lambda: lsgp.measure_distortion(surface, mesh.positions[mesh.triangles][..., :2]),
    "quads": lambda: lsgp.remesh_to_quads(lsgp.Surface(box.positions, box.triangles), target=10**6),
    "command": lambda: main(sys.argv[3:]),
    "again": lambda: [new_pages() for _ in range(5)],
}

def new_pages():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    lsgp.parameterize(surface, mesh.cones)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

def run():
    global ended, before
    before, space = size("VmRSS"), size("VmSize")
    if limit:
        resource.setrlimit(resource.RLIMIT_AS, (space + limit, space + limit))
    try:
        ended = calls[sys.argv[1]]()
        ended = ended if isinstance(ended, (int, list)) else "result"
    except MemoryError:
        ended = "MemoryError"
    except lsgp.SolverError as error:
        ended = [error.code, error.message]

limit = int(sys.argv[2])
# Linux ends a process whose stack cannot grow; that of a thread has its full size from the start.
threading.stack_size(8 << 20)
thread = threading.Thread(target=run)
thread.start()
thread.join()
print(json.dumps({"grown": size("VmHWM") - before, "ended": ended}))
"""


def run_child(call: str, limit: int, arguments: tuple[str, ...] = ()) -> dict:
    # One arena: another one would take its share of the address space unseen.
    threads = {"OPENBLAS_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "1"}
    environment = os.environ | threads | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    done = subprocess.run(
        [sys.executable, "-c", CHILD, call, str(limit), *arguments],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, f"ended with {done.returncode}: {done.stderr[-2000:]}"
    return json.loads(done.stdout.splitlines()[-1])


@cache
def peak(call: str) -> int:
    """Bytes by which a process grows when there is enough."""
    found = run_child(call, 0)
    assert found["ended"] == "result" and found["grown"] > 2**20
    return found["grown"]


def with_far_vertices(mesh: Mesh, seed: int, least: float, most: float) -> tuple[Mesh, np.ndarray]:
    """One to three vertices moved out by so many powers of ten, and which."""
    random = np.random.default_rng(seed)
    far = random.permutation(len(mesh.positions))[: 1 + seed % 3]
    positions = mesh.positions.copy()
    positions[far] *= 10.0 ** random.uniform(least, most, (len(far), 1))
    return mesh._replace(positions=positions), far


def test_a_surface_that_cannot_be_computed_with_is_named() -> None:
    """Vertices so far apart that linear systems lose all digits: an honest map or SOLVER_FAILED, never NaN."""
    failed = 0
    for seed in range(40):
        mesh, _ = with_far_vertices(meshes.torus(6, 4), seed, 3, 19)
        try:
            result = lsgp.parameterize(surface(mesh), mesh.cones)
        except lsgp.LsgpError as error:
            assert error.code == "SOLVER_FAILED" and isinstance(error, lsgp.SolverError)
            failed += 1
        else:
            assert undeclared_faults(surface(mesh), result) == []
    assert failed > 0


@pytest.mark.parametrize(("length", "fits"), [(18, True), (30, False)])
def test_lengths_that_differ_by_more_than_numbers_can_hold_are_refused(length: int, fits: bool) -> None:
    """A closed rod with cones at one end: the other shrinks by e to the power of 2 pi lengths over its girth."""
    mesh = meshes.subdivide(meshes.subdivide(meshes.voxels(np.ones((length, 1, 1), bool))))
    cones = np.arange(4)
    assert (mesh.positions[cones, 0] == mesh.positions[:, 0].min()).all()
    if fits:
        result = lsgp.parameterize(surface(mesh), cones)
        assert np.ptp(result.log_scale) > 2 * np.pi * (length - 2) / 4
        assert undeclared_faults(surface(mesh), result) == [] and len(result.flipped) == 0
        only(result.warnings, "HIGH_DISTORTION")
    else:
        with pytest.raises(lsgp.SolverError, match="Add cones") as caught:
            lsgp.parameterize(surface(mesh), cones)
        assert caught.value.code == "SOLVER_FAILED"


FINE = {
    "cube": meshes.cube(4),
    "sphere": meshes.bumpy_sphere(2),
    "torus": meshes.torus(6, 4),
    "grid": meshes.grid(8, 8, lambda x, y: np.sin(x + y)),
}


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", FINE)
def test_vertices_beyond_all_measure_are_named(name: str, seed: int) -> None:
    mesh, far = with_far_vertices(FINE[name], seed, 25, 55)
    for verb in (lsgp.parameterize, lsgp.prescribe_curvature, lsgp.find_cuts):
        with pytest.raises(lsgp.InputError) as caught:
            verb(surface(mesh), mesh.cones)
        assert caught.value.code == "SCALE_RANGE"
        assert caught.value.elements.kind == "vertices"
        assert np.array_equal(caught.value.elements.indices, np.sort(far))


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("name", FINE)
def test_infinite_coordinates_as_blender_keeps_them(name: str, count: int) -> None:
    """Some beside each other and some opposite; the other coordinates stay."""
    mesh = FINE[name]._replace(positions=FINE[name].positions.copy())
    random = np.random.default_rng(count)
    far = random.permutation(len(mesh.positions))[:count]
    mesh.positions[far, random.integers(0, 3, count)] = np.finfo(np.float32).max * random.choice([-1, 1], count)
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.parameterize(surface(mesh), mesh.cones)
    assert caught.value.code == "SCALE_RANGE"
    assert np.array_equal(caught.value.elements.indices, np.sort(far))


@pytest.mark.parametrize("neighbors", [False, True])
def test_far_vertices_of_one_triangle(neighbors: bool) -> None:
    mesh = FINE["sphere"]._replace(positions=FINE["sphere"].positions.copy())
    far = np.sort(mesh.triangles[7])
    mesh.positions[far, 0] = 3.4e38 * np.array([1, 1 if neighbors else -1, 1])
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.parameterize(surface(mesh), mesh.cones)
    assert caught.value.code == "SCALE_RANGE" and np.array_equal(caught.value.elements.indices, far)


def test_a_part_with_far_vertices_does_not_stop_the_rest() -> None:
    mesh = meshes.merge([FINE["sphere"], FINE["grid"]])
    count = len(FINE["sphere"].positions)
    mesh.positions[count + 5] = 3.4e38
    whole = lsgp.parameterize(surface(mesh), mesh.cones)
    skipped = only(whole.warnings, "COMPONENT_SKIPPED")
    assert "SCALE_RANGE" in skipped.message
    assert np.array_equal(skipped.elements.indices, np.arange(len(mesh.triangles))[len(FINE["sphere"].triangles) :])
    alone = mesh.triangles[whole.solved]
    assert np.array_equal(
        whole.corner_uv[whole.solved], lsgp.parameterize(lsgp.Surface(mesh.positions, alone), mesh.cones).corner_uv
    )


def test_sizes_that_change_gradually_are_no_far_vertices() -> None:
    """A flat ring of rings, each sqrt(10) times as large as the one inside: it is its own map."""
    rings = 20
    tube = meshes.cylinder(16, rings)
    level = np.rint(tube.positions[:, 2] / tube.positions[:, 2].max() * rings)
    direction = tube.positions[:, :2] / np.linalg.norm(tube.positions[:, :2], axis=1, keepdims=True)
    flat = np.concatenate([direction * 10.0 ** (level[:, None] / 2), np.zeros((len(level), 1))], axis=1)
    result = lsgp.parameterize(lsgp.Surface(flat, tube.triangles), [])
    assert result.flipped.size == 0 and abs(result.distortion.l2_stretch - 1) <= 1e-9


@pytest.mark.parametrize("distance", [1e9, 1e15, 1e25, 1e40])
def test_parts_far_from_each_other_are_no_far_vertices(distance: float) -> None:
    """Each has its own measure; what its digits do not hold at that distance is named."""
    near, away = FINE["sphere"], FINE["torus"]
    moved = away._replace(positions=away.positions * max(1.0, 1e-12 * distance) + distance)
    mesh = meshes.merge([near, moved])
    mesh = mesh._replace(positions=np.concatenate([near.positions, moved.positions]))
    result = lsgp.parameterize(surface(mesh), mesh.cones)
    assert result.solved.all() and undeclared_faults(surface(mesh), result) == []


@pytest.mark.skipif("libasan" in os.environ.get("LD_PRELOAD", ""), reason="AddressSanitizer reserves terabytes")
class TestMemory:
    @pytest.mark.slow
    @pytest.mark.parametrize("percent", [50, *nightly(10, 25, 40, 60, 75, 90)])
    @pytest.mark.parametrize(
        "call",
        [
            "poisson",
            "spectral",
            "straightness",
            "low stretch",
            "repair",
            "split",
            "seamless",
            "many cones",
            "place",
            "place many",
            "gains",
            "holes",
            "measure",
        ],
    )
    def test_too_little_of_it_is_an_error_and_no_crash(self, call: str, percent: int) -> None:
        found = run_child(call, peak(call) * percent // 100)
        told = found["ended"][0] == "OUT_OF_MEMORY"
        assert not told or re.search(r"memory.* (fewer faces at once|fewer elements)", found["ended"][1])
        refused = told or found["ended"] == "MemoryError"
        assert refused or found["ended"] == "result"
        if percent <= 50:
            assert refused

    def test_enough_of_it_is_a_result(self) -> None:
        assert run_child("poisson", 2 * peak("poisson"))["ended"] == "result"

    def test_what_is_freed_is_kept_for_the_next_map(self) -> None:
        first, *_, last = run_child("again", 0)["ended"]
        assert last < first / 10

    @pytest.mark.slow
    def test_it_is_estimated_before_it_is_taken(self) -> None:
        # The surface takes 0.4 of it, what is estimated 0.7, and the stack of each thread 9 MB of addresses.
        whole = peak("fine")
        assert run_child("fine", whole * 3 // 2)["ended"] == "result"
        found = run_child("fine", whole * 3 // 4)
        code, message = found["ended"]
        needed, left = (1e6 * int(number) for number in re.findall(r"(\d+) MB", message))
        assert code == "OUT_OF_MEMORY" and needed > left
        # The factor was asked for while the surface was all there was.
        assert found["grown"] <= 0.5 * whole and 0.4 * whole <= needed <= whole

    @pytest.mark.slow
    def test_quads_are_counted_before_they_are_made(self) -> None:
        whole = peak("quads")
        found = run_child("quads", whole // 2)
        code, message = found["ended"]
        needed, left = (1e6 * int(number) for number in re.findall(r"(\d+) MB", message))
        assert code == "OUT_OF_MEMORY" and needed > left and "larger quads" in message
        assert found["grown"] <= 0.1 * whole and 0.5 * whole <= needed <= 1.5 * whole

    @pytest.mark.slow
    @pytest.mark.parametrize("percent", [25, 50, 75])
    def test_the_command_line_refuses_and_writes_nothing(self, tmp_path: Path, percent: int) -> None:
        mesh = meshes.bumpy_sphere(5)
        lines = ["v {:.17g} {:.17g} {:.17g}".format(*p) for p in mesh.positions.tolist()]
        lines += ["f {} {} {}".format(*f) for f in (mesh.triangles + 1).tolist()]
        (tmp_path / "in.obj").write_text("\n".join(lines))
        names = {name: str(tmp_path / name) for name in ("in.obj", "out.obj", "report.json")}
        arguments = ("unwrap", names["in.obj"], "-o", names["out.obj"], "--report", names["report.json"])
        found = run_child("command", peak("poisson") * percent // 100, arguments)
        assert found["ended"] == 3
        assert not (tmp_path / "out.obj").exists()
        assert json.loads((tmp_path / "report.json").read_text())["code"] == "OUT_OF_MEMORY"
