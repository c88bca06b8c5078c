# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

import bpy

from .identifiers import EXTENSION


def preferences() -> bpy.types.AddonPreferences | None:
    """None if a script registered the add-on, which has no preferences then.  Only in Blender's main thread."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return None if addon is None else addon.preferences


def chosen_threads() -> int:
    """How many threads the library may take, as the artist chose; 0 for the library's default, see `native`."""
    found = preferences()
    return 0 if found is None else found.threads
