# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets of the extension: where Blender lists them, and that each sets all properties."""

import re
from pathlib import Path

import bpy
import pytest
from installed import addon
from scenes import add_cone_cube

FOLDER = Path(addon.__file__).parent / "presets" / "operator"
PRESETS = sorted(path.relative_to(FOLDER).as_posix() for path in FOLDER.glob("*/*.py"))
# Values that are nobody's default.
OTHERS = {
    "uv.cone_auto_unwrap": {"preset": "BAKE", "texture_size": "64", "margin": 1, "cuts": "VIEW"},
    "uv.cone_unwrap": {"mode": "LOW_STRETCH", "stretch": 0.25, "pack": False, "prescription": "HARMONIC"},
}


@pytest.mark.parametrize("operator", OTHERS)
def test_blender_lists_them(operator):
    folders = [Path(found) for found in bpy.utils.preset_paths(f"operator/{operator}")]
    # Blender 4.2 need not be able to.
    assert any(folder.samefile(FOLDER / operator) for folder in folders) == hasattr(bpy.utils, "register_preset_path")
    assert len(list((FOLDER / operator).glob("*.py"))) >= 5


def values(properties):
    return {name: getattr(properties, name) for name in {*properties.bl_rna.properties.keys()} - {"rna_type"}}


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
def test_a_preset_does_not_depend_on_what_was_set_before(preset):
    operator = preset.partition("/")[0]
    add_cone_cube()
    run = getattr(bpy.ops.uv, operator.removeprefix("uv."))
    after = []
    for options in ({}, OTHERS[operator]):
        assert run("EXEC_DEFAULT", True, **options) == {"FINISHED"}
        before = values(bpy.context.active_operator.properties)
        done = bpy.ops.script.execute_preset(filepath=str(FOLDER / preset), menu_idname="WM_MT_operator_presets")
        assert done == {"FINISHED"}
        after.append(values(bpy.context.active_operator.properties))
        assert after[-1] != before
    assert after[0] == after[1]
    properties = bpy.context.active_operator.properties
    # What is another view of one of them always counts as set.
    set_by_it = {name for name in after[0] if properties.is_property_set(name)} - {"max_stretch"}
    assert set_by_it == set(re.findall(r"^op\.(\w+) = ", (FOLDER / preset).read_text(), re.MULTILINE))
