# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads: the grid of a seamless layout as a mesh, and the layouts for it."""
