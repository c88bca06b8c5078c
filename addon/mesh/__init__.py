# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading and writing meshes and images of Blender: geometry, UVs, cones, attributes, selection, materials, pixels."""
