# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density read from meshes, given to them, and used to select faces."""
