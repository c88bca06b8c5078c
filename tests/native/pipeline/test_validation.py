# SPDX-License-Identifier: GPL-3.0-or-later
"""Each error code with the smallest input that raises it, its class, its elements, and a message with a remedy."""

from __future__ import annotations

import re

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface, unwrap

NAN = float("nan")
TRIANGLE = meshes.make([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
TETRAHEDRON = meshes.tetrahedron()


def with_triangles(triangles: object) -> lsgp.Surface:
    return lsgp.Surface(TRIANGLE.positions, np.array(triangles, np.int32).reshape(-1, 3))


def moved(scale: float) -> lsgp.Surface:
    return lsgp.Surface(TRIANGLE.positions * scale, TRIANGLE.triangles)


def with_y(value: float) -> lsgp.Surface:
    return surface(meshes.with_coordinate(TRIANGLE, 2, value))


def with_far_tip(x: float) -> lsgp.Surface:
    return surface(meshes.with_coordinate(TETRAHEDRON, 3, x))


def tetrahedron(**fields: object) -> lsgp.Surface:
    return lsgp.Surface(TETRAHEDRON.positions, TETRAHEDRON.triangles, **fields)


INPUT, TOPOLOGY, CURVATURE = lsgp.InputError, lsgp.TopologyError, lsgp.CurvatureError

# code, class, surface, cones, angles, kind of the elements, elements
REFUSALS = {
    "no triangles": ("EMPTY_MESH", INPUT, with_triangles([]), [], None, None, None),
    "no vertices": (
        "EMPTY_MESH",
        INPUT,
        lsgp.Surface(np.empty((0, 3)), np.empty((0, 3), np.int32)),
        [],
        None,
        None,
        None,
    ),
    "index too large": ("INDEX_OUT_OF_RANGE", INPUT, with_triangles([[0, 1, 3]]), [], None, "triangles", [0]),
    "index negative": (
        "INDEX_OUT_OF_RANGE",
        INPUT,
        with_triangles([[0, 1, 2], [0, -1, 2]]),
        [],
        None,
        "triangles",
        [1],
    ),
    "cuttable index": ("INDEX_OUT_OF_RANGE", INPUT, tetrahedron(edges=[[0, 4]]), range(4), None, None, None),
    "seam index": ("INDEX_OUT_OF_RANGE", INPUT, tetrahedron(seams=[[-1, 0]]), range(4), None, None, None),
    "repeated vertex": ("BAD_FACE", INPUT, with_triangles([[0, 1, 2], [0, 1, 1]]), [], None, "triangles", [1]),
    "nan": ("NON_FINITE_POSITION", INPUT, with_y(NAN), [], None, "vertices", [2]),
    "infinity": ("NON_FINITE_POSITION", INPUT, with_y(-np.inf), [], None, "vertices", [2]),
    "too large": ("SCALE_RANGE", INPUT, moved(1e100), [], None, None, None),
    "too small": ("SCALE_RANGE", INPUT, moved(1e-100), [], None, None, None),
    "too far": ("SCALE_RANGE", INPUT, with_far_tip(3.4e38), range(4), None, "vertices", [3]),
    "one point": ("DEGENERATE_MESH", INPUT, moved(0), [], None, None, None),
    "one line": ("DEGENERATE_MESH", INPUT, with_y(0), [], None, None, None),
    "cuttable no edge": (
        "EDGE_NOT_IN_MESH",
        INPUT,
        surface(meshes.grid(2, 1), edges=[[0, 2]]),
        [],
        None,
        "edges",
        [[0, 2]],
    ),
    "seam no edge": (
        "SEAM_NOT_AN_EDGE",
        INPUT,
        surface(meshes.grid(2, 1), seams=[[0, 1], [0, 2]]),
        [],
        None,
        "edges",
        [[0, 2]],
    ),
    "seam to itself": ("SEAM_NOT_AN_EDGE", INPUT, tetrahedron(seams=[[1, 1]]), range(4), None, "edges", [[1, 1]]),
    "cone too large": ("CONE_INDEX", INPUT, tetrahedron(), [0, 1, 2, 4], None, None, None),
    "cone negative": ("CONE_INDEX", INPUT, tetrahedron(), [0, 1, 2, -1], None, None, None),
    "cone twice": ("CONE_DUPLICATE", INPUT, tetrahedron(), [0, 1, 2, 3, 1], None, "vertices", [1]),
    "cone off the surface": (
        "CONE_NOT_ON_SURFACE",
        INPUT,
        surface(meshes.with_isolated_vertices(TETRAHEDRON, 2)),
        [1, 2, 3, 4, 5],
        None,
        "vertices",
        [1],
    ),
    "an angle too few": ("ANGLE_COUNT", INPUT, tetrahedron(), range(4), [np.pi] * 3, None, None),
    "angle nan": ("CONE_ANGLE_NON_FINITE", INPUT, tetrahedron(), range(4), [None, NAN, None, None], "vertices", [1]),
    "angle infinite": (
        "CONE_ANGLE_NON_FINITE",
        INPUT,
        tetrahedron(),
        range(4),
        [None, None, np.inf, None],
        "vertices",
        [2],
    ),
    "angle zero": ("CONE_ANGLE_RANGE", CURVATURE, tetrahedron(), range(4), [None, 0.0, None, None], "vertices", [1]),
    "angle negative": (
        "CONE_ANGLE_RANGE",
        CURVATURE,
        tetrahedron(),
        range(4),
        [-1.0, None, None, None],
        "vertices",
        [0],
    ),
    "moebius": ("NOT_ORIENTABLE", TOPOLOGY, surface(meshes.moebius_strip(5, 1)), [], None, None, None),
    "klein": ("NOT_ORIENTABLE", TOPOLOGY, surface(meshes.klein_bottle(4, 4)), [], None, None, None),
    "no cones": ("TOO_FEW_CONES", TOPOLOGY, tetrahedron(), [], None, None, None),
    "one cone": ("TOO_FEW_CONES", TOPOLOGY, tetrahedron(), [0], None, None, None),
    "two cones": ("TOO_FEW_CONES", TOPOLOGY, tetrahedron(), [0, 1], None, None, None),
    "no way between cones": ("CUTS_BLOCKED", TOPOLOGY, tetrahedron(edges=[[0, 1], [1, 2]]), range(4), None, None, None),
    "angles do not add up": ("GAUSS_BONNET", CURVATURE, tetrahedron(), range(4), [1.0] * 4, None, None),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_refusal_has_its_code_class_elements_and_remedy(case: str) -> None:
    code, kind_of_error, given, cones, angles, kind, elements = REFUSALS[case]
    with pytest.raises(lsgp.LsgpError) as caught:
        lsgp.parameterize(given, np.array(list(cones), np.int32), angles)
    error = caught.value
    assert error.code == code
    assert type(error) is kind_of_error
    assert isinstance(error, ValueError) == (kind_of_error is INPUT)
    if kind is not None:
        assert error.elements.kind == kind
        assert error.elements.indices.dtype == np.int32
        assert error.elements.indices.tolist() == elements
    where = str(error.elements)
    assert str(error) == (f"{error.message} ({where})" if where else error.message)
    assert re.search(r"\. [A-Z][^.]*\.$", error.message) or error.message.count(".") >= 2, (
        "the last sentence is the remedy"
    )


@pytest.mark.parametrize(
    "case", [c for c, r in REFUSALS.items() if r[0] not in ("GAUSS_BONNET", "EMPTY_MESH") and r[4] is None]
)
def test_every_verb_refuses_alike(case: str) -> None:
    code, _, given, cones, _, _, _ = REFUSALS[case]
    cones = np.array(list(cones), np.int32)
    if code != "CUTS_BLOCKED":  # angles need no cuts
        with pytest.raises(lsgp.LsgpError) as caught:
            lsgp.prescribe_curvature(given, cones)
        assert caught.value.code == code
    if code not in ("TOO_FEW_CONES",):
        with pytest.raises(lsgp.LsgpError) as caught:
            lsgp.find_cuts(given, cones)
        assert caught.value.code == code


def test_gauss_bonnet_message_states_the_sum_and_the_sum_required() -> None:
    with pytest.raises(lsgp.CurvatureError) as caught:
        unwrap(TETRAHEDRON, [1.0, 1.25, 1.5, 1.75])
    numbers = [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", caught.value.message)]
    total, need = 5.5, 4 * np.pi
    # As total angles or as curvatures (angle defects), in radians or degrees.
    readings = [(total, need), (8 * np.pi - total, 4 * np.pi)]
    readings += [(np.degrees(a), np.degrees(b)) for a, b in readings]

    def stated(value: float) -> bool:
        return any(abs(x - value) <= 1e-3 * abs(value) for x in numbers)

    assert any(stated(a) and stated(b) for a, b in readings), caught.value.message


def test_a_vertex_of_no_triangle_may_hold_anything() -> None:
    mesh = meshes.with_coordinate(meshes.with_isolated_vertices(TETRAHEDRON, 1), 0, NAN)
    assert unwrap(mesh).solved.all()


@pytest.mark.parametrize(
    "positions, triangles",
    [
        (np.zeros((4, 2)), TETRAHEDRON.triangles),
        (np.zeros(12), TETRAHEDRON.triangles),
        (TETRAHEDRON.positions, np.zeros((4, 4), np.int32)),
        (TETRAHEDRON.positions, TETRAHEDRON.triangles.ravel()),
    ],
)
def test_wrong_shapes_are_refused(positions: object, triangles: object) -> None:
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.Surface(positions, triangles)
    assert caught.value.code == "WRONG_SHAPE"


def test_fractional_indices_are_refused_not_rounded() -> None:
    with pytest.raises(lsgp.InputError):
        lsgp.Surface(TETRAHEDRON.positions, TETRAHEDRON.triangles + 0.5)
    with pytest.raises(lsgp.InputError):
        lsgp.parameterize(tetrahedron(), [0.5, 1, 2, 3])
    with pytest.raises(lsgp.InputError):
        lsgp.Surface(TETRAHEDRON.positions, TETRAHEDRON.triangles.astype(np.int64) + 2**32)


@pytest.mark.parametrize("field", ["prescription", "unfold", "method"])
def test_unknown_options_are_refused(field: str) -> None:
    with pytest.raises(lsgp.InputError, match="magic"):
        unwrap(TETRAHEDRON, **{field: "magic"})


def test_arguments_stay_untouched() -> None:
    mesh = meshes.bumpy_sphere(1)
    copies = [a.copy() for a in mesh]
    unwrap(mesh)
    assert all(np.array_equal(a, b) for a, b in zip(mesh, copies, strict=True))


@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1e9, 1e30])
def test_unit_of_length_does_not_matter(scale: float) -> None:
    mesh = meshes.flower(2)
    small = unwrap(mesh._replace(positions=mesh.positions * scale))
    assert np.abs(small.corner_uv - unwrap(mesh).corner_uv).max() <= 1e-9
