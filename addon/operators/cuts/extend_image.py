# SPDX-License-Identifier: GPL-3.0-or-later
"""Extend Image across Cuts."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...core.errors import Refused
from ...core.text import counted
from ...jobs.uv_maps.gutters import Mapped, extended, mapped_faces
from ...mesh.image_aspect import active_image, faces_showing
from ...mesh.image_pixels import read_pixels, require_paintable, write_pixels
from ...mesh.region_read import Faces, Groups, read_region, require_uv_map
from ...mesh.targets import target_objects
from ..shared.conclusion import conclude, for_each
from ..shared.polling import ComputingOperator


class UV_OT_cone_extend_image(ComputingOperator, bpy.types.Operator):
    """Extend Image across Cuts."""

    bl_idname = identifiers.EXTEND_IMAGE
    bl_label = "Extend Image across Cuts"
    bl_description = (
        "Fill the image in the material of the active face, beside the islands of all selected objects that show it, "
        "with what lies beyond their cuts, so that cuts do not show where textures are filtered. Pixels inside islands "
        "stay as they are"
    )
    # Without UNDO, as writing pixels makes undo steps of its own kind.
    bl_options = {"REGISTER"}

    margin: bpy.props.IntProperty(
        name="Margin",
        description="How far from islands the image is filled; each further mip level of a texture needs twice as much",
        default=16,
        min=1,
        soft_max=256,
        subtype="PIXEL",
    )
    normal_map: bpy.props.BoolProperty(
        name="Normal Map",
        description="The image holds tangent-space normals with green up, which rotate with the map; set its color "
        "space to Non-Color",
        default=False,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), _shown)
        parts: dict[bpy.types.Image, list[tuple[bpy.types.Object, Mapped]]] = {}
        for obj, (image, mapped) in found:
            parts.setdefault(image, []).append((obj, mapped))
        # Where an object is refused, its islands would not be spared.
        for name in failures:
            parts.pop(active_image(context.view_layer.objects[name]), None)
        done = []
        for image, shown in parts.items():
            results, failed = for_each([shown[0][0]], lambda _, image=image, shown=shown: self._extend(image, shown))
            failures |= failed
            done += [text for _, text in results]
        return conclude(self, done, {}, failures)

    def _extend(self, image: bpy.types.Image, shown: list[tuple[bpy.types.Object, Mapped]]) -> str:
        """Write an image; says what was done.  Raises LsgpError."""
        before = read_pixels(image)
        after = extended(before, [mapped for _, mapped in shown], self.margin, normal_map=self.normal_map)
        changed = int((before != after).any(axis=2).sum())
        if not changed:
            return f'No pixel of "{image.name}" had to change'
        write_pixels(image, after)
        return f'Extended "{image.name}": {counted(changed, "pixel")}; save the image'


def _shown(obj: bpy.types.Object) -> tuple[bpy.types.Image, Mapped]:
    """The image that an object shows, and the faces that show it.  Raises LsgpError, Refused."""
    region = read_region(obj, Faces.ALL, Groups())
    require_uv_map(obj)
    image = active_image(obj)
    if image is None:
        raise Refused("the material of the active face has no image with pixels; add an Image Texture to it")
    require_paintable(image)
    return image, mapped_faces(region, faces_showing(obj, image))
