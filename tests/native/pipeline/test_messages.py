# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages: degrees, true numbers of a few digits, nothing infinite."""

from __future__ import annotations

import re

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import only, surface

ODD = re.compile(r"\binf\b|\bnan\b|\de[-+]\d| pi\b|[1-9]\.\d{5,}")


def message_of(mesh: meshes.Mesh, angles: list[float | None]) -> str:
    with pytest.raises(lsgp.LsgpError) as caught:
        lsgp.parameterize(surface(mesh), mesh.cones, angles)
    assert not ODD.search(caught.value.message), caught.value.message
    return caught.value.message


def numbers(message: str) -> list[float]:
    return [float(number) for number in re.findall(r"(-?[\d.]*\d) degrees", message)]


@pytest.mark.parametrize(("off", "word"), [(0.3, "large"), (-0.2, "small"), (2e-6, "large")])
def test_given_angles_are_told_the_sum_required_and_what_is_missing(off: float, word: str) -> None:
    cube = meshes.cube(2)
    angles = np.full(len(cube.cones), 1.5 * np.pi)
    angles[0] += off
    message = message_of(cube, list(angles))
    left, required, missing = numbers(message)
    assert left == pytest.approx(np.rad2deg((2 * np.pi - angles).sum()), abs=1e-3) and required == 720
    assert missing == pytest.approx(np.rad2deg(abs(off)), rel=1e-3)
    assert f"too {word} together" in message and "in sum" in message


def test_angles_that_leave_the_automatic_ones_too_much_are_told_the_bound() -> None:
    cube = meshes.cube(2)
    message = message_of(cube, [None] + [2 * np.pi] * 7)
    assert "at most" in message and "The automatic cones cannot take up the rest" in message
    # One cone alone cannot have an angle below 0.
    most, required, missing = numbers(message)
    assert 350 < most < 360 and required == 720 and missing == pytest.approx(720 - most, abs=0.1)


def test_a_surface_without_cones_is_told_its_curvature_in_degrees() -> None:
    assert numbers(message_of(meshes.icosphere(1)._replace(cones=np.empty(0, np.int32)), [])) == [720]


def test_a_stretch_beyond_numbers_is_told_by_a_power_of_ten() -> None:
    """A rod that all its cones are at one end of: by 2 pi lengths over its girth the other end shrinks."""
    long = meshes.cube(3, stretch=(1, 1000, 1))
    end = np.flatnonzero(long.positions[:, 1] == long.positions[:, 1].min())[:4]
    warning = only(lsgp.prescribe_curvature(surface(long), end).warnings, "HIGH_DISTORTION")
    assert not ODD.search(warning.message) and "expected" not in warning.message
    power = float(re.search(r"by a factor of 10\^(\d+)", warning.message)[1])
    girth = 4 * np.ptp(long.positions[:, 0])
    assert power == pytest.approx(2 * np.pi * np.ptp(long.positions[:, 1]) / girth / np.log(10), rel=0.2)


def test_an_expected_stretch_has_a_few_digits() -> None:
    ball = meshes.icosphere(3)
    found = lsgp.prescribe_curvature(surface(ball), np.sort(ball.triangles[0]))
    warning = only(found.warnings, "HIGH_DISTORTION")
    assert not ODD.search(warning.message)
    expected = float(re.search(r"stretch of ([\d.]+) is expected", warning.message)[1])
    assert expected == pytest.approx(found.predicted_l2, rel=1e-3)
