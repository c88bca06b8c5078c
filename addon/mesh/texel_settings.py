# SPDX-License-Identifier: GPL-3.0-or-later
"""The texel density of a scene's assets and the size of their textures; saved with the file."""

from __future__ import annotations

import bpy

from ..core.length_units import length_unit
from .image_aspect import active_image

IMAGE_DESCRIPTION = "Take the size of the image in the material of the active face, if there is one"
SIZE_DESCRIPTION = "Side of the texture in pixels, where it is not taken from an image"
DENSITY_DESCRIPTION = "Pixels of the texture along a unit of length, which is that of the scene's unit settings"


class ConeUnwrapTexels(bpy.types.PropertyGroup):
    """What Get, Set and Select by Texel Density begin with."""

    density: bpy.props.FloatProperty(
        name="Density", description=DENSITY_DESCRIPTION, default=1024.0, min=1e-6, soft_max=1e5, precision=2
    )
    use_image: bpy.props.BoolProperty(name="Size from Image", description=IMAGE_DESCRIPTION, default=True)
    texture_size: bpy.props.IntProperty(
        name="Texture Size",
        description=SIZE_DESCRIPTION,
        default=1024,
        min=1,
        soft_max=16384,
        subtype="PIXEL",
    )


def texel_settings(scene: bpy.types.Scene) -> ConeUnwrapTexels:
    return scene.cone_unwrap_texels


def texture_size(obj: bpy.types.Object, *, use_image: bool, typed: int) -> tuple[int, int]:
    """Width and height in pixels: of the object's image, or as typed where it has none or it is not to be used."""
    image = active_image(obj) if use_image else None
    return (typed, typed) if image is None else tuple(image.size)


def shown_density(scene: bpy.types.Scene, density: float) -> str:
    """A number of pixels in the unit of the scene, as "512.0 px/m"."""
    digits = 1 if density < 10000 else 0
    return f"{density:.{digits}f} {density_unit(scene)}" if density >= 1 else f"{density:.3g} {density_unit(scene)}"


def density_unit(scene: bpy.types.Scene) -> str:
    """As "px/m"."""
    return f"px/{length_unit(scene).name}"


def register() -> None:
    bpy.utils.register_class(ConeUnwrapTexels)
    bpy.types.Scene.cone_unwrap_texels = bpy.props.PointerProperty(type=ConeUnwrapTexels)


def unregister() -> None:
    del bpy.types.Scene.cone_unwrap_texels
    bpy.utils.unregister_class(ConeUnwrapTexels)
