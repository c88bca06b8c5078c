# SPDX-License-Identifier: GPL-3.0-or-later
"""Computations on what was read from Blender, in rooms by what they are for."""
