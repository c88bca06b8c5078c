# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gauss-Bonnet ledger against the native core, which keeps it on its own, and against counting by hand."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import Options, Surface, build_ledger, hold_complete, part_surface

CLOSED = {
    "cube": meshes.cube(4),
    "icosphere": meshes.bumpy_sphere(2)._replace(cones=np.array([0, 3, 5, 9], np.int32)),
    "torus": meshes.torus()._replace(cones=np.array([0, 17, 95], np.int32)),
    "double torus": meshes.double_torus()._replace(cones=np.array([0, 9, 17, 30], np.int32)),
}
OPEN = {
    "hill": meshes.hill()._replace(cones=np.array([60, 71], np.int32)),
    "cylinder": meshes.cylinder()._replace(cones=np.array([40, 60], np.int32)),
    "holes": meshes.disk_with_holes()._replace(cones=np.array([75, 110], np.int32)),
}


def surface(mesh: meshes.Mesh, **more: object) -> Surface:
    return Surface(mesh.positions, mesh.triangles, **more)


@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_what_is_required_is_counted_from_vertices_edges_and_triangles(name: str) -> None:
    mesh = (CLOSED | OPEN)[name]
    (part,) = build_ledger(surface(mesh), mesh.cones)
    assert part.euler == meshes.euler_characteristic(mesh.triangles)
    assert part.required == pytest.approx(2 * np.pi * part.euler)
    assert (part.borders == 0) == (name in CLOSED) == (not part.border_takes_up)
    assert part.triangles.tolist() == list(range(len(mesh.triangles)))
    assert part.automatic.tolist() == list(range(len(mesh.cones)))
    assert part.missing == part.required and part.closes and not part.complete


def test_borders_are_counted() -> None:
    assert [build_ledger(surface(mesh), [])[0].borders for mesh in OPEN.values()] == [1, 2, 3]
    assert [part.borders for part in build_ledger(surface(meshes.triangle_soup(meshes.cube(2))), [])] == [1] * 48


@pytest.mark.parametrize("name", CLOSED)
def test_angles_that_the_core_finds_balance_the_ledger(name: str) -> None:
    mesh = CLOSED[name]
    found = lsgp.prescribe_curvature(surface(mesh), mesh.cones)
    (part,) = build_ledger(surface(mesh), found.cones, found.cone_angles)
    assert part.missing == pytest.approx(0, abs=1e-9)
    assert part.complete


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-4, -1.0])
def test_it_closes_exactly_where_the_core_agrees(name: str, off: float) -> None:
    mesh = CLOSED[name]
    angles = lsgp.prescribe_curvature(surface(mesh), mesh.cones).cone_angles.tolist()
    angles[0] += off
    (part,) = build_ledger(surface(mesh), mesh.cones, angles)
    assert part.missing == pytest.approx(off, abs=1e-9)
    if part.closes:
        lsgp.prescribe_curvature(surface(mesh), mesh.cones, angles)
    else:
        with pytest.raises(lsgp.CurvatureError, match=r"leave|cannot carry"):
            lsgp.prescribe_curvature(surface(mesh), mesh.cones, angles)
    assert part.closes == part.complete == (abs(off) < 1e-6)


def test_one_automatic_cone_takes_up_the_rest_while_it_has_room() -> None:
    mesh = meshes.cube(4)
    (part,) = build_ledger(surface(mesh), mesh.cones, [np.pi, *[1.5 * np.pi] * 6, None])
    assert part.automatic.tolist() == [7]
    assert part.missing == pytest.approx(0)
    assert part.closes and not part.complete
    # All of the curvature in one cone would leave it no angle.
    (full,) = build_ledger(surface(mesh), mesh.cones, [*[2 * np.pi] * 7, None])
    assert full.missing == pytest.approx(4 * np.pi) and full.room[1] < 2 * np.pi and not full.closes
    with pytest.raises(lsgp.CurvatureError):
        lsgp.prescribe_curvature(surface(mesh), mesh.cones, [*[2 * np.pi] * 7, None])


@pytest.mark.parametrize("name", OPEN)
def test_a_free_border_takes_up_what_is_left(name: str) -> None:
    mesh = OPEN[name]
    (part,) = build_ledger(surface(mesh), mesh.cones, [np.pi, 3.0])
    assert part.assigned == pytest.approx(np.pi + 2 * np.pi - 3.0)
    assert part.complete
    lsgp.prescribe_curvature(surface(mesh), mesh.cones, [np.pi, 3.0])


def test_corners_of_a_border_count_half_a_turn() -> None:
    mesh = meshes.grid(4, 4)
    corners = [0, 4, 20, 24]
    straight = Options(border="straight")
    (part,) = build_ledger(surface(mesh), corners, [np.pi / 2] * 4, straight)
    assert part.curvature == pytest.approx([np.pi / 2] * 4)
    assert not part.border_takes_up and part.missing == pytest.approx(0) and part.complete
    (off,) = build_ledger(surface(mesh), corners, [np.pi / 2, 1.0, None, np.pi / 2], straight)
    assert off.missing == pytest.approx(1.0) and off.automatic.tolist() == [2]
    # On a free border a cone without an angle prescribes nothing.
    (free,) = build_ledger(surface(mesh), corners, [np.pi / 2, None, None, None])
    assert free.cones.tolist() == [0] and free.border_takes_up


def test_a_border_of_corners_only_has_to_balance() -> None:
    mesh = meshes.make([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    (part,) = build_ledger(surface(mesh), [0, 1, 2], [1.0, 1.0, 1.0])
    assert not part.border_takes_up and not part.closes
    (part,) = build_ledger(surface(mesh), [0, 1, 2], [1.0, 1.0, np.pi - 2.0])
    assert part.complete


def test_parts_are_those_that_are_solved_one_by_one() -> None:
    mesh = meshes.merge([meshes.cube(2), meshes.torus(), meshes.hill()])
    parts = build_ledger(surface(mesh), mesh.cones, [1.5 * np.pi] * 8 + [None] * (len(mesh.cones) - 8))
    assert [part.euler for part in parts] == [2, 0, 1]
    assert [part.borders for part in parts] == [0, 0, 1]
    assert parts[0].cones.tolist() == list(range(8)) and parts[0].complete
    assert sorted(np.concatenate([part.triangles for part in parts])) == list(range(len(mesh.triangles)))


def test_it_reads_broken_surfaces_as_the_core_does() -> None:
    ball = CLOSED["icosphere"]
    flipped = meshes.with_flipped(ball, [3, 4, 50])
    assert build_ledger(surface(flipped), ball.cones)[0].euler == 2
    doubled = meshes.make(ball.positions, np.concatenate([ball.triangles, ball.triangles[5:6, [1, 2, 0]]]))
    (part,) = build_ledger(surface(doubled), ball.cones)
    assert part.euler == 2 and len(part.triangles) == len(ball.triangles)
    isolated = meshes.with_isolated_vertices(ball, 3)
    assert build_ledger(surface(isolated), isolated.cones)[0].euler == 2
    # At the edge of three triangles the ball runs on, and the fin is by itself.
    finned, _ = meshes.with_fin(ball)
    assert [(part.euler, part.borders) for part in build_ledger(surface(finned), ball.cones)] == [(2, 0), (1, 1)]
    # What touches in one vertex only does not hang together.
    tied, tip = meshes.bow_tie()
    parts = build_ledger(surface(tied), [tip], [1.0])
    assert [part.euler for part in parts] == [1, 1]
    assert [part.cones.tolist() for part in parts] == [[0], [0]]
    # Nor where both are one part: two balls that touch, joined by a handle elsewhere, would count one vertex less.
    touching = ball.triangles.copy()
    far = int(np.argmax(np.linalg.norm(ball.positions - ball.positions[0], axis=1)))
    touching[touching == far] = 0
    assert build_ledger(surface(meshes.make(ball.positions, touching)), [0])[0].euler == 2


def test_seams_part_what_their_meaning_says() -> None:
    mesh = meshes.cube(2)
    top = mesh.positions[:, 2] == mesh.positions[:, 2].max()
    lid = mesh.triangles[top[mesh.triangles].all(axis=1)]
    ring = meshes.edges_of(mesh.triangles)
    # The edges with one triangle on the lid.
    ring = ring[[sum({a, b} <= set(triangle) for triangle in lid.tolist()) == 1 for a, b in ring.tolist()]]
    with_seams = surface(mesh, seams=ring)
    parts = build_ledger(with_seams, mesh.cones, None, Options(seams="boundary"))
    assert sorted((part.euler, part.borders) for part in parts) == [(1, 1), (1, 1)]
    for seams in ("follow", "ignore"):
        (part,) = build_ledger(with_seams, mesh.cones, None, Options(seams=seams))
        assert (part.euler, part.borders) == (2, 0)
    # Without cones a closed part is opened along its seams; where seams mean nothing it cannot be unfolded.
    assert all(part.closes for part in build_ledger(with_seams, []))
    assert not build_ledger(with_seams, [], None, Options(seams="ignore"))[0].closes


def test_the_order_of_cones_and_triangles_does_not_matter() -> None:
    mesh = meshes.merge([CLOSED["double torus"], meshes.cube(3)])
    angles = np.linspace(1, 7, len(mesh.cones))
    before = build_ledger(surface(mesh), mesh.cones, angles)
    order = np.random.default_rng(1).permutation(len(mesh.cones))
    shuffled = mesh.triangles[np.random.default_rng(2).permutation(len(mesh.triangles))]
    after = build_ledger(surface(mesh._replace(triangles=shuffled)), mesh.cones[order], angles[order])
    assert sorted(round(part.missing, 9) for part in before) == sorted(round(part.missing, 9) for part in after)


def test_rules_that_choose_all_angles_leave_none_assigned() -> None:
    mesh = meshes.cube(2)
    (part,) = build_ledger(surface(mesh), mesh.cones, [1.0] * 8, Options(prescription="harmonic"))
    assert part.assigned == 0 and len(part.automatic) == 8


def test_what_does_not_belong_together_is_refused() -> None:
    mesh = meshes.cube(2)
    with pytest.raises(lsgp.InputError, match="outside the vertices") as outside:
        build_ledger(surface(mesh), [len(mesh.positions)])
    with pytest.raises(lsgp.InputError, match="8 cones but 1") as count:
        build_ledger(surface(mesh), mesh.cones, [1.0])
    assert (outside.value.code, count.value.code) == ("CONE_INDEX", "ANGLE_COUNT")


def test_no_triangles_no_parts() -> None:
    assert build_ledger(Surface(np.zeros((3, 3)), np.empty((0, 3), np.int32)), [0]) == []


def test_tentative_angles_hold_while_their_part_is_complete() -> None:
    mesh = meshes.merge([meshes.cube(2), meshes.cube(2)])
    cones, right, every = mesh.cones, [1.5 * np.pi] * 16, [True] * 16
    assert hold_complete(surface(mesh), cones, right, every) == right
    # One cone less on the first cube, and its others are automatic again; so they are with one more.
    assert hold_complete(surface(mesh), cones[1:], right[1:], every[1:]) == [None] * 7 + right[8:]
    more = [*cones, np.setdiff1d(np.arange(len(mesh.positions)), cones)[-1]]
    assert hold_complete(surface(mesh), more, [*right, None], [*every, False]) == right[:8] + [None] * 9
    # What is not tentative stays.
    changed = [np.pi, *right[1:]]
    assert hold_complete(surface(mesh), cones, changed, [False, *every[1:]]) == [np.pi, *[None] * 7, *right[8:]]
    assert hold_complete(surface(mesh), cones, changed, [False] * 16) == changed


def test_a_part_by_itself_has_the_account_and_the_prescription_it_had() -> None:
    mesh = meshes.merge([CLOSED["icosphere"], OPEN["hill"], meshes.torus()])
    edges = meshes.edges_of(mesh.triangles)
    whole = surface(mesh, edges=edges, seams=edges[::5])
    for seams in ("follow", "boundary", "ignore"):
        options = Options(seams=seams)
        together = build_ledger(whole, mesh.cones, None, options)
        for part in together:
            own = mesh.cones[part.cones]
            by_itself = build_ledger(part_surface(whole, part), own, None, options)
            assert sum(p.euler for p in by_itself) == part.euler
            assert sum(p.borders for p in by_itself) == part.borders
    part = build_ledger(whole, mesh.cones)[0]
    found = lsgp.prescribe_curvature(part_surface(whole, part), mesh.cones[part.cones])
    together = lsgp.prescribe_curvature(whole, mesh.cones)
    assert found.cone_angles == pytest.approx(together.cone_angles[: len(part.cones)])


@pytest.mark.parametrize("name", CLOSED)
def test_angles_stored_in_single_precision_add_up_again(name: str) -> None:
    mesh = CLOSED[name]
    exact = lsgp.prescribe_curvature(surface(mesh), mesh.cones).cone_angles
    stored = np.nextafter(exact.astype(np.float32), np.float32(10)).tolist()
    held = hold_complete(surface(mesh), mesh.cones, stored, [True] * len(stored))
    assert held == pytest.approx(exact.tolist(), abs=2e-6)
    assert build_ledger(surface(mesh), mesh.cones, held)[0].missing == pytest.approx(0, abs=1e-12)
    # More than that is not rounding.
    assert hold_complete(surface(mesh), mesh.cones, [stored[0] + 1e-4, *stored[1:]], [True] * len(stored)) == [
        None
    ] * len(stored)
