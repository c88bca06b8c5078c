# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps, cones and quads computed from regions, in the background, with their options and results."""
