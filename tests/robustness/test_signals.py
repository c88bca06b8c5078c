# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C ends every verb soon, with and without a progress callback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from nightly import nightly

TESTS = Path(__file__).parents[1]

ANSWER_SECONDS = 0.5

pytestmark = pytest.mark.skipif(os.name != "posix", reason="SIGINT is sent as on POSIX")

# Calls the verb until it is interrupted, and tells how much processor time that took from the signal on.
PROGRAM = """
import os, signal, sys, threading, time
import lsgp, meshes
from map_checks import surface

signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in what a script started in the background
ball = meshes.bumpy_sphere(5)
whole = surface(ball)
solver = lsgp.Solver(whole)
seamless, split = lsgp.Options(seamless=lsgp.Seamless()), lsgp.Options(overlaps="split")
low_stretch, spectral = lsgp.Options(mode="low-stretch"), lsgp.Options(unfold="spectral")
uv = lsgp.parameterize(whole, ball.cones).corner_uv if sys.argv[1] == "measure" else None
verbs = {
    "parameterize": lambda tell: lsgp.parameterize(whole, ball.cones, progress=tell),
    "seamless": lambda tell: lsgp.parameterize(whole, ball.cones, None, seamless, progress=tell),
    "split": lambda tell: lsgp.parameterize(whole, ball.cones, None, split, progress=tell),
    "low stretch": lambda tell: lsgp.parameterize(whole, ball.cones, None, low_stretch, progress=tell),
    "spectral": lambda tell: lsgp.parameterize(whole, ball.cones, None, spectral, progress=tell),
    "solver": lambda tell: solver.parameterize(ball.cones, None, low_stretch, progress=tell),
    "place": lambda tell: lsgp.place_cones(whole, count=40, progress=tell),
    "gains": lambda tell: lsgp.cone_gains(whole, progress=tell),
    "cuts": lambda tell: lsgp.find_cuts(whole, ball.cones, progress=tell),
    "angles": lambda tell: lsgp.prescribe_curvature(whole, ball.cones, progress=tell),
    "measure": lambda tell: lsgp.measure_distortion(whole, uv, progress=tell),
    "quads": lambda tell: lsgp.remesh_to_quads(whole, progress=tell),
}
verb = verbs[sys.argv[1]]
told = [] if sys.argv[2] == "told" else None
tell = None if told is None else told.append  # a builtin, in which Python looks for no signals
sent = []

def send():
    sent.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)

threading.Timer(0.3, send).start()
try:
    while True:
        verb(tell)
except KeyboardInterrupt:
    print(time.process_time() - sent[0])
"""
VERBS = ["parameterize", "seamless", "split", "low stretch", "spectral", "solver", "place", "gains", "cuts", "angles"]
HOW = ("alone", "told")
# Every other one is each verb once.
CASES = [(verb, HOW[(i + j) % 2]) for i, verb in enumerate([*VERBS, "measure"]) for j in range(2)]


@pytest.mark.slow
@pytest.mark.parametrize(("verb", "callback"), [*CASES[::2], *nightly(*CASES[1::2])])
def test_ctrl_c_is_answered(verb: str, callback: str) -> None:
    command = [sys.executable, "-c", PROGRAM, verb, callback]
    paths = os.pathsep.join([str(TESTS), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": paths}
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < ANSWER_SECONDS
