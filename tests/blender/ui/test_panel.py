# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator's panel: options without effect are left out."""

import inspect

import bpy
from installed import EXTENSION
from scenes import add_cone_cube

SEAMLESS_ONLY = {
    "straight_places",
    "lattice",
    "tile_fit",
    "tiles",
    "tile_size",
    "density",
    "coarse_grid",
    "parity",
    "mip_safe",
    "texture_size",
    "mip_levels",
}


class RecordingLayout:
    """Stands for the redo panel and keeps which properties were drawn, and whether they were grayed out."""

    def __init__(self, drawn, active=True, is_open=True):
        self.drawn, self.active, self.is_open = drawn, active, is_open
        self.use_property_split = False

    def _part(self, **_options):
        return RecordingLayout(self.drawn, self.active, self.is_open)

    row = column = box = _part

    def panel(self, _identifier, default_closed):
        return self, self if self.is_open or not default_closed else None

    def label(self, text=""):
        pass

    def separator(self):
        pass

    def prop(self, _owner, name, expand=False, text=""):
        self.drawn[name] = self.active

    def prop_enum(self, _owner, name, _value):
        self.drawn[name] = self.active

    def prop_search(self, _owner, name, *_where, **_options):
        self.drawn[name] = self.active


def our_properties(operator=bpy.ops.uv.cone_unwrap):
    """The operator's properties but those that every operator has."""
    common = {"rna_type", "bl_idname", "bl_label"}
    return [p for p in operator.get_rna_type().properties if p.identifier not in common]


def panel(is_open=True, operator=bpy.ops.uv.cone_unwrap, **options):
    """Names of the properties drawn with these options; True where they can be changed.

    is_open: whether all parts are open, or those that are at first.
    """
    add_cone_cube()
    cls = getattr(bpy.types, operator.get_rna_type().identifier)
    ours = [cls for cls in cls.__mro__ if cls.__module__.startswith(EXTENSION)]
    functions = {name: f for cls in reversed(ours) for name, f in vars(cls).items() if inspect.isfunction(f)}
    stand_in = type("Operator", (), functions)()
    values = {prop.identifier: prop.default for prop in our_properties(operator)} | options
    for name, value in values.items():
        setattr(stand_in, name, value)
    stand_in.layout = RecordingLayout({}, is_open=is_open)
    stand_in.draw(bpy.context)
    return stand_in.layout.drawn


def test_every_property_is_drawn_once_with_the_options_it_has_a_say_in():
    plain = panel()
    everything = {prop.identifier for prop in our_properties()}
    low_stretch = {"stretch", "use_weights"}
    weights = {"weight_group", "weight_factor"}
    straight = {"straight_sharp", "straight_seams", "straight_borders", "straight_creases"}
    assert plain.keys() == everything - low_stretch - weights - straight - {"straight_angle"} - SEAMLESS_ONLY
    assert "margin" in plain
    assert panel(mode="LOW_STRETCH").keys() - plain.keys() == low_stretch | straight
    assert panel(mode="LOW_STRETCH", use_weights=True).keys() - plain.keys() == low_stretch | straight | weights
    with_creases = panel(mode="LOW_STRETCH", straight_creases=True)
    assert with_creases.keys() - plain.keys() == low_stretch | straight | {"straight_angle"}
    assert panel(use_weights=True).keys() == plain.keys()


def test_options_of_seamless_layouts_are_drawn_only_with_it():
    plain, seamless = panel(), panel(seamless=True)
    straight = {"straight_sharp", "straight_seams", "straight_borders", "straight_creases"}
    of_grid = {"lattice", "tile_fit", "coarse_grid", "parity", "mip_safe", "straight_places"}
    assert seamless.keys() - plain.keys() == of_grid | straight
    assert plain.keys() - seamless.keys() == {"correct_aspect", "margin", "effort", "in_place"}
    assert panel(seamless=True, tile_fit="TILES").keys() - seamless.keys() == {"tiles"}
    assert panel(seamless=True, tile_fit="SIZE").keys() - seamless.keys() == {"tile_size"}
    by_density = panel(seamless=True, tile_fit="DENSITY").keys()
    assert by_density - seamless.keys() == {"density", "texture_size"}
    assert panel(seamless=True, tile_fit="DENSITY", mip_safe=True).keys() - by_density == {"mip_levels"}
    assert panel(seamless=True, mip_safe=True).keys() - seamless.keys() == {"texture_size", "mip_levels"}
    assert seamless["parity"] and not panel(seamless=True, lattice="HEXAGON")["parity"]


def test_the_margin_is_drawn_where_islands_are_packed():
    def drawn(**options):
        names = panel(**options)
        return {name: name in names for name in ("margin", "keep_placement", "pack")}

    packer, no_packer = {"margin": True}, {"margin": False}
    assert drawn() == packer | {"keep_placement": True, "pack": True}
    assert drawn(pack=False) == no_packer | {"keep_placement": True, "pack": True}
    # What keeps its place is not packed.
    assert drawn(keep_placement=True) == no_packer | {"keep_placement": True, "pack": False}
    # Seamless islands are moved by whole tiles only.
    assert drawn(seamless=True) == no_packer | {"keep_placement": True, "pack": True}


def test_a_beginner_sees_few_properties_and_the_rest_is_closed():
    closed = panel(is_open=False)
    assert set(closed) == {"mode", "overlaps", "seamless"}


def test_of_auto_unwrap_a_beginner_sees_the_preset_cuts_cones_and_the_square():
    def at_first(**options):
        return set(panel(False, bpy.ops.uv.cone_auto_unwrap, **options))

    always = {"preset", "cuts", "count", "direction"}
    square = {"texture_size", "margin", "scale", "udim", "effort"}
    assert at_first() == at_first(preset="BAKE") == always | square | {"max_stretch", "stack"}
    assert at_first(scale="DENSITY") == always | square | {"max_stretch", "density"}
    assert at_first(preset="TILE") == always | {"max_stretch", "tile_fit"}
    # A number of cones leaves no choice of the stretch.
    assert at_first(preset="TILE", count=8) == always | {"tile_fit"}


def test_without_panels_in_a_popup_all_properties_are_drawn(monkeypatch):
    def refuse(*_arguments, **_options):
        raise RuntimeError("Layout panels can not be used in this context")

    whole = panel()
    monkeypatch.setattr(RecordingLayout, "panel", refuse)
    assert panel() == whole


def test_every_property_has_a_tooltip_in_blenders_manner():
    told = {prop.identifier: prop for prop in our_properties()}
    assert told.keys() >= SEAMLESS_ONLY | {"seamless"}
    for prop in told.values():
        assert prop.name and prop.description and not prop.description.endswith(".")
        for item in getattr(prop, "enum_items", ()):
            assert item.name and item.description and not item.description.endswith(".")


def test_importance_weights_are_named_as_in_blenders_own_unwrap():
    # From the version on that has them.
    theirs = bpy.ops.uv.unwrap.get_rna_type().properties
    ours = {prop.identifier: prop for prop in our_properties()}
    assert ours["weight_group"].default == "uv_importance"
    assert ours["weight_factor"].default == 1.0
    for name in {"use_weights", "weight_group", "weight_factor"} & set(theirs.keys()):
        assert ours[name].name == theirs[name].name
        assert ours[name].default == theirs[name].default
