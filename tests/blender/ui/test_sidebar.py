# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar: its tables, which panels are shown when, and buttons that select what a message is about."""

from dataclasses import replace

import bmesh
import bpy
import pytest
from installed import addon
from scenes import add_ball, add_cone_cube, add_object, add_ramp, corners, edit, selected

findings, saved_reports, changes = addon.core.findings, addon.mesh.reports, addon.mesh.changes
tables, panels, text = addon.ui.tables, addon.ui.panels, addon.ui.text


class RecordingLayout:
    """Stands for a panel's layout and keeps its texts and buttons."""

    def __init__(self, texts, buttons):
        self.texts, self.buttons = texts, buttons

    def _part(self, **_options):
        return RecordingLayout(self.texts, self.buttons)

    row = column = box = split = grid_flow = _part

    def label(self, text="", icon="NONE"):
        self.texts.append(text)

    def operator(self, name, text="", icon="NONE"):
        button = type("Button", (), {})()
        self.buttons.append((name, button))
        return button

    def prop(self, _owner, name, text="", expand=False):
        self.texts.append(name)


def drawn(panel):
    """(texts, buttons) of a panel; None where it is not shown."""
    if not is_shown(panel):
        return None
    stand_in = type("Panel", (), {})()
    texts, buttons = [], []
    stand_in.layout = RecordingLayout(texts, buttons)
    panel.draw(stand_in, bpy.context)
    return texts, buttons


def is_shown(panel):
    return not hasattr(panel, "poll") or panel.poll(bpy.context)


def shown():
    return {panel.bl_label for panel in panels.PANELS if is_shown(panel)}


ALWAYS = {"Cone Unwrap", "Cones", "Overlay", "Distortion", "Texel Density", "Texture", "Texture Up"}


def test_panels_come_with_what_they_tell():
    assert shown() == {"Cone Unwrap"}
    add_cone_cube()
    assert shown() == ALWAYS
    bpy.ops.uv.cone_unwrap()
    assert shown() == ALWAYS | {"Quality"}
    bpy.ops.uv.cone_unwrap(seamless=True)
    changes.mark_changed(bpy.context.object.data)
    assert shown() == ALWAYS | {"Quality", "Seam Certificate"}


def test_the_uv_editor_has_the_panels_of_the_3d_view_that_concern_its_map():
    ours = {panel.bl_label: panel for panel in panels.PANELS}
    for panel in panels.UV_EDITOR_PANELS:
        original = ours[panel.bl_label]
        assert panel.bl_idname if hasattr(panel, "bl_idname") else panel.__name__.startswith("IMAGE_PT_")
        assert (panel.bl_space_type, panel.bl_region_type, panel.bl_category) == ("IMAGE_EDITOR", "UI", "Cone Unwrap")
        assert panel.draw is original.draw
        # Without a UV editor.
        assert not is_shown(panel)
    wanted = {"Cone Unwrap", "Islands", "Problems", "Quality", "Seam Certificate", "Overlay", "Texel Density"}
    assert {panel.bl_label for panel in panels.UV_EDITOR_PANELS} == wanted


def test_islands_have_their_tools_in_edit_mode():
    cube = add_cone_cube()
    assert "Islands" not in shown()
    edit(cube)
    assert "Islands" in shown()
    _, buttons = drawn(panels.VIEW3D_PT_cone_unwrap_islands)
    verbs = ("straighten", "rectify", "grid", "stitch", "rip", "orient", "orient", *["align"] * 6)
    assert [name for name, _ in buttons] == [f"uv.cone_{verb}" for verb in verbs]


def test_only_the_first_panel_and_problems_are_open_at_first():
    closed = {panel.bl_label for panel in panels.PANELS if "DEFAULT_CLOSED" in getattr(panel, "bl_options", ())}
    assert {panel.bl_label for panel in panels.PANELS} - closed == {"Cone Unwrap", "Problems"}


def test_the_first_panel_has_one_large_button_and_it_is_auto_unwrap():
    _, buttons = drawn(panels.VIEW3D_PT_cone_unwrap)
    assert [name for name, _ in buttons] == ["uv.cone_auto_unwrap", "uv.cone_unwrap", "uv.cone_pack"]


def test_the_table_has_the_figures_of_the_library():
    add_ball()
    bpy.ops.uv.cone_unwrap()
    report = saved_reports.find(bpy.context.object.data)
    rows = {label: value for label, value, _ in tables.quality_rows(report)}
    assert float(rows["Angles"]) == pytest.approx(report.distortion["quasi_conformal"], abs=5e-4)
    assert float(rows["Stretch"]) == pytest.approx(report.distortion["l2_stretch"], abs=5e-4)
    assert rows["Flipped Faces"] == rows["Overlapping Faces"] == "0"
    assert {rows[name] for name in ("Sides of Cuts", "Rotations of Cuts", "Translations of Cuts")} == {"exact"}
    texts, _ = drawn(panels.VIEW3D_PT_cone_unwrap_quality)
    assert " ".join(texts).startswith("96 faces, 1 island, 8 cones")


def test_a_changed_map_is_said_to_be_so():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    cube.data.uv_layers.active.uv[0].vector.x += 0.5
    changes.mark_changed(cube.data)
    texts, _ = drawn(panels.VIEW3D_PT_cone_unwrap_quality)
    assert "The UV map has changed" in " ".join(texts)


def test_the_certificate_lists_cuts_by_turn_and_whole_tiles():
    add_cone_cube()
    bpy.ops.uv.cone_unwrap(seamless=True)
    certificate = saved_reports.find(bpy.context.object.data).certificate
    assert tables.seam_summary(certificate) == "All 7 cuts match exactly"
    rows = tables.seam_rows(certificate)
    assert len(rows) == 7
    assert {turn for turn, _, _ in rows} <= {"0°", "90°", "180°", "270°"}
    assert all(float(part).is_integer() for _, shift, _ in rows for part in shift.split(", "))
    off = certificate | {"error": 1e-3, "error_texels": 1.024}
    assert tables.seam_summary(off) == "All 7 cuts match up to 1e+0 texels of 1024 x 1024"
    assert tables.seam_summary(certificate | {"cuts": []}) == "No cuts, so no seam"


def test_a_message_has_a_button_that_selects_what_it_is_about():
    ramp = add_ramp()
    bpy.ops.uv.cone_unwrap(overlaps="KEEP")
    overlapping = saved_reports.find(ramp.data).overlapping
    texts, buttons = drawn(panels.VIEW3D_PT_cone_unwrap_problems)
    assert "overlap others in the layout" in " ".join(texts)
    edit(ramp, select="DESELECT")
    name, button = buttons[0]
    assert name == "mesh.cone_select_reported"
    assert bpy.ops.mesh.cone_select_reported(finding=button.finding) == {"FINISHED"}
    assert [face.index for face in bmesh.from_edit_mesh(ramp.data).faces if face.select] == overlapping


def test_an_error_has_one_too_and_of_several_messages_one_is_selected():
    cube = add_cone_cube()
    broken = corners(cube)[3]
    cube.data.vertices[broken].co.x = float("nan")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    texts, buttons = drawn(panels.VIEW3D_PT_cone_unwrap_problems)
    assert "not a finite number" in " ".join(texts) and len(buttons) == 1
    first = findings.last(cube)[0]
    others = replace(findings.MeshElements.none(), vertices=first.elements.vertices - 1)
    other = findings.KeptFinding("Another", findings.Severity.ATTENTION, others, first.mesh_size)
    findings._last[cube.data.session_uid].append(other)
    edit(cube, select="DESELECT")
    for number, vertices in ((0, [broken]), (1, [broken - 1]), (-1, [broken - 1, broken])):
        bpy.ops.mesh.cone_select_reported(finding=number)
        assert selected(cube) == vertices


def test_messages_without_elements_have_no_button(reports):
    def build(bm):
        bm.verts.new((0, 0, 0))

    add_object("Point", build)
    with pytest.raises(RuntimeError, match="no faces"):
        bpy.ops.uv.cone_unwrap()
    texts, buttons = drawn(panels.VIEW3D_PT_cone_unwrap_problems)
    assert "the mesh has no faces" in " ".join(texts) and buttons == []


@pytest.mark.parametrize(
    "said", ["one", "a few words that fit", "averyveryveryveryveryverylongword and some more " * 8]
)
def test_wrapped_text_is_the_text(said):
    lines = text.wrapped(bpy.context, said)
    assert " ".join(lines) == said.strip()
    assert len(lines) < len(said.split()) or len(said.split()) == 1
    assert all(len(line) <= 60 for line in lines)


def test_every_panel_draws():
    add_cone_cube()
    bpy.ops.uv.cone_unwrap(seamless=True)
    bpy.ops.uv.cone_measure()
    bpy.ops.uv.cone_texture()
    changes.mark_changed(bpy.context.object.data)
    seen = {panel.bl_label: drawn(panel) for panel in panels.PANELS}
    assert seen.pop("Problems") is seen.pop("Islands") is None
    assert all(texts or buttons for texts, buttons in seen.values())
    assert [name for name, button in seen["Texture"][1] if getattr(button, "clear", False)] == ["uv.cone_texture"]
