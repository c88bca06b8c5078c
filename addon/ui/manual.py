# SPDX-License-Identifier: GPL-3.0-or-later
"""What *Online Manual* in the context menu of an operator or a property opens: the home page, at a page of `docs`."""

import bpy

from ..core import identifiers

FIRST_UNWRAP = "tutorials/first-unwrap"
SEEING = "how-to/seeing"
CONES = "how-to/choosing-cones"
ANGLES = "reference/cone-angles"
CUTS = "how-to/cuts"
TEXELS = "how-to/texel-density"
ISLANDS = "how-to/islands"
DIRECTION = "how-to/texture-direction"

PAGES = {
    identifiers.AUTO_UNWRAP: FIRST_UNWRAP,
    identifiers.UNWRAP: FIRST_UNWRAP,
    identifiers.PACK: "how-to/packing",
    identifiers.STRAIGHTEN: ISLANDS,
    identifiers.RECTIFY: ISLANDS,
    identifiers.GRID: ISLANDS,
    identifiers.ALIGN: ISLANDS,
    identifiers.ORIENT: ISLANDS,
    identifiers.STITCH: ISLANDS,
    identifiers.RIP: ISLANDS,
    identifiers.REMESH_TO_QUADS: "how-to/quads",
    identifiers.MARK: CONES,
    identifiers.SELECT: CONES,
    identifiers.EDIT: CONES,
    identifiers.PLACE: CONES,
    identifiers.EDIT_CUTS: CUTS,
    identifiers.STEER_CUTS: CUTS,
    identifiers.SELECT_CUTS: CUTS,
    identifiers.SEAMS_FROM_CUTS: CUTS,
    identifiers.DRAW_UP: DIRECTION,
    identifiers.MARK_UP: DIRECTION,
    identifiers.SET_ANGLE: ANGLES,
    identifiers.SPREAD_REST: ANGLES,
    identifiers.SNAP_ANGLES: ANGLES,
    identifiers.SUGGEST: ANGLES,
    identifiers.PREVIEW: ANGLES,
    identifiers.SELECT_ONE: ANGLES,
    identifiers.UPDATE_TABLE: ANGLES,
    identifiers.CLEAR_DATA: ANGLES,
    identifiers.SELECT_REPORTED: "how-to/troubleshooting",
    identifiers.MEASURE: SEEING,
    identifiers.TEXTURE_SHOW: SEEING,
    identifiers.EXTEND_IMAGE: "how-to/gutters",
    identifiers.TEXEL_GET: TEXELS,
    identifiers.TEXEL_SET: TEXELS,
    identifiers.TEXEL_SELECT: TEXELS,
}
"""Page by operator, without the suffix."""

SETTINGS = {
    "ConeUnwrapOverlay": SEEING,
    "ConeUnwrapTexels": TEXELS,
    "Object.cone_unwrap_density_weight": TEXELS,
    "ConeUnwrapPreferences": "how-to/installing",
    "ConeUnwrapPresetDefaults": "how-to/installing",
}
"""Page by class of properties, or by property."""


def manual_map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """As `bpy.utils.register_manual_map` wants it: a prefix, and patterns of lower-case names with what follows it."""
    operators = [(f"bpy.ops.{operator}", page) for operator, page in PAGES.items()]
    settings = [(f"bpy.types.{name.lower()}*", page) for name, page in SETTINGS.items()]
    return f"{identifiers.HOME_PAGE}#", (*operators, *settings)


def register() -> None:
    bpy.utils.register_manual_map(manual_map)


def unregister() -> None:
    bpy.utils.unregister_manual_map(manual_map)
