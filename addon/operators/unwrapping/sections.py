# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of an operator's panel that can be closed."""

import bpy


def section(
    layout: bpy.types.UILayout, identifier: str, title: str, *, is_open: bool = False
) -> bpy.types.UILayout | None:
    """The layout of a part; None while it is closed.  identifier: keeps whether it is.  is_open: at first."""
    try:
        header, body = layout.panel(identifier, default_closed=not is_open)
    except RuntimeError:
        # Blender has no panels in the popup of F9.
        body = layout.column()
        body.label(text=title)
        return body
    header.label(text=title)
    return body
