# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences: the defaults of each preset of Auto Unwrap, as far as they have an effect."""

import bpy
import pytest
from installed import EXTENSION, addon

OF_TEXTURE = ["texture_size", "margin", "direction"]


class RecordingLayout:
    """Keeps the names of the properties that were drawn, by owner."""

    def __init__(self, drawn):
        self.drawn = drawn

    def _part(self, **_options):
        return RecordingLayout(self.drawn)

    row = column = _part

    def label(self, text="", icon="NONE"):
        pass

    def separator(self):
        pass

    def prop(self, owner, name, text=None):
        self.drawn.append((owner, name))


@pytest.fixture
def preferences():
    found = bpy.context.preferences.addons[EXTENSION].preferences
    yield found
    for name in ("preset", "paint", "tile", "bake"):
        found.property_unset(name)


def drawn(preferences, preset):
    """The names drawn for a preset."""
    layout = RecordingLayout([])
    stand_in = type("Preferences", (), {"layout": layout, "_draw_defaults": type(preferences)._draw_defaults})()
    for prop in preferences.bl_rna.properties:
        setattr(stand_in, prop.identifier, getattr(preferences, prop.identifier))
    type(preferences).draw(stand_in, bpy.context)
    return [name for owner, name in layout.drawn if owner == getattr(preferences, preset)]


def test_each_preset_has_defaults_of_its_own(preferences):
    preferences.bake.margin = 16
    assert (preferences.paint.margin, preferences.tile.margin) == (4, 4)
    assert drawn(preferences, "paint") == drawn(preferences, "bake") == OF_TEXTURE


def test_the_size_of_tiles_is_drawn_as_it_is_chosen(preferences):
    numbers = {"AUTO": [], "TILES": ["tiles"], "SIZE": ["tile_size"], "DENSITY": ["texture_size"]}
    for fit, number in numbers.items():
        preferences.tile.tile_fit = fit
        assert drawn(preferences, "tile") == ["tile_fit", *number, "direction"]


def test_they_are_the_defaults_of_the_operator(preferences):
    """Nobody who never opens the preferences gets another map by a press than by a script."""
    operator = bpy.ops.uv.cone_auto_unwrap.get_rna_type().properties
    for preset, names in addon.core.choices.DEFAULTS.items():
        of_preset = getattr(preferences, preset.lower())
        for name in names:
            assert getattr(of_preset, name) == operator[name].default
