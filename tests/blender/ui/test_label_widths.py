# SPDX-License-Identifier: GPL-3.0-or-later
"""No label is cut off in the sidebar and in redo panels as wide as Blender opens them."""

from dataclasses import dataclass, field

import blf
import bpy
import pytest
from installed import addon
from scenes import add_ball, add_cone_cube, edit

changes, findings, panels = addon.mesh.changes, addon.core.findings, addon.ui.panels
# Pixels at a scale of 1, measured in Blender 4.3: inside a panel of the sidebar, and of the redo panel, whose labels
# are right of it, the part for labels and that for values.
SIDEBAR, LABEL, VALUE = 226, 94, 144
# What buttons, menus, numbers and checkboxes need besides their text, and boxes at their sides.
BUTTON, MENU, CHECKBOX, ICON, BOX = 10, 20, 24, 20, 10


def width(text):
    blf.size(0, 11)
    return blf.dimensions(0, text)[0]


def rna_of(name):
    """Of an operator, such as "uv.cone_unwrap"."""
    group, _, rest = name.partition(".")
    return getattr(getattr(bpy.ops, group), rest).get_rna_type()


@dataclass
class Part:
    """Stands for a layout: what is in it, side by side or below each other, and the share of each of its width."""

    side_by_side: bool = False
    shares: tuple = ()
    inset: int = 0
    parts: list = field(default_factory=list)

    def _part(self, *options, **more):
        self.parts.append(Part(*options, **more))
        return self.parts[-1]

    def _text(self, text, besides):
        self.parts.append((text, besides))

    def row(self, **_options):
        return self._part(side_by_side=True)

    def column(self, **_options):
        return self._part()

    def box(self):
        return self._part(inset=BOX)

    def split(self, factor, **_options):
        return self._part(side_by_side=True, shares=(factor, 1 - factor))

    def grid_flow(self, columns, **_options):
        # One of its rows stands for all: every part gets as much.
        return self._part(shares=(1 / columns,))

    def label(self, text="", icon="NONE"):
        self._text(text, ICON if icon != "NONE" else 0)

    def operator(self, name, text=None, icon="NONE", **_options):
        rna = rna_of(name)
        self._text(rna.name if text is None else text, BUTTON + (ICON if icon != "NONE" else 0))
        return type("Button", (), {})()

    def prop(self, owner, name, text=None, expand=False):
        rna = owner.bl_rna.properties[name]
        if expand:
            row = self._part(side_by_side=True)
            for item in rna.enum_items:
                row._text(item.name, BUTTON)
            return
        besides = CHECKBOX if rna.type == "BOOLEAN" else MENU
        shown = rna.name if text is None else text
        if rna.type in {"INT", "FLOAT"} and not getattr(rna, "array_length", 0):
            shown += f" {getattr(owner, name):.2f}"
        self._text(shown, besides if shown else 0)

    def cut_off(self, available):
        """Texts wider than what they have, with both widths."""
        available -= self.inset
        found = []
        for number, part in enumerate(self.parts):
            own = available / len(self.parts) if self.side_by_side else available
            if self.shares:
                own = available * self.shares[min(number, len(self.shares) - 1)]
            if isinstance(part, Part):
                found += part.cut_off(own)
            elif width(part[0]) + part[1] > own:
                found.append((part[0], round(width(part[0]) + part[1]), round(own)))
        return found


def cut_off_in(panel):
    stand_in = type("Panel", (), {name: value for name, value in vars(panel).items() if callable(value)})()
    stand_in.layout = Part()
    stand_in.draw(bpy.context)
    assert stand_in.layout.parts
    return stand_in.layout.cut_off(SIDEBAR)


def with_everything():
    """A seamless map with findings, measured, with a texture and an image size."""
    ball = add_ball()
    bpy.ops.uv.cone_unwrap(seamless=True)
    bpy.ops.uv.cone_measure()
    bpy.ops.uv.cone_texture()
    addon.overlay.settings.settings(bpy.context).cut_colors = "KIND"
    changes.mark_changed(ball.data)
    return ball


SIDEBAR_PANELS = (*panels.PANELS, addon.ui.angle_panel.VIEW3D_PT_cone_angles)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_in_the_sidebar(mode):
    ball = with_everything()
    if mode == "EDIT":
        edit(ball, select="SELECT")
    shown = [panel for panel in SIDEBAR_PANELS if not hasattr(panel, "poll") or panel.poll(bpy.context)]
    assert len(shown) > 8
    assert {panel.bl_label: cut_off_in(panel) for panel in shown} == {panel.bl_label: [] for panel in shown}


def test_titles_of_panels():
    assert [panel.bl_label for panel in SIDEBAR_PANELS if width(panel.bl_label) + 2 * ICON > SIDEBAR] == []


def test_in_redo_panels():
    """Checkboxes have their text beside them, other properties to the left."""
    add_cone_cube()
    names = [cls.bl_idname for cls in addon.registration.CLASSES if issubclass(cls, bpy.types.Operator)]
    cut, seen = [], 0
    for name in names:
        for prop in rna_of(name).properties:
            if prop.identifier in {"rna_type", "bl_idname", "bl_label"} or prop.is_hidden:
                continue
            seen += 1
            if width(prop.name) > (VALUE - CHECKBOX if prop.type == "BOOLEAN" else LABEL):
                cut.append((name, prop.name, round(width(prop.name))))
            for item in getattr(prop, "enum_items", ()):
                if width(item.name) + MENU > VALUE:
                    cut.append((name, prop.name, item.name, round(width(item.name))))
    assert seen > 60
    assert cut == []
