# SPDX-License-Identifier: GPL-3.0-or-later
"""Cone Unwrap: UV unwrapping through cones; one rotation and one translation relate the two sides of every seam.

The code is divided into rooms. A room imports only rooms named before it; tests/architecture checks this.

core: arrays, names, errors and findings; nothing is read from meshes here.
mesh: reading and writing Blender's meshes.
jobs: computations on what was read, in rooms by what they are for.
overlay: what is drawn over meshes.
operators: Blender's operators, one per file, in rooms by topic.
ui: menus, panels and preferences.
"""

from .registration import register, unregister

__all__ = ["register", "unregister"]
