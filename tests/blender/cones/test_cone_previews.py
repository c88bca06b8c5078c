# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones on large meshes: approximate maps while a cone is dragged, the exact one once it is released."""

import time

import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, edit

cone_session, following = addon.jobs.sessions.cone_session, addon.jobs.sessions.following
unwrapping = addon.jobs.tasks.unwrapping
lsgp = addon.core.native.lsgp


@pytest.fixture
def ball():
    obj = add_ball(cuts=40)
    edit(obj, select="DESELECT")
    return obj


def begin(obj):
    settings = unwrapping.UnwrapSettings(
        lsgp.Options(), "uv_cones", None, 0.0, True, False, True, addon.jobs.tasks.cuts.CutChoice()
    )
    return cone_session.ConeSession(obj, settings)


@pytest.fixture
def maps(monkeypatch):
    """What each map was made by, in that order."""
    made = []
    for kind in (lsgp.Solver, lsgp.Preview):

        def parameterize(self, *arguments, _original=kind.parameterize, _name=kind.__name__, **options):
            made.append(_name)
            return _original(self, *arguments, **options)

        monkeypatch.setattr(kind, "parameterize", parameterize)
    return made


def until_idle(follower):
    end = time.monotonic() + 60
    while follower.outdated or follower.is_busy:
        follower.follow()
        assert time.monotonic() < end


def drag(session, follower, vertices):
    follower.drag(True)
    for vertex in vertices:
        assert session.cones.move(vertex)
        follower.outdated = True
        until_idle(follower)


def free_vertices(session, count):
    return [v for v in range(5000, 6000, 97) if v not in session.cones][:count]


def difference(one, other):
    return np.median(np.linalg.norm(one - other, axis=-1)) / np.ptp(other.reshape(-1, 2), axis=0).max()


@pytest.mark.slow
def test_a_dragged_cone_has_previews_and_a_released_one_the_exact_map(ball, maps):
    session = begin(ball)
    assert len(session.region.surface.triangles) >= cone_session.PREVIEWED
    follower = following.Follower(session)
    session.cones.add(session.cones.vertices[0])
    drag(session, follower, free_vertices(session, 3))
    assert maps == ["Preview"] * 3 and not follower.problem
    shown = UvMap(ball).uv
    follower.drag(False)
    until_idle(follower)
    assert maps == ["Preview"] * 3 + ["Solver"]
    exact = UvMap(ball).uv
    step = session.draft()
    session.show(step, step.solve())
    np.testing.assert_array_equal(UvMap(ball).uv, exact)
    # Where they have other cuts, they are not quite in the same place.
    assert 0 < difference(shown, exact) < 0.1
    follower.drag(False)
    assert not follower.outdated
    session.restore()


def test_finishing_and_undoing_use_exact_maps_alone(ball, maps):
    session = begin(ball)
    follower = following.Follower(session)
    before, state = UvMap(ball).uv, session.cones.state()
    session.cones.add(session.cones.vertices[0])
    drag(session, follower, free_vertices(session, 1))
    kept = session.cones.state()
    session.cones.put(state)
    follower.drag(False)
    until_idle(follower)
    np.testing.assert_array_equal(UvMap(ball).uv, before)
    assert maps == ["Preview"]
    session.cones.put(kept)
    follower.outdated = True
    until_idle(follower)
    follower.stop()
    session.unwrap()
    assert maps == ["Preview", "Solver", "Solver"]


def test_small_meshes_and_pins_have_no_previews(maps):
    small = add_ball(cuts=10)
    edit(small, select="DESELECT")
    session = begin(small)
    follower = following.Follower(session)
    session.cones.add(session.cones.vertices[0])
    follower.drag(True)
    vertex = next(v for v in range(50, 90) if v not in session.cones)
    assert session.cones.move(vertex)
    follower.outdated = True
    until_idle(follower)
    assert maps == ["Solver"]
    follower.drag(False)
    assert not follower.outdated
    session.restore()


def test_stopping_ends_what_makes_previews(ball):
    session = begin(ball)
    follower = following.Follower(session)
    session.cones.add(session.cones.vertices[0])
    follower.drag(True)
    assert session.cones.move(free_vertices(session, 1)[0])
    follower.outdated = True
    follower.follow()
    follower.stop()
    assert not follower.is_busy
    session.restore()


def test_an_impossible_preview_leaves_the_exact_maps(ball, maps, monkeypatch):
    def fail(*_arguments, **_options):
        raise lsgp.SolverError("OUT_OF_MEMORY", "There is not enough memory.")

    monkeypatch.setattr(lsgp, "Preview", fail)
    session = begin(ball)
    follower = following.Follower(session)
    session.cones.add(session.cones.vertices[0])
    drag(session, follower, free_vertices(session, 2))
    assert maps == ["Solver"] * 2
    session.restore()
