# SPDX-License-Identifier: GPL-3.0-or-later
"""Interactive use: the example of `help(lsgp)` runs, and no object shows its arrays."""

import dataclasses
import doctest
import math

import lsgp
import meshes
import numpy as np
from lsgp.base.equality import EqualByContent
from lsgp.base.short_repr import ShortRepr

LONGEST = 400  # characters, about three lines of a terminal


def test_the_example_of_the_package_runs():
    outcome = doctest.testmod(lsgp, verbose=False)
    assert outcome.attempted >= 6 and outcome.failed == 0


def test_examples_of_functions_run(tmp_path, monkeypatch):
    """Their surface is that of the package's example; what they write is written elsewhere."""
    monkeypatch.chdir(tmp_path)
    finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner(verbose=False)
    (package,) = finder.find(lsgp)
    runner.run(package, clear_globs=False)
    known = {**package.globs, "math": math, "np": np}
    of_functions = [test for name in lsgp.__all__ for test in finder.find(getattr(lsgp, name), name, globs=known)]
    assert sum(bool(test.examples) for test in of_functions) >= 6
    assert sum(runner.run(test).failed for test in of_functions) == 0


def test_results_are_shown_by_counts():
    ball = meshes.bumpy_sphere(2)
    surface = lsgp.Surface(ball.positions, ball.triangles)
    placed = lsgp.place_cones(surface, count=6)
    result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    shown = repr(result)
    assert shown.startswith("Result(triangles=320, solved=320, islands=1, cones=6, l2_stretch=1.0")
    assert "flipped=0, wrong_angle_sums=0" in shown and "warnings=[]" in shown
    assert repr(surface).startswith("Surface(positions=float64(162, 3), triangles=int32(320, 3)")
    assert "edges=" not in repr(surface)
    assert "cones=int32(6,)" in repr(placed) and f"predicted_l2={placed.predicted_l2:.6g}" in repr(placed)
    measured = lsgp.measure_distortion(surface, result.corner_uv)
    cuts = lsgp.find_cuts(surface, placed.cones)
    for value in (result, surface, placed, cuts, lsgp.cone_gains(surface, placed.cones), measured):
        assert len(repr(value)) < LONGEST


def test_findings_are_shown_with_their_sentence():
    finding = lsgp.Finding("CODE", "A sentence.", lsgp.Elements("vertices", np.arange(1000, dtype=np.int32)))
    assert repr(finding) == (
        "Finding(code='CODE', message='A sentence.', elements=Elements(kind='vertices', indices=int32(1000,)))"
    )


def test_every_class_with_arrays_is_shown_shortly():
    classes = [value for value in vars(lsgp).values() if dataclasses.is_dataclass(value)]
    compared = [each for each in classes if issubclass(each, EqualByContent)]
    assert len(compared) >= 12
    assert all(each.__repr__ in (ShortRepr.__repr__,) for each in compared)
