# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed extension: names, options, menus, preferences, and complete removal."""

import os
import sys

import bpy
import pytest
from installed import EXTENSION, addon

native = addon.core.native

OPERATORS = {
    "uv.cone_auto_unwrap",
    "uv.cone_unwrap",
    "object.cone_remesh_to_quads",
    "mesh.cone_mark",
    "mesh.cone_select",
    "mesh.cone_place",
    "mesh.cone_select_reported",
    "mesh.cone_select_cuts",
    "mesh.cone_seams_from_cuts",
    "mesh.cone_set_angle",
    "mesh.cone_spread_rest",
    "mesh.cone_snap_angles",
    "mesh.cone_suggest",
    "mesh.cone_preview",
    "uv.cone_measure",
    "uv.cone_texture",
    "mesh.cone_clear_data",
    "uv.cone_texel_get",
    "uv.cone_texel_set",
    "mesh.cone_texel_select",
}
SUBMENU = ("VIEW3D_MT_cone_unwrap", None)


class RecordingLayout:
    """Stands for a menu's layout and keeps which operators were drawn, with their `clear` where it was set."""

    class Entry:
        clear = None

    operator_context = "EXEC_REGION_WIN"

    def __init__(self):
        self.drawn = []

    def operator(self, name, text=""):
        entry = self.Entry()
        self.drawn.append((name, entry, text))
        return entry

    def menu(self, name):
        self.drawn.append((name, self.Entry(), ""))

    def operator_menu_enum(self, name, _property):
        self.menu(name)

    def separator(self):
        pass


def our_entries(menu):
    """(operator, clear) for what the extension draws in a menu."""
    cls = getattr(bpy.types, menu)
    stand_in = type("Menu", (), {"layout": RecordingLayout()})()
    for draw in cls._dyn_ui_initialize():
        if draw.__module__.startswith(EXTENSION):
            draw(stand_in, bpy.context)
    return [(name, entry.clear) for name, entry, _ in stand_in.layout.drawn]


def test_library_comes_from_the_extensions_wheel():
    import lsgp

    assert native.lsgp is lsgp
    assert native.PROBLEM == ""
    extensions = os.path.join(os.environ["BLENDER_USER_RESOURCES"], "extensions")
    assert os.path.realpath(lsgp._lsgp.__file__).startswith(os.path.realpath(extensions) + os.sep)


@pytest.mark.parametrize("name", sorted(OPERATORS))
def test_operators_can_be_undone_and_repeated(name):
    area, verb = name.split(".")
    rna = getattr(getattr(bpy.ops, area), verb).get_rna_type()
    cls = getattr(bpy.types, rna.identifier)
    assert cls.bl_options - {"PRESET"} == {"REGISTER", "UNDO"}
    assert rna.description and not rna.description.endswith(".")


def test_settings_of_the_unwrap_can_be_kept_as_presets():
    assert "PRESET" in bpy.types.UV_OT_cone_unwrap.bl_options


def test_remeshing_is_where_blender_converts_objects():
    assert our_entries("VIEW3D_MT_object_convert") == [("object.cone_remesh_to_quads", None)]


@pytest.mark.parametrize(
    "menu", ["IMAGE_MT_uvs", "VIEW3D_MT_object", "VIEW3D_MT_edit_mesh_edges", "VIEW3D_MT_edit_mesh_vertices"]
)
def test_every_menu_has_one_entry(menu):
    assert our_entries(menu) == [SUBMENU]


def test_everything_is_in_the_submenu_and_auto_unwrap_comes_first():
    stand_in = type("Menu", (), {"layout": RecordingLayout()})()
    bpy.types.VIEW3D_MT_cone_unwrap.draw(stand_in, bpy.context)
    assert [(name, entry.clear) for name, entry, _ in stand_in.layout.drawn] == [
        ("uv.cone_auto_unwrap", None),
        ("uv.cone_unwrap", None),
        ("uv.cone_pack", None),
        ("VIEW3D_MT_cone_islands", None),
        ("object.cone_remesh_to_quads", None),
        ("mesh.cone_mark", False),
        ("mesh.cone_mark", True),
        ("mesh.cone_select", None),
        ("mesh.cone_edit", None),
        ("mesh.cone_place", None),
        ("VIEW3D_MT_cone_angles", None),
        ("mesh.cone_edit_cuts", None),
        ("mesh.cone_steer_cuts", None),
        ("mesh.cone_select_cuts", None),
        ("mesh.cone_seams_from_cuts", None),
        ("mesh.cone_draw_up", None),
        ("mesh.cone_mark_up", False),
        ("mesh.cone_mark_up", True),
        ("mesh.cone_select_reported", None),
        ("VIEW3D_MT_cone_seeing", None),
        ("VIEW3D_MT_cone_texels", None),
        ("uv.cone_extend_image", None),
        ("mesh.cone_clear_data", None),
    ]


def test_the_menu_of_angles_has_their_operators():
    stand_in = type("Menu", (), {"layout": RecordingLayout()})()
    bpy.types.VIEW3D_MT_cone_angles.draw(stand_in, bpy.context)
    names = [name for name, _, _ in stand_in.layout.drawn]
    assert names == [f"mesh.cone_{verb}" for verb in ("set_angle", "spread_rest", "snap_angles", "suggest", "preview")]


def test_the_menu_of_islands_has_their_operators():
    stand_in = type("Menu", (), {"layout": RecordingLayout()})()
    bpy.types.VIEW3D_MT_cone_islands.draw(stand_in, bpy.context)
    names = [name for name, _, _ in stand_in.layout.drawn]
    verbs = ("straighten", "rectify", "grid", "orient", "align", "stitch", "rip")
    assert names == [f"uv.cone_{verb}" for verb in verbs]


def test_the_unwrap_menu_with_which_u_begins_has_auto_unwrap_and_the_submenu_at_its_top():
    assert our_entries("IMAGE_MT_uvs_unwrap") == [("uv.cone_auto_unwrap", None), SUBMENU]
    assert our_entries("VIEW3D_MT_uv_map") == []
    first, *others = bpy.types.IMAGE_MT_uvs_unwrap._dyn_ui_initialize()
    assert first.__module__.startswith(EXTENSION) and others
    stand_in = type("Menu", (), {"layout": RecordingLayout()})()
    first(stand_in, bpy.context)
    # What Blender draws next runs as before.
    assert stand_in.layout.operator_context == "EXEC_REGION_WIN"


def test_context_menu_has_cones_in_vertex_select_mode_only():
    settings = bpy.context.tool_settings
    settings.mesh_select_mode = (True, False, False)
    assert our_entries("VIEW3D_MT_edit_mesh_context_menu") == [SUBMENU]
    settings.mesh_select_mode = (False, True, True)
    assert our_entries("VIEW3D_MT_edit_mesh_context_menu") == []


def test_preferences_say_where_the_library_is():
    assert bpy.context.preferences.addons[EXTENSION].preferences is not None
    assert sys.modules["lsgp"].__file__ in native.library_state()


def test_disabling_removes_operators_and_menu_entries_and_enabling_restores_them():
    menus = ("IMAGE_MT_uvs_unwrap", "IMAGE_MT_uvs", "VIEW3D_MT_edit_mesh_vertices", "VIEW3D_MT_edit_mesh_context_menu")
    entries = {menu: our_entries(menu) for menu in menus}
    addon.unregister()
    try:
        assert all(our_entries(menu) == [] for menu in menus)
        assert not hasattr(bpy.types, "UV_OT_cone_unwrap")
        assert not hasattr(bpy.types, "MESH_OT_cone_mark")
    finally:
        addon.register()
    assert {menu: our_entries(menu) for menu in menus} == entries
    assert hasattr(bpy.types, "UV_OT_cone_unwrap")


def test_one_core_is_left_to_blender():
    assert os.environ["LSGP_THREADS"] == str(max(1, (os.cpu_count() or 1) - 1))
