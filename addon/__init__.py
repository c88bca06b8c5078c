# SPDX-License-Identifier: GPL-3.0-or-later
"""Cone Unwrap: unwrap meshes through cones, with both sides of every seam related by one rotation and translation."""

from .registration import register, unregister

__all__ = ["register", "unregister"]
