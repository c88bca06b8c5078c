# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator where meshes are selected and the active object is none of them: it runs, or reports why it cannot."""

import bpy
import pytest
from installed import addon
from scenes import add_cube

OPERATORS = [kind.bl_idname for kind in addon.registration.CLASSES if issubclass(kind, bpy.types.Operator)]
OTHERS = {
    "none": lambda: None,
    "empty": lambda: bpy.data.objects.new("Other", None),
    "curve": lambda: bpy.data.objects.new("Other", bpy.data.curves.new("Other", "CURVE")),
    "lattice": lambda: bpy.data.objects.new("Other", bpy.data.lattices.new("Other")),
}


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_runs_or_says_why_not(operator: str, other: str) -> None:
    add_cube(cuts=1)
    active = OTHERS[other]()
    if active is not None:
        bpy.context.collection.objects.link(active)
    bpy.context.view_layer.objects.active = active
    group, name = operator.split(".")
    call = getattr(getattr(bpy.ops, group), name)
    if not call.poll():
        return
    try:
        assert call() <= {"FINISHED", "CANCELLED", "PASS_THROUGH"}
    except RuntimeError as error:
        assert "Traceback" not in str(error)
