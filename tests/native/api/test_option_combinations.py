# SPDX-License-Identifier: GPL-3.0-or-later
"""Options two by two: a map that keeps what each of them says, or a refusal that names what does not go together."""

from __future__ import annotations

import itertools

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import Options, Seamless
from map_checks import surface

CHOICES: dict[str, list[object]] = {
    "prescription": ["least-distortion", "harmonic", "straightness", "manual"],
    "unfold": ["spectral"],
    "method": ["lscm"],
    "seams": ["boundary", "ignore"],
    "border": ["straight"],
    "seamless": [Seamless(tiles=12)],
    "mode": ["low-stretch"],
    "repair": [False],
    "overlaps": ["split"],
    "factorization": ["cut", "sparse"],
}
MESHES = {"closed": meshes.bumpy_sphere(1), "open": meshes.hill(6)}
CONES = {"closed": meshes.bumpy_sphere(1).cones, "open": np.array([0, 6, 24, 42, 48], np.int32)}
# Each with what it is refused for.
REFUSED = {
    ("method", "seamless"): "transitions",
    ("method", "mode"): "low stretch",
    ("method", "border"): "boundaries",
    ("method", "unfold"): "spectral",
    ("border", "seamless"): "boundaries",
}
PAIRS = [
    (one, first, other, second)
    for one, other in itertools.combinations(CHOICES, 2)
    for first in CHOICES[one]
    for second in CHOICES[other]
]


def pair_name(value: object) -> str:
    return "seamless" if isinstance(value, Seamless) else str(value)


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: "-".join(map(pair_name, pair)))
def test_every_pair_is_a_map_or_a_refusal(pair: tuple[str, object, str, object], name: str) -> None:
    one, first, other, second = pair
    mesh = MESHES[name]
    seams = meshes.edges_of(mesh.triangles)[::9]
    marked, options = surface(mesh, seams=seams), Options(**{one: first, other: second})
    why = REFUSED.get((one, other)) or REFUSED.get((other, one))
    if why is not None:
        with pytest.raises(lsgp.InputError, match=why) as refused:
            lsgp.parameterize(marked, CONES[name], options=options)
        assert refused.value.code == "WRONG_PARAMETER"
        return
    result = lsgp.parameterize(marked, CONES[name], options=options)
    assert result.solved.all() and np.isfinite(result.corner_uv).all()
    if options.seamless is not None:
        assert result.seamless is not None and result.seamless.error <= 1e-6
    if options.method == "lscm" and name == "closed":
        assert result.seams.sister_ratio_max > 1 + 1e-9 or options.seams != "follow"


def test_turning_of_borders_and_pins_are_not_for_lscm() -> None:
    mesh = MESHES["open"]
    options = Options(method="lscm", loop_turning={0: 6.0})
    with pytest.raises(lsgp.InputError, match="turning") as refused:
        lsgp.parameterize(surface(mesh), [], options=options)
    assert refused.value.code == "WRONG_PARAMETER"
    pins = lsgp.Pins([0, 30], [[0.0, 0.0], [1.0, 1.0]])
    with pytest.raises(lsgp.InputError, match="pins") as refused:
        lsgp.parameterize(surface(mesh), [], options=Options(method="lscm"), pins=pins)
    assert refused.value.code == "PINS_CONFLICT"


def test_mirror_plane_is_for_symmetric_cones() -> None:
    with pytest.raises(lsgp.InputError, match="mirror") as refused:
        lsgp.place_cones(surface(MESHES["closed"]), mirror=([0, 0, 0], [1, 0, 0]))
    assert refused.value.code == "WRONG_PARAMETER"
