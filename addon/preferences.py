# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: the state of the computing library."""

import bpy

from . import native


def library_state() -> str:
    """One sentence: where the computing library was loaded from, or that it is missing and what to do."""
    return native.PROBLEM or f"Computing library loaded from {native.lsgp.__file__}"


class ConeUnwrapPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.label(text=library_state(), icon="ERROR" if native.PROBLEM else "CHECKMARK")
        if native.REASON:
            self.layout.label(text=native.REASON)
