# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's collection of real meshes, ../shared/meshes beside the checkout or $LSGP_SHARED/meshes.

A checkout without the collection skips the tests that need it; the reason names where it was looked for.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest
from meshes import Mesh, make

_BESIDE_THE_CHECKOUT = Path(__file__).resolve().parents[2] / "shared"


def shared_folder() -> Path:
    """The folder that holds meshes/, present or not."""
    return Path(os.environ.get("LSGP_SHARED") or _BESIDE_THE_CHECKOUT)


def shared_mesh(name: str) -> Mesh:
    """The mesh meshes/<name>.obj, polygons as fans, with the cones of <name>.cones.json; skips without the file."""
    path = shared_folder() / "meshes" / f"{name}.obj"
    if not path.is_file():
        pytest.skip(f"{path} is missing: set LSGP_SHARED to the folder that holds meshes/ to run this test")
    positions, triangles = [], []
    with path.open() as lines:
        for line in lines:
            if line.startswith("v "):
                positions.append([float(x) for x in line.split()[1:4]])
            elif line.startswith("f "):
                face = [int(x.split("/")[0]) - 1 for x in line.split()[1:]]
                triangles += [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
    return make(positions, triangles, shared_cones(name)[0])


def hard_mesh(name: str) -> Mesh:
    """The mesh meshes/hard/<name>.off, polygons as fans; skips without the file."""
    path = shared_folder() / "meshes" / "hard" / f"{name}.off"
    if not path.is_file():
        pytest.skip(f"{path} is missing: set LSGP_SHARED to the folder that holds meshes/ to run this test")
    lines = [line.split() for line in path.read_text().splitlines()[1:] if line.strip()]
    vertices, faces = int(lines[0][0]), int(lines[0][1])
    positions = np.array(lines[1 : 1 + vertices], float)
    triangles = []
    for line in lines[1 + vertices : 1 + vertices + faces]:
        face = [int(x) for x in line[1 : 1 + int(line[0])]]
        triangles += [[face[0], face[i], face[i + 1]] for i in range(1, len(face) - 1)]
    return make(positions, triangles)


def shared_cones(name: str) -> tuple[list[int], list[float]]:
    """Cones of meshes/<name>.cones.json and the angles in radians that go with them; both empty without the file."""
    path = shared_folder() / "meshes" / f"{name}.cones.json"
    if not path.is_file():
        return [], []
    data = json.loads(path.read_text())
    return data["cones"], list(np.array(data["angles_over_pi_2"], float) * np.pi / 2)
