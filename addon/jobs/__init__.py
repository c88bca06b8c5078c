# SPDX-License-Identifier: GPL-3.0-or-later
"""Computations on what was read from Blender: in the background, in batches, while cones are edited, on images."""
