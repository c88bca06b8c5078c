# SPDX-License-Identifier: GPL-3.0-or-later
"""The texel density of a scene's assets, its weight on each object, and the size of textures; saved with the file."""

from __future__ import annotations

import bpy

from ..core.length_units import length_unit
from .image_aspect import active_image

WEIGHT_DESCRIPTION = (
    "How many times the texel density of other objects this one gets where several are unwrapped together or a density "
    "is asked for: 2 for what is seen from near, 0.5 for what is seen from afar"
)
DENSITY_DESCRIPTION = "Pixels of the texture along a unit of length, which is that of the scene's unit settings"


def image_property(**options: object) -> bool:
    return bpy.props.BoolProperty(
        name="Size from Image",
        description="Take the size of the image in the material of the active face, if there is one",
        default=True,
        **options,
    )


def size_property(**options: object) -> int:
    return bpy.props.IntProperty(
        name="Texture Size",
        description="Side of the texture in pixels, where it is not taken from an image",
        default=1024,
        min=1,
        soft_max=16384,
        subtype="PIXEL",
        **options,
    )


class ConeUnwrapTexels(bpy.types.PropertyGroup):
    """The defaults of Get, Set and Select by Texel Density."""

    density: bpy.props.FloatProperty(
        name="Density", description=DENSITY_DESCRIPTION, default=1024.0, min=1e-6, soft_max=1e5, precision=2
    )
    use_image: image_property()
    texture_size: size_property()


def texel_settings(scene: bpy.types.Scene) -> ConeUnwrapTexels:
    return scene.cone_unwrap_texels


def density_weight(obj: bpy.types.Object) -> float:
    """How many times the density of other objects it is to have."""
    return obj.cone_unwrap_density_weight


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
    bpy.types.Object.cone_unwrap_density_weight = bpy.props.FloatProperty(
        name="Density Weight", description=WEIGHT_DESCRIPTION, default=1.0, min=0.01, max=100.0, soft_max=4.0, step=10
    )


def unregister() -> None:
    del bpy.types.Object.cone_unwrap_density_weight
    del bpy.types.Scene.cone_unwrap_texels
    bpy.utils.unregister_class(ConeUnwrapTexels)
