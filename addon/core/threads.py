# SPDX-License-Identifier: GPL-3.0-or-later
"""How many threads the library may take, as the artist chose in the preferences."""

import bpy

from .identifiers import EXTENSION


def chosen_threads() -> int:
    """0 for the library's default, see `native`.  Only in Blender's main thread."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return 0 if addon is None else addon.preferences.threads  # None: registered by a script, without preferences
