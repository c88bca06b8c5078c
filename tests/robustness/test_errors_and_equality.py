# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors survive copies and other processes; inputs and results are equal where their content is."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, is_dataclass, replace
from multiprocessing import get_context

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.io.polygons import PolygonMesh
from map_checks import surface

ERRORS = [kind for kind in vars(lsgp).values() if isinstance(kind, type) and issubclass(kind, lsgp.LsgpError)]
COPIES = {
    "pickled": lambda value: pickle.loads(pickle.dumps(value)),
    "copied": copy.copy,
    "copied in depth": copy.deepcopy,
}
BALL = meshes.bumpy_sphere(1)


def require_same_error(found: lsgp.LsgpError, error: lsgp.LsgpError) -> None:
    assert type(found) is type(error)
    assert (found.code, found.message, str(found), found.args) == (error.code, error.message, str(error), error.args)
    assert found.elements == error.elements


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("kind", ERRORS)
def test_errors_can_be_copied(kind: type[lsgp.LsgpError], way: str) -> None:
    for elements in (None, lsgp.Elements("edges", np.array([[1, 2], [3, 4]], np.int32))):
        error = kind("SOME_CODE", "What is wrong. What to do.", elements)
        error.add_note("seen while testing")
        found = COPIES[way](error)
        require_same_error(found, error)
        assert found.__notes__ == ["seen while testing"]


def unwrap(mesh: meshes.Mesh) -> lsgp.Result:
    return lsgp.parameterize(surface(mesh), mesh.cones)


def test_a_refused_mesh_does_not_break_a_pool_of_processes() -> None:
    refused = meshes.moebius_strip()
    with pytest.raises(lsgp.LsgpError) as caught:
        unwrap(refused)
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        for _ in range(2):
            error = pool.submit(unwrap, refused).exception(timeout=60)
            assert isinstance(error, lsgp.LsgpError)
            require_same_error(error, caught.value)
        assert pool.submit(unwrap, BALL).result(timeout=60) == unwrap(BALL)


def examples() -> list[object]:
    """Of every dataclass that holds arrays, one that has some."""
    whole = surface(BALL, seams=BALL.triangles[:3, :2])
    result = lsgp.parameterize(whole, BALL.cones, None, lsgp.Options(seamless=lsgp.Seamless()))
    (part,) = lsgp.build_ledger(whole, BALL.cones)
    released = lsgp.ReleasedFeature(np.array([0, 1, 2], np.int32), "curved", 0.5)
    return [
        whole,
        lsgp.Pins([0, 4], [[0, 0], [1, np.nan]]),
        result,
        result.seamless,
        lsgp.find_cuts(whole, BALL.cones),
        lsgp.prescribe_curvature(whole, BALL.cones),
        lsgp.place_cones(whole),
        lsgp.cone_gains(whole),
        lsgp.measure_distortion(whole, result.corner_uv),
        lsgp.find_tubes(surface(meshes.cylinder())),
        lsgp.measure_charts(whole)[0],
        lsgp.remesh_to_quads(whole, BALL.cones, target=200).mesh,
        lsgp.triangle_distortion(whole, result.corner_uv),
        lsgp.find_stacks(result.corner_uv, result.island),
        lsgp.ShapedMap(np.zeros((2, 3, 2)), np.array([1], np.int32), 1, []),
        lsgp.StitchedMap(np.zeros((2, 3, 2)), np.ones(2, bool), 1, 0, np.zeros(3, bool), np.zeros(3, bool)),
        lsgp.MovedCut(np.array([0, 1], np.int32), np.array([2], np.int32), np.zeros((1, 3, 2))),
        part,
        released,
        lsgp.Elements("triangles", np.array([3, 4], np.int32)),
        lsgp.Finding("CODE", "message", lsgp.Elements("triangles", np.array([3, 4], np.int32))),
        PolygonMesh(whole.positions, whole.triangles.ravel(), np.full(len(whole.triangles), 3)),
    ]


EXAMPLES = examples()


def changed(value: object) -> object:
    """The same but for one number of its first array that has one."""
    arrays = {field.name: getattr(value, field.name) for field in fields(value)}
    name = next(name for name, array in arrays.items() if isinstance(array, np.ndarray) and array.size)
    array = arrays[name].copy()
    array.flat[-1] = 0 if np.isnan(array.flat[-1]) else array.flat[-1] + 1
    return replace(value, **{name: array})


@pytest.mark.parametrize("value", EXAMPLES, ids=lambda value: type(value).__name__)
def test_equal_where_the_content_is(value: object) -> None:
    for way in COPIES.values():
        assert way(value) == value
    assert value != "something else" and value is not None
    if isinstance(value, lsgp.Finding):
        assert value != replace(value, elements=changed(value.elements))
    else:
        assert changed(value) != value


@pytest.mark.parametrize("value", EXAMPLES, ids=lambda value: type(value).__name__)
def test_what_holds_arrays_has_no_hash(value: object) -> None:
    with pytest.raises(TypeError, match="unhashable"):
        hash(value)


def test_every_public_dataclass_is_among_them_or_holds_no_array() -> None:
    kinds = {kind for kind in vars(lsgp).values() if isinstance(kind, type) and is_dataclass(kind)}
    without = kinds - {type(value) for value in EXAMPLES}
    numbers = {lsgp.Options, lsgp.Seamless, lsgp.Distortion, lsgp.SeamQuality, lsgp.RepairReport, lsgp.Transition}
    features = {lsgp.FeatureReport}  # a list of features that are among them
    texels = {lsgp.TexelDensity, lsgp.TexelLayout}
    quads = {lsgp.QuadQuality, lsgp.QuadRemesh}  # the latter has a mesh and a layout, which are compared
    choices = {lsgp.Choice, lsgp.Weights}
    assert without == numbers | texels | quads | features | choices | {lsgp.MeshFile}
    assert lsgp.MeshFile.__eq__ is object.__eq__  # a file is itself alone


def test_the_same_call_gives_an_equal_result() -> None:
    first, second = unwrap(BALL), unwrap(BALL)
    assert first == second
    assert first != unwrap(meshes.bumpy_sphere(2))
