# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import bpy

from ...core import identifiers, native
from ...core.choices import (
    DEFAULTS,
    PRESETS,
    Choices,
    DirectionProperty,
    PresetProperty,
    StrokesProperty,
    TextureProperties,
    enum_items,
)
from ...core.length_units import length_unit
from ...core.preferences import chosen_threads, preferences
from ...core.region import Region
from ...jobs.layouts.maps import PackSettings, map_summary, unwrap_and_place, write_map
from ...jobs.tasks.areas import mean_tile_size
from ...jobs.tasks.placing import mark_placed
from ...jobs.tasks.unwrapped import Unwrapped
from ...jobs.tasks.unwrapping import USUAL_TARGET, UnwrapSettings, UnwrapTask, unwrap_task
from ...mesh.angles import require_attributes
from ...mesh.own_settings import keep_settings, own_settings
from ...mesh.region_read import Groups
from ...mesh.targets import active_object
from ..shared.background import BackgroundOperator, Solved
from ..shared.cut_choices import chosen_cuts
from ..shared.packing import EFFORTS, PackingProperties, with_surroundings
from ..shared.properties import (
    NOT_IN_PRESETS,
    SEAMS,
    ConeGroupProperty,
    CutsProperty,
    SeamsProperty,
    max_stretch_property,
)
from ..shared.views import show_layouts
from .direction_choices import chosen_direction
from .features import PLACES, FeatureProperties
from .seamless import TileSizeProperties
from .sections import section

if TYPE_CHECKING:
    import lsgp

SCALES: Choices = {
    "FILL": (None, "Fill Square", "Islands become as large as possible"),
    "DENSITY": (None, "Texel Density", "Islands get this many texels per unit of length in the world"),
}

STACKS: Choices = {
    "NONE": (None, "None", "Every island has texels of its own"),
    "SAME": ("same", "Same", "Islands of one shape are stacked and share their texels"),
    "MIRRORED": (
        "mirrored",
        "Same or Mirrored",
        "Mirrored islands are stacked as well, such as those of the two halves of a body",
    ),
}

_UNSEEN = {"HIDDEN", *NOT_IN_PRESETS}


# Properties that are factors of a weight of `lsgp.Weights`.
WEIGHTS = {"fewer_islands": "islands", "shorter_cuts": "cuts", "fuller_square": "square", "symmetry": "symmetry"}


def weight_property(name: str, description: str) -> Any:
    return bpy.props.FloatProperty(
        name=name,
        description=f"{description} in the choice among maps, relative to the preset; 0 is no wish at all",
        default=1.0,
        min=0.0,
        max=100.0,
        soft_max=4.0,
    )


class UV_OT_cone_auto_unwrap(
    ConeGroupProperty,
    SeamsProperty,
    CutsProperty,
    PresetProperty,
    TextureProperties,
    DirectionProperty,
    StrokesProperty,
    TileSizeProperties,
    FeatureProperties,
    PackingProperties,
    BackgroundOperator,
    bpy.types.Operator,
):
    """Auto Unwrap."""

    bl_idname = identifiers.AUTO_UNWRAP
    bl_label = "Auto Unwrap"
    bl_description = (
        "Unwrap ready for use: marked cones and seams are kept, missing cones are placed, nothing overlaps, and the "
        "islands of all objects are packed together. Works on the selected faces in edit mode, on all faces of the "
        "selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    activity = "Unwrapping"
    nothing_selected = "No face is selected; select the faces to unwrap"

    count: bpy.props.IntProperty(
        name="Cones",
        description="Cones on each connected component that gets some, including those already marked; 0: as few as "
        "the stretch requires",
        default=0,
        min=0,
        soft_max=64,
    )
    target: bpy.props.FloatProperty(
        name="Stretch",
        description="The stretch (L2, 1 is none, 1.05 is 5 %) not to exceed on any connected component, as far as "
        "possible; less takes more cones, and with them cuts",
        default=USUAL_TARGET,
        min=1.001,
        soft_max=1.5,
        step=1,
        precision=3,
    )
    max_stretch: max_stretch_property()
    udim: bpy.props.IntProperty(
        name="UDIM Tiles",
        description="Spread the islands over this many UDIM tiles, 1001 and following, so that they become as large "
        "as possible; Bake cuts them further for that. Fewer are used if the largest island alone fills one. Each tile "
        "has a texture of this size. At a texel density this is the largest number",
        default=1,
        min=1,
        max=100,
        soft_max=10,
    )
    scale: bpy.props.EnumProperty(name="Scale", description="How large islands are", items=enum_items(SCALES))
    stack: bpy.props.EnumProperty(
        name="Stack",
        description="Which islands are stacked, so that all become larger; what is painted or baked on one "
        "appears on all. They do not count as overlapping. Not at a texel density",
        items=enum_items(STACKS),
    )
    inside: bpy.props.FloatProperty(
        name="Inside",
        description="Size of islands that nothing outside can see, as far as the unwrapped faces of their object hide "
        "them, relative to that of the others, so that the others become larger; 1: the same. Not at a texel density",
        default=1.0,
        min=0.01,
        max=1.0,
    )
    use_subsurf_data: bpy.props.BoolProperty(
        name="Subdivision Surface",
        description="Map UVs taking vertex position after Subdivision Surface modifier has been applied",
        default=True,
    )
    creases: bpy.props.BoolProperty(
        name="Cut at Sharp Edges",
        description="Cut hard surfaces at their creases and at edges marked sharp where that removes stretch; Paint "
        "does so only where many cones would be needed otherwise, Tile only where creases cannot run along the tiles. "
        "Components with marked cones or seams are not affected",
        default=True,
    )
    straighten: bpy.props.BoolProperty(
        name="Straight Sides",
        description="Make nearly straight sides of islands exactly straight, and align them with the axes of the UV "
        "map, wherever that costs hardly any stretch. Round sides stay round. With Tile: let creases of hard surfaces "
        "run along the tiles",
        default=True,
    )
    compact: bpy.props.BoolProperty(
        name="Split for Packing",
        description="Further cut islands that would leave much of the square empty, such as long strips, rings and "
        "those with arms: Bake wherever that is worth it, Paint only where a short cut fills much of the square; not "
        "parts with marked seams",
        default=True,
    )
    symmetric: bpy.props.BoolProperty(
        name="Symmetric",
        description="Place cones alike on both sides of a mirror plane, and on components that mirror each other, if "
        "that costs hardly any stretch and few islands; only where no cones are marked",
        default=True,
    )
    fewer_islands: weight_property("Fewer Islands", "How much fewer islands count")
    shorter_cuts: weight_property("Shorter Cuts", "How much shorter cuts count")
    fuller_square: weight_property("Fuller Square", "How much it counts that islands fill the square")
    symmetry: weight_property("Symmetry", "How much it counts that cones and cuts are symmetric")
    mark: bpy.props.BoolProperty(
        name="Mark Cones",
        description="Mark the cones that are placed, so that they can be edited and are kept by the next run",
        default=False,
    )

    taken: bpy.props.StringProperty(description="What was taken from the preferences, as JSON", options=_UNSEEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._take_settings(context)
        self._take_defaults(is_redone=False)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        if self.options.is_repeat:
            self._take_defaults(is_redone=True)
        return super().execute(context)

    def _take_settings(self, context: bpy.types.Context) -> None:
        """Those that were chosen for the active object, where the caller says nothing; what was chosen for another one,
        and Blender keeps, has no say."""
        active = active_object(context)
        kept = {} if active is None else own_settings(active)
        for name in self._names():
            if self.properties.is_property_set(name):
                continue
            self.properties.property_unset(name)
            if name in kept:
                # A value of another version of the add-on may be none any more.
                with suppress(TypeError, ValueError):
                    setattr(self, name, kept[name])

    def _keep_settings(self, objects: Iterable[bpy.types.Object]) -> None:
        """On the objects, but for what came from the preferences."""
        taken = json.loads(self.taken or "{}")
        is_set = partial(self.properties.is_property_set, ghost=False)
        values = {name: getattr(self, name) for name in self._names() if name != "taken" and is_set(name)}
        chosen = {name: value for name, value in values.items() if value != taken.get(name)}
        for obj in objects:
            keep_settings(obj, chosen)

    def _names(self) -> list[str]:
        # The stretch in percent is another view of the target.
        every = self.properties.bl_rna.properties
        return [prop.identifier for prop in every if not prop.is_readonly and prop.identifier != "max_stretch"]

    def _take_defaults(self, *, is_redone: bool) -> None:
        """Take from the preferences what neither the caller says nor the artist chose since Blender was started.

        is_redone: everything is set then, be it by the caller or by the run that is redone, and nothing is taken unless
            another preset was chosen.
        """
        defaults = preferences()
        taken = json.loads(self.taken or "{}")
        if defaults is None or (is_redone and taken.get("for") == self.preset):
            return

        def take(name: str, default: Any) -> None:
            is_said = not is_redone and self.properties.is_property_set(name)
            is_chosen = self.properties.is_property_set(name, ghost=False) and getattr(self, name) != taken.get(name)
            if not (is_said or is_chosen):
                setattr(self, name, default)
                taken[name] = getattr(self, name)

        if not is_redone:
            take("preset", defaults.preset)
        of_preset = getattr(defaults, self.preset.lower())
        for name in DEFAULTS[self.preset]:
            take(name, getattr(of_preset, name))
        self.taken = json.dumps(taken | {"for": self.preset})

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.row().prop(self, "preset", expand=True)
        layout.prop(self, "cuts")
        layout.prop(self, "count", text="Cones" if self.count else "Cones (Auto)")
        if not self.count:
            layout.prop(self, "max_stretch")
        if self.preset == "TILE":
            self.draw_tile_size(layout, context)
        else:
            layout.prop(self, "texture_size")
            layout.prop(self, "margin")
            layout.prop(self, "scale")
            if self.scale == "DENSITY":
                self.draw_density(layout, context)
            layout.prop(self, "udim")
            if self.scale == "FILL":
                layout.prop(self, "stack")
            layout.prop(self, "effort")
            if context.mode == "EDIT_MESH":
                layout.prop(self, "in_place")
        layout.prop(self, "direction")
        body = section(layout, "cone_auto_unwrap_cuts", "Cuts and Cones")
        if body is not None:
            self.draw_seams(body)
            body.prop(self, "creases")
            body.prop(self, "straighten")
            if self.preset != "TILE":
                body.prop(self, "compact")
                if self.scale == "FILL":
                    body.prop(self, "inside", slider=True)
            body.prop(self, "symmetric")
            body.prop(self, "follow_strokes")
            body.prop(self, "use_subsurf_data")
            body.prop(self, "mark")
            self.draw_vertex_group(body, context)
        body = section(layout, "cone_auto_unwrap_weights", "What Counts")
        if body is not None:
            for name in WEIGHTS:
                if name != "symmetry" or self.symmetric:
                    body.prop(self, name, slider=True)
        self.draw_features(layout, "cone_auto_unwrap_features", in_tiles=self.preset == "TILE")

    def plan(self) -> tuple[Groups, Callable[[bpy.types.Object, Region], UnwrapTask]]:
        self.adopt_density(bpy.context)
        options = self._options()
        settings = UnwrapSettings(
            options=options,
            cone_group=self.vertex_group,
            weight_group=None,
            weight_factor=1.0,
            # Pins and the shape of an image would tear a seamless layout; pins would have to move for a density.
            use_pins=options.seamless is None and self.scale == "FILL",
            keep_placement=False,
            correct_aspect=options.seamless is None,
            cuts=chosen_cuts(self.cuts),
            direction=chosen_direction(self.direction, tiles=self.preset == "TILE"),
            features=self.feature_kinds(),
        )

        def make_task(obj: bpy.types.Object, region: Region) -> UnwrapTask:
            if self.mark:
                require_attributes(obj.data)
            creases_of = PRESETS[self.preset][0] if self.creases else None
            return replace(
                unwrap_task(region, settings),
                completes=True,
                count=self.count or None,
                # As it was typed, not in single precision.
                target=round(self.target, 6),
                symmetric=self.symmetric,
                weights=self._weights(),
                creases_of=creases_of,
            )

        return Groups(settings.cone_group), make_task

    def solver(self, context: bpy.types.Context) -> Callable[..., list[Unwrapped | Exception]]:
        settings = with_surroundings(self._packing(), *self.sources(context), in_place=self.in_place)
        return partial(unwrap_and_place, settings)

    def write(self, solved: Solved) -> list[str]:
        for obj, task, unwrapped in solved:
            write_map(obj, unwrapped)
            if self.mark:
                mark_placed(obj, self.vertex_group, task.cones, unwrapped.result)
        self._keep_settings(obj for obj, _, _ in solved)
        if self.preset == "TILE":
            # Such layouts are as many units wide as there are tiles.
            show_layouts(bpy.context)
            return [f"{map_summary(unwrapped)}, {_size_of_tiles(unwrapped)}" for _, _, unwrapped in solved]
        return [map_summary(unwrapped) for _, _, unwrapped in solved]

    def _weights(self) -> lsgp.Weights:
        """Those of the preset, times what the artist wants more or less."""
        usual = native.lsgp.preset_weights(PRESETS[self.preset][0])
        return replace(usual, **{of: getattr(usual, of) * getattr(self, name) for name, of in WEIGHTS.items()})

    def _packing(self) -> PackSettings:
        size = int(self.texture_size)
        by_cells = self.preset == "TILE"
        effort = EFFORTS[self.effort][0]
        pack = PackSettings(True, by_cells, self.margin / size, udim=self.udim, effort=effort)
        if by_cells:
            return pack
        if self.scale == "FILL":
            return replace(pack, stack=STACKS[self.stack][0], inside=self.inside)
        layout = native.lsgp.TexelLayout(self.density, size, self.udim, self.margin)
        return replace(pack, texels=layout, unit=length_unit(bpy.context.scene).size)

    def _options(self) -> lsgp.Options:
        """Raises InputError."""
        options = native.lsgp.preset_options(PRESETS[self.preset][0])
        options = replace(
            options,
            seams=SEAMS[self.seams][0],
            straighten=options.straighten and self.straighten,
            compact=options.compact if self.compact else "off",
            follow_strokes=self.follow_strokes,
            square_share=float(self.udim),
            threads=chosen_threads(),
        )
        if options.seamless is not None:
            tiles = self.tile_size_options() | {"feature_places": PLACES[self.straight_places][0]}
            options = replace(options, seamless=replace(options.seamless, **tiles))
        return options


def _size_of_tiles(unwrapped: Unwrapped) -> str:
    """In the world, as they came out, as "tiles of 0.25 m"."""
    unit = length_unit(bpy.context.scene)
    size = mean_tile_size(unwrapped.region, unwrapped.result) * unwrapped.region.object_scale / unit.size
    return f"tiles of {size:.3g} {unit.name}"
