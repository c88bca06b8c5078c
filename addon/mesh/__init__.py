# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading and writing Blender's meshes: geometry, UVs, cones and their angles, attributes, selection, materials."""
