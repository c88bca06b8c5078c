# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators of texel density share: the density, the size of the texture, and reading meshes with both."""

from __future__ import annotations

import bpy

from ...jobs.uv_maps.texels import Texels, measure_texels
from ...mesh.region_read import Faces, read_chosen, require_editable, require_uv_map
from ...mesh.targets import selects_by_uv
from ...mesh.texel_settings import image_property, size_property, texel_settings, texture_size
from ..shared.polling import ComputingOperator

NOTHING_SELECTED = "No face is selected; select some first"


class TexelOperator(ComputingOperator):
    """Mix-in: an operator that takes the scene's settings where it is not told otherwise."""

    use_image: image_property(options={"SKIP_SAVE"})
    texture_size: size_property(options={"SKIP_SAVE"})

    def adopt_settings(self, context: bpy.types.Context) -> None:
        """Take from the scene's settings what the caller has not set; the redo panel shows it as set."""
        kept = texel_settings(context.scene)
        for name in ("density", "use_image", "texture_size"):
            if name in self.properties.bl_rna.properties and not self.properties.is_property_set(name):
                setattr(self, name, getattr(kept, name))

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        if "density" in self.properties.bl_rna.properties:
            self.draw_density(layout, context)
        self.draw_choices(layout)
        layout.prop(self, "use_image")
        layout.prop(self, "texture_size")

    def draw_choices(self, layout: bpy.types.UILayout) -> None:
        """What only this operator has."""

    def measured(self, context: bpy.types.Context, obj: bpy.types.Object, faces: Faces | None = None) -> Texels | None:
        """The map of an object; None where no face is selected.  faces: by default the selected ones of the editor.

        Raises LsgpError, Refused.
        """
        require_editable(obj)
        require_uv_map(obj)
        selected = Faces.UV_SELECTED if selects_by_uv(context) else Faces.SELECTED
        found = read_chosen(obj, selected if faces is None else faces)
        if found is None:
            return None
        return measure_texels(*found, texture_size(obj, use_image=self.use_image, typed=self.texture_size))
