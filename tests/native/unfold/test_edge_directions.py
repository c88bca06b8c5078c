# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions of the texture along edges, measured at the coordinates of their ends."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from numpy.typing import NDArray

MET = np.radians(0.01)
UP = (0.0, 0.0, 1.0)


def surface_of(mesh: meshes.Mesh) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles)


def edge_images(triangles: NDArray, corner_uv: NDArray, edges: NDArray) -> list[NDArray[np.complex128]]:
    """Of each edge, from its first vertex to its second, the images in the triangles beside it."""
    z = oracle.as_complex(corner_uv)
    out = []
    for a, b in edges:
        beside = np.flatnonzero((triangles == a).any(axis=1) & (triangles == b).any(axis=1))
        out.append(np.array([z[f, triangles[f] == b][0] - z[f, triangles[f] == a][0] for f in beside]))
    return out


def off_v(image: NDArray[np.complex128], rotation_order: int = 1) -> NDArray[np.float64]:
    period = 2 * np.pi / rotation_order
    angle = np.angle(image / 1j)
    return np.abs(angle - period * np.round(angle / period))


@pytest.mark.parametrize("name", ["hill", "saddle", "bumpy_sphere"])
@pytest.mark.parametrize("reverse", [False, True])
def test_v_runs_along_an_edge_from_its_first_vertex_to_its_second(name: str, reverse: bool) -> None:
    mesh = {"hill": meshes.hill, "saddle": meshes.saddle, "bumpy_sphere": lambda: meshes.bumpy_sphere(2)}[name]()
    cones = lsgp.place_cones(surface_of(mesh)).cones if name == "bumpy_sphere" else []
    cut = {tuple(sorted(e)) for e in lsgp.find_cuts(surface_of(mesh), cones).edges.tolist()} if len(cones) else set()
    inside = [e for e in meshes.edges_of(mesh.triangles).tolist() if tuple(sorted(e)) not in cut]
    for edge in (inside[3], inside[len(inside) // 2]):
        marked = np.array([edge[::-1] if reverse else edge])
        surface = replace(surface_of(mesh), directions=lsgp.edge_directions(surface_of(mesh), marked))
        result = lsgp.parameterize(surface, cones)
        (image,) = edge_images(mesh.triangles, result.corner_uv, marked)
        assert len(image) in (1, 2) and off_v(image).max() <= MET
        assert np.isfinite(result.direction_errors).sum() == len(image)
        assert np.nanmax(result.direction_errors) <= MET


def test_v_runs_up_whatever_the_order_of_vertices() -> None:
    mesh = meshes.hill(6)
    marked = meshes.edges_of(mesh.triangles)[::5]
    turned = marked.copy()
    turned[::2] = turned[::2, ::-1]
    for up in (UP, (0.3, -1.0, 0.2)):
        found = lsgp.edge_directions(surface_of(mesh), marked, up=up)
        np.testing.assert_allclose(lsgp.edge_directions(surface_of(mesh), turned, up=up), found, atol=1e-12)
        along = mesh.positions[marked[:, 1]] - mesh.positions[marked[:, 0]]
        for edge, vector in zip(marked, along, strict=True):
            single = lsgp.edge_directions(surface_of(mesh), [edge], up=up)
            assert np.allclose(single[single.any(axis=1)] @ np.array(up) >= 0, True)
            assert np.allclose(np.cross(single[single.any(axis=1)], vector), 0, atol=1e-9)


@pytest.mark.parametrize(("edge", "way"), [((0, 1), (1, 0, 0)), ((0, 3), (0, 1, 0)), ((0, 2), (0, 1, 0))])
def test_edges_across_up_run_along_y_or_else_x(edge: tuple[int, int], way: tuple[int, int, int]) -> None:
    square = lsgp.Surface([(0, 0, 0), (1, 0, 1e-9), (-1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    for marked in (edge, edge[::-1]):
        found = lsgp.edge_directions(square, [marked], up=UP)
        assert (found[found.any(axis=1)] @ np.array(way) > 0).all()


def test_edges_have_the_weight_of_their_length_whatever_the_size_of_triangles() -> None:
    # Two edges of length 1 and 2 in one plane, beside a large and a small triangle, at an angle of 90 degrees.
    positions = np.array([(0, 0, 0), (0, 1, 0), (30, 0.5, 0), (5, 5, 0), (7, 5, 0), (6, 5.1, 0)], float)
    triangles = np.array([(0, 2, 1), (3, 4, 5)])
    surface = lsgp.Surface(positions, triangles)
    found = lsgp.edge_directions(surface, [(0, 1), (3, 4)])
    area = oracle.triangle_areas(positions, triangles)
    weight = area * np.linalg.norm(found, axis=1)
    assert weight[1] == pytest.approx(2 * weight[0]) and weight.sum() == pytest.approx(area.sum())
    np.testing.assert_allclose(found / np.linalg.norm(found, axis=1)[:, None], [(0, 1, 0), (1, 0, 0)], atol=1e-12)
    # Neither the unit of lengths nor the place matters.
    moved = lsgp.edge_directions(lsgp.Surface(2.0**40 * positions, triangles), [(0, 1), (3, 4)])
    np.testing.assert_allclose(moved, found, rtol=1e-12)


def test_a_line_of_edges_is_met_on_the_average_by_length() -> None:
    mesh = meshes.hill(8)
    edges = meshes.edges_of(mesh.triangles)
    marked = edges[np.abs(np.diff(mesh.positions[edges, 0], axis=1)[:, 0]) < 1e-9]
    assert len(marked) > 10
    surface = surface_of(mesh)
    surface = replace(surface, directions=lsgp.edge_directions(surface, marked, up=(0, 1, 0)))
    result = lsgp.parameterize(surface, [])
    forward = np.where((mesh.positions[marked[:, 1]] - mesh.positions[marked[:, 0]])[:, 1] > 0, 1, -1)
    images = edge_images(mesh.triangles, result.corner_uv, marked)
    # No triangle has two of these edges, which would be added up first; and as they are about parallel, the axes of one
    # frame are fitted to them.
    lengths = np.linalg.norm(np.diff(mesh.positions[marked], axis=1)[:, 0], axis=1)
    total = 0j
    for length, way, image in zip(lengths, forward, images, strict=True):
        total += length * ((way * image / np.abs(image) / 1j) ** 4).sum()
    assert abs(np.angle(total)) <= 1e-9
    assert max(off_v(way * image).max() for way, image in zip(forward, images, strict=True)) > 1e-3


@pytest.mark.parametrize("edge", [(0, 0), (0, 10**6), (-1, 0), (0, 40)])
def test_edges_that_are_none_are_refused(edge: tuple[int, int]) -> None:
    mesh = meshes.hill(6)
    assert set(edge) not in [set(e) for e in meshes.edges_of(mesh.triangles).tolist()]
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.edge_directions(surface_of(mesh), [meshes.edges_of(mesh.triangles)[0], edge])
    inside = min(edge) >= 0 and max(edge) < len(mesh.positions)
    assert refused.value.code == ("EDGE_NOT_IN_MESH" if inside else "INDEX_OUT_OF_RANGE")


@pytest.mark.parametrize("up", [(0, 0, 0), (0, np.nan, 1), (0, 1)])
def test_an_up_that_is_none_is_refused(up: tuple[float, ...]) -> None:
    mesh = meshes.hill(4)
    with pytest.raises(lsgp.InputError):
        lsgp.edge_directions(surface_of(mesh), meshes.edges_of(mesh.triangles)[:1], up=up)


def test_no_edges_are_no_directions() -> None:
    assert not lsgp.edge_directions(surface_of(meshes.hill(4)), []).any()
